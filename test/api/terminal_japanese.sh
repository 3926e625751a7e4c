#!/bin/bash
# What the program says on a terminal to a Japanese user: mistakes, check, scenes, new, sample, inspect.
# usage: terminal_japanese.sh PROGRAM      works in a fresh folder that it removes
set -uo pipefail
here=$(cd "$(dirname "$0")" && pwd)
. "$here/checks.sh" "$1"
# No locale need be there: the program reads its name only.
printf '#!/bin/sh\nLC_ALL=ja_JP.UTF-8 exec "%s" "$@"\n' "$program" > japanese
chmod +x japanese
program=$PWD/japanese

# says TEXT: the last command said it on its standard output
says() { check "says '$1'" grep -qF -- "$1" out.txt; }

cat > tank.json <<'END'
{ "dimension": 2, "domain": { "min": [0, 0], "max": [0.4, 0.3] }, "spacing": 0.02, "end_time": 0.1,
  "fluids": [ { "name": "water", "density": 1, "fill": [ { "box": { "min": [0, 0], "max": [0.4, 0.2] } } ] } ],
  "bodies": [ { "name": "wood", "box": { "min": [0.1, 0.2], "max": [0.2, 0.28] }, "density": 0.5,
                "dynamics": "free" } ],
  "output": { "interval": 0.05 } }
END
expect 0 "" check tank.json
says "シーン           tank（dfsph、2次元）"
says "計算領域         0 0 ～ 0.4 0.3 m"
says "粒子間隔         0.02 m"
says "物体             wood: "
says "注意             流体 'water': 密度が1 kg/m3で、気体の密度である。水は1000 kg/m3である"
says "、液体に対する密度比0.5、重心0.15 0.24 m、慣性モーメント"
says "；浮かぶ。喫水0.04 m、GM "
says "流体の粒子       200"
says "出力             3回、0.05 sごと：約"
says "計算時間         "
words=$(sed 's/tank\|water\|wood\|dfsph\|[kMG]B\|kg\|GM//g' out.txt | grep -oE '[A-Za-z]{3,}' | sort -u | tr '\n' ' ')
check "no English in the lines of check: $words" test -z "$words"

sed 's/"end_time": 0.1/"end_time": -1/' tank.json > wrong.json
expect 1 "wrong.json:1:96: end_time: -1である。許容範囲は0～1e9 s" check wrong.json --set 'fluids[0].density=-1'
grep -qF "誤りが2個ある" err.txt || bad "the number of mistakes"
expect 1 "tobiuo: --set fluids[0].density=-1：fluids[0].density：-1である。許容範囲は1e-6～1e9 kg/m3" check tank.json \
    --set 'fluids[0].density=-1'
expect 1 "シーン nowhere.json: ファイルまたはフォルダがない" check nowhere.json
expect 2 "コマンド'rnu'はない。もしかしてrun" rnu
expect 2 "--threads：'x'は0（すべてのコア）～4096の数でない" run tank.json --threads x

expect 0 "" scenes
says "  dam_break         水槽の中で水柱が崩れ、向かいの壁に当たる。"
check "each scene has its Japanese" test "$(grep '^  [a-z]' out.txt | grep -v ' tobiuo' | grep -cv '。')" = 0
expect 0 "" new
says "      --spacing        粒子間隔 (0.0125 m)"
expect 0 "" new dam_break my_dam --spacing 0.02
says "my_dam/scene.jsonにdam_breakのシーンを書いた。計算するには：tobiuo run my_dam"
expect 0 "" new dam_break my_other --spacing 0.02 --language ja
says "my_other/scene.jsonにdam_breakのシーンを書いた"
expect 0 "" new --language=en
says "Families of scenes"
expect 2 "'fr'はjaでもenでもない" new dam_break --language fr
check "its comments are Japanese" test "$(grep '//' my_dam/scene.json | grep -cE '壁|単位')" -ge 2
expect 1 "水が水槽（--height）より高い" new dam_break high --water-height 3

old=${TOBIUO_SOURCE:-$here/../..}/test/scenes/taichi
for scene in rigid_blocks.json falling_box.json blocks_y_up.json fish.json parameters.py; do
    expect 0 "" import "$old/$scene" --out old.json --force
    check "each remark on $scene has its Japanese" test -z "$(grep '^    ' out.txt | LC_ALL=C grep -v $'[\343-\351]')"
    check "no English in the table of $scene" test -z "$(grep -E 'nothing$|not given' out.txt)"
    check "the comments of $scene are Japanese" grep -q "から変換した。キーの変換先：" old.json
done
says "ファイルではなくプログラムにあった値：ヤング率1e6 Pa"
expect 0 "" check "$old/rigid_blocks.json"
says "Taichi版のシーン。キーの変換先："
expect 0 "" check old.json

expect 0 "" describe
check "each topic has its Japanese" test "$(grep -c '^  [a-z]' out.txt)" = \
    "$(grep '^  [a-z]' out.txt | grep -cE 'の|る|用|列')"
expect 0 "" describe fill
says "      満たす箱の下の角。箱には両方の角が必要"
says "ベクトル、単位m、許容範囲-1e7～1e7 m、既定値[0, 0, 0]"
expect 0 "" describe mean_pressure_force_x
says "mean_pressure_force_x：bodies.csvの列、単位N"
expect 1 "'camra'という名前はない。もしかしてcamera？" describe camra
"$program" describe scene > japanese.md
check "the page of scenes stays English" grep -q "^# Scenes" japanese.md

expect 1 "tobiuo: 出力500001回で約" run tank.json --out out --set output.interval=2e-7
expect 0 "tobiuo: 注意：流体 'water': 密度が1 kg/m3" run tank.json --out out
says "計算終了：t = 0.1 s"
expect 1 "out：計算結果がある。何も変えていない" run tank.json --out out
expect 0 "" sample out --line "0.2,0 to 0.2,0.2"
says "補間：out/sample/"
says "画像：out/plots/sample_line.svg"
check "axes of profiles are Japanese" grep -q "圧力 (Pa)" out/plots/sample_line.svg
check "no English at the axes of profiles" test -z "$(grep -E 'velocity|pressure' out/plots/sample_line.svg)"
expect 0 "注意：outの計算結果は0.1 sで終わる" picture out --time 9
says "画像：out/picture.png、"
expect 1 "outにフィールド'heat'はない。" sample out --line "0.2,0 to 0.2,0.2" --fields heat
expect 0 "" inspect tank.json --at 0.2,0.1 --out inspect
says "カーネル         "
check "labels of the kernels are Japanese" grep -q "カーネル、影響半径" inspect/kernels.svg
check "and their units stand as elsewhere" test "$(grep -cE '>(W \(1/m2\)|dW/dr \(1/m3\)|r \(m\))<' inspect/kernels.svg)" = 3
expect 1 "out: センサーがない（probes.csvがない）" waves out
expect 0 "tobiuo: note: fluid 'water': its density is 1 kg/m3" run tank.json --out out --force --language en

echo "$passed passed, $failed failed"
[ "$failed" = 0 ]
