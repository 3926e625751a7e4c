#!/usr/bin/python3
"""The lid-driven cavity against Ghia, Ghia & Shin (1982) and Marchi, Santiago & Carvalho (2021)."""
import json
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from harness import Case, mean, read_table

case = Case("cavity", "Lid-driven cavity", methods=("isph",))

# (y, u on x = 0.5) and (x, v on y = 0.5) by Reynolds number; table I and II of the publication.
U = {100: [(0.9766, 0.84123), (0.9688, 0.78871), (0.9609, 0.73722), (0.9531, 0.68717), (0.8516, 0.23151),
           (0.7344, 0.00332), (0.6172, -0.13641), (0.5, -0.20581), (0.4531, -0.2109), (0.2813, -0.15662),
           (0.1719, -0.1015), (0.1016, -0.06434), (0.0703, -0.04775), (0.0625, -0.04192), (0.0547, -0.03717)],
     1000: [(0.9766, 0.65928), (0.9688, 0.57492), (0.9609, 0.51117), (0.9531, 0.46604), (0.8516, 0.33304),
            (0.7344, 0.18719), (0.6172, 0.05702), (0.5, -0.0608), (0.4531, -0.10648), (0.2813, -0.27805),
            (0.1719, -0.38289), (0.1016, -0.2973), (0.0703, -0.2222), (0.0625, -0.20196), (0.0547, -0.18109)]}
V = {100: [(0.9688, -0.05906), (0.9609, -0.07391), (0.9531, -0.08864), (0.9453, -0.10313), (0.9063, -0.16914),
           (0.8594, -0.22445), (0.8047, -0.24533), (0.5, 0.05454), (0.2344, 0.17527), (0.2266, 0.17507),
           (0.1563, 0.16077), (0.0938, 0.12317), (0.0781, 0.1089), (0.0703, 0.10091), (0.0625, 0.09233)],
     1000: [(0.9688, -0.21388), (0.9609, -0.27669), (0.9531, -0.33714), (0.9453, -0.39188), (0.9063, -0.5155),
            (0.8594, -0.42665), (0.8047, -0.31966), (0.5, 0.02526), (0.2344, 0.32235), (0.2266, 0.33075),
            (0.1563, 0.37095), (0.0938, 0.32627), (0.0781, 0.30353), (0.0703, 0.29012), (0.0625, 0.27485)]}

# The same lines at Re 1000 by Marchi et al. (2021), 8192 x 8192 cells, extrapolated; further values between.
MARCHI_U = [
    (0.0546875, -0.1812532), (0.0625, -0.2023291), (0.0703125, -0.2229271), (0.1015625, -0.3003688), (0.125, -0.3478431),
    (0.171875, -0.3885676), (0.1875, -0.3844078), (0.25, -0.3189453), (0.28125, -0.2804279), (0.3125, -0.2456931),
    (0.375, -0.1837316), (0.4375, -0.1234102), (0.453125, -0.1081753), (0.5, -0.0620561), (0.5625, 0.0005617),
    (0.6171875, 0.0570044), (0.625, 0.0652484), (0.6875, 0.1335720), (0.734375, 0.1886436), (0.75, 0.2079138),
    (0.8125, 0.2884412), (0.8515625, 0.3371763), (0.875, 0.3625452), (0.9375, 0.4229307), (0.953125, 0.4724491),
    (0.9609375, 0.5171830), (0.96875, 0.5803655), (0.9765625, 0.6639720)]
MARCHI_V = [
    (0.0625, 0.2807042), (0.0703125, 0.2962922), (0.078125, 0.3099493), (0.09375, 0.3329768), (0.125, 0.3650400),
    (0.15625, 0.3769157), (0.1875, 0.3678512), (0.2265625, 0.3340319), (0.234375, 0.3253866), (0.25, 0.3071034),
    (0.3125, 0.2312678), (0.375, 0.1605638), (0.4375, 0.0929691), (0.5, 0.0257995), (0.5625, -0.0418405),
    (0.625, -0.1107978), (0.6875, -0.1816791), (0.75, -0.2533806), (0.8046875, -0.3201954), (0.8125, -0.3315658),
    (0.859375, -0.4263892), (0.875, -0.4677741), (0.90625, -0.5264155), (0.9375, -0.4561505), (0.9453125, -0.4102923),
    (0.953125, -0.3551312), (0.9609375, -0.2933786), (0.96875, -0.2283407)]


def compute(re, across, end, goal):
    """Runs one Reynolds number and compares both lines."""
    probes = [{"name": f"u{k}", "position": [0.5, y]} for k, (y, _) in enumerate(U[re])]
    probes += [{"name": f"v{k}", "position": [x, 0.5]} for k, (x, _) in enumerate(V[re])]
    probes += [{"name": f"mu{k}", "position": [0.5, y]} for k, (y, _) in enumerate(MARCHI_U)]
    probes += [{"name": f"mv{k}", "position": [x, 0.5]} for k, (x, _) in enumerate(MARCHI_V)]
    scene = json.loads("\n".join(l for l in (case.folder / "scene.json").read_text().splitlines() if l[:1] != "#"))
    scene.update(probes=probes, spacing=1/across, end_time=end)
    scene["fluids"][0]["viscosity"] = 1000/re
    path = case.out / f"cavity{re}_{across}.json"
    path.write_text(json.dumps(scene))
    table = read_table(case.run(f"cavity{re}_{across}_out", scene=path) / "probes.csv")
    late = [k for k, t in enumerate(table["time"]) if t > end - 2]
    for name, rows, axis in (("u", U[re], "x"), ("v", V[re], "y")):
        ours = [mean([table[f"{name}{k}_velocity_{axis}"][i] for i in late]) for k in range(len(rows))]
        worst = max(abs(a - b) for a, (_, b) in zip(ours, rows))
        case.figure(f"Re {re}, {across} across: largest deviation of {name} over U", worst, f"<= {goal}", worst <= goal)
        # Twice the goal: another flow is off by more, rest by 0.2 at least.
        case.hold(f"Re {re}: {name} within {2*goal:g}", worst <= 2*goal)
        case.plot(f"{name} on the centre line, Re = {re}", "y / L" if name == "u" else "x / L", f"{name} / U",
                  [(f"tobiuo, {across} across", [r[0] for r in rows], ours, False),
                   ("Ghia et al. 1982", [r[0] for r in rows], [r[1] for r in rows], True)])
    if re == 1000:
        off = [mean([table[f"{name}{k}_velocity_{axis}"][i] for i in late]) - value
               for name, rows, axis in (("mu", MARCHI_U, "x"), ("mv", MARCHI_V, "y")) for k, (_, value) in enumerate(rows)]
        error = math.sqrt(mean([o*o for o in off]))
        case.figure(f"Re {re}, {across} across: L2 of both lines over U, against Marchi et al.", error, "<= 0.01", error <= 0.01)
        case.state(f"Re {re}, {across} across: seconds of the run", case.costs[-1][0])


compute(100, *case.pick((20, 10), (40, 20)), 0.03)
if not case.smoke:
    compute(1000, 50, 45, 0.05)
if case.args.method == "isph":
    compute(1000, 100, 40, 0.02)
case.finish()
