"""Fields of particles at places (include/tobiuo/sample.h, docs/sample.md)."""
import json
from dataclasses import dataclass

import numpy as np

from .library import call, ffi, lib, text_of


@dataclass
class Sample:
    """wet: where there is liquid (bool, one for each place); fields: values by name, NaN where it is dry."""
    wet: np.ndarray
    fields: dict


@dataclass
class Means:
    """Over outputs, of each place: share: of the outputs at which it is wet; mean and rms (root mean square of the
    fluctuations) by field, NaN where it was never wet; reynolds: of the velocity the means of the products of two
    fluctuations, m2/s2, in the order xx, xy, xz, yy, yz, zz, or None; times: of the outputs, s."""
    times: np.ndarray
    share: np.ndarray
    mean: dict
    rms: dict
    reynolds: np.ndarray


@dataclass
class Frame:
    """Of a body at an output: where it is and how it is turned (columns: its axes), m/s and rad/s."""
    place: np.ndarray
    axes: np.ndarray
    velocity: np.ndarray
    spin: np.ndarray


def _numbers(values, what, columns=None, least=None):
    values = np.ascontiguousarray(values, dtype=np.float64)
    if columns is not None:
        allowed = [n for n in (columns - 1, columns) if n >= (least or 0)]
        if values.ndim != 2 or values.shape[1] not in allowed:
            raise ValueError(f"{what}: an array of {values.shape}, rows of {' or '.join(map(str, allowed))} numbers "
                             "are allowed")
        if values.shape[1] < columns:
            values = np.hstack([values, np.zeros((len(values), 1))])
    return values


def _points(values):
    return ffi.from_buffer("double[][3]", values) if len(values) else ffi.NULL


def sample(places, positions, fields, spacing, box, dimension=3, periodic=(False, False, False), solids=None,
           threads=0):
    """Fields (by name: n or n x components) of the particles at `positions` (m, n x 3) at places (m, k x 3, in
    2-D k x 2 too). spacing: m, of the particles. box: lower and upper corner of the domain, m. solids: points that fill
    bodies, m, about a spacing apart. Gives a Sample."""
    places, positions = (_numbers(values, what, 3, dimension) for values, what in ((places, "places"),
                                                                                   (positions, "positions")))
    solids = _numbers(np.empty((0, 3)) if solids is None else solids, "solids", 3)
    d = ffi.new("tobi_sample_def *", lib.tobi_default_sample())
    d.dimension, d.spacing, d.threads = dimension, spacing, threads
    for a in range(dimension):
        d.box_min[a], d.box_max[a], d.periodic[a] = box[0][a], box[1][a], bool(periodic[a])
    d.particle_count, d.positions = len(positions), _points(positions)
    d.solid_count, d.solids = len(solids), _points(solids)
    d.place_count, d.places = len(places), _points(places)
    wet, kept, out = np.zeros(len(places), np.uint8), [], {}
    own = ffi.new("tobi_sample_field[]", max(1, len(fields)))
    for k, (name, values) in enumerate(fields.items()):
        values = _numbers(values, name)
        if len(values) != len(positions) or values.ndim > 2:
            raise ValueError(f"{name}: an array of {values.shape} for {len(positions)} particles")
        out[name] = np.full((len(places),) + values.shape[1:], np.nan)
        buffers = [ffi.from_buffer("double[]", array) for array in (values, out[name])]
        kept += buffers
        own[k].components = 1 if values.ndim == 1 else values.shape[1]
        own[k].values, own[k].at = buffers
    marks = ffi.from_buffer("uint8_t[]", wet)
    d.fields, d.field_count, d.wet = own, len(fields), marks
    call(lib.tobi_sample_make, d)
    return Sample(wet.astype(bool), out)


def thin(points, spacing):
    """Of points nearer to each other than the spacing (m) one in each cell of that size."""
    rows = np.unique(np.floor(points/spacing), axis=0, return_index=True)[1]
    return points[np.sort(rows)]


def _choose(materials, kind, name):
    """The number of a fluid or solid by its name."""
    names = [m["name"] for m in materials[kind]]
    if name not in names:
        raise KeyError(f"{name!r}; {kind} are: {', '.join(names) or 'none'}")
    return names.index(name) + (len(materials["fluids"]) if kind == "solids" else 0)


def _split(moment, name):
    """A field and the number of its component, None of all: "velocity_x"."""
    component = ffi.new("int *")
    whole = lib.tobi_world_find_field(name.encode(), component, ffi.NULL)
    whole = name if name in moment.fields or whole == ffi.NULL else text_of(whole)
    if whole not in moment.fields:
        raise KeyError(f"{name!r}; fields are: {', '.join(moment.fields)}")
    return whole, None if whole == name else component[0]


def find_frame(table, body, time):
    """Of the rows of a body in bodies.csv that of an output."""
    table = {key.split(" [")[0]: values for key, values in table.items()}
    rows = np.flatnonzero(np.abs(table["time"] - time) <= 1e-9*(1 + abs(time)))
    if len(rows) == 0:
        raise ValueError(f"bodies.csv has no row of {body!r} at the output of {time} s")
    of = {name: np.array([table[f"{name}_{part}"][rows[0]] for part in parts], dtype=np.float64)
          for name, parts in (("position", "xyz"), ("orientation", "wxyz"), ("velocity", "xyz"), ("angular_velocity", "xyz"))}
    w, x, y, z = of["orientation"]/np.linalg.norm(of["orientation"])
    axes = np.array([[1 - 2*(y*y + z*z), 2*(x*y - w*z), 2*(x*z + w*y)],
                     [2*(x*y + w*z), 1 - 2*(x*x + z*z), 2*(y*z - w*x)],
                     [2*(x*z - w*y), 2*(y*z + w*x), 1 - 2*(x*x + y*y)]])
    return Frame(of["position"], axes, of["velocity"], of["angular_velocity"])


