#!/usr/bin/env bash
# Every scene can be read, has its README, and includes the geometry that the script makes. One pixel
# of each is rendered, by paths, for which nothing is tried before: that takes a tenth of what `info` does.
# usage: test_scenes.sh ROOT PROGRAM; speaks TAP.
root=$1
program=$2
number=0

# report NAME STATUS
report() {
    number=$((number + 1))
    if [ "$2" = 0 ]; then
        echo "ok $number /scenes/$1"
    else
        echo "not ok $number /scenes/$1"
    fi
}

work=$(mktemp -d) || exit 99
trap 'rm -rf "$work"' EXIT

# Those whose model is fetched are read where it is.
can_be_read() {
    local folder=${1%/*}
    case $1 in
    */breakfast/venice-*) [ -f "$folder/venice.exr" ] || return 0 ;;
    */dragons/*) [ -f "$folder/dragon.ply" ] || return 0 ;;
    */sponza/*) [ -f "$folder/walls.ply" ] || return 0 ;;
    esac
    "$program" render "$1" -q --size 1x1 --integrator path --spp 1 --passes 1 -o "$work/pixel.pfm"
}

mapfile -t scenes < <(grep -l '^WorldBegin' "$root"/scenes/*/*.pbrt)
echo "1..$((${#scenes[@]} + 3))"
for scene in "${scenes[@]}"; do
    can_be_read "$scene"
    report "$(basename "$scene" .pbrt)" $?
done

status=0
for folder in "$root"/scenes/*/; do
    [ -f "$folder/README.md" ] || { echo "# no README.md in $folder"; status=1; }
done
report readmes $status

PYTHONDONTWRITEBYTECODE=1 python3 "$root/tools/scene_geometry.py" --check | sed 's/^/# /'
report geometry "${PIPESTATUS[0]}"

echo 'WorldBegin Shape "sphere" "float radius" -1' >"$work/fault.pbrt"
! can_be_read "$work/fault.pbrt" 2>/dev/null
report planted-fault $?
