#!/bin/bash
# slides between bodies in water, by every method: closed, motors and stops, the same bits after a resume and for
# other numbers of threads, as a guide where there is one, with solids, energies.
# usage: slides.sh PROGRAM     works in a fresh folder that it removes; last line: "N passed, N failed"
set -uo pipefail
. "$(dirname "$0")/checks.sh" "$1"

# Of tables v("NAME") is the number in the row's column of that name; ends with "exit lost || ...".
by_name='function v(name) { if (!(name in at)) { lost = 1; exit 1 } return $at[name] }
         FNR == 1 { for (k = 1; k <= NF; k++) at[$k] = k; next }'
has() {
    local file=$1 column
    shift
    for column; do head -1 "$file" | tr , '\n' | grep -qxF -- "$column" || return 1; done
}

cat > wec.json <<'END2'
{ "dimension": 2, "domain": { "min": [0, 0], "max": [1.2, 0.6] }, "spacing": 0.025, "end_time": 0.1,
  "fluids": [ { "name": "water", "fill": [ { "box": { "min": [0, 0], "max": [1.2, 0.3] } } ] } ],
  "bodies": [ { "name": "float", "box": { "min": [0.2, 0.2], "max": [0.5, 0.4] }, "dynamics": "free", "density": 300 },
              { "name": "spar", "box": { "min": [0.325, 0.1], "max": [0.375, 0.5] }, "dynamics": "free", "density": 1500 },
              { "name": "flap", "box": { "min": [0.5, 0.275], "max": [0.65, 0.325] }, "dynamics": "free" },
              { "name": "carriage", "box": { "min": [0.8, 0.5], "max": [0.9, 0.55] },
                "motion": [ { "translation": { "velocity": [0.3, 0], "ramp": 0.05 } },
                            { "yaw": { "amplitude": 10, "period": 0.4, "centre": [0.85, 0.52] } } ] },
              { "name": "ram", "box": { "min": [0.825, 0.15], "max": [0.875, 0.45] }, "dynamics": "free" } ],
  "joints": [ { "name": "pto", "kind": "slide", "body": "float", "to_body": "spar", "point": [0.35, 0.3], "axis": [0, 1],
                "lower": -0.002, "upper": 0.1, "stiffness": 20, "damping": 50 },
              { "name": "pin", "body": "flap", "to_body": "float", "point": [0.5, 0.3] },
              { "name": "lift", "kind": "slide", "body": "ram", "to_body": "carriage", "point": [0.85, 0.4],
                "axis": [0, 2], "motor": { "position": 0, "amplitude": 0.02, "period": 0.4 } } ],
  "output": { "interval": 0.05 } }
END2
for method in dfsph wcsph isph eisph; do
    "$program" run wec.json --out whole --quiet --force --threads 1 --set method=$method > out.txt 2>&1
    check "$method: a slide has position, force, power and work" has whole/joints.csv "pto_position [m]" "pto_gap [m]" \
        "pto_power [W per m]" "pto_work [J per m]" "pto_force_x [N per m]" "pto_moment_z [N m per m]" \
        "lift_motor_force [N per m]" "pin_angle [degrees]"
    check "$method: and no angle" eval '! has whole/joints.csv "pto_angle [degrees]"'
    check "$method: slides are closed, within stops, and a motor on a carriage keeps its place" \
        awk -F, "$by_name"' v("pto_gap [m]") > 1e-12 || v("pin_gap [m]") > 1e-12 || v("lift_gap [m]") > 1e-12 { bad = 1 }
                 v("pto_position [m]") < -0.002 - 1e-9 || $0 ~ /nan/ { bad = 1 }
                 { due = 0.02*sin(5*3.14159265358979*v("time [s]")) }
                 (v("lift_position [m]") - due)^2 > 1e-19 { bad = 1 } END { exit lost || bad || NR < 8 }' whole/joints.csv
    "$program" run wec.json --out parts --quiet --force --threads 2 --until 0.05 --set method=$method > out.txt 2>&1
    expect 0 "" resume parts --quiet --threads 2 --until 0.1
    for table in joints bodies history; do
        check "$method: $table is the same after a resume, with two threads" cmp whole/$table.csv parts/$table.csv
    done
done
check "resolved.json has the kind, and a motor with keys of a slide alone" eval \
    'grep -q "\"kind\": \"slide\"" whole/resolved.json && ! grep -q "\"torque_max" whole/resolved.json'
expect 0 "" run whole/resolved.json --out again --quiet --threads 1
check "and runs alike" cmp whole/joints.csv again/joints.csv

# A light buoy on a slide to the domain goes as one on a guide: the pressure of the water knows both.
cat > guide.json <<'END2'
{ "dimension": 2, "domain": { "min": [0, 0], "max": [1, 0.6] }, "spacing": 0.025, "end_time": 0.2,
  "fluids": [ { "name": "water", "fill": [ { "box": { "min": [0, 0], "max": [1, 0.4] } } ] } ],
  "bodies": [ { "name": "buoy", "box": { "min": [0.4, 0.2], "max": [0.65, 0.4] }, "dynamics": "free", "density": 100,
                "guide": { "axis": [0.6, 0.8] } } ],
  "output": { "interval": 0.05 } }
END2
rail='"joints": [ { "name": "rail", "kind": "slide", "body": "buoy", "point": [0.4, 0.3], "axis": [0.6, 0.8] } ],'
sed "s/\"guide\": {[^}]*}/\"restitution\": 0/; s/\"output\"/$rail \"output\"/" \
    guide.json > slide.json
