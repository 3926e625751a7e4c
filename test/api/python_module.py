#!/usr/bin/python3
"""The Python module: runs and states equal those of the program, controllers and motions in Python, what is
refused, Ctrl-C, results as arrays.

usage: python_module.py PROGRAM MODULE_FOLDER     works in a fresh folder that it removes; 77 without cffi or NumPy
"""
import json
import os
import pathlib
import re
import signal
import subprocess
import sys
import tempfile
import unittest

program = os.path.abspath(sys.argv[1])
sys.path.insert(0, os.path.abspath(sys.argv[2]))
try:
    import cffi  # noqa: F401
    import numpy as np
except ImportError as problem:
    print("not there:", problem)
    sys.exit(77)
import tobiuo  # noqa: E402
from tobiuo import sampling  # noqa: E402

POOL = {
    "dimension": 2, "domain": {"min": [0, 0], "max": [0.4, 0.3]}, "spacing": 0.01, "end_time": 0.1, "threads": 1,
    "fluids": [{"name": "water", "fill": [{"box": {"min": [0, 0], "max": [0.4, 0.15]}}]}],
    "output": {"interval": 0.05}}
FLOAT = {"name": "float", "box": {"min": [0.16, 0.12], "max": [0.24, 0.18]}, "density": 500, "dynamics": "free"}
FLAP = {"name": "flap", "box": {"min": [0.1, 0.05], "max": [0.14, 0.2]},
        "motion": {"translation": {"velocity": [0.1, 0]}}}
FALL = {"dimension": 3, "domain": {"min": [0, 0, 0], "max": [1, 1, 4]}, "spacing": 0.1, "end_time": 1, "method": "mlsmpm",
        "time_step_max": 0.01,
        "bodies": [{"name": "ball", "sphere": {"centre": [0.5, 0.5, 2], "radius": 0.2}, "density": 1000,
                    "dynamics": "free"}]}


def with_bodies(*bodies, **more):
    return {**POOL, "bodies": list(bodies), **more}


