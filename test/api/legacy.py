#!/usr/bin/python3
"""Scenes of the Taichi program: what a user sees of exportFrame, exportPly, exportObj, camera, color and
invisibleObjects. Pixels and files are measured, not compared with earlier ones.

usage: legacy.py PROGRAM      works in a fresh folder that it removes
"""
import json
import math
import os
import pathlib
import struct
import subprocess
import sys
import tempfile
import zlib

WIDTH, HEIGHT = 640, 480
RED = {"objectId": 2, "start": [0.6, 0.2, 0.1], "end": [0.7, 0.3, 0.2], "translation": [0.05, 0.1, 0.05], "scale": [1, 1, 1],
       "velocity": [0, 0, 0], "density": 2000.0, "color": [255, 20, 20], "isDynamic": False}
GREEN = dict(RED, objectId=3, start=[0.85, 0.3, 0.15], end=[0.95, 0.4, 0.25], translation=[0, 0, 0], color=[20, 230, 20])
MIDDLE = [0.7, 0.35, 0.2]           # of the red block, whose front lies at z = 0.25
WATER = {"objectId": 0, "start": [0, 0, 0], "end": [0.3, 0.4, 0.4], "translation": [0, 0, 0], "scale": [1, 1, 1],
         "velocity": [0, 0, 0], "density": 1000.0, "color": [50, 100, 200]}
SCENE = {
    "Configuration": {
        "domainStart": [0, 0, 0], "domainEnd": [1, 0.6, 0.4], "particleRadius": 0.02, "particleRadiusRigid": 0.01,
        "numberOfStepsPerRenderUpdate": 2, "density0": 1000, "simulationMethod": 4, "gravitation": [0, -9.81, 0],
        "timeStepSize": 0.002, "simulationTime": 0.008, "exportFrame": True,
        "cameraPosition": [0.7, 0.35, 1.45], "cameraLookat": MIDDLE, "cameraFov": 40},
    "FluidBlocks": [WATER], "RigidBlocks": [RED, GREEN]}
passed = failed = 0


def check(what, ok):
    global passed, failed
    passed += bool(ok)
    failed += not ok
    print("ok    " if ok else "FAILED", what)


def paeth(left, above, corner):
    """That of the three which is nearest to left + above - corner (ISO/IEC 15948)."""
    a, b, c = abs(above - corner), abs(left - corner), abs(left + above - 2*corner)
    return left if a <= b and a <= c else above if b <= c else corner


def read_png(path):
    """Rows of pixels, three bytes each."""
    data, at, packed = path.read_bytes(), 8, b""
    width, height, depth, kind = struct.unpack(">IIBB", data[16:26])
    assert depth == 8 and kind == 2
    while at < len(data):
        size, name = struct.unpack(">I4s", data[at:at + 8])
        packed += data[at + 8:at + 8 + size] if name == b"IDAT" else b""
        at += 12 + size
    raw, rows, above = zlib.decompress(packed), [], bytes(3*width)
    for y in range(height):
        how, line = raw[y*(3*width + 1)], bytearray(raw[y*(3*width + 1) + 1:(y + 1)*(3*width + 1)])
        assert how in (0, 1, 2, 4), "a filter that this test does not know"
        if how == 2:
            line = bytes([(a + b) & 255 for a, b in zip(line, above)])
        elif how and (how == 1 or any(line) or any(above)):
            for k in range(3*width):
                left, corner = (line[k - 3], above[k - 3]) if k > 2 else (0, 0)
                line[k] = (line[k] + (left if how == 1 else paeth(left, above[k], corner))) & 255
        rows.append(line)
        above = line
    return rows


def is_color(row, x, most, ratio=1.8):
    """Whether a channel is much stronger than both others."""
    p = row[3*x:3*x + 3]
    return all(p[most] > 60 and p[most] > ratio*p[k] for k in range(3) if k != most)


def find(rows, most, ratio=1.8):
    """The box around pixels of a colour: x0, y0, x1, y1; None without any."""
    a, b = (k for k in range(3) if k != most)
    spots = [(x, y) for y, row in enumerate(rows)
             for x, (p, q, r) in enumerate(zip(row[most::3], row[a::3], row[b::3])) if p > 60 and p > ratio*q and p > ratio*r]
    if not spots:
        return None
    return (min(s[0] for s in spots), min(s[1] for s in spots), max(s[0] for s in spots), max(s[1] for s in spots))


