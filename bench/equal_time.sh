#!/bin/sh
# Which transport is best at equal time: relMSE after so many seconds on one thread, against a
# long render. usage: equal_time.sh NEPHROID [SECONDS [SIZE [SCENE...]]]
#
# The reference is the mean of no candidate: it is vcm's, with another seed and 30 times as long,
# and is checked with auto's of the same length, whose distance to it is the last column: figures
# near that one mean nothing more. A second table gives the time of a pass over one of path.
set -e
nephroid=$1
seconds=${2:-5}
size=${3:-96x72}
root=$(dirname "$0")/..
[ $# -ge 3 ] && shift 3 || shift $#
[ $# -gt 0 ] || set -- "$root"/scenes/*/*.pbrt \
    "$root"/../shared/refs/bitterli/cornell-box/scene-v4.pbrt \
    "$root"/../shared/refs/bitterli/veach-mis/scene-v4.pbrt \
    "$root"/../shared/refs/bitterli/coffee/scene-v4.pbrt \
    "$root"/../shared/refs/spectral/cornell-glass.pbrt
work=$(mktemp -d) || exit 99
trap 'rm -rf "$work"' EXIT

# shot OUTPUT SCENE OPTION...
shot() {
    output=$1 scene=$2
    shift 2
    "$nephroid" render "$scene" --size "$size" --threads 1 -o "$output" "$@" 2>/dev/null
}

name() {
    echo "$(basename "$(dirname "$1")")/$(basename "$1" .pbrt)"
}

long=$((30 * seconds))
printf '%-28s %10s %10s %10s %10s %10s\n' "relMSE after $seconds s" path auto vcm photonmap reference
for scene; do
    [ -f "$scene" ] || continue
    shot "$work/reference.exr" "$scene" --integrator vcm --seed 77 --time "$long" >/dev/null
    shot "$work/check.exr" "$scene" --integrator auto --seed 78 --time "$long" >/dev/null
    printf '%-28s' "$(name "$scene")"
    for kind in path auto vcm photonmap; do
        shot "$work/$kind.exr" "$scene" --integrator $kind --time "$seconds" >/dev/null
        printf ' %10s' "$("$nephroid" compare -m relmse "$work/$kind.exr" "$work/reference.exr")"
    done
    printf ' %10s\n' "$("$nephroid" compare -m relmse "$work/check.exr" "$work/reference.exr")"
done

printf '\n%-28s %10s %10s %10s\n' 'time over path, 16 passes' auto vcm photonmap
for scene; do
    [ -f "$scene" ] || continue
    printf '%-28s' "$(name "$scene")"
    base=
    for kind in path auto vcm photonmap; do
        spent=$(shot "$work/$kind.exr" "$scene" --integrator $kind --passes 16 |
            awk '$1 == "time" { print $2 }')
        [ -n "$base" ] || { base=$spent && continue; }
        printf ' %10s' "$(awk "BEGIN { printf \"%.2f\", $spent / $base }")"
    done
    printf '\n'
done
