"""What a run has written, as arrays."""
import csv
import difflib
import json
import os
import pathlib
from dataclasses import dataclass

import numpy as np

from . import sampling
from .library import array_of, call, ffi, lib, free_pointer, text_of


class Fields(dict):
    """Arrays by the names of fields."""

    def __missing__(self, key):
        raise KeyError(f"{key!r}; the files have: {', '.join(self)}")


@dataclass
class Moment:
    """One output: time (s), positions (m, n x 3) and fields of the particles, surfaces of bodies: (vertices in
    m, triangles) by name."""
    time: float
    positions: np.ndarray
    fields: dict
    surfaces: dict


class Results:
    """The outputs of a run, read when asked for: len(results), results.times, results[-1].

    A run that still goes on can be read; refresh() looks for new outputs.
    """

    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        out = ffi.new("tobi_results **")
        call(lib.tobi_results_open, os.fspath(folder).encode(), out)
        self._results = ffi.gc(out[0], lib.tobi_results_free)

    @property
    def nests(self):
        """The Results of each nest by its name."""
        scene = self.folder/"resolved.json"
        entries = json.loads(scene.read_text(encoding="utf-8")).get("nests") if scene.exists() else None
        names = [entry["name"] for entry in entries or []]
        return {name: Results(self.folder/"nests"/name) for name in names if (self.folder/"nests"/name).is_dir()}

    def refresh(self):
        call(lib.tobi_results_refresh, self._results)

    def __len__(self):
        return lib.tobi_results_count(self._results)

    @property
    def times(self):
        """s"""
        return np.array([lib.tobi_results_time(self._results, k) for k in range(len(self))])

    def __getitem__(self, output):
        if isinstance(output, slice):
            return [self[k] for k in range(len(self))[output]]
        if not -len(self) <= output < len(self):
            raise IndexError(f"output {output} of {len(self)}")
        m = ffi.new("tobi_moment *")
        call(lib.tobi_results_read, self._results, output % len(self), m)
        try:
            fields = Fields()
            for k in range(m.field_count):
                f = m.fields[k]
                shape = (m.count, f.components) if f.components > 1 else (m.count,)
                fields[text_of(f.name)] = array_of(f.values, shape)
            surfaces = {}
            for k in range(m.surface_count):
                s = m.surfaces[k]
                surfaces[text_of(s.name)] = (array_of(s.vertices, (s.vertex_count, 3)),
                                             array_of(s.triangles, (s.triangle_count, 3), np.int32))
            return Moment(m.time, array_of(m.positions, (m.count, 3)), fields, surfaces)
        finally:
            lib.tobi_moment_free(m)

    def sample(self, output, places, fields=None, fluid=None, threads=0, solid=None, body=None):
        """Fields of the liquids of an output at places (m, k x 3, in 2-D k x 2 too): a Sample with `wet` and `fields`, as
        "tobiuo sample" finds them. fields: names, of components too ("velocity_x"), without them all; fluid,
        solid: the name of one; body: places move and turn with it from where they are at the start, velocities are
        against it, vectors in its axes."""
        moment, frames = self[output], None
        points, count = ffi.new("double (**)[3]"), ffi.new("int64_t *")
        call(lib.tobi_results_read_bodies, self._results, output % len(self), points, count)
        solids = array_of(points[0], (count[0], 3))
        free_pointer(points[0])
        scene = sampling.read_scene(self.folder/"resolved.json")
        if body is not None:
            rows = self.table("bodies", of=body)
            frames = [sampling.find_frame(rows, body, t) for t in (self.times[0], moment.time)]
        return sampling.of_scene(places, scene, moment, solids, fields, fluid, solid, threads, frames)

    def mean(self, places, fields=None, start=0, until=float("inf"), fluid=None, threads=0, solid=None, body=None):
        """Means of these fields over the outputs from `start` to `until` (s): Means with `share`, `mean`, `rms` and
        `reynolds`. Each output counts the same. The others as for sample."""
        times = self.times
        chosen = np.flatnonzero((times >= start*(1 - 1e-9)) & (times <= until*(1 + 1e-9)))
        if len(chosen) == 0:
            raise ValueError(f"no output from {start} to {until} s; there are some from {times[0]} to {times[-1]} s")
        return sampling.mean_of((self.sample(int(k), places, fields, fluid, threads, solid, body) for k in chosen),
                                times[chosen], threads)

    def table(self, name="history", of=None):
        """A table of the run, "history", "bodies", "probes" ...: read_table of its file."""
        path = self.folder/f"{name}.csv"
        if not path.exists():
            there = ", ".join(sorted(file.stem for file in self.folder.glob("*.csv")))
            raise FileNotFoundError(f"{path} is not there; tables of the run: {there or 'none'}")
        return read_table(path, of)


class Table(dict):
    """Columns by the names of the header. A unit may be left out: table["G1_level"] is "G1_level [m]"."""

    def _find(self, key):
        return next((name for name in self if name == key or name.partition(" [")[0] == key), None)

    def __missing__(self, key):
        name = self._find(key)
        if name is None:
            near = difflib.get_close_matches(str(key), [known.partition(" [")[0] for known in self])
            raise KeyError(f"{key!r}; the columns are {', '.join(self)}" +
                           (f"; did you mean {near[0]!r}?" if near else ""))
        return self[name]

    def __contains__(self, key):
        return self._find(key) is not None

    def get(self, key, default=None):
        return self[key] if key in self else default


def read_table(path, of=None):
    """The Table of a CSV file: arrays of numbers, lists of texts. of: only the rows of this name, of bodies.csv and
    solids.csv."""
    with open(path, newline="", encoding="utf-8") as file:
        rows = csv.reader(line for line in file if not line.startswith("#"))
        head = next(rows, [])
        rows = [row for row in rows]
    if of is not None:
        if "name" not in head:
            raise ValueError(f"{path}: its rows have no names")
        names = sorted({row[head.index("name")] for row in rows})
        if of not in names:
            raise KeyError(f"{of!r}; {path} has: {', '.join(names)}")
        rows = [row for row in rows if row[head.index("name")] == of]
    return Table((key, _column([row[k] for row in rows])) for k, key in enumerate(head))


def _column(texts):
    try:
        return np.array([float(text) for text in texts])
    except ValueError:
        return texts
