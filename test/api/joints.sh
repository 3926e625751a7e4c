#!/bin/bash
# joints between bodies: their table, the same bits after a resume and for other numbers of threads, messages.
# usage: joints.sh PROGRAM     works in a fresh folder that it removes; last line: "N passed, N failed"
set -uo pipefail
. "$(dirname "$0")/checks.sh" "$1"

# Of tables v("NAME") is the number in the row's column of that name; ends with "exit lost || ...".
by_name='function v(name) { if (!(name in at)) { lost = 1; exit 1 } return $at[name] }
         FNR == 1 { for (k = 1; k <= NF; k++) at[$k] = k; next }'
# has FILE COLUMN...: the table has all of them
has() {
    local file=$1 column
    shift
    for column; do head -1 "$file" | tr , '\n' | grep -qxF -- "$column" || return 1; done
}

cat > rafts.json <<'END2'
{ "dimension": 2, "domain": { "min": [0, 0], "max": [1, 0.6] }, "spacing": 0.025, "end_time": 0.1,
  "fluids": [ { "name": "water", "fill": [ { "box": { "min": [0, 0], "max": [1, 0.3] } } ] } ],
  "bodies": [ { "name": "left", "box": { "min": [0.2, 0.2], "max": [0.45, 0.4] }, "dynamics": "free", "density": 300 },
              { "name": "right", "box": { "min": [0.55, 0.2], "max": [0.8, 0.4] }, "dynamics": "free",
                "density": 700 },
              { "name": "mast", "box": { "min": [0.3, 0.35], "max": [0.32, 0.58] }, "dynamics": "free" } ],
  "joints": [ { "name": "hinge", "body": "left", "to_body": "right", "point": [0.5, 0.3] },
              { "name": "foot", "kind": "ball", "body": "mast", "to_body": "left", "point": [0.31, 0.36] } ],
  "output": { "interval": 0.05 } }
END2
for method in dfsph wcsph isph eisph; do
    expect 0 "" run rafts.json --out whole --quiet --force --threads 1 --set method=$method
    check "$method: a table of forces, angles and gaps" \
        has whole/joints.csv "time [s]" "hinge_force_x [N per m]" "hinge_force_y [N per m]" "hinge_moment_z [N m per m]" \
        "hinge_angle [degrees]" "hinge_gap [m]" "foot_force_x [N per m]"
    check "$method: the joints are closed" \
        awk -F, "$by_name"' v("hinge_gap [m]") > 1e-12 || v("foot_gap [m]") > 1e-12 || $0 ~ /nan/ { bad = 1 }
                 END { exit lost || bad || NR < 8 }' whole/joints.csv
    expect 0 "" run rafts.json --out parts --quiet --force --threads 2 --until 0.05 --set method=$method
    expect 0 "" resume parts --quiet --threads 2 --until 0.1
    check "$method: the same forces after a resume, with two threads" cmp whole/joints.csv parts/joints.csv
done
check "resolved.json has the joints" grep -q '"to_body": "right"' whole/resolved.json
expect 0 "" run whole/resolved.json --out again --quiet
check "and runs alike" cmp whole/joints.csv again/joints.csv

cat > jelly.json <<'END2'
{ "dimension": 2, "method": "mlsmpm", "domain": { "min": [0, 0], "max": [1, 0.4] }, "spacing": 0.02, "end_time": 0.4,
  "solids": [ { "name": "jelly", "youngs_modulus": 1e5, "density": 1000,
                "fill": [ { "box": { "min": [0, 0], "max": [1, 0.1] } } ] } ],
  "bodies": [ { "name": "left", "box": { "min": [0.2, 0.14], "max": [0.48, 0.2] }, "dynamics": "free", "density": 3000 },
              { "name": "right", "box": { "min": [0.52, 0.14], "max": [0.8, 0.2] }, "dynamics": "free",
                "density": 500 } ],
  "joints": [ { "name": "hinge", "body": "left", "to_body": "right", "point": [0.5, 0.17] } ] }
END2
expect 0 "" run jelly.json --out jelly --quiet
check "joined bodies fall on a soft solid and stay joined" \
    awk -F, "$by_name"' v("hinge_gap [m]") > 1e-12 || $0 ~ /nan/ { bad = 1 } END { exit lost || bad || NR < 99 }' \
    jelly/joints.csv

