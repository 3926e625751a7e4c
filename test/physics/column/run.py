#!/usr/bin/python3
"""A column of sand collapses on a floor."""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from harness import Case, fit_line, read_series, read_table, read_vtu

case = Case("column", "Granular column")

D, ROUGH, SMOOTH, RISE = 0.1, 1.0, 0.6, 0.26


def find_foot(x, d, front):
    """Run-outs where the deposit is d/10 thick and where the line through its columns d/20 to d/5 thick ends, over D."""
    counts = [0]*front
    for q in x[::3]:
        if q < 2*d*front:
            counts[int(q/(2*d))] += 1
    at, thick = [(k + 0.5)*2*d/D - 1 for k in range(front)], [n*d/2/D for n in counts] + [0]
    k = max(k for k in range(front) if thick[k] >= 0.1)
    part = [k for k in range(front) if 0.05 <= thick[k] <= 0.2 and at[k] > 0]
    slope, offset = fit_line([at[k] for k in part], [thick[k] for k in part])
    return at[k] + (thick[k] - 0.1)/(thick[k] - thick[k + 1])*2*d/D, -offset/slope


def collapse(ratio, cells, friction, rise=0.0):
    d, reach = D/cells/2, D*(1.5 + 3*ratio)
    end = 3.5*(2*ratio*D/9.81)**0.5 + 0.3
    out = case.solids(f"a{ratio}_{cells}" + ("" if friction == ROUGH else "_smooth") + ("_rise" if rise else ""), {
        "domain": {"min": [0, 0], "max": [reach, D*ratio + 4*d], "walls": {"y": ["separate", "slip"]}, "friction": friction},
        "gravity": [0, -9.81], "spacing": d, "end_time": end,
        "solids": [{"name": "sand", "model": "sand", "density": 1600, "youngs_modulus": 1e6, "friction_angle": 31, "friction_rise": rise,
                    "fill": [{"box": {"min": [0, 0], "max": [D, D*ratio]}}]}],
        "output": {"interval": end/40}})
    times, fronts = [], []
    for t, path in read_series(out):
        x = read_vtu(path)["Points"]
        cell = 2*d
        filled = {int(q/cell) for q in x[::3]}
        front = next(k for k in range(len(filled) + 1) if k not in filled)
        last = [q for q in x[::3] if q < front*cell]
        times.append(t)
        fronts.append((max(last) + d/2)/D - 1)
    slices = [0]*int(reach/D*20 + 1)
    for q in x[::3]:
        slices[int(q/D*20)] += 1
    thick = next(k for k, n in enumerate(slices) if n*d*d < (D/20)**2)/20 - 1
    h = read_table(out/"history.csv")
    case.plot(f"a = {ratio}, {cells} cells, floor {friction}, rise {rise}", "t, s", "(x - d)/d", [
        ("front", times, fronts, False), ("Lube", times, [run_out(ratio)]*len(times), False)])
    top = max(y for q, y in zip(x[::3], x[1::3]) if q < D/8) + d/2
    return fronts[-1], (thick, *find_foot(x, d, front)), top/D, (2*h["kinetic_energy"][-1]/(h["weight"][-1]/9.81))**0.5


def run_out(ratio):
    return 1.2*ratio if ratio < 1.8 else 1.9*ratio**(2/3)


def state_thick(text, thick, exact):
    case.state(f"{text}: where the deposit is d/20 thick, over Lube's run-out", thick[0]/exact)
    case.state(f"{text}: d/10 thick; end of the line through d/20 to d/5", f"{thick[1]/exact:.3f}; {thick[2]/exact:.3f}")


for ratio, cells in case.pick([(1, 24), (4, 12)], [(0.5, 32), (0.5, 64), (1, 16), (1, 32), (1, 64), (4, 16), (4, 32), (8, 16)]):
    exact = run_out(ratio)
    found, thick, top, speed = collapse(ratio, cells, ROUGH)
    text = f"a = {ratio}, {cells} cells in d"
    case.figure(f"{text}: run-out over Lube's {exact:.2f}", found/exact, "within 10 % of 1", abs(found/exact - 1) <= 0.1)
    state_thick(text, thick, exact)
    case.state(f"{text}: height at the side over Lube's", top/(ratio if ratio < 1.15 else ratio**0.4))
    case.state(f"{text}: speed at the end, root mean square, m/s", speed)
    # Twice the scatter of the experiments, which is the goal. Broken with 16 cells in d (0.76 to 0.78): momentum diffuses through
    # the cells that shear (sand_slope), so no smoke size is that coarse.
    case.hold(f"{text}: run-out within 20 %", abs(found/exact - 1) <= 0.2)
    case.hold(f"{text}: come to rest, below 1 cm/s", speed < 0.01)
for ratio, cells in case.pick([], [(1, 16), (1, 32), (1, 64), (4, 16)]):
    found, thick, top, speed = collapse(ratio, cells, ROUGH, RISE)
    exact, text = run_out(ratio), f"a = {ratio}, {cells} cells in d, friction_rise {RISE}"
    case.figure(f"{text}: run-out over Lube's {exact:.2f}", found/exact, "within 10 % of 1", abs(found/exact - 1) <= 0.1)
    state_thick(text, thick, exact)
for ratio, cells in case.pick([], [(1, 32), (1, 64)]):
    found, thick, top, speed = collapse(ratio, cells, SMOOTH)
    text = f"a = {ratio}, {cells} cells in d, floor of friction tan 31"
    case.state(f"{text}: run-out over Lube's", found/run_out(ratio))
    state_thick(text, thick, run_out(ratio))
case.finish()
