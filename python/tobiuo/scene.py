"""Scenes: loaded, checked, described."""
import json
import math
import os

from .library import Error, call, drop_places, ffi, lib, raise_error, take_text, text_of


def _plain(value):
    """What json does not know: numbers and arrays of NumPy."""
    if hasattr(value, "tolist"):
        return value.tolist()
    raise TypeError(f"{value!r} is nothing that a scene holds; allowed are numbers, texts, lists, dicts and arrays")


def _find_nan(value, path=""):
    """The key and value of the first number that JSON cannot hold."""
    if hasattr(value, "tolist"):
        value = value.tolist()
    if isinstance(value, dict):
        inside = ((f"{path}.{key}" if path else str(key), entry) for key, entry in value.items())
    elif isinstance(value, (list, tuple)):
        inside = ((f"{path}[{k}]", entry) for k, entry in enumerate(value))
    else:
        return (path, value) if isinstance(value, float) and not math.isfinite(value) else None
    return next((found for name, entry in inside if (found := _find_nan(entry, name))), None)


def _to_json(value, path=""):
    if found := _find_nan(value, path):
        raise ValueError(f"{found[0]}: is {found[1]}, must be a finite number")
    return json.dumps(value, default=_plain)


def _overrides(values):
    """{"spacing": 0.01} as the texts "spacing=0.01"; a list of such texts stays."""
    if values is None:
        return ffi.NULL, []
    if isinstance(values, dict):
        values = [f"{key}={value if isinstance(value, str) else _to_json(value, key)}" for key, value in values.items()]
    elif isinstance(values, str):
        values = [values]
    kept = [ffi.new("char[]", text.encode()) for text in values]
    return ffi.new("char *[]", kept + [ffi.NULL]), kept


def _read(scene, values, name):
    """The status of loading, scene, report and error."""
    out, report, error = ffi.new("tobi_scene **"), ffi.new("tobi_report **"), ffi.new("tobi_error *")
    texts, kept = _overrides(values)
    if isinstance(scene, dict):
        scene, name = _to_json(scene), name or "scene.json"
    if not isinstance(scene, (str, bytes, os.PathLike)):
        raise TypeError(f"a scene is a path, a text in JSON or a dict, not {scene!r}")
    scene = os.fsdecode(scene)
    if name or scene.lstrip().startswith("{"):
        data = scene.encode()
        status = lib.tobi_scene_parse((name or "scene.json").encode(), data, len(data), texts, out, report, error)
    else:
        if os.path.isdir(scene):
            scene = os.path.join(scene, "scene.json")
        status = lib.tobi_scene_load(scene.encode(), texts, out, report, error)
    del kept
    return status, out[0], report[0], error


def _take_lines(report, scene):
    lines = [text_of(lib.tobi_report_line(report, k)) for k in range(lib.tobi_report_count(report))]
    lib.tobi_report_free(report)
    return [drop_places(line) for line in lines] if isinstance(scene, dict) else lines


def load(scene, values=None, name=None):
    """A tobi_scene that the caller owns."""
    status, out, report, error = _read(scene, values, name)
    lines = _take_lines(report, scene)
    if status != lib.TOBI_OK:
        if lines:
            error.text = "\n".join(lines).encode()[:2047].decode(errors="ignore").encode()
        raise_error(status, error, isinstance(scene, dict))
    return out


def check(scene, set=None, name=None):
    """The mistakes of a scene, a line of text each; an empty list if there is none.

    scene: the path of a scene or of its folder, a text in JSON, or a dict. set: keys that are changed first,
    as of World. name: the path that a text or dict would have: relative paths are looked up beside it.
    """
    status, out, report, error = _read(scene, set, name)
    lines = _take_lines(report, scene)
    if status == lib.TOBI_OK:
        lib.tobi_scene_free(out)
        return []
    return lines or [text_of(error.text)]


def describe(word=None):
    """What `tobiuo describe WORD` prints; None if there is nothing of this name."""
    return take_text(lib.tobi_scene_describe(word.encode() if word else ffi.NULL))


def shipped(name="."):
    """The path of a file among the scenes that come with Tobiuo; None if it cannot be found."""
    return take_text(lib.tobi_scene_shipped(name.encode()))


def build(scene, of_dict=False):
    """The world of a scene, owned by the caller; the scene is freed if there is none."""
    world = ffi.new("tobi_world **")
    try:
        call(lib.tobi_scene_build, scene, world, of_dict=of_dict)
    except Error:
        lib.tobi_scene_free(scene)
        raise
    return world[0]