cat > both.json <<'END2'
{ "dimension": 2, "domain": { "min": [0, 0], "max": [1, 0.6] }, "spacing": 0.025, "end_time": 0.1,
  "fluids": [ { "name": "water", "fill": [ { "box": { "min": [0, 0], "max": [1, 0.3] } } ] } ],
  "solids": [ { "name": "fin", "youngs_modulus": 3e4, "density": 1100, "clamped_to": "left",
                "fill": [ { "box": { "min": [0.2, 0.1], "max": [0.275, 0.2] } } ] },
              { "name": "cargo", "youngs_modulus": 3e4, "density": 900,
                "fill": [ { "box": { "min": [0.65, 0.4], "max": [0.75, 0.475] } } ] } ],
  "bodies": [ { "name": "left", "box": { "min": [0.2, 0.2], "max": [0.45, 0.4] }, "dynamics": "free", "density": 300 },
              { "name": "right", "box": { "min": [0.55, 0.2], "max": [0.8, 0.4] }, "dynamics": "free",
                "density": 500 },
              { "name": "anchor", "box": { "min": [0.58, 0.02], "max": [0.64, 0.2] }, "dynamics": "free",
                "density": 4000 } ],
  "joints": [ { "name": "hinge", "body": "left", "to_body": "right", "point": [0.5, 0.3], "lower": -10,
                "upper": 10, "stiffness": 5, "damping": 0.2 },
              { "name": "top", "body": "anchor", "to_body": "right", "point": [0.61, 0.2] },
              { "name": "ground", "body": "anchor", "point": [0.61, 0.03] } ],
  "output": { "interval": 0.05 } }
END2
# By dfsph what falls into the water lets forces scatter, which is told.
for method in dfsph wcsph isph eisph; do
    told=$([ $method = dfsph ] && echo "scatters by")
    expect 0 "$told" run both.json --out whole --quiet --force --threads 1 --set method=$method
    check "$method: joints in water with soft solids are closed" \
        awk -F, "$by_name"' v("hinge_gap [m]") > 1e-12 || v("top_gap [m]") > 1e-12 { bad = 1 }
                 v("ground_gap [m]") > 1e-12 || $0 ~ /nan/ { bad = 1 } END { exit lost || bad || NR < 8 }' whole/joints.csv
    expect 0 "" run both.json --out parts --quiet --force --threads 2 --until 0.05 --set method=$method
    expect 0 "" resume parts --quiet --threads 2 --until 0.1
    check "$method: the same after a resume, with two threads" cmp whole/joints.csv parts/joints.csv
done

cat > motors.json <<'END2'
{ "dimension": 2, "domain": { "min": [0, 0], "max": [1, 0.6] }, "spacing": 0.025, "end_time": 0.1,
  "fluids": [ { "name": "water", "fill": [ { "box": { "min": [0, 0], "max": [1, 0.3] } } ] } ],
  "bodies": [ { "name": "flap", "box": { "min": [0.2, 0.05], "max": [0.25, 0.4] }, "dynamics": "free",
                "hinge": { "point": [0.225, 0.05], "motor": { "file": "angles.csv" } } },
              { "name": "hull", "box": { "min": [0.5, 0.2], "max": [0.75, 0.4] }, "dynamics": "free", "density": 500 },
              { "name": "fin", "box": { "min": [0.77, 0.24], "max": [0.95, 0.28] }, "dynamics": "free" } ],
  "joints": [ { "name": "tail", "body": "fin", "to_body": "hull", "point": [0.76, 0.26],
                "motor": { "speed": 0, "amplitude": 300, "period": 0.2, "torque_max": 1 } } ],
  "output": { "interval": 0.05 } }
END2
printf 'time,angle\n0,0\n0.04,2\n0.08,8\n' > angles.csv
for method in dfsph wcsph isph eisph; do
    told=$([ $method = dfsph ] && echo "scatters by")
    expect 0 "$told" run motors.json --out whole --quiet --force --threads 1 --set method=$method
    check "$method: torque and power of motors" has whole/joints.csv "tail_angle [degrees]" "tail_gap [m]" \
        "tail_motor_torque [N m per m]" "tail_power [W per m]" "tail_work [J per m]" "flap_motor_torque [N m per m]" "flap_power [W per m]" \
        "flap_work [J per m]"
    check "$method: an angle by a file is kept, a torque is at its bound" \
        awk -F, "$by_name"' v("time [s]") > 0.08 && (v("flap_angle [degrees]") - 8)^2 > 1e-16 { bad = 1 }
                 v("tail_motor_torque [N m per m]")^2 > 1.000001 { bad = 1 }
                 v("tail_motor_torque [N m per m]")^2 > 0.999999 { bound = 1 } END { exit lost || bad || !bound }' \
        whole/joints.csv
    expect 0 "" run motors.json --out parts --quiet --force --threads 2 --until 0.05 --set method=$method
    expect 0 "" resume parts --quiet --threads 2 --until 0.1
    for table in joints bodies history; do
        check "$method: $table is the same after a resume, with two threads" cmp whole/$table.csv parts/$table.csv
    done
    check "$method: joint_work is the sum of the works of joints" \
        awk -F, "$by_name"' FILENAME ~ /joints/ { works = v("tail_work [J per m]") + v("flap_work [J per m]"); next }
                 { sum = v("joint_work") } END { exit lost || !(works != 0 && (works - sum)^2 < 1e-12*sum^2) }' \
        whole/joints.csv whole/history.csv
