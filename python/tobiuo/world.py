"""A world of particles that a program steps."""
from collections.abc import Mapping

import numpy as np

from . import scene as scenes
from .library import Error, array_of, call, ffi, lib, raise_error, text_of, values_of, vector

_SETS = {"fluid": "TOBI_FLUID", "bodies": "TOBI_BODIES"}
# Found once: cffi looks a function up under a lock. A collection that frees a world may come while it is held.
_free_nests, _free_world, _free_scene = lib.tobi_nests_free, lib.tobi_world_destroy, lib.tobi_scene_free


class _Named(Mapping):
    """Things of a world by name; `take(number)` makes one."""

    def __init__(self, names, take):
        self._names, self._take = names, take

    def __getitem__(self, name):
        if name not in self._names:
            raise KeyError(f"{name!r}; there are: {', '.join(self._names) or 'none'}")
        return self._take(self._names.index(name))

    def __repr__(self):
        return f"<{', '.join(self._names) or 'none'}>"

    def __iter__(self):
        return iter(self._names)

    def __len__(self):
        return len(self._names)


def _list_names(name_of, owner, *rest):
    names = []
    while True:
        name = text_of(name_of(owner, len(names), *rest))
        if name is None:
            return names
        names.append(name)


def _list_fields():
    """(numbers per particle, unit) by name, of all methods."""
    components, unit, found = ffi.new("int *"), ffi.new("const char **"), {}
    while True:
        name = text_of(lib.tobi_world_field_name(len(found), components, unit))
        if name is None:
            return found
        found[name] = (components[0], text_of(unit[0]))


class Body:
    """A body. Its attributes are those of tobi_body_info: position, velocity, pressure_force, mass ... (SI)."""

    def __init__(self, world, number):
        self._world, self._number = world, number

    def info(self):
        out = ffi.new("tobi_body_info *")
        self._world._ask(lib.tobi_world_body, self._number, out)
        values = values_of(out[0])
        values["inertia"] = values["inertia"].reshape(3, 3)
        return values

    def __getattr__(self, name):
        values = self.info()
        if name in values:
            return values[name]
        raise AttributeError(f"a body has no {name!r}; it has: {', '.join(values)}")

    def __setattr__(self, name, value):
        if not name.startswith("_"):
            raise AttributeError(f"a body's {name!r} cannot be set; a free body follows its forces (set_force), "
                                 "others follow their motion (set_motion)")
        super().__setattr__(name, value)

    def __repr__(self):
        name = text_of(lib.tobi_world_body_name(self._world._world, self._number))
        return f"<tobiuo.Body {name!r} of {self._world!r}>"

    def energy(self):
        """kinetic, potential (J); power by particles, by contact, by its motion (W)."""
        out = ffi.new("tobi_body_energy *")
        self._world._ask(lib.tobi_world_body_energy, self._number, out)
        return values_of(out[0])

    def surface(self):
        """Vertices (m, n x 3) and triangles (n x 3) of its surface now."""
        counts, vertices, triangles = ffi.new("int64_t[2]"), ffi.new("double(**)[3]"), ffi.new("int32_t(**)[3]")
        self._world._ask(lib.tobi_world_surface, self._number, counts, vertices, counts + 1, triangles)
        return array_of(vertices[0], (counts[0], 3)), array_of(triangles[0], (counts[1], 3), np.int32)

    def set_force(self, force, torque=(0, 0, 0)):
        """A constant force (N, on the centre of mass) and torque (N m; in 2-D its third number), from the next step
        on."""
        self._world._call(lib.tobi_world_set_body_force, self._number, vector(force, "force"),
                          vector(torque, "torque", (3,)))

    def set_motion(self, function):
        """Another motion of a body that was defined with one: function(t, rest) returns the places (m, n x 3) of
        the points `rest` (m, n x 3) at time t (s). It must be a pure function, rigid or not as that one."""
        self._world._set_motion(self._number, function)


