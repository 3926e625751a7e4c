#!/bin/bash
# tobiuo plot: pictures of a real run and of made-up tables, reference data, hostile names, messages.
# usage: plot.sh PROGRAM      works in a fresh folder that it removes; last line: "N passed, N failed"
# Answers 77 (skipped) without gnuplot, after the tests that do without it.
set -uo pipefail
. "$(dirname "$0")/checks.sh" "$1"

# has FILE TEXT: a whole SVG file whose visible texts contain TEXT
has() {
    $python - "$1" "$2" <<'END'
import sys, xml.etree.ElementTree as tree
texts = ["".join(e.itertext()) for e in tree.parse(sys.argv[1]).iter() if e.tag.endswith("}text")]
sys.exit(not any(sys.argv[2] in t for t in texts))
END
}
# points FILE: number of reference marks (gnuplot draws them as <use> of its symbols)
points() { grep -c "<use xlink:href='#gpPt[0-9]*' transform=" "$1"; }

# --- without gnuplot --------------------------------------------------------------------------------
expect 2 "which DIR?" plot
expect 2 "neither svg nor png" plot nowhere --format gif
expect 1 "no history.csv" plot nowhere
mkdir made && mkfifo made/history.csv
expect 1 "is not a file" plot made
rm made/history.csv && : > made/history.csv
expect 1 "is empty" plot made
echo "when,what" > made/history.csv
expect 1 'no column "time"' plot made
echo "time,step,kinetic_energy" > made/history.csv
expect 1 "no rows yet" plot made
check "nothing was drawn so far" test ! -e made/plots
mkdir -p fifo && mkfifo fifo/history.csv
got=0; timeout 20 "$program" plot fifo 2> err.txt || got=$?
check "a FIFO is not waited for (exit code $got)" test $got = 1
printf '0,0,0\n0.1,1,2\n0.2,2,nan\n' >> made/history.csv
got=0; PATH=/nonexistent "$program" plot made > out.txt 2> err.txt || got=$?
check "gnuplot missing: exit code 1 (was $got)" test $got = 1
check "gnuplot missing: the package is named" grep -q "gnuplot-nox" err.txt

# --- references in a scene --------------------------------------------------------------------------
cat > box.obj <<'END'
v -0.02 -0.02 -0.02
v 0.02 -0.02 -0.02
v -0.02 0.02 -0.02
v 0.02 0.02 -0.02
v -0.02 -0.02 0.02
v 0.02 -0.02 0.02
v -0.02 0.02 0.02
v 0.02 0.02 0.02
f 1 3 4 2
f 5 6 8 7
f 1 2 6 5
f 3 7 8 4
f 1 5 7 3
f 2 4 8 6
END
printf '# an experiment\nt [ms],"F, N",other\n10,-35,1\n20,-40,2\n30,-39,3\n900,-39,4\n' > measured.csv
cat > tank.json <<'END'
{ "domain": {"min": [-0.1, -0.1, 0], "max": [0.1, 0.1, 0.2]}, "spacing": 0.01, "end_time": 0.04,
  "fluids": [{"name": "water", "fill": [{"box": {"min": [-0.1, -0.1, 0], "max": [0.1, 0.1, 0.1]}}]}],
  "bodies": [{"name": "the 'box' $(touch pwned)", "mesh": "box.obj", "translation": [0, 0, 0.05]}],
  "probes": [{"name": "P 1", "position": [0.1, 0, 0.02]}, {"name": "H", "kind": "level", "position": [0.05, 0, 0]}],
  "references": [
    {"file": "measured.csv", "probe": "P 1", "column": "pressure", "x": "t [ms]", "x_scale": 1e-3, "y": "F, N",
     "y_scale": -20},
    {"file": "measured.csv", "column": "wall_force_z", "x": "t [ms]", "x_scale": 1e-3, "y": "F, N",
     "label": "Müller & <Co> 'it''s' `touch pwned` 10 %"},
    {"file": "measured.csv", "column": "wall_force_z", "x": "t [ms]", "x_scale": 1e-3, "y": "F, N",
     "y_scale": 1.1},
    {"file": "measured.csv", "column": "pressure_force_z", "body": "the 'box' $(touch pwned)",
     "x": "t [ms]", "x_scale": 1e-3, "y": "other"} ] }
END
expect 0 "" check tank.json
expect 1 'did you mean "wall_force_z"?' check tank.json --set 'references[1].column=wal_force_z'
expect 1 '"H_level" is of a probe: write "probe": "H", "column": "level"' check tank.json \
    --set 'references[1].column=H_level'
