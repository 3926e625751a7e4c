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


def _numbers(values, what, columns=None):
    values = np.ascontiguousarray(values, dtype=np.float64)
    if columns is not None:
        if values.ndim != 2 or values.shape[1] not in (columns, columns - 1):
            raise ValueError(f"{what}: an array of {values.shape}, rows of {columns - 1} or {columns} numbers are allowed")
        if values.shape[1] < columns:
            values = np.hstack([values, np.zeros((len(values), 1))])
    return values


def _points(values):
    return ffi.from_buffer("double[][3]", values) if len(values) else ffi.NULL


def sample(places, positions, fields, spacing, box, dimension=3, periodic=(False, False, False), solids=None,
           threads=0):
    """Fields (by name: n or n x components) of the particles at `positions` (m, n x 3) at places (m, k x 2 or
    k x 3). spacing: m, of the particles. box: lower and upper corner of the domain, m. solids: points that fill
    bodies, m, about a spacing apart. Gives a Sample."""
    places, positions = _numbers(places, "places", 3), _numbers(positions, "positions", 3)
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


def _field(moment, name):
    """A field, or a component of one, "velocity_x"."""
    component = ffi.new("int *")
    whole = lib.tobi_world_find_field(name.encode(), component, ffi.NULL)
    whole = name if name in moment.fields or whole == ffi.NULL else text_of(whole)
    if whole not in moment.fields:
        raise KeyError(f"{name!r}; fields are: {', '.join(moment.fields)}")
    values = moment.fields[whole]
    return values if whole == name else values[:, component[0]]


def of_scene(places, scene, moment, bodies, names, fluid=None, solid=None, threads=0):
    """The liquids of an output, or one of its materials: scene is its resolved.json."""
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
    domain = scene["domain"]
    return sample(places, moment.positions[ours], {n: _field(moment, n)[ours] for n in names}, spacing,
                  (domain["min"], domain["max"]), scene["dimension"],
                  [domain["walls"][a][0] == "periodic" for a in "xyz"],
                  thin(bodies, spacing) if finer else bodies, threads)


def read_scene(path):
    with open(path, encoding="utf-8") as file:
        return json.load(file)