class World:
    """A world from a scene: a path, a text in JSON, or a dict.

    set: keys of the scene that are changed first, {"spacing": 0.01, "fluids.water.viscosity": 0.1}, or texts
    "spacing=0.01". name: the path that a text or dict would have. The world frees its memory when it is closed
    or no longer used.
    """

    _handle = None
    _busy = False

    def __init__(self, scene, set=None, name=None):
        self._raised, self._motions, self._of_dict = None, {}, isinstance(scene, dict)
        self._scene = scenes.load(scene, set, name)
        self._handle = scenes.build(self._scene, self._of_dict)
        self._made_nests = ffi.new("tobi_nests **")
        self._call(lambda w, error: lib.tobi_nests_create(self._scene, w, self._made_nests, error))
        # Asked between two iterations: there Python looks for Ctrl-C.
        self._stop = ffi.callback("int(void *)", lambda user: 0, error=1, onerror=self._remember)
        for world in [self._world, *(nest._world for nest in self.nests.values())]:
            lib.tobi_world_set_stop(world, self._stop, ffi.NULL)

    @property
    def nests(self):
        """Each Nest of the scene by its name. They go along with each step."""
        made, name, found = self._made_nests[0], ffi.new("const char **"), {}
        while self._world and (world := lib.tobi_nests_world(made, len(found), name)) != ffi.NULL:
            found[text_of(name[0])] = world
        return _Named(list(found), lambda k: Nest(self, list(found)[k], list(found.values())[k]))

    @property
    def bodies(self):
        """Each Body by its name."""
        return _Named([text_of(lib.tobi_world_body_name(self._world, k))
                       for k in range(lib.tobi_world_body_count(self._world))], lambda k: Body(self, k))

    @property
    def probes(self):
        """What each probe measures now: pressure, level, flow ... (tobi_probe_info)."""
        self.start()
        return _Named(_list_names(lib.tobi_world_probe_name, self._world, ffi.NULL),
                      lambda k: self._values("tobi_probe_info", lib.tobi_world_probe, k))

    @property
    def joints(self):
        """Force, power, angle ... of each joint, hinge and guide (tobi_joint_info)."""
        return _Named(_list_names(lib.tobi_world_joint, self._world, ffi.NULL),
                      lambda k: self._of("tobi_joint_info", lib.tobi_world_joint, k))

    @property
    def lines(self):
        """Tension and ends of each line (tobi_line_info)."""
        return _Named(_list_names(lib.tobi_world_line, self._world, ffi.NULL),
                      lambda k: self._of("tobi_line_info", lib.tobi_world_line, k))

    @property
    def porous_zones(self):
        """Force, power, volume ... of each porous zone (tobi_porous_info)."""
        return _Named(_list_names(lib.tobi_world_porous, self._world, ffi.NULL),
                      lambda k: self._of("tobi_porous_info", lib.tobi_world_porous, k))

    @property
    def scalars(self):
        """Least, mean, largest value and amount of temperature and concentration (tobi_scalar_info)."""
        found = []
        while lib.tobi_world_scalar(self._world, len(found), ffi.NULL):
            found.append(self._of("tobi_scalar_info", lib.tobi_world_scalar, len(found)))
        return {info["field"]: info for info in found}

    @property
    def scalar_flows(self):
        """What comes into the liquid through each side and body with a value or flux: WALL_temperature ..."""
        names = _list_names(lib.tobi_world_scalar_flow, self._world, ffi.NULL)
        flows = [self._of("tobi_scalar_flow", lib.tobi_world_scalar_flow, k) for k in range(len(names))]
        return {f"{name}_{flow['field']}": flow["flow"] for name, flow in zip(names, flows)}

    @property
    def solids(self):
        """Mass, centre, velocity ... of each solid (tobi_solid_info)."""
        return _Named([self._solid(k)["name"] for k in range(lib.tobi_world_solid_count(self._world))], self._solid)

    # --- calls ------------------------------------------------------------------------------------

    @property
    def _world(self):
        if self._busy:
            raise Error("the world is in a call: functions that it asks, and other threads, must not use it")
        if self._handle is None:
            raise Error("the world is closed")
        return self._handle

    def _remember(self, kind, value, trace):
        self._raised = value

    def _call(self, function, *arguments):
        """A call with this world; what a Python function raised in it comes out as it was."""
        error, world = ffi.new("tobi_error *"), self._world
        self._raised, self._busy = None, True
        try:
            status = function(world, *arguments, error)
        finally:
            self._busy = False
        raised, self._raised = self._raised, None
        if raised is not None:
            raise raised
        if status != lib.TOBI_OK:
            lib.tobi_scene_place_error(self._scene, error)
            raise_error(status, error, self._of_dict)

    def _ask(self, function, *arguments):
        """The same of calls without a text."""
        status = function(self._world, *arguments)
        if status != lib.TOBI_OK:
            raise Error(text_of(lib.tobi_status_text(status)))

    def _values(self, struct, function, *arguments):
        out = ffi.new(struct + " *")
        self._call(function, *arguments, out)
        return values_of(out[0])

    def _of(self, struct, function, number):
        out = ffi.new(struct + " *")
        function(self._world, number, out)
        return values_of(out[0])

    def _solid(self, number):
        out = ffi.new("tobi_solid_info *")
        self._ask(lib.tobi_world_solid, number, out)
        return values_of(out[0])

    def close(self):
        """Frees the memory. The world cannot be used afterwards."""
        if self._handle is not None:
            world = self._world                     # not in a call
            _free_nests(self._made_nests[0])
            _free_world(world)
            _free_scene(self._scene)
        self._handle = None

    def __del__(self):
        self.close()

    def __enter__(self):
        return self

    def __exit__(self, *what):
        self.close()

    # --- time -------------------------------------------------------------------------------------

    @property
    def time(self):
        """s"""
        return lib.tobi_world_time(self._world)

    @property
    def end_time(self):
        """s, of the scene"""
        return lib.tobi_scene_world_def(self._scene).end_time

    def start(self):
        """Places the particles; the first step does it, too."""
        self._call(lib.tobi_world_start)

    def step(self, max_dt=0):
        """One time step, not longer than max_dt (s; 0: no bound). Returns what it did, as `info`."""
        self._follow()                              # a nest that Ctrl-C has stopped
        self._call(lib.tobi_world_step, float(max_dt), ffi.NULL)
        self._follow()
        return self.info

    def advance(self, time):
        """Steps until `time` (s), not for so long; it is hit exactly."""
        if not self.nests:
            self._call(lib.tobi_world_advance, float(time), ffi.NULL)
            return
        self._follow()
        while True:
            self._call(lib.tobi_world_step_to, float(time))
            self._follow()
            if self.time >= time:
                return

    def _catch_up(self):
        """Nests that Ctrl-C or a motion has stopped, before something changes; one that fails stays behind."""
        try:
            if self.nests and self.time > 0:
                self._follow()
        except Exception:
            self._raised = None

    def _follow(self):
        self._call(lambda world, error: lib.tobi_nests_follow(self._made_nests[0], error))

    @property
    def info(self):
        """What the last step did: step, dt, iterations, energies, momentum ... (tobi_step_info)."""
        return values_of(lib.tobi_world_info(self._world)[0])

    def energy(self):
        """Of bodies and springs (J), and the power of motions, joints and lines (W): tobi_energy."""
        out = ffi.new("tobi_energy *")
        self._ask(lib.tobi_world_energy, out)
        return values_of(out[0])

    # --- particles --------------------------------------------------------------------------------

    def count(self, of="fluid"):
        """Particles of fluids and solids ("fluid") or of bodies ("bodies")."""
        of = self._set(of)
        self.start()
        return lib.tobi_world_count(self._world, of)

    @staticmethod
    def _set(of):
        if of not in _SETS:
            raise ValueError(f"of: {of!r}, allowed are {', '.join(_SETS)}")
        return getattr(lib, _SETS[of])

    def fields(self):
        """The fields that `read` knows: (numbers per particle, unit) by name."""
        method = lib.tobi_scene_world_def(self._scene).method
        mine = _list_names(lib.tobi_method_field, method)
        absent = {"temperature", "concentration"} - set(self.scalars)
        return {name: what for name, what in _list_fields().items() if name in mine and name not in absent}

    def read(self, field, of="fluid"):
        """A copy of a field, in the order of rising ids: n numbers, or n x components."""
        self.start()
        known = _list_fields()
        if field not in known:
            raise Error(f"there is no field {field!r}; there are: {', '.join(self.fields())}", "not found")
        n, width = self.count(of), known[field][0]
        out = np.empty((n, width) if width > 1 else n)
        self._call(lib.tobi_world_read, self._set(of), field.encode(), ffi.from_buffer("double[]", out), n)
        return out

    def ids(self, of="fluid"):
        """Whole numbers that name particles, rising."""
        self.start()
        out = np.empty(self.count(of), np.int64)
        self._call(lib.tobi_world_read_ids, self._set(of), ffi.from_buffer("int64_t[]", out), len(out))
        return out

    def write(self, field, values):
        """Sets "velocity" or "pressure" of all particles of the fluid, in the order and shape of `read`."""
        n, width = self.count(), _list_fields().get(field, (1, ""))[0]
        shape = (n, width) if width > 1 else (n,)
        must = f"must be {shape}, as read({field!r}) gives it"
        try:
            values = np.ascontiguousarray(values, np.float64)
        except (TypeError, ValueError) as error:
            raise ValueError(f"{field}: {type(values).__name__} is no array of numbers, {must}") from error
        if values.shape != shape:
            raise ValueError(f"{field}: an array of {values.shape}, {must}")
        self._call(lib.tobi_world_write, field.encode(), ffi.from_buffer("double[]", values), len(values))

    def pieces(self):
        """The connected pieces of the solids, the heaviest first, debris last."""
        out = ffi.new("const tobi_pieces **")
        self._call(lib.tobi_world_pieces, out)
        return [values_of(out[0].piece[k]) for k in range(out[0].count + out[0].fragments)]

    # --- between two steps ------------------------------------------------------------------------

    def set_gravity(self, gravity):
        """m/s2, from the next step on."""
        self._catch_up()
        self._call(lib.tobi_world_set_gravity, vector(gravity, "gravity"))
        for nest in self.nests.values():
            nest._call(lib.tobi_world_set_gravity, vector(gravity, "gravity"))

    def _set_motion(self, body, function):
        def move(user, t, n, rest, out, error):
            places = np.asarray(function(t, array_of(rest, (n, 3))), np.float64)
            if places.shape != (n, 3):
                raise ValueError(f"the motion answered an array {places.shape}, it should be {(n, 3)}")
            ffi.memmove(out, np.ascontiguousarray(places), 24*n)
            return lib.TOBI_OK
        made = ffi.callback("tobi_motion_fn", move, error=lib.TOBI_SCRIPT, onerror=self._remember)
        self._catch_up()
        self._call(lib.tobi_world_set_body_motion, body, made, ffi.NULL)
        previous, self._motions[body] = self._motions.get(body), made
        for nest in self.nests.values():            # they have called the one before until here
            nest._call(lib.tobi_world_set_body_motion, body, made, ffi.NULL)
        del previous

    # --- state ------------------------------------------------------------------------------------

    def save(self, path):
        """Writes the whole state; the file appears whole or not at all. Nests have files of their own beside it,
        PATH.NAME."""
        self._follow()
        for name, nest in self.nests.items():
            nest._call(lib.tobi_world_save, f"{path}.{name}".encode())
        self._call(lib.tobi_world_save, str(path).encode())

    def load(self, path):
        """Reads a state of a world of the same scene. A file that cannot be loaded changes nothing but nests that
        were loaded before it."""
        for name, nest in self.nests.items():
            nest._call(lib.tobi_world_load, f"{path}.{name}".encode())
        self._call(lib.tobi_world_load, str(path).encode())

    @property
    def hash(self):
        """Of the whole state: the same for any number of threads."""
        return lib.tobi_world_hash(self._world)

    @property
    def notes(self):
        """What was repaired or looks odd in the meshes, a text each."""
        return _list_names(lib.tobi_world_note, self._world)

    def __repr__(self):
        if self._handle is None:
            return "<tobiuo.World, closed>"
        return f"<tobiuo.World {text_of(lib.tobi_scene_name(self._scene))!r}, t = {self.time:g} s>"


class Nest(World):
    """The world of a nest: to be read as a World is. Its time goes on with the world that it is in."""

    def __init__(self, outer, name, handle):
        self._outer, self._name, self._nest = outer, name, handle
        self._scene, self._raised, self._of_dict = outer._scene, None, outer._of_dict

    nests = _Named([], None)

    @property
    def _world(self):
        return self._outer._world and self._nest

    def start(self):
        self._outer.start()
        self._call(lib.tobi_world_start)

    def _refuse(self, *arguments):
        raise Error(f"nest {self._name!r} goes with its world: call that")

    step = advance = set_gravity = save = load = _set_motion = _refuse

    def close(self):
        """Nothing: the world that it is in frees it."""

    def __repr__(self):
        return f"<tobiuo.Nest {self._name!r} of {self._outer!r}>"
