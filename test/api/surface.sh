#!/bin/bash
# tobiuo surface: surfaces of a run in all formats, those beside a run, VTK's reading of them, messages.
# usage: surface.sh PROGRAM      works in a fresh folder that it removes; last line: "N passed, N failed"
set -uo pipefail
here=$(cd "$(dirname "$0")" && pwd)
. "$here/checks.sh" "$1"

# vtk WHAT FILE [KEY=VALUE...]: VTK reads it and finds that (without VTK, code 77, nothing is checked)
vtk() {
    local code=0 what=$1
    shift
    /usr/bin/python3 "$here/read_vtk.py" "$@" > out.txt || code=$?
    check "$what: $(tail -1 out.txt)" test $code = 0 -o $code = 77
}

cat > dam.json <<'END'
{ "domain": {"min": [0, 0, 0], "max": [0.4, 0.2, 0.3]}, "gravity": [0, 0, -9.81], "spacing": 0.02, "end_time": 0.1,
  "fluids": [{"name": "water", "fill": [{"box": {"min": [0, 0, 0], "max": [0.2, 0.2, 0.2]}}]}],
  "output": {"interval": 0.05, "surface": {"write": true, "fields": ["velocity"]}} }
END
expect 0 "" run dam.json --out dam --quiet
vtk "beside the run" dam/surface/surface_000002.vtp 'arrays={"group": 1, "normals": 3, "velocity": 3}'
vtk "its list" dam/surface.pvd 'times=[0, 0.05, 0.1]'
cp -r dam/surface own

for format in vtp obj ply stl; do
    expect 0 "" surface dam --format $format
    check "$format: three files" test -s dam/surface/surface_000002.$format
    check "$format: that is told" grep -q "^surface: dam/surface, 3 files, .* million triangles" out.txt
done
vtk "afterwards" dam/surface/surface_000002.vtp 'arrays={"group": 1, "normals": 3, "speed": 1, "pressure": 1}'
vtk "its list" dam/surface.pvd 'times=[0, 0.05, 0.1]'
if /usr/bin/python3 -c "import vtk" 2> /dev/null; then
    check "closed as VTK sees it" /usr/bin/python3 -c '
import vtk
reader, edges = vtk.vtkXMLPolyDataReader(), vtk.vtkFeatureEdges()
reader.SetFileName("dam/surface/surface_000002.vtp")
edges.SetInputConnection(reader.GetOutputPort())
edges.FeatureEdgesOff()
edges.BoundaryEdgesOn()
edges.NonManifoldEdgesOn()
edges.Update()
assert reader.GetOutput().GetNumberOfPolys() > 500 and edges.GetOutput().GetNumberOfCells() == 0
assert reader.GetOutput().GetPointData().GetNormals() is not None'
fi
expect 0 "" surface dam --last --language ja
check "in Japanese too" grep -q "^表面：dam/surface、1ファイル、三角形" out.txt
check "no parts are left" test -z "$(find dam -name '*.part')"

expect 2 "is none of vtp" run dam.json --out no --surface dxf
expect 1 "a run in 2-D has no surface" run dam.json --out no --surface glb --set dimension=2 \
    --set 'gravity=[0, -9.81]' --set output.surface={}
expect 0 "" run dam.json --out film --quiet --surface glb --slow 2 --set output.surface.write=false
expect 0 "" surface dam --format glb --slow 2
check "run --surface is tobiuo surface" cmp film/surface.glb dam/surface.glb

# Two liquids: a surface and a colour each, which lets light through.
cat > two.json <<'END'
{ "domain": {"min": [0, 0, 0], "max": [0.4, 0.2, 0.3]}, "gravity": [0, 0, -9.81], "spacing": 0.02, "end_time": 0.01,
  "fluids": [{"name": "water", "fill": [{"box": {"min": [0, 0, 0], "max": [0.2, 0.2, 0.2]}}]},
    {"name": "oil", "density": 900, "color": [204, 153, 51],
     "fill": [{"box": {"min": [0.2, 0, 0], "max": [0.4, 0.2, 0.1]}}]}],
  "output": {"interval": 0.01} }
END
expect 0 "" run two.json --out two --quiet
for format in obj ply glb; do expect 0 "" surface two --last --format $format; done
check "one frame is no frames" grep -q "glb, 1 frame, " out.txt
check "two liquids, their colours" $python - <<'END'
import json, struct
lines = open("two/surface/surface_000001.obj").read().splitlines()
colors = {tuple(l.split()[4:]) for l in lines if l.startswith("v ")}
assert colors == {("0.1000", "0.4000", "0.5000"), ("0.8000", "0.6000", "0.2000")}, colors
head, _, body = open("two/surface/surface_000001.ply", "rb").read().partition(b"end_header\n")
assert b"property uchar red" in head and b"color_0" not in head
size = {b"uchar": 1, b"int": 4, b"float": 4, b"double": 8}
row = sum(size[l.split()[1]] for l in head.splitlines() if l.startswith(b"property") and b"list" not in l)
count = int(head.split(b"element vertex")[1].split()[0])
assert {struct.unpack_from("<i", body, row*i + 36)[0] for i in range(count)} == {0, 1}
data = open("two/surface.glb", "rb").read()
g = json.loads(data[20:20 + struct.unpack("<I", data[12:16])[0]])
parts = g["meshes"][0]["primitives"]
assert [g["materials"][p["material"]].get("alphaMode") for p in parts] == ["BLEND"], parts
END