for method in dfsph wcsph isph eisph; do
    for way in guide slide; do
        "$program" run $way.json --out $way --quiet --force --set method=$method > out.txt 2>&1
    done
    check "$method: a slide to the domain is a guide" \
        awk -F, "$by_name"' FILENAME ~ /guide/ { guide = v("buoy_position [m]"); next } { slide = v("rail_position [m]") }
                 END { exit lost || !(guide > 0.02 && (slide/guide - 1)^2 < 1e-4) }' guide/joints.csv slide/joints.csv
done

# A stiff spring does not shake bodies in water: its force is known to the pressure. The float is lifted by 31 N.
cat > stiff.json <<'END2'
{ "dimension": 2, "domain": { "min": [0, 0], "max": [1.2, 0.6] }, "spacing": 0.025, "end_time": 0.4,
  "fluids": [ { "name": "water", "fill": [ { "box": { "min": [0, 0], "max": [1.2, 0.3] } } ] } ],
  "bodies": [ { "name": "float", "box": { "min": [0.45, 0.2], "max": [0.75, 0.4] }, "dynamics": "free", "density": 500 },
              { "name": "spar", "box": { "min": [0.575, 0.05], "max": [0.625, 0.55] }, "dynamics": "free", "density": 700 } ],
  "joints": [ { "name": "pto", "kind": "slide", "body": "float", "to_body": "spar", "point": [0.6, 0.3], "axis": [0, 1],
                "stiffness": 1e6 } ] }
END2
for method in dfsph wcsph isph eisph; do
    "$program" run stiff.json --out stiff --quiet --force --set method=$method > out.txt 2>&1
    check "$method: a stiff spring holds a float at rest"         awk -F, "$by_name"' v("pto_position [m]")^2 > 1e-6 { bad = 1 }
                 END { exit lost || bad || NR < 100 }' stiff/joints.csv
done
# Likewise one about the axis of a hinge.
sed 's/"pto", "kind": "slide"/"pto"/; s/, "axis": \[0, 1\]//' stiff.json > elbow.json
for method in dfsph isph; do
    "$program" run elbow.json --out elbow --quiet --force --set joints.pto.stiffness=1e5 --set method=$method > out.txt 2>&1
    check "$method: so does one about a hinge"         awk -F, "$by_name"' v("pto_angle [degrees]")^2 > 0.01 { bad = 1 }
                 END { exit lost || bad || NR < 100 }' elbow/joints.csv
done

# What a damper takes in water is the integral of c v^2 over the motion, of a slide and of a hinge.
sed 's/"density": 500/"density": 300/; s/"stiffness": 1e6/"damping": 300/' stiff.json > damp.json
sed 's/"density": 500/"density": 300, "translation": [0.15, 0]/; s/"stiffness": 1e6/"damping": 20/' elbow.json > bend.json
for method in dfsph wcsph isph eisph; do
    for scene in damp bend; do
        "$program" run $scene.json --out damped --quiet --force --set method=$method > out.txt 2>&1
        check "$method, $scene: the work of a damper is that of the motion" \
            awk -F, "$by_name"' { t = v("time [s]"); w = v("pto_work [J per m]"); dt = t - before; before = t
                     if ("pto_angle [degrees]" in at) { x = v("pto_angle [degrees]")*3.14159265/180; c = 20 }
                     else { x = v("pto_position [m]"); c = 300 }
                     if (dt < t) sum += c*(x - last)^2/dt; last = x }
                     END { exit lost || !(sum > 0.1 && (w/sum - 1)^2 < 4e-4) }' damped/joints.csv
    done
done

# Soft solids press a body on a slide.
cat > soft.json <<'END2'
{ "dimension": 2, "method": "mlsmpm", "domain": { "min": [0, 0], "max": [1, 0.6] }, "spacing": 0.02, "end_time": 0.8,
  "solids": [ { "name": "jelly", "youngs_modulus": 1e5, "density": 1000,
                "fill": [ { "box": { "min": [0.3, 0.3], "max": [0.6, 0.4] } } ] } ],
  "bodies": [ { "name": "table", "box": { "min": [0.25, 0.2], "max": [0.65, 0.28] }, "dynamics": "free", "mass": 30 } ],
  "joints": [ { "name": "leg", "kind": "slide", "body": "table", "point": [0.25, 0.2], "axis": [0, 1],
                "stiffness": 11772, "damping": 700 } ] }
END2
expect 0 "" run soft.json --out soft --quiet
check "a table on a spring bears a block of jelly: (30 + 30) g/k" \
    awk -F, "$by_name"' { z = v("leg_position [m]"); gap = v("leg_gap [m]") }
             END { exit lost || !((z + 0.05)^2 < 9e-6 && gap < 1e-12) }' soft/joints.csv

refuse() { expect 1 "$1" check wec.json --set "$2"; }
refuse 'must have an axis, along which the body slides' joints.pto.axis='[0,0,0]'
refuse 'axis: is 1 in z, must be 0 in a 2-D scene' joints.pto.axis='[0,0,1]'
refuse 'lower: is 0.2, allowed is -179 to 0' joints.pto.lower=0.2
refuse 'to_body: is the body at the other side too' joints.pto.to_body=float
refuse 'motor.angle: is of a hinge, a slide has position' joints.lift.motor='{"angle":0}'
expect 0 "" check wec.json --set joints.lift.motor='{"speed":0.3}'
check "a motor that asks for a jump is told" \
    grep -q "its motor asks for 0.3 m/s at 0 s: the body has that in one step, by as large a force as it takes" out.txt

echo "$passed passed, $failed failed"
[ $failed -eq 0 ]
