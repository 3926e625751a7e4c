"""The shared library, its declarations, and what turns its values into Python's."""
import os
import pathlib
import re

import cffi
import numpy as np

_HERE = pathlib.Path(__file__).resolve().parent

ffi = cffi.FFI()
ffi.cdef((_HERE/"interface.h").read_text())


class Error(RuntimeError):
    """What a call of the library refuses or fails at; `status` is its word, `key` the place in a definition."""

    def __init__(self, text, status="", key=""):
        super().__init__(text)
        self.status, self.key = status, key


def _open():
    name = "libtobiuo.so.0"
    places = [os.environ.get("TOBIUO_LIBRARY")]
    # beside the package in a build folder; below the prefix that the package is installed in
    places += [str(_HERE.parents[1]/name), str(_HERE.parents[2]/name)]
    places += [str(place) for place in sorted(_HERE.parents[2].glob(f"*/{name}"))]
    for place in places:
        if place and os.path.exists(place):
            return ffi.dlopen(place)
    try:
        return ffi.dlopen(name)
    except OSError as error:
        raise ImportError(f"{name} is not there: build Tobiuo, or name the file in TOBIUO_LIBRARY "
                          f"(tried {', '.join(p for p in places if p)})") from error


lib = _open()
version = ffi.string(lib.tobi_version()).decode()


def text_of(pointer):
    """A C text, which the library keeps; None for NULL."""
    return None if pointer == ffi.NULL else ffi.string(pointer).decode()


def take_text(pointer):
    """A C text that the caller owns."""
    text = text_of(pointer)
    if text is not None:
        _libc.free(pointer)
    return text


_libc_ffi = cffi.FFI()
_libc_ffi.cdef("void free(void *);")
_libc = _libc_ffi.dlopen(None)


def free_pointer(pointer):
    """Of memory that the caller owns."""
    _libc.free(pointer)


def drop_places(text):
    """A dict has no lines and columns: its mistakes begin with the key."""
    return re.sub(r"(?m)^[^\n]*?:1:\d+: ", "", text)


def raise_error(status, error, of_dict=False):
    said = text_of(error.text).replace("--force", "force=True")      # the option of the program
    said = drop_places(said) if of_dict else said
    raise Error(said or text_of(lib.tobi_status_text(status)),
                text_of(lib.tobi_status_text(status)), text_of(error.key))


def call(function, *arguments, of_dict=False):
    """Calls a function whose last argument is a tobi_error; raises Error if it fails."""
    error = ffi.new("tobi_error *")
    status = function(*arguments, error)
    if status != lib.TOBI_OK:
        raise_error(status, error, of_dict)


def set_language(name):
    """The language of errors, mistakes and notes of the whole process: "en", as at the start, or "ja"."""
    call(lib.tobi_set_language, name.encode())


def array_of(pointer, shape, kind=np.float64):
    """A copy of `shape` numbers."""
    count = int(np.prod(shape))
    if count == 0:
        return np.empty(shape, kind)
    return np.frombuffer(ffi.buffer(pointer, count*np.dtype(kind).itemsize), kind).reshape(shape).copy()


def values_of(struct):
    """A dict of the members of a C struct that are numbers, texts, or arrays of numbers."""
    out = {}
    for name, field in ffi.typeof(struct).fields:
        value = getattr(struct, name)
        if field.type.kind == "array":
            out[name] = np.array(list(value))
        elif field.type.kind == "primitive":
            out[name] = value
        elif field.type is ffi.typeof("const char *"):
            out[name] = text_of(value)
    return out


def vector(values, what, allowed=(2, 3)):
    """Three doubles for C. In 2-D two will do."""
    if np.ndim(values) != 1 or len(values) not in allowed:
        hint = "2 or 3 numbers" if 2 in allowed else "3 numbers; in 2-D the third counts"
        raise ValueError(f"{what}: is {values!r}, must be {hint}")
    values = [float(v) for v in values]
    return ffi.new("double[3]", values + [0.0]*(3 - len(values)))