expect 1 "one of bodies.csv or probes.csv needs body" check tank.json --set 'references[1].column=position_x'
expect 1 'there is no body "fish"' check tank.json --set 'references[3].body=fish'
expect 1 'there is no probe "P2"' check tank.json --set 'references[0].probe=P2'
expect 1 'no column "level" in a point' check tank.json --set 'references[0].column=level'
expect 1 'no column "pressure" in a level' check tank.json --set 'references[0].probe=H'
expect 1 "at most one of them" check tank.json --set 'references[3].probe=H'
expect 1 "cannot find" check tank.json --set 'references[1].file=no_such.csv'
expect 1 "allowed is 1e-30 to 1e30" check tank.json --set 'references[2].x_scale=-1'
expect 1 "file: is missing" check tank.json --set 'references=[{"column": "dt"}]'
expect 1 "must be a list" check tank.json --set 'references={}'
expect 1 "one line" check tank.json --set 'references[0].label="a\nb"'
expect 0 "" describe reference
expect 0 "" run tank.json --quiet --out tank
check "resolved.json carries the references" grep -q '"x_scale": 0.001' tank/resolved.json
expect 0 "" run tank/resolved.json --quiet --out again --until 0.01
check "and reads them back" grep -q '"x_scale": 0.001' again/resolved.json

if ! command -v gnuplot > /dev/null; then
    echo "$passed passed, $failed failed; no gnuplot (Debian package gnuplot-nox)"
    [ $failed -eq 0 ] && exit 77
    exit 1
fi

# --- a real run -------------------------------------------------------------------------------------
expect 0 "" plot tank
box="the _box_ \$(touch pwned)"
for file in energies walls incompressibility solver "${box}_motion" "${box}_force" "${box}_torque" \
            probes_pressure probes_velocity probes_level "compare_P 1_pressure" compare_wall_force_z "compare_${box}_pressure_force_z"; do
    check "a picture of $file" has "tank/plots/$file.svg" "time, s"
    check "$file is listed" grep -qxF "tank/plots/$file.svg" out.txt
done
check "13 pictures" test "$(wc -l < out.txt)" = 13
check "axes have units" has tank/plots/energies.svg "kinetic energy, J"
check "the body is named as it is" has "tank/plots/${box}_force.svg" "the 'box' \$(touch pwned)"
check "the label as well" has tank/plots/compare_wall_force_z.svg "Müller & <Co> 'it''s' \`touch pwned\` 10 %"
check "a reference without label shows its file" has tank/plots/compare_wall_force_z.svg "measured.csv"
check "the marks within the run's time: twice 3, and 2 in the legend" \
    test "$(points tank/plots/compare_wall_force_z.svg)" = 8
check "no name was run as a command" test ! -e pwned -a ! -e tank/plots/pwned
printf 'time [s],rope_tension [N],rope_distance [m]\n0,1,2\n0.1,2,3\n' > tank/lines.csv
printf 'time [s],pin_force_x [N],pin_moment_z [N m],pin_angle [degrees],pin_gap [m],pin_power [W]\n0,1,2,3,0,0\n0.1,2,3,4,0,5\n' \
    > tank/joints.csv
printf 'time,name,position_x,velocity_x,mean_liquid_force_x\n0,jelly,1,0,0\n0.1,jelly,1,2,3\n' > tank/solids.csv
expect 0 "" plot tank
check "lines are drawn" has tank/plots/lines.svg "rope_tension"
check "forces of joints are drawn" has tank/plots/joints_force.svg "force_x, N"
check "moments of joints are drawn" has tank/plots/joints_moment.svg "pin_moment_z"
check "angles of joints are drawn" has tank/plots/joints_angle.svg "angle, degrees"
check "power of joints is drawn" has tank/plots/joints_power.svg "power, W"
check "motions of solids are drawn" has tank/plots/jelly_solid_motion.svg "velocity, m/s"
check "forces on solids are drawn" has tank/plots/jelly_liquid_force.svg "mean force, N"
rm tank/lines.csv tank/joints.csv tank/solids.csv
mkdir plane && cat > flat.json <<'END'
{ "dimension": 2, "domain": { "min": [0, 0], "max": [1, 1] }, "spacing": 0.1, "end_time": 1,
  "fluids": [ { "name": "water", "fill": [ { "box": { "min": [0, 0], "max": [1, 0.5] } } ] } ] }
END
printf 'time,step,kinetic_energy,wall_force_x,wall_force_y,wall_force_z\n0,0,0,0,0,0\n0.1,1,1,0,-5,0\n' > plane/history.csv
printf 'time,name,position_x,position_y,position_z,velocity_x,velocity_y,velocity_z\n0,b,2,1,0,0,0,0\n0.1,b,2,3,0,0,4,0\n' \
    > plane/bodies.csv
expect 0 "has no values" plot plane --scene flat.json
check "in 2-D components of 0 are left out" test "$(grep -c '<title>gnuplot_plot' plane/plots/walls.svg)" = 1
check "motions are shifts" has plane/plots/b_motion.svg "shift since the start, m"
sed 's/"y_scale": -20}/"y_scale": -20, "label": "later"}/' tank.json > later.json
expect 0 "" plot tank --scene later.json
check "references may come later" has "tank/plots/compare_P 1_pressure.svg" "later"
check "without an offset" grep -q "^0.01 700$" tank/plots/plots.gnuplot
sed -i 's/"label": "later"/"x_offset": 0.005, "y_offset": 100/' later.json
expect 0 "" plot tank --scene later.json
check "offsets are added after the factors" grep -q "^0.015 800$" tank/plots/plots.gnuplot
expect 1 "nowhere.json" plot tank --scene nowhere.json
sed 's/measured/forgotten/' later.json > wrong.json
expect 1 "wrong.json:" plot tank --scene wrong.json
expect 0 "" plot tank --format png
check "png" cmp -n 8 tank/plots/energies.png <(printf '\211PNG\r\n\032\n')

