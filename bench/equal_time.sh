#!/bin/sh
# Which transport is best at equal time: relMSE and FLIP after so many seconds on one thread,
# against a long render. usage: equal_time.sh NEPHROID [SECONDS [SIZE [SCENE...]]]
#
# The reference is vcm's, or that of the transport named in REFERENCE, with another seed and 15 times
# as long; auto's of that length is compared with it in the last column: figures near that one mean
# nothing more. path is the better reference where nothing focuses light. relMSE is at the mercy of
# single pixels (the lamp's image in a ball), FLIP is not. A second table gives the time of 16 passes
# over that of path.
set -e
nephroid=$1
seconds=${2:-5}
size=${3:-96x72}
root=$(dirname "$0")/..
[ $# -ge 3 ] && shift 3 || shift $#
# No scene with media: vcm refuses those.
[ $# -gt 0 ] || set -- "$root"/scenes/cornell-box/cornell-box.pbrt \
    "$root"/scenes/glass-ball/glass-ball.pbrt "$root"/scenes/ring/ring.pbrt \
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

long=$((15 * seconds))
# against_reference FILE
against_reference() {
    for metric in relmse flip; do
        "$nephroid" compare -m $metric "$work/$1.exr" "$work/reference.exr"
    done | awk '{ v[NR] = $1 } END { printf "  %8.5f %6.4f", v[1], v[2] }'
}

printf '%-26s %17s %17s %17s %17s %17s\n' "relMSE, FLIP after $seconds s" path auto vcm photonmap check
for scene; do
    [ -f "$scene" ] || continue
    shot "$work/reference.exr" "$scene" --integrator "${REFERENCE:-vcm}" --seed 77 --time "$long" >/dev/null
    shot "$work/check.exr" "$scene" --integrator auto --seed 78 --time "$long" >/dev/null
    printf '%-26s' "$(name "$scene")"
    for kind in path auto vcm photonmap; do
        shot "$work/$kind.exr" "$scene" --integrator $kind --time "$seconds" >/dev/null
        against_reference $kind
    done
    against_reference check
    printf '\n'
done

printf '\n%-26s %10s %10s %10s\n' 'time over path, 16 passes' auto vcm photonmap
for scene; do
    [ -f "$scene" ] || continue
    printf '%-26s' "$(name "$scene")"
    base=
    for kind in path auto vcm photonmap; do
        spent=$(shot "$work/$kind.exr" "$scene" --integrator $kind --passes 16 |
            awk '$1 == "time" { print $2 }')
        [ -n "$base" ] || { base=$spent && continue; }
        printf ' %10s' "$(awk "BEGIN { printf \"%.2f\", $spent / $base }")"
    done
    printf '\n'
done