done
cat > light.json <<'END2'
{ "dimension": 2, "domain": { "min": [0, 0], "max": [1, 0.6] }, "spacing": 0.025, "end_time": 0.1,
  "fluids": [ { "name": "water", "fill": [ { "box": { "min": [0, 0], "max": [1, 0.4] } } ] } ],
  "bodies": [ { "name": "flap", "box": { "min": [0.48, 0.05], "max": [0.54, 0.35] }, "dynamics": "free", "density": 100,
                "hinge": { "point": [0.51, 0.05], "motor": { "speed": 40, "torque_max": 60 } } } ] }
END2
# The water around it is many times heavier: it turns at its speed all the same, and is not thrown about.
for method in dfsph isph wcsph eisph; do
    "$program" run light.json --out light --quiet --force --set method=$method > out.txt 2>&1
    check "$method: a motor at its bound sets a light flap in motion in water" \
        awk -F, "$by_name"' { turn = v("flap_angle [degrees]"); t = v("time [s]") }
                 turn < -0.01 || turn > 40*t + 0.1 { bad = 1 } END { exit lost || bad || turn < 30*t }' light/joints.csv
done
# The same along a guide, with less force than the added mass asks for: the speed is reached late, and kept.
cat > push.json <<'END2'
{ "dimension": 2, "domain": { "min": [0, 0], "max": [1, 0.6] }, "spacing": 0.025, "end_time": 0.1,
  "fluids": [ { "name": "water", "fill": [ { "box": { "min": [0, 0], "max": [1, 0.4] } } ] } ],
  "bodies": [ { "name": "plate", "box": { "min": [0.48, 0.05], "max": [0.54, 0.35] }, "dynamics": "free",
                "density": 100, "guide": { "axis": [1, 0], "motor": { "speed": 0.2, "force_max": 300 } } } ],
  "output": { "interval": 0.01 } }
END2
for method in dfsph isph wcsph eisph; do
    "$program" run push.json --out push --quiet --force --set method=$method > out.txt 2>&1
    check "$method: a motor at its bound pushes a light plate through water and does not throw it" \
        awk -F, "$by_name"' { u = v("velocity_x") } u < 0 || u > 0.2001 { bad = 1 }
                 END { exit lost || bad || u < 0.19 }' push/bodies.csv
done
cat > slides.json <<'END2'
{ "dimension": 2, "domain": { "min": [0, 0], "max": [1, 0.6] }, "spacing": 0.025, "end_time": 0.1,
  "fluids": [ { "name": "water", "fill": [ { "box": { "min": [0, 0], "max": [1, 0.3] } } ] } ],
  "bodies": [ { "name": "piston", "box": { "min": [0.1, 0.02], "max": [0.15, 0.5] }, "dynamics": "free",
                "guide": { "axis": [1, 0], "motor": { "file": "ways.csv" } } },
              { "name": "buoy", "box": { "min": [0.5, 0.2], "max": [0.75, 0.4] }, "dynamics": "free", "density": 500,
                "guide": { "axis": [0, 1], "damping": 5,
                           "motor": { "speed": 0, "amplitude": 0.5, "period": 0.2, "force_max": 100 } } } ],
  "output": { "interval": 0.05 } }