def move(places, start, now):
    """Places that a body takes along from the start."""
    return now.place + (_numbers(places, "places", 3) - start.place) @ (now.axes @ start.axes.T).T


def turn(sample_, places, start, now):
    """Values at moved places as the body sees them: velocities against it, all in its axes of the start."""
    back = now.axes @ start.axes.T
    for name, values in sample_.fields.items():
        n = 1 if values.ndim == 1 else values.shape[1]
        if name == "velocity":
            values = values - now.velocity - np.cross(now.spin, places - now.place)
        if n == 3:
            values = values @ back
        elif n == 6:                                # xx, yy, zz, xy, yz, zx
            full = back.T @ values[:, [0, 3, 5, 3, 1, 4, 5, 4, 2]].reshape(-1, 3, 3) @ back
            values = full.reshape(-1, 9)[:, [0, 4, 8, 1, 5, 2]]
        elif n == 9:                                # a deformation gradient: its other side is the rest
            values = (back.T @ values.reshape(-1, 3, 3)).reshape(-1, 9)
        sample_.fields[name] = values


def of_scene(places, scene, moment, bodies, names, fluid=None, solid=None, threads=0, frames=None):
    """The liquids of an output, or one of its materials: scene is its resolved.json. frames: of a body at the
    start and now, which takes the places along."""
    materials = {kind: scene.get(kind, []) for kind in ("fluids", "solids")}
    is_liquid = [True]*len(materials["fluids"]) + [s["model"] == "liquid" for s in materials["solids"]]
    if fluid is not None and solid is not None:
        raise ValueError("fluid or solid, not both")
    chosen = ([_choose(materials, "fluids", fluid)] if fluid is not None else
              [_choose(materials, "solids", solid)] if solid is not None else
              [k for k, liquid in enumerate(is_liquid) if liquid])
    if not chosen:
        raise ValueError("a run without a liquid; solid takes the name of a solid")
    ours = np.isin(moment.fields.get("material", np.zeros(len(moment.positions))), chosen)
    names = [names] if isinstance(names, str) else names
    labels = ("material", "part", "piece", "cut_side")
    names = names or [n for n in moment.fields if n not in labels and "_id" not in n]
    own = scene.get("mlsmpm", {}).get("spacing")
    spacing = own if chosen[0] >= len(materials["fluids"]) and not isinstance(own, (str, type(None))) else scene["spacing"]
    finer = any((scene["spacing"] if isinstance(b["spacing"], str) else b["spacing"]) < 0.99*spacing
                for b in scene.get("bodies", []))
    domain, parts = scene["domain"], {name: _split(moment, name) for name in names}
    places = _numbers(places, "places", 3, scene["dimension"])
    if frames:
        places = move(places, *frames)
    found = sample(places, moment.positions[ours], {whole: moment.fields[whole][ours] for whole, _ in parts.values()},
                   spacing, (domain["min"], domain["max"]), scene["dimension"],
                   [domain["walls"][a][0] == "periodic" for a in "xyz"],
                   thin(bodies, spacing) if finer else bodies, threads)
    if frames:
        turn(found, places, *frames)
    found.fields = {name: found.fields[whole] if part is None else np.ascontiguousarray(found.fields[whole][:, part])
                    for name, (whole, part) in parts.items()}
    return found


def mean_of(samples, times, threads=0):
    """Means over samples of the same places and fields, in the order of the outputs."""
    means, count = {}, 0
    for found in samples:
        count = len(found.wet)
        marks = ffi.from_buffer("uint8_t[]", found.wet.astype(np.uint8))
        for name, values in found.fields.items():
            values = np.ascontiguousarray(values, dtype=np.float64)
            if name not in means:
                out = ffi.new("tobi_sample_mean **")
                n = 1 if values.ndim == 1 else values.shape[1]
                call(lib.tobi_sample_mean_create, count, n, threads, out)
                means[name] = ffi.gc(out[0], lib.tobi_sample_mean_free), values.shape[1:], n
            call(lib.tobi_sample_mean_add, means[name][0], marks, ffi.from_buffer("double[]", values))
    out = Means(np.asarray(times), np.zeros(count), {}, {}, None)
    for name, (mean, shape, n) in means.items():
        arrays = [np.zeros((count,) + shape), np.zeros((count,) + shape), np.zeros((count, n*(n + 1)//2))]
        call(lib.tobi_sample_mean_read, mean, *[ffi.from_buffer("double[]", a, require_writable=True)
                                                for a in (out.share, *arrays)])
        out.mean[name], out.rms[name] = arrays[:2]
        if name == "velocity" and n == 3:
            out.reynolds = arrays[2]
    return out


def read_scene(path):
    with open(path, encoding="utf-8") as file:
        return json.load(file)
