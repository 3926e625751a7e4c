"""Tobiuo from Python: scenes, worlds, runs and results (docs/python.md).

    import tobiuo
    world = tobiuo.World("scenes/dam_break_2d", set={"spacing": 0.02})
    world.advance(0.5)
    print(world.time, world.read("position").max(axis=0))

All units are SI. A call that fails raises tobiuo.Error with the text of the library.
"""
from .library import Error, set_language, version as __version__
from .results import Moment, Results, read_table
from .run import run
from .sampling import Means, Sample, sample
from .scene import check, describe, shipped
from .world import Nest, World

__all__ = ["Error", "Means", "Moment", "Nest", "Results", "Sample", "World", "__version__", "check", "describe",
           "read_table", "run", "sample", "set_language", "shipped"]
