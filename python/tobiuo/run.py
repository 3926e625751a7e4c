"""A run that writes the files of `tobiuo run`."""
import os

from .library import Error, ffi, lib, take_text
from .world import World


def run(scene, out, set=None, name=None, until=None, force=False, each_step=None):
    """Computes a scene to its end (or to `until`, s) and writes tables, particles and checkpoints into the
    folder `out`, as `tobiuo run` does. Returns the World at its end.

    force: results in `out` are removed first; else they are an Error. each_step(world) is called before each
    step: it may read, and set gravity, forces and motions. If it returns False, the run ends there. A run that
    is interrupted can be resumed by `tobiuo resume`, without each_step.
    """
    world = World(scene, set, name)
    end = float(until) if until is not None else world.end_time
    resolved = lib.tobi_scene_resolved(world._scene)
    handle = ffi.new("tobi_run **")
    output = lib.tobi_scene_output_def(world._scene)
    nests, how = world._made_nests[0], lib.TOBI_NESTS_REPLACE if force else lib.TOBI_NESTS_CREATE
    try:
        world._call(lambda w, error: lib.tobi_nests_prepare(nests, os.fspath(out).encode(), how, error))
        world._call(lambda w, error: lib.tobi_run_create(w, output, os.fspath(out).encode(), int(force), resolved,
                                                         handle, error))
    finally:
        take_text(resolved)
    outcome = "failed"
    try:
        world._call(lambda w, error: lib.tobi_nests_record(nests, handle[0], os.fspath(out).encode(), how, error))
        outcome = "interrupted"
        world._call(lambda w, error: lib.tobi_scene_note_files(world._scene, os.fspath(out).encode(), 0, error))
        while not lib.tobi_run_done(handle[0], end):
            if each_step and each_step(world) is False:
                break
            world._call(lambda w, error: lib.tobi_run_step(handle[0], end, ffi.NULL, error))
        world._call(lambda w, error: lib.tobi_run_output_end(handle[0], error))
        outcome = "complete"
    except Error as error:
        outcome = {"the simulation diverged": "diverged", "the simulation gets nowhere": "stalled"}.get(
            error.status, "failed")
        raise
    finally:
        _end(world, handle[0], outcome)
    return world


def _end(world, handle, outcome):
    error = ffi.new("tobi_error *")
    if outcome in ("complete", "interrupted", "stalled"):
        lib.tobi_run_checkpoint(handle, error)
    status = lib.tobi_run_finish(handle, outcome.encode(), error)
    lib.tobi_run_free(handle)
    lib.tobi_nests_close(world._made_nests[0])
    if status != lib.TOBI_OK and outcome == "complete":
        raise Error(ffi.string(error.text).decode())