END2
printf 'time,position\n0,0\n0.04,0.002\n0.08,0.008\n' > ways.csv
for method in dfsph wcsph isph eisph; do
    told=$([ $method = dfsph ] && echo "scatters by")
    expect 0 "$told" run slides.json --out slides --quiet --force --threads 1 --set method=$method
    check "$method: force and power of guides" has slides/joints.csv "piston_motor_force [N per m]" "piston_power [W per m]" \
        "piston_work [J per m]" "buoy_force_x [N per m]" "buoy_motor_force [N per m]" "buoy_power [W per m]" "buoy_work [J per m]"
    check "$method: a force is at its bound" \
        awk -F, "$by_name"' { f = v("buoy_motor_force [N per m]") } f^2 > 10000.01 { bad = 1 } f^2 > 9999.99 { bound = 1 }
                 END { exit lost || bad || !bound }' slides/joints.csv
    check "$method: a position by a file is kept" \
        awk -F, "$by_name"' v("name") == "piston" && v("time") > 0.09 { x = v("position_x") }
                 END { exit lost || (x - 0.133)^2 > 1e-16 }' slides/bodies.csv
    expect 0 "" run slides.json --out parts --quiet --force --threads 2 --until 0.05 --set method=$method
    expect 0 "" resume parts --quiet --threads 2 --until 0.1
    check "$method: guides are the same after a resume, with two threads" cmp slides/joints.csv parts/joints.csv
done
check "resolved.json has the motor of a guide" grep -q '"force_max": 100' slides/resolved.json
expect 0 "" run slides/resolved.json --out again --quiet --force
check "and runs alike" cmp slides/joints.csv again/joints.csv
# Held 0.05 m below where it floats: 1000 9.81 0.25 0.05 N.
expect 0 "" run slides.json --out held --quiet --force --set method=isph --set bodies.buoy.translation='[0,-0.05]' \
    --set bodies.buoy.guide.motor='{"speed":0}' --set bodies.piston.guide.motor='{"speed":0}' --set end_time=0.5
check "a brake holds a buoy against its buoyancy" \
    awk -F, "$by_name"' v("time [s]") > 0.2 { sum += v("buoy_motor_force [N per m]"); n++ }
             END { exit lost || !(n > 5 && (sum/n + 122.6)^2 < 16) }' held/joints.csv
# A piston makes the same wave by a motor as by a motion.
cat > wave.json <<'END2'
{ "dimension": 2, "method": "isph", "domain": { "min": [0, 0], "max": [2, 0.6] }, "spacing": 0.025, "end_time": 1.5,
  "fluids": [ { "name": "water", "fill": [ { "box": { "min": [0.2, 0], "max": [2, 0.3] } } ] } ],
  "bodies": [ { "name": "piston", "box": { "min": [0.15, 0], "max": [0.2, 0.55] }, "sealed": true, "dynamics": "free",
                "guide": { "axis": [1, 0], "motor": { "position": 0, "amplitude": 0.04, "period": 1.2, "ramp": 1.2 } } } ],
  "probes": [ { "name": "gauge", "kind": "level", "position": [0.6, 0.3] } ] }
END2
sed 's/"dynamics": "free",/"motion": { "surge": { "amplitude": 0.04, "period": 1.2, "ramp": 1.2 } } } ],/; /"guide"/d' wave.json > same.json
expect 0 "" run wave.json --out wave --quiet
expect 0 "" run same.json --out same --quiet
check "a piston with a motor makes the wave of one with a motion" \
    awk -F, "$by_name"' FILENAME ~ /wave/ { wave = v("gauge_level [m]"); next } { same = v("gauge_level [m]") }
             END { exit lost || !((wave - 0.3)^2 > 1e-4 && (wave - same)^2 < 1e-9) }' wave/probes.csv same/probes.csv
cat > towed.json <<'END2'
{ "dimension": 2, "domain": { "min": [0, 0], "max": [1, 0.6] }, "spacing": 0.025, "end_time": 0.1,
  "fluids": [ { "name": "water", "fill": [ { "box": { "min": [0, 0], "max": [1, 0.4] } } ] } ],
  "bodies": [ { "name": "hull", "box": { "min": [0.3, 0.2], "max": [0.5, 0.3] },
                "motion": [ { "translation": { "velocity": [0.3, 0], "ramp": 0.05 } },
                            { "yaw": { "amplitude": 10, "period": 0.4, "centre": [0.4, 0.25] } } ] },
              { "name": "fin", "box": { "min": [0.52, 0.23], "max": [0.7, 0.27] }, "dynamics": "free" } ],
  "joints": [ { "name": "tail", "body": "fin", "to_body": "hull", "point": [0.51, 0.25],
                "motor": { "angle": 0, "amplitude": 12, "period": 0.4 } } ],
  "output": { "interval": 0.05 } }