# Tables from programs that write decimal commas, or tabs.
sed -i 's/,/;/g; s/"F; N"/"F, N"/' measured.csv
expect 0 "" plot tank
check "semicolons" test "$(points tank/plots/compare_wall_force_z.svg)" = 8
sed -i 's/;/\t/g' measured.csv
expect 0 "" plot tank
check "tabs" test "$(points tank/plots/compare_wall_force_z.svg)" = 8
sed -i 's/\t/,/g' measured.csv

# --- what may be wrong with files -------------------------------------------------------------------
sed -i 's/t \[ms\]/seconds/' measured.csv
expect 0 'has no column "t [ms]"; its columns are seconds, F, N, other' plot tank
check "drawn all the same" has tank/plots/compare_wall_force_z.svg "this run"
printf 't [ms],"F, N",other\n900,1,1\n' > measured.csv
expect 0 "no value between 0 and 0.04 s" plot tank
rm measured.csv
expect 0 "drawn without reference data" plot tank
check "only the run's own 10" test "$(wc -l < out.txt)" = 10

# Older or foreign tables: what is there is drawn.
expect 0 "no values for the picture" plot made
check "a gap for nan" grep -qx "NaN NaN" made/plots/plots.gnuplot
check "one picture" test "$(cat out.txt)" = "made/plots/energies.svg"
printf '\xef\xbb\xbf# made by hand\r\n"time" , step,"kinetic_energy"\r\n0.5,3,1e-3\r\n' > made/history.csv
cat > made/bodies.csv <<'END'
time,name,position_x,"position_y"
0.5,"../a, ""b"" `touch pwned` '; system('touch pwned'); '",1,2
END
expect 0 "no values for the picture" plot made
check "one row is enough" has made/plots/energies.svg "kinetic energy, J"
check "a name is no path" test -e "made/plots/.._a_ _b_ \`touch pwned\` _; system(_touch pwned_); __motion.svg"
check "nothing above the folder" test -z "$(find . -maxdepth 1 -name '*motion*')"
check "no name was run as a command either" test ! -e pwned -a ! -e made/plots/pwned
# The axis is that of the rows after a start that stands far out.
{ echo "time,step,kinetic_energy"; echo "0,0,0"; echo "0.1,1,900"; for k in 2 3 4 5; do echo "0.$k,$k,$k"; done; } > made/history.csv
expect 0 "no values for the picture" plot made
check "an outlier of the first rows does not set the axis" grep -qx 'set yrange \[1.82:5.18\]' made/plots/plots.gnuplot
# Of solids the sum has the elastic energy: 2 J and 3 J change into 1 J and 2 J, 1.5 J are elastic, 0.5 J are lost.
printf 'time,step,kinetic_energy,potential_energy,elastic_energy,energy_lost\n0,0,2,3,0,0\n1,1,1,2,1.5,0.5\n' > made/history.csv
expect 0 "no values for the picture" plot made
check "the sum of energies" has made/plots/energies.svg "sum of all"
check "has the elastic one" grep -qx "1 -0.5" made/plots/plots.gnuplot
check "and no picture of contact" test -z "$(find made/plots -name '*contact*')"
check "nothing is said of a liquid that is not there" test -z "$("$program" plot made 2>&1 | grep incompressible)"
printf 'time,name,mean_contact_force_x,contact_force_x,mean_contact_force_z,contact_force_z\n' > made/bodies.csv
printf '%s,box,0,0,9.8,10\n' 0 1 >> made/bodies.csv
expect 0 "no values for the picture" plot made
check "the contact with bodies and sides" has made/plots/box_contact_force.svg "Force of bodies and sides on box"
check "where there is one" has made/plots/box_contact_force.svg "z, N"
check "and not where there is none" test "$(grep -c 'x, N' made/plots/box_contact_force.svg)" = 0
echo "step,name" > made/bodies.csv
expect 1 'no column "time"' plot made
mkdir -p blocked && cp made/history.csv blocked && : > blocked/plots
expect 1 "plots" plot blocked

# A folder that a stranger has prepared: no link leads out of it.
mkdir dear linked strange && echo dear > dear/energies.svg && cp dear/energies.svg dear/plots.gnuplot
printf 'time,step,kinetic_energy\n0,0,1\n1,1,2\n' | tee strange/history.csv > linked/history.csv
ln -s ../dear strange/plots
expect 1 "a link is not followed" plot strange
mkdir linked/plots && ln -s ../../dear/energies.svg ../../dear/plots.gnuplot linked/plots
expect 0 "no values for the picture" plot linked
check "a picture in the place of a link" has linked/plots/energies.svg "kinetic energy, J"
check "nothing written through a link" test "$(cat dear/*)" = "$(printf 'dear\ndear')"

echo "$passed passed, $failed failed"
[ $failed -eq 0 ]