# A component as the vertices' number, and the colour of glTF.
expect 0 "" surface dam --last --field velocity_z
vtk "a component" dam/surface/surface_000002.vtp 'arrays={"group": 1, "normals": 3, "velocity_z": 1}'
for field in velocity velocity_z; do
    expect 0 "" surface dam --last --field $field --format ply
    mv dam/surface/surface_000002.ply $field.ply
done
check "it is the third of the vector" $python - <<'END'
import struct
def read(name):
    head, _, body = open(name, "rb").read().partition(b"end_header\n")
    size = {b"uchar": 1, b"int": 4, b"float": 4, b"double": 8}
    names, at = {}, 0
    for line in head.splitlines():
        if not line.startswith(b"property") or b"list" in line: continue
        names[line.split()[2].decode()] = at
        at += size[line.split()[1]]
    count = int(head.split(b"element vertex")[1].split()[0])
    key = list(names)[-1]
    return key, [struct.unpack_from("<f", body, at*i + names[key])[0] for i in range(count)]
(whole, a), (part, b) = read("velocity.ply"), read("velocity_z.ply")
assert (whole, part) == ("velocity_2", "velocity_z") and a == b and min(a) < -0.3, (whole, part)
END
expect 0 "" surface dam --format glb --field velocity_z
expect 1 "dam has no field 'velocity_w'; it has speed, velocity" surface dam --field velocity_w

# A solid whose particles are nearer to each other than the water's keeps its volume.
cat > fine.json <<'END'
{ "domain": {"min": [0, 0, 0], "max": [1, 0.3, 0.4]}, "gravity": [0, 0, 0], "spacing": 0.02, "end_time": 0.001,
  "mlsmpm": {"spacing": 0.01},
  "fluids": [{"name": "water", "fill": [{"box": {"min": [0, 0, 0], "max": [0.4, 0.3, 0.2]}}]}],
  "solids": [{"name": "ball", "youngs_modulus": 1e5,
              "fill": [{"sphere": {"centre": [0.7, 0.15, 0.2], "radius": 0.08}}]}],
  "output": {"interval": 0.001} }
END
expect 0 "" run fine.json --out fine --quiet
expect 0 "" surface fine --last --format obj
check "a solid of finer particles" $python - <<'END'
import math
rows = [l.split() for l in open("fine/surface/surface_000001.obj")]
at = [[float(x) for x in r[1:4]] for r in rows if r[:1] == ["v"]]
volume = 0
for r in rows:
    if r[:1] != ["f"]: continue
    a, b, c = (at[int(k.split("/")[0]) - 1] for k in r[1:4])
    if a[0] < 0.55: continue
    volume += (a[0]*(b[1]*c[2] - b[2]*c[1]) + a[1]*(b[2]*c[0] - b[0]*c[2]) + a[2]*(b[0]*c[1] - b[1]*c[0]))/6
assert abs(volume/(4/3*math.pi*0.08**3) - 1) < 0.02, volume/(4/3*math.pi*0.08**3)
END

# The same bits for any number of threads; glTF as a reader of JSON sees it.
expect 0 "" surface dam --format glb --field speed --threads 1
mv dam/surface.glb one.glb
expect 0 "" surface dam --format glb --field speed --threads 3
check "the same bits" cmp one.glb dam/surface.glb
$python - <<'END'
import json, struct
data = open("one.glb", "rb").read()
magic, version, length, size, kind = struct.unpack("<4sIIII", data[:20])
assert (magic, version, length, kind) == (b"glTF", 2, len(data), 0x4e4f534a)
g = json.loads(data[20:20 + size])
binary, = struct.unpack("<I", data[20 + size:24 + size])
assert binary == g["buffers"][0]["byteLength"] == length - size - 28
assert len(g["meshes"]) == 3 and len(g["animations"][0]["channels"]) == 3
for view in g["bufferViews"]:
    assert view["byteOffset"] + view["byteLength"] <= binary
    assert view["byteOffset"] % 4 == 0
# every frame is shown from its own time to that of the next
at = 28 + size
def numbers(accessor):
    a = g["accessors"][accessor]
    v = g["bufferViews"][a["bufferView"]]
    return struct.unpack_from(f"<{v['byteLength']//4}f", data, at + v["byteOffset"])
for k, s in enumerate(g["animations"][0]["samplers"]):
    times, scales = numbers(s["input"]), numbers(s["output"])
    assert s["interpolation"] == "STEP"
    for t in (0, 1, 2):
        step = max(i for i, x in enumerate(times) if x <= t*0.05 + 1e-4)
        assert scales[3*step] == (t == k), (k, t, times, scales)
