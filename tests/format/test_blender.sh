#!/usr/bin/env bash
# Blender's round trip: what it exports renders like the picture that Cycles makes of it
# (without caustics on either side: paths alone do not find those of lamps without size).
#
#   test_blender.sh NEPHROID
set -u

nephroid=$1
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)

if ! command -v blender >/dev/null; then
    echo "1..0 # SKIP Blender is not installed"
    exit 0
fi
if ! blender --background --python-exit-code 1 --python-expr "import numpy" >/dev/null 2>&1; then
    echo "1..0 # SKIP Blender has no numpy, which its glTF exporter needs"
    exit 0
fi
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
echo "1..3"

# check NUMBER NAME CONDITION-OF-AWK
check() {
    if awk "BEGIN { exit !($3) }"; then
        echo "ok $1 $2"
    else
        echo "not ok $1 $2: $3"
    fi
}

if ! blender --background --python "$here/blender_scene.py" -- "$folder" \
    >"$folder/log" 2>&1 || [ ! -f "$folder/cycles.exr" ]; then
    sed 's/^/# /' "$folder/log"
    echo "Bail out! Blender failed"
    exit 1
fi
if "$nephroid" render "$folder/scene.glb" -o "$folder/ours.exr" --integrator path \
    --set passes=8 --set spp=16 --size 160x120 >"$folder/log" 2>&1; then
    echo "ok 1 what Blender exports renders"
else
    sed 's/^/# /' "$folder/log"
    echo "not ok 1 what Blender exports renders"
fi
"$nephroid" compare "$folder/ours.exr" "$folder/cycles.exr" >"$folder/log"
sed 's/^/# /' "$folder/log"
read -r ours cycles < <(sed -n 's/^mean luminance *\([0-9.]*\), reference *\([0-9.]*\)/\1 \2/p' "$folder/log")
flip=$(sed -n 's/^flip *//p' "$folder/log")
check 2 "as bright as Cycles' picture" "${ours:-0} / ${cycles:-1} > 0.97 && ${ours:-0} / ${cycles:-1} < 1.03"
check 3 "looks like Cycles' picture" "${flip:-1} < 0.06"