END2
for method in dfsph wcsph isph eisph; do
    told=$([ $method = dfsph ] && echo "scatters by")
    expect 0 "$told" run towed.json --out towed --quiet --force --threads 1 --set method=$method
    check "$method: a motor on a hull with a motion keeps its angle" \
        awk -F, "$by_name"' { due = 12*sin(5*3.14159265358979*v("time [s]")) }
                 (v("tail_angle [degrees]") - due)^2 > 1e-13 { bad = 1 } END { exit lost || bad || NR < 8 }' \
        towed/joints.csv
    expect 0 "" run towed.json --out parts --quiet --force --threads 2 --until 0.05 --set method=$method
    expect 0 "" resume parts --quiet --threads 2 --until 0.1
    check "$method: and is the same after a resume, with two threads" cmp towed/joints.csv parts/joints.csv
done
told() { expect 0 "" check "$1" "${@:3}"; check "check tells: $2" grep -q "$2" out.txt; }
told motors.json "joint 'tail': its motor asks for 12 degrees/s at 0 s: the body has that in one step, by as large a torque" \
    --set joints.tail.motor='{"speed":12}'
told motors.json "'tail': its motor asks for 12 degrees/s at 0.02 s" --set joints.tail.motor='{"speed":12,"start":0.02}'
told motors.json "'tail': its motor asks for 5 degrees at 0.02 s: the body goes that in one step" \
    --set joints.tail.motor='{"angle":5,"start":0.02}'
told motors.json "'tail': its motor asks for 314.2 degrees/s at 0 s: the body has that in one step" \
    --set joints.tail.motor='{"angle":0,"amplitude":10,"period":0.2}'
printf 'time,speed\n0,0.5\n0.04,2\n' > speeds.csv
told slides.json "as large a force as it takes; a file that begins where the body is, or a force_max, lets it get there in time" \
    --set bodies.piston.guide.motor.file=speeds.csv
for motor in '{"speed":12,"ramp":0.1}' '{"speed":12,"torque_max":3}' '{"speed":0}' '{"torque":3}' '{"speed":12,"start":0.02,"ramp":0.1}' \
    '{"angle":0,"amplitude":10,"period":0.2,"ramp":0.1}' '{"angle":10,"ramp":0.001}' '{"angle":-10,"amplitude":10,"period":0.2,"phase":90}'; do
    "$program" check motors.json --set joints.tail.motor="$motor" > out.txt 2>&1
    check "check does not tell of $motor" eval '! grep -q "its motor" out.txt'
done
cat > swells.json <<'END2'
{ "dimension": 2, "method": "isph", "domain": { "min": [0, 0], "max": [1, 0.6] }, "spacing": 0.05, "end_time": 1,
  "gravity": [0, 0], "fluids": [ { "name": "water", "fill": [ { "box": { "min": [0, 0], "max": [1, 0.3] } } ] } ],
  "bodies": [ { "name": "bar", "box": { "min": [0.3, 0.4], "max": [0.7, 0.5] }, "density": 1000, "dynamics": "free",
                "motion": { "script": "swells.lua" } } ] }
END2
echo 'function deform(x, y, z, t) return x*(1 + t), y, z end' > swells.lua
expect 0 "" check swells.json
check "check tells bodies as they start" grep -q "^body  *bar: 40 kg/m, .*, inertia 0.5667 kg m2/m" out.txt
check "and a swimmer that sets off at speed" grep -q "body 'bar': sets off at 0.2 m/s" out.txt
expect 1 "Body 'flap' moves at 19.1 m/s: let its motion, motor or force begin at 0" check motors.json \
    --set method=isph --set gravity='[0,0]' --set bodies.flap.hinge.motor='{"angle":0,"amplitude":60,"period":0.01}'
check "resolved.json has the motors" grep -q '"amplitude": 300' whole/resolved.json

"$program" check rafts.json --set joints.hinge.stiffness=1e9 > out.txt 2>&1
check "check tells the steps of a stiff spring" grep -q "^time step  *about [0-9.]*e-0[5-9] s" out.txt

refuse() { expect 1 "$1" check rafts.json --set "$2"; }
refuse '"ship" is no body of the scene' joints.hinge.body=ship
refuse '"pier" is no body of the scene' joints.hinge.to_body=pier
refuse 'is the body at the other side too' joints.hinge.to_body=left
refuse '"left" is prescribed; a joint holds a free or controlled body' bodies.left.dynamics=prescribed
refuse '"foot" is already the name of joints[0]' joints.hinge.name=foot
refuse 'axis: must be along z in a 2-D scene' joints.hinge.axis='[1,0,0]'
refuse 'axis: is of a hinge or slide, a ball joint has none' joints.foot.axis='[0,0,1]'
expect 0 "" describe joints
check "describe names the columns" grep -q "^  gap " out.txt
check "and the table" grep -q "The columns of joints.csv for each joint" out.txt

echo "$passed passed, $failed failed"
[ $failed -eq 0 ]