# water stands below the top of the column, upwards is y
low = min(g["accessors"][m["primitives"][0]["attributes"]["POSITION"]]["min"][2] for m in g["meshes"])
high = max(g["accessors"][m["primitives"][0]["attributes"]["POSITION"]]["max"][2] for m in g["meshes"])
assert 0.19 < high - low < 0.22, (low, high)
r = g["nodes"][0]["rotation"]
assert abs(r[0] + 0.5**0.5) < 1e-6 and abs(r[3] - 0.5**0.5) < 1e-6
END
check "glTF holds what it should" test $? = 0
if command -v assimp > /dev/null; then
    check "assimp reads it" assimp info one.glb
fi
# VTK's reader of glTF: at the time of each frame that frame alone has a size, that of its VTP file.
if /usr/bin/python3 -c "import vtk" 2> /dev/null; then
    expect 0 "" surface dam --format vtp
    check "VTK sees the animation" /usr/bin/python3 - <<'END'
import vtk
def shown(time):
    reader = vtk.vtkGLTFReader()
    reader.SetFileName("one.glb")
    reader.SetFrameRate(100)
    reader.UpdateInformation()
    assert reader.GetNumberOfAnimations() == 1 and abs(reader.GetAnimationDuration(0) - 0.15) < 1e-6
    reader.EnableAnimation(0)
    reader.UpdateInformation()
    reader.UpdateTimeStep(time)
    tree, seen = reader.GetOutput().NewIterator(), []
    while not tree.IsDoneWithTraversal():
        part = tree.GetCurrentDataObject()
        box = part.GetBounds()
        if max(box[1] - box[0], box[3] - box[2], box[5] - box[4]) > 1e-6: seen.append((part.GetNumberOfCells(), box))
        tree.GoToNextItem()
    return seen
for k in range(3):
    own = vtk.vtkXMLPolyDataReader()
    own.SetFileName(f"dam/surface/surface_{k:06d}.vtp")
    own.Update()
    (cells, box), = shown(0.05*k + 0.02)
    x, y, z = (own.GetOutput().GetBounds()[2*a:2*a + 2] for a in range(3))
    assert cells == own.GetOutput().GetNumberOfCells(), (k, cells)
    for a, b in zip(box, (*x, *z, -y[1], -y[0])): assert abs(a - b) < 1e-5, (k, box, x, y, z)
END
fi

# The volume of the water is that of its particles, but for what water beside walls stands too high.
expect 0 "" surface dam --format stl --smooth 25 --cell 0.5 --last
$python - <<'END'
import struct
data = open("dam/surface/surface_000002.stl", "rb").read()
n, = struct.unpack_from("<I", data, 80)
total = 0
for k in range(n):
    a, b, c = (struct.unpack_from("<3f", data, 84 + 50*k + 12 + 12*q) for q in range(3))
    total += (a[0]*(b[1]*c[2] - b[2]*c[1]) + a[1]*(b[2]*c[0] - b[0]*c[2]) + a[2]*(b[0]*c[1] - b[1]*c[0]))/6
assert abs(total/0.008 - 1) < 0.05, total
END
check "the volume is right" test $? = 0

expect 1 "dam has no field 'sped'; it has speed, velocity, pressure" surface dam --field sped
expect 1 "there are no results of a run" surface nowhere
expect 2 "--cell: 7 is not from 0.1 to 2 spacings" surface dam --cell 7
expect 2 "--smooth: '101' is not a number from 0 to 100" surface dam --smooth 101
expect 2 "none of vtp, obj, ply, stl, glb" surface dam --format vtk
expect 2 "which DIR?" surface
rm -r dam/surface && : > dam/surface
expect 1 "dam/surface is no folder" surface dam
sed 's/"gravity".*"spacing"/"dimension": 2, "spacing"/; s/, 0\.[23]\]/]/g; s/\[0, 0, 0\]/[0, 0]/g; s/"output".*/"output": {"interval": 0.05} }/' \
    dam.json > flat.json
sed -i 's/"max": \[0.4, 0.2\]/"max": [0.4, 0.3]/' flat.json
expect 0 "" run flat.json --out flat --quiet
expect 1 "flat is a run in 2-D, which has no surface" surface flat
# Too small a cell for the memory: the number is told. First, how much memory a large cell needs.
rm -f dam/surface
in_memory() { (ulimit -v "$1"; OMP_NUM_THREADS=1 "$program" surface dam --cell "$2" --threads 1 --last > out.txt 2> err.txt); }
room=40000
until in_memory $room 2 || [ $room -gt 400000 ]; do room=$((room + 5000)); done
got=0; in_memory $room 0.1 || got=$?
check "no memory: exit code 1 (was $got)" test $got = 1
check "no memory: the number is told" grep -q "surface: no memory for [0-9.e+-]* GB; a larger cell needs less" err.txt

echo "$passed passed, $failed failed"
[ $failed -eq 0 ]