class Module(unittest.TestCase):
    def test_a_run_writes_what_the_program_writes(self):
        pathlib.Path("pool.json").write_text(json.dumps(with_bodies(FLOAT)), encoding="utf-8")
        subprocess.run([program, "run", "pool.json", "--out", "mine", "--quiet"], check=True)
        world = tobiuo.run("pool.json", "theirs")
        self.assertEqual(world.time, 0.1)
        for path in sorted(pathlib.Path("mine").rglob("*")):
            if path.is_file() and path.suffix in (".csv", ".vtu", ".vtp", ".pvd") or path.name == "resolved.json":
                self.assertEqual(path.read_bytes(), (pathlib.Path("theirs")/path.relative_to("mine")).read_bytes(), path)
        self.assertEqual(json.loads(pathlib.Path("theirs/summary.json").read_text())["outcome"], "complete")
        with self.assertRaisesRegex(tobiuo.Error, "theirs.*force=True"):
            tobiuo.run("pool.json", "theirs")
        tobiuo.run("pool.json", "theirs", until=0.05, force=True)
        self.assertEqual(tobiuo.Results("theirs").times[-1], 0.05)

    def test_nests_go_along(self):
        scene = with_bodies(FLOAT, method="isph", probes=[{"name": "low", "position": [0.2, 0.02]}], nests=[
            {"name": "middle", "box": {"min": [0.1, 0], "max": [0.3, 0.3]}, "follow": "float", "feedback": True}])
        pathlib.Path("nests.json").write_text(json.dumps(scene), encoding="utf-8")
        subprocess.run([program, "run", "nests.json", "--out", "nests_mine", "--quiet"], check=True)
        for again in (False, True):
            done = tobiuo.run("nests.json", "nests_theirs", force=again)
        paths = [path.relative_to("nests_mine") for path in sorted(pathlib.Path("nests_mine").rglob("*"))
                 if path.suffix in (".csv", ".vtu") or path.name == "resolved.json"]
        self.assertIn(pathlib.Path("nests/middle/history.csv"), paths)
        for path in paths:
            self.assertEqual(("nests_mine"/path).read_bytes(), ("nests_theirs"/path).read_bytes(), path)
        nests = tobiuo.Results("nests_theirs").nests
        self.assertEqual(list(nests), ["middle"])
        self.assertEqual(list(nests["middle"].times), [0, 0.05, 0.1])
        with self.assertRaisesRegex(tobiuo.Error, "nests_theirs"):
            tobiuo.run("nests.json", "nests_theirs")
        with tobiuo.World("nests.json") as world, tobiuo.World("nests.json") as other:
            nest = world.nests["middle"]
            self.assertEqual(list(world.nests), ["middle"])
            world.advance(0.05)
            self.assertEqual((world.time, nest.time), (0.05, 0.05))
            self.assertGreater(nest.count(), world.count())
            self.assertEqual(nest.read("velocity").shape, (nest.count(), 3))
            self.assertAlmostEqual(nest.probes["low"]["pressure"], 1275, delta=100)
            self.assertIn("middle", repr(nest))
            for refused in (nest.step, lambda: nest.advance(1), lambda: nest.set_gravity([0, 0])):
                with self.assertRaisesRegex(tobiuo.Error, "goes with its world"):
                    refused()
            world.save("state")
            world.advance(0.1)
            other.load("state")
            self.assertEqual(other.nests["middle"].time, 0.05)
            other.advance(0.1)
            self.assertEqual((world.hash, nest.hash), (other.hash, other.nests["middle"].hash))
            with self.assertRaisesRegex(tobiuo.Error, "has passed"):
                world.advance(0.05)
            world.set_gravity([5, 0])
            world.step()
            self.assertEqual(nest.time, world.time)
        with self.assertRaisesRegex(tobiuo.Error, "closed"):
            nest.count()

    def test_a_motion_in_python_moves_nests(self):
        scene = with_bodies(FLAP, method="isph", nests=[{"name": "all", "box": {"min": [0, 0], "max": [0.4, 0.3]}}])
        with tobiuo.World(scene) as world:
            world.bodies["flap"].set_motion(lambda t, rest: rest + 0.5*t*np.array([0, 1, 0]))
            world.advance(0.05)
            places = [w.bodies["flap"].position for w in (world, world.nests["all"])]
            np.testing.assert_allclose(*places, atol=1e-9)
            self.assertAlmostEqual(places[0][1], 0.15, 6)
            signal.setitimer(signal.ITIMER_REAL, 0.1)
            signal.signal(signal.SIGALRM, signal.default_int_handler)
            with self.assertRaises(KeyboardInterrupt):
                world.advance(1000)
            until = world.time + 0.01
            world.bodies["flap"].set_motion(lambda t, rest: rest + 0.5*min(t, 0.1)*np.array([0, 1, 0]))
            world.advance(until)
            self.assertEqual(world.nests["all"].time, until)

    def test_texts_in_japanese(self):
        wrong = with_bodies(FLOAT) | {"spacing": 0, "cfll": 1}
        tobiuo.set_language("ja")
        try:
            mistakes = tobiuo.check(wrong)
            with self.assertRaisesRegex(tobiuo.Error, "未知のキー") as caught:
                tobiuo.World(wrong)
            self.assertEqual(caught.exception.status, "invalid input")
            with self.assertRaisesRegex(tobiuo.Error, "言語'fr'はない"):
                tobiuo.set_language("fr")
        finally:
            tobiuo.set_language("en")
        self.assertTrue(any("spacing: 0である。許容範囲は" in line for line in mistakes), mistakes)
        self.assertEqual([line.split(": ")[0] for line in mistakes],
                         [line.split(": ")[0] for line in tobiuo.check(wrong)])

    def test_fields_at_places_are_those_of_the_program(self):
        pathlib.Path("sampled.json").write_text(json.dumps(with_bodies(FLOAT)), encoding="utf-8")
        subprocess.run([program, "run", "sampled.json", "--out", "sampled", "--quiet"], check=True)
        subprocess.run([program, "sample", "sampled", "--line", "0.05,0 to 0.35,0.3", "--count", "31", "--from", "0.1"],
                       check=True, capture_output=True)
        results = tobiuo.Results("sampled")
        table = tobiuo.read_table("sampled/sample/line.csv")
        places = np.stack([table["x [m]"], table["y [m]"]], 1)
        found = results.sample(-1, places)
        self.assertTrue((found.wet == (table["wet"] == 1)).all() and 5 < found.wet.sum() < 25)
        for name, column in (("pressure", "pressure [Pa]"), ("velocity", "velocity_x [m/s]")):
            values = found.fields[name] if name == "pressure" else found.fields[name][:, 0]
            told = np.array([float(text) if text else np.nan for text in table[column]])
            self.assertTrue(np.array_equal(np.isnan(values), ~found.wet))
            np.testing.assert_allclose(values[found.wet], told[found.wet], rtol=1e-8, atol=1e-12)
        self.assertEqual(list(results.sample(0, places, ["density"], fluid="water").fields), ["density"])
        parts = results.sample(-1, places, "velocity_y").fields
        np.testing.assert_array_equal(parts["velocity_y"], found.fields["velocity"][:, 1])
        with self.assertRaisesRegex(KeyError, "velocity_w.*velocity"):
            results.sample(0, places, ["velocity_w"])
        with self.assertRaisesRegex(KeyError, "heat.*velocity"):
            results.sample(0, places, ["heat"])
        with self.assertRaisesRegex(KeyError, "oil.*water"):
            results.sample(0, places, fluid="oil")
        with self.assertRaisesRegex(ValueError, "places"):
            results.sample(0, [1, 2])

    def test_means_and_frames_are_those_of_the_program(self):
        vane = {"name": "vane", "box": {"min": [0.15, 0.06], "max": [0.19, 0.1]},
                "motion": {"rotation": {"centre": [0.2, 0.06], "rate": 200}}}
        scene = with_bodies(vane, output={"interval": 0.02})
        pathlib.Path("vane.json").write_text(json.dumps(scene), encoding="utf-8")
        subprocess.run([program, "run", "vane.json", "--out", "vane", "--quiet"], check=True)
        results = tobiuo.Results("vane")

        def told(table, name):
            return np.array([float(text) if text else np.nan for text in table[name]])

        for body in (None, "vane"):
            subprocess.run([program, "sample", "vane", "--line", "0.12,0.03 to 0.2,0.2", "--count", "21", "--from",
                            "0.04", "--until", "0.08", "--mean", "--fields", "velocity,pressure"] +
                           (["--with", body] if body else []), check=True, capture_output=True)
            table = tobiuo.read_table("vane/sample/line_mean.csv")
            places = np.stack([table["x [m]"], table["y [m]"]], 1)
            found = results.mean(places, ["velocity", "pressure"], 0.04, 0.08, body=body)
            np.testing.assert_allclose(found.times, [0.04, 0.06, 0.08])
            np.testing.assert_allclose(found.share, table["wet_share"], atol=1e-8)
            self.assertTrue(0.2 < found.share.mean() < 1)
            for a, axis in enumerate("xyz"):
                for kind in ("mean", "rms"):
                    np.testing.assert_allclose(getattr(found, kind)["velocity"][:, a],
                                               told(table, f"{kind}_velocity_{axis} [m/s]"), rtol=1e-7, atol=1e-9)
            np.testing.assert_allclose(found.mean["pressure"], told(table, "mean_pressure [Pa]"), rtol=1e-8)
            for k, pair in enumerate(("xx", "xy", "xz", "yy", "yz", "zz")):
                np.testing.assert_allclose(found.reynolds[:, k], told(table, f"reynolds_{pair} [m2/s2]"), rtol=1e-6,
                                           atol=1e-9)
        rows = tobiuo.read_table("vane/sample/line.csv")
        at = told(rows, "time [s]") == 0.04
        now = results.sample(2, places, "velocity_y", body="vane")
        np.testing.assert_allclose(now.fields["velocity_y"], told(rows, "velocity_y [m/s]")[at], rtol=1e-7, atol=1e-9)
        self.assertIsNone(results.mean(places, "pressure", start=0.1).reynolds)
        with self.assertRaisesRegex(ValueError, "no output from 0.03 to 0.035 s; there are some from 0.0 to 0.1 s"):
            results.mean(places, start=0.03, until=0.035)
        with self.assertRaisesRegex(KeyError, "boat.*vane"):
            results.sample(0, places, body="boat")

    def test_tensors_turn_with_a_body(self):
        c, s = np.cos(0.7), np.sin(0.7)
        axes = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
        zero = np.zeros(3)
        start, now = (sampling.Frame(zero, a, zero, zero) for a in (np.eye(3), axes))
        stress = np.array([[1., 2, 3, 4, 5, 6]])
        own = axes.T @ np.array([[1, 4, 6], [4, 2, 5], [6, 5, 3]]) @ axes
        found = tobiuo.Sample(np.ones(1, bool), {"stress": stress, "gradient": np.arange(9.).reshape(1, 9)})
        sampling.turn(found, np.zeros((1, 3)), start, now)
        np.testing.assert_allclose(found.fields["stress"][0], own[[0, 1, 2, 0, 1, 2], [0, 1, 2, 1, 2, 0]])
        np.testing.assert_allclose(found.fields["gradient"].reshape(3, 3), axes.T @ np.arange(9.).reshape(3, 3))

    def test_solids_at_places_are_those_of_the_program(self):
        def box(low, high):
            return [{"box": {"min": low, "max": high}}]
        scene = {"dimension": 2, "method": "mlsmpm", "domain": {"min": [0, 0], "max": [0.6, 0.6]}, "spacing": 0.04,
                 "end_time": 0.02, "mlsmpm": {"spacing": 0.02}, "output": {"interval": 0.02},
                 "solids": [{"name": "pool", "model": "liquid", "fill": box([0, 0], [0.6, 0.4])},
                            {"name": "cube", "youngs_modulus": 1e5, "fill": box([0.2, 0.42], [0.3, 0.52])}]}
        pathlib.Path("solid.json").write_text(json.dumps(scene), encoding="utf-8")
        subprocess.run([program, "run", "solid.json", "--out", "solid", "--quiet"], check=True)
        results = tobiuo.Results("solid")
        for name in (None, "cube"):
            subprocess.run([program, "sample", "solid", "--line", "0.25,0 to 0.25,0.6", "--count", "31", "--from",
                            "0.02"] + (["--solid", name] if name else []), check=True, capture_output=True)
            table = tobiuo.read_table("solid/sample/line.csv")
            found = results.sample(-1, np.stack([table["x [m]"], table["y [m]"]], 1), solid=name)
            self.assertTrue((found.wet == (table["wet"] == 1)).all() and 3 < found.wet.sum() < 25)
            told = np.array([float(text) if text else np.nan for text in table["velocity_y [m/s]"]])
            np.testing.assert_allclose(found.fields["velocity"][found.wet, 1], told[found.wet], rtol=1e-8, atol=1e-12)
        with self.assertRaisesRegex(KeyError, "sponge.*pool, cube"):
            results.sample(0, [[0, 0]], solid="sponge")
        with self.assertRaisesRegex(ValueError, "not both"):
            results.sample(0, [[0, 0]], fluid="pool", solid="cube")

    def test_fields_of_arrays(self):
        x = (np.stack(np.meshgrid(*[np.arange(8)]*3), -1).reshape(-1, 3) + 0.5)/8
        places = np.random.default_rng(1).uniform(0, 1, (50, 3))
        found = tobiuo.sample(places, x, {"height": x[:, 2], "place": x}, 1/8, ([0, 0, 0], [1, 1, 1]))
        np.testing.assert_allclose(found.fields["place"], places, atol=1e-12)
        np.testing.assert_allclose(found.fields["height"], places[:, 2], atol=1e-12)
        self.assertTrue(found.wet.all())
        empty = tobiuo.sample(places, x[:0], {"height": x[:0, 2]}, 1/8, ([0, 0, 0], [1, 1, 1]))
        self.assertTrue(np.isnan(empty.fields["height"]).all() and not empty.wet.any())
        with self.assertRaisesRegex(ValueError, r"places: an array of \(50, 2\), rows of 3 numbers are allowed"):
            tobiuo.sample(places[:, :2], x, {"height": x[:, 2]}, 1/8, ([0, 0, 0], [1, 1, 1]))
        with self.assertRaisesRegex(ValueError, "height"):
            tobiuo.sample(places, x, {"height": x[:5, 2]}, 1/8, ([0, 0, 0], [1, 1, 1]))
        with self.assertRaisesRegex(tobiuo.Error, "spacing of 0 m"):
            tobiuo.sample(places, x, {}, 0, ([0, 0, 0], [1, 1, 1]))

    def test_results_are_the_world(self):
        world = tobiuo.run(with_bodies(FLOAT), "results", set={"output.fields": ["velocity", "pressure"]})
        results = tobiuo.Results("results")
        self.assertEqual(list(results.times), [0, 0.05, 0.1])
        last = results[-1]
        self.assertEqual((last.time, len(results)), (0.1, 3))
        self.assertEqual(last.positions.shape, (world.count(), 3))
        np.testing.assert_allclose(last.positions, world.read("position"), atol=1e-7)
        np.testing.assert_allclose(last.fields["velocity"], world.read("velocity"), atol=1e-6)
        vertices, triangles = last.surfaces["float"]
        mine = world.bodies["float"].surface()
        np.testing.assert_allclose(vertices, mine[0], atol=1e-7)
        np.testing.assert_array_equal(triangles, mine[1])
        table = results.table("bodies", of="float")
        self.assertAlmostEqual(table["position_y"][-1], world.bodies["float"].position[1], 8)
        self.assertEqual(list(results.table()["time"]), [0, 0.05, 0.1])
        self.assertEqual(results.table("bodies")["name"], ["float"]*3)
        self.assertEqual([one.time for one in results[1:]], [0.05, 0.1])
        with self.assertRaises(IndexError):
            results[3]
        with self.assertRaisesRegex(KeyError, "float"):
            results.table("bodies", of="boat")
        with self.assertRaisesRegex(ValueError, "no names"):
            results.table("history", of="boat")
        with self.assertRaisesRegex(tobiuo.Error, "nowhere"):
            tobiuo.Results("nowhere")
        with self.assertRaisesRegex(FileNotFoundError, "probe.csv is not there; tables of the run: bodies, history"):
            results.table("probe")
        with self.assertRaisesRegex(KeyError, "'speed'; the files have: velocity"):
            results[0].fields["speed"]
        self.assertEqual((repr(world.bodies), repr(world.lines)), ("<float>", "<none>"))

    def test_columns_are_found_without_their_units(self):
        path = pathlib.Path("levels.csv")
        path.write_text("time [s],G1_level [m],G10_level [m]\n0,0.5,1\n1,0.6,2\n")
        table = tobiuo.read_table(path)
        self.assertEqual(list(table), ["time [s]", "G1_level [m]", "G10_level [m]"])
        for name in ("G1_level", "G1_level [m]"):
            self.assertEqual(list(table[name]), [0.5, 0.6])
            self.assertEqual(list(table.get(name)), [0.5, 0.6])
            self.assertIn(name, table)
        self.assertNotIn("G1", table)
        self.assertEqual(table.get("G1", 7), 7)
        with self.assertRaisesRegex(KeyError, "'G2_level'; the columns are time .*; did you mean 'G1_level'"):
            table["G2_level"]

    def test_a_world_goes_on_from_a_state(self):
        with tobiuo.World(POOL) as one, tobiuo.World(POOL) as other:
            one.advance(0.05)
            one.save("state")
            other.load("state")
            self.assertEqual((one.time, one.hash), (other.time, other.hash))
            for world in (one, other):
                world.advance(0.1)
            self.assertEqual(one.hash, other.hash)
            self.assertGreater(one.info["step"], 1)
            self.assertEqual(one.info["momentum"].shape, (3,))
            pathlib.Path("broken").write_text("nothing", encoding="utf-8")
            with self.assertRaisesRegex(tobiuo.Error, "broken"):
                one.load("broken")
            one.step(1e-4)

    def test_particles_are_arrays(self):
        with tobiuo.World(POOL) as world:
            self.assertEqual(world.count(), 600)
            place = world.read("position")
            self.assertEqual(place.shape, (600, 3))
            self.assertEqual(world.fields()["velocity"], (3, "m/s"))
            velocity = np.zeros_like(place)
            velocity[:, 0] = place[:, 1]
            world.write("velocity", velocity)
            np.testing.assert_allclose(world.read("velocity"), velocity, atol=1e-7)
            self.assertEqual(world.read("pressure").shape, (600,))
            self.assertEqual(list(world.ids()), list(range(600)))
            for wrong, text in ((lambda: world.write("velocity", velocity[1:]), r"\(599, 3\), must be \(600, 3\)"),
                                (lambda: world.write("velocity", velocity[:, :2]), r"must be \(600, 3\)"),
                                (lambda: world.write("pressure", velocity), r"must be \(600,\), as read"),
                                (lambda: world.write("pressure", "x"), r"pressure: str is no array of numbers, must be \(600,"),
                                (lambda: world.read("position", of="air"), "fluid, bodies"),
                                (lambda: world.set_gravity([1]), r"\[1\], must be 2 or 3 numbers"),
                                (lambda: world.set_gravity(-9.81), "gravity: is -9.81, must be 2 or 3 numbers")):
                with self.assertRaisesRegex(ValueError, text):
                    wrong()
            with self.assertRaisesRegex(tobiuo.Error, "there is no field 'colour'"):
                world.read("colour")

    def test_a_controller_in_python_holds_a_ball(self):
        with tobiuo.World(FALL) as world:
            ball = world.bodies["ball"]
            self.assertEqual(list(world.bodies), ["ball"])
            weight = ball.mass*9.81
            while world.time < 1:
                push = weight - 200*(ball.position[2] - 2.2) - 0.5*ball.mass**0.5*40*ball.velocity[2]
                ball.set_force([0, 0, push])
                world.step(0.01)
            self.assertAlmostEqual(ball.position[2], 2.2, 1)
            self.assertGreater(ball.position[2], 2.1)
            for torque in (2, [0, 2]):
                with self.assertRaisesRegex(ValueError, "torque: .* must be 3 numbers; in 2-D the third counts"):
                    ball.set_force([0, 0, 0], torque)
            self.assertEqual(ball.inertia.shape, (3, 3))
            parts = {"kinetic", "potential", "power", "contact_power", "motion_power", "force_power", "air_power",
                     "field_power", "nest_power"}
            self.assertEqual(set(ball.energy()), parts)
            with self.assertRaisesRegex(AttributeError, "position, orientation"):
                ball.colour
            with self.assertRaisesRegex(AttributeError, "'velocity' cannot be set; .*set_force"):
                ball.velocity = [0, 0, 0]
            self.assertIn("Body 'ball' of <tobiuo.World", repr(ball))
            with self.assertRaisesRegex(KeyError, "there are: ball"):
                world.bodies["bat"]

    def test_gravity_turns(self):
        with tobiuo.World(FALL) as world:
            world.set_gravity([0, 0, 5])
            world.advance(0.1)
            self.assertAlmostEqual(world.bodies["ball"].velocity[2], 0.5, 6)
            self.assertAlmostEqual(world.energy()["kinetic"], world.bodies["ball"].energy()["kinetic"], 9)

    def test_a_motion_in_python_is_the_motion_of_the_scene(self):
        hashes = []
        for mine in (False, True):
            with tobiuo.World(with_bodies(FLAP)) as world:
                if mine:
                    world.bodies["flap"].set_motion(lambda t, rest: rest + t*np.array([0.1, 0, 0]))
                world.advance(0.1)
                hashes.append(world.hash)
        self.assertEqual(hashes[0], hashes[1])

    def test_what_a_motion_raises_comes_out(self):
        with tobiuo.World(with_bodies(FLAP)) as world:
            world.bodies["flap"].set_motion(lambda t, rest: rest + t*np.array([0.1, 0, 0]) if t < 0.05 else 1/0)
            with self.assertRaises(ZeroDivisionError):
                world.advance(0.1)
            world.bodies["flap"].set_motion(lambda t, rest: rest + t*np.array([0.1, 0, 0]))
            world.advance(0.1)
            with self.assertRaisesRegex(ValueError, "answered an array"):
                world.bodies["flap"].set_motion(lambda t, rest: rest[1:])
                world.step()

    def test_a_motion_must_not_use_its_world(self):
        with tobiuo.World(with_bodies(FLAP)) as world:
            world.start()
            uses = (lambda: world.time, lambda: world.step(), lambda: world.read("position"), lambda: world.close())
            for use in uses:
                world.bodies["flap"].set_motion(lambda t, rest, use=use: (use() if t > 0.01 else 0, rest)[1])
                with self.assertRaisesRegex(tobiuo.Error, "in a call"):
                    world.advance(world.time + 0.02)
                world.bodies["flap"].set_motion(lambda t, rest: rest)

    def test_control_c_stops_between_two_steps(self):
        with tobiuo.World(POOL) as world, tobiuo.World(POOL) as other:
            world.start()
            signal.setitimer(signal.ITIMER_REAL, 0.05)
            signal.signal(signal.SIGALRM, signal.default_int_handler)
            with self.assertRaises(KeyboardInterrupt):
                world.advance(1000)
            until = world.time + 0.01
            self.assertLess(until, 1000)
            world.advance(until)
            self.assertEqual(world.time, until)
            other.advance(0.01)

    def test_each_step_may_end_a_run(self):
        seen = []
        world = tobiuo.run(POOL, "ended", each_step=lambda w: seen.append(w.time) or w.time < 0.03)
        self.assertEqual(seen[-1], world.time)
        self.assertLess(world.time, 0.1)
        self.assertEqual(tobiuo.Results("ended").times[-1], world.time)

        def break_down(world):
            if world.time > 0.02:
                raise OSError("the controller has lost its link")
        with self.assertRaisesRegex(OSError, "its link"):
            tobiuo.run(POOL, "broken_down", each_step=break_down)
        subprocess.run([program, "resume", "broken_down", "--quiet"], check=True)
        self.assertEqual(tobiuo.Results("broken_down").times[-1], 0.1)

    def test_joints_lines_probes_solids(self):
        scene = with_bodies(FLOAT, probes=[{"name": "gauge", "kind": "level", "position": [0.3, 0.1]}],
                            lines=[{"name": "chain", "kind": "rope", "body": "float", "point": [0.2, 0.12],
                                    "to": [0.2, 0.02], "length": 0.05, "stiffness": 100}])
        with tobiuo.World(scene) as world:
            world.advance(0.02)
            self.assertAlmostEqual(world.probes["gauge"]["level"], 0.15, 1)
            self.assertGreater(world.lines["chain"]["tension"], 1)
            self.assertEqual((len(world.joints), len(world.solids)), (0, 0))
            with self.assertRaisesRegex(KeyError, "there are: none"):
                world.joints["hinge"]
        with tobiuo.World({**POOL, "method": "mlsmpm", "fluids": [], "solids": [
                {"name": "jelly", "density": 900, "fill": [{"box": {"min": [0.1, 0.1], "max": [0.2, 0.2]}}]}]}) as world:
            world.start()
            self.assertAlmostEqual(world.solids["jelly"]["mass"], 9, 6)
            self.assertEqual([piece["particles"] for piece in world.pieces()], [world.count()])

    def test_mistakes_of_scenes_are_told(self):
        lines = tobiuo.check({**POOL, "spacing": -1, "fluids": [{"name": "water", "fill": [], "colour": 1}]})
        self.assertTrue(any("spacing: is -1" in line for line in lines) and any("colour" in line for line in lines))
        self.assertTrue(lines[0].startswith("spacing: is -1"), lines)              # a dict has no lines
        self.assertEqual(tobiuo.check(POOL), [])
        self.assertIn("s.json:2:12: spacing: is -1", tobiuo.check('{\n"spacing": -1 }', name="s.json")[-1])
        with self.assertRaisesRegex(tobiuo.Error, r"\Afluids\[0\].fill\[0\].level: fluid 'water': the level"):
            cup = {"name": "cup", "box": {"min": [0.1, 0.1], "max": [0.2, 0.2]}, "vessel": True, "open_side": [0, 1]}
            tobiuo.World({**POOL, "bodies": [cup], "fluids": [{"name": "water", "fill": [{"vessel": "cup", "level": 1}]}]}).start()
        arrays = {**POOL, "domain": {k: np.array(v) for k, v in POOL["domain"].items()}}
        self.assertEqual(tobiuo.check(arrays, set={"spacing": np.float32(POOL["spacing"]), "end_time": np.int64(1)}), [])
        with self.assertRaisesRegex(TypeError, "nothing that a scene holds"):
            tobiuo.check({**POOL, "spacing": {1, 2}})
        for wrong, at in (({**POOL, "domain": {"min": [0, np.nan], "max": [1, 1]}}, r"domain.min\[1\]: is nan"),
                          ({**POOL, "end_time": float("inf")}, "end_time: is inf, must be a finite number")):
            with self.assertRaisesRegex(ValueError, at):
                tobiuo.check(wrong)
        with self.assertRaisesRegex(ValueError, "fluids.water.viscosity: is nan"):
            tobiuo.check(POOL, set={"fluids.water.viscosity": float("nan")})
        with self.assertRaisesRegex(TypeError, r"a scene is a path, a text in JSON or a dict, not \[\]"):
            tobiuo.World([])
        self.assertIn("none.json", tobiuo.check("none.json")[0])
        with self.assertRaisesRegex(tobiuo.Error, "spacing: is the text") as caught:
            tobiuo.World(POOL, set="spacing=thick")
        self.assertEqual(caught.exception.status, "invalid input")
        with self.assertRaisesRegex(tobiuo.Error, "nothing.obj"):
            tobiuo.World(with_bodies({"name": "boat", "mesh": "nothing.obj"}))
        self.assertIn("spacing", tobiuo.describe("spacing"))
        self.assertIsNone(tobiuo.describe("no such word"))
        self.assertTrue(os.path.exists(tobiuo.shipped("dam_break_2d/scene.json")))

    def test_examples_of_the_page_run(self):
        root = pathlib.Path(__file__).resolve().parents[2]
        for name in ("scenes", "test"):
            os.symlink(root/name, name)
        pages = [(root/f"docs/python{part}.md").read_text(encoding="utf-8") for part in ("", ".ja")]
        codes = [re.findall(r"^```python\n(.*?)^```$", page, re.M | re.S) for page in pages]
        self.assertEqual(len(codes[0]), 3)
        without_comments = [[re.sub(r" +#.*", "", code) for code in page] for page in codes]
        self.assertEqual(*without_comments)
        for code in codes[0]:
            out = subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True,
                                 env={**os.environ, "PYTHONPATH": sys.path[0]}).stdout
            print(out, end="")
            self.assertRegex(out, "[0-9]")

    def test_a_world_is_freed_while_cffi_is_locked(self):
        code = ("import tobiuo, tobiuo.library as l; w = tobiuo.World(tobiuo.shipped('dam_break_2d'), set='spacing=0.02'); "
                "l.ffi._lock.acquire(); del w; print('freed')")
        out = subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True, timeout=60,
                             env={**os.environ, "PYTHONPATH": sys.path[0]}).stdout
        self.assertEqual(out, "freed\n")

    def test_a_closed_world_says_so(self):
        world = tobiuo.World(tobiuo.shipped("dam_break_2d"), set={"spacing": 0.02})
        self.assertIn("t = 0 s", repr(world))
        world.close()
        world.close()
        self.assertEqual(repr(world), "<tobiuo.World, closed>")
        for use in (lambda: world.time, world.step, lambda: world.bodies, lambda: world.info, world.count):
            with self.assertRaisesRegex(tobiuo.Error, "closed"):
                use()


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        unittest.main(argv=sys.argv[:1])