def run(program, name, keys=None, **parts):
    """The folder of results of the scene with other keys; a value of None takes a key away."""
    scene = {**json.loads(json.dumps(SCENE)), **parts}
    for key, value in (keys or {}).items():
        scene["Configuration"][key] = value
        if value is None:
            del scene["Configuration"][key]
    path = pathlib.Path(name + ".json")
    path.write_text(json.dumps(scene))
    subprocess.run([program, "run", path, "--out", name, "--quiet", "--set", f"output.picture.width={WIDTH}",
                    "--set", f"output.picture.height={HEIGHT}"], check=True)
    return pathlib.Path(name)


def main(program):
    out = run(program, "all", {"exportPly": True, "exportObj": True})
    frames = sorted(p.name for p in (out/"frames").glob("*.png"))
    check("exportFrame: a picture every other step, and the start",
          frames == [f"frame_{k:06d}.png" for k in range(3)])
    rows = read_png(out/"frames"/"frame_000000.png")
    box = find(rows, 0)
    check("cameraLookat is in the middle of the picture, where the red block is",
          box and abs(box[0] + box[2] + 1 - WIDTH) < 6 and is_color(rows[HEIGHT//2], WIDTH//2, 0))
    side = 0.1*0.5*HEIGHT/math.tan(math.radians(20))/1.2      # pixels, of its front, 1.2 m from the eye
    check(f"cameraFov: it is {box[2] - box[0] + 1} pixels wide, by the angle {side:.0f}",
          abs(box[2] - box[0] + 1 - side) < 0.06*side)
    green, blue = find(rows, 1), find(rows, 2, 1.4)
    check("color: a green block, right of the red one and not above it",
          green and green[0] > box[2] and abs(green[1] + green[3] - box[1] - box[3]) < 0.5*side)
    check("color: blue water on the left, below the red block",
          blue and blue[0] < box[0] - 2*side and blue[3] > box[3])
    tilted = read_png(run(program, "angle", {"cameraFov": None})/"frames"/"frame_000000.png")
    wide = find(tilted, 0)
    check("cameraFov is 45 degrees without the key", abs((wide[2] - wide[0] + 1)/(box[2] - box[0] + 1)
                                                        - math.tan(math.radians(20))/math.tan(math.radians(22.5))) < 0.05)
    moved = find(read_png(run(program, "moved", {"cameraPosition": [0.7, 0.35, 2.65]})/"frames"/"frame_000000.png"), 0)
    check("cameraPosition: twice as far, half as large", abs((moved[2] - moved[0] + 1)/(box[2] - box[0] + 1) - 0.5) < 0.06)
    free = read_png(run(program, "free", {k: None for k in ("cameraPosition", "cameraLookat", "cameraFov")})
                    / "frames"/"frame_000000.png")
    check("without a camera all is in the picture", find(free, 0) and find(free, 1) and find(free, 2, 1.4))

    for numbers, red, grass, water in ([3], 1, 0, 1), ([2, 3], 0, 0, 1), ([0], 1, 1, 0):
        rows = read_png(run(program, "hidden", {"invisibleObjects": numbers, "simulationTime": 0.004})
                        / "frames"/"frame_000000.png")
        seen = [find(rows, 0), find(rows, 1), find(rows, 2, 1.4)]
        check(f"invisibleObjects {numbers}: those are not in the picture, others are",
              [bool(s) for s in seen] == [bool(s) for s in (red, grass, water)])
        subprocess.run(["rm", "-r", "hidden"], check=True)

    plies = sorted(out.rglob("*.ply"))
    check("exportPly: a file at each output", len(plies) == 3)
    head, body = plies[0].read_bytes().split(b"end_header\n", 1)
    count = int([line for line in head.split(b"\n") if line.startswith(b"element vertex")][0].split()[2])
    check(f"exportPly: {count} particles of 8 x 10 x 10", count == 800)
    objs = sorted(out.rglob("*.obj"))
    check("exportObj: each body at each output", len(objs) == 6)
    corners = [[float(v) for v in line.split()[1:4]] for line in objs[0].read_text().splitlines() if line.startswith("v ")]
    low, high = [[f(c[k] for c in corners) for k in range(3)] for f in (min, max)]
    check("exportObj: the first is the red block, moved by its translation",
          all(abs(low[k] - MIDDLE[k] + 0.05) < 1e-6 and abs(high[k] - MIDDLE[k] - 0.05) < 1e-6 for k in range(3)))
    bare = run(program, "bare", {"exportFrame": False, "exportPly": False, "exportObj": False})
    check("no export, no such files", not [p for kind in ("png", "ply", "obj") for p in bare.rglob("*." + kind)])


if __name__ == "__main__":
    file = pathlib.Path(sys.argv[1]).resolve()
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        main(file)
        os.chdir("/")
    print(f"{passed} passed, {failed} failed")
    sys.exit(failed > 0)
