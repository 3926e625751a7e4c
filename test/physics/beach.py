"""A flat bottom and a plane slope, and a piston that sends a solitary wave up it; 2-D, inviscid, at rest."""
import math

G = 9.81


def write_slope(path, flat, way, top):
    """The slope as a closed body from x = flat, over `way` up to `top`, as OBJ. Returns the path."""
    path.parent.mkdir(parents=True, exist_ok=True)
    lines = [f"v {x} {y} {z}" for z in (-1, 1) for x, y in ((flat, 0), (flat + way, 0), (flat + way, top))]
    faces = [(1, 3, 2), (4, 5, 6)] + [f for k in range(3) for f in ((k + 1, (k + 1) % 3 + 1, (k + 1) % 3 + 4),
                                                                     (k + 1, (k + 1) % 3 + 4, k + 4))]
    path.write_text("\n".join(lines + ["f %d %d %d" % f for f in faces]) + "\n")
    return path


def soliton(height):
    """Wave number times depth and speed over sqrt(g d) of a solitary wave of that height over depth."""
    return math.sqrt(0.75*height), math.sqrt(1 + height)


def scene(slope, depth, height, cot, layers, flat, meant, end, gauges):
    """The scene: `height` and `meant`, the run-up expected, over the depth; gauges: x of levels, from the slope's toe."""
    spacing, block = depth/layers, 6*depth/layers
    top = round((1.3 + 2*meant)*depth, 4)
    way = math.ceil(top*cot/spacing)*spacing
    # the end of the slope is the domain's. Water ends where the slope leaves it: particles inside the body are not placed.
    return {"dimension": 2, "domain": {"min": [-3*block, 0], "max": [flat + way + spacing, round(max(1.2*top, 1.7*depth)/spacing)*spacing]},
            "spacing": spacing, "end_time": end,
            "fluids": [{"name": "water", "density": 1000, "viscosity": 0,
                        "fill": [{"box": {"min": [0, 0], "max": [flat + depth*cot, depth]}}]}],
            "bodies": [{"name": "piston", "box": {"min": [-block, 0], "max": [0, 1.5*depth]},
                        "motion": {"piston": {"depth": depth, "solitary": {"height": height*depth}}}},
                       {"name": "slope", "mesh": str(write_slope(slope, flat, way, top))}],
            "probes": [{"name": "shore", "kind": "run-up", "position": [flat + 0.5*depth*cot, 0.5*depth + 0.5*spacing],
                        "end": [flat + 0.98*way, 0.98*top + 0.5*spacing]}]
            + [{"name": name, "kind": "level", "position": [flat + x, max(0, x/cot)]} for name, x in gauges],
            "output": {"interval": end/10, "probe_interval": end/600, "fields": ["velocity"], "surfaces": False}}
