#!/bin/bash
# Long renders: whether memory stays as it is after the first minute, and the picture goes on
# getting better. Each of auto, sppm and vcm on each scene renders for so many minutes; every
# quarter of it the picture is compared with a reference, rendered by vcm with another seed for
# as long, at a small size.
# usage: soak.sh NEPHROID MINUTES [SCENE...]; exits with 1 if memory is more than 1 % larger in the
# second half of what follows the first minute than in the first half (nine tenths of the time:
# each pass takes some and gives it back), or the error did not fall.
set -u
program=$(realpath "$1")
minutes=$2
shift 2
root=$(cd "$(dirname "$0")/.." && pwd)
[ $# -gt 0 ] || set -- "$root/scenes/ring/ring.pbrt" "$root/scenes/glass-ball/glass-ball.pbrt"
seconds=$(awk -v m="$minutes" 'BEGIN { print int(60 * m) }')
work=$(mktemp -d) || exit 99
trap 'rm -rf "$work"' EXIT
bad=0

resident() { # KiB of a process
    awk '/^VmRSS/ { print $2 }' "/proc/$1/status" 2>/dev/null
}

# watch PID: writes seconds and KiB
watch() {
    local start=$SECONDS size
    while kill -0 "$1" 2>/dev/null; do
        size=$(resident "$1")
        [ -n "$size" ] && echo "$((SECONDS - start)) $size"
        sleep 1
    done
}

# most FROM TO: KiB that are not exceeded nine tenths of the seconds in between
most() {
    awk -v from="$1" -v to="$2" '$1 >= from && $1 < to { print $2 }' "$work/memory" | sort -n |
        awk '{ size[NR] = $1 } END { print size[int(0.9 * (NR - 1)) + 1] + 0 }'
}

error_of() { # PICTURE
    "$program" compare "$1" "$work/reference.exr" --metric relmse
}

soak() { # SCENE INTEGRATOR
    local quarter
    quarter=$(awk -v s="$seconds" 'BEGIN { print s / 4 }')
    rm -f "$work"/a.exr "$work"/at.*
    "$program" render "$1" -q --size 128x128 --integrator "$2" --time "$seconds" --every "${quarter}s" \
        -o "$work/a.exr" --set denoise=off &
    local job=$! first='' last n=0
    watch $job >"$work/memory" &
    local watcher=$! seen=''
    while kill -0 $job 2>/dev/null; do
        sleep 1
        local now
        now=$(stat -c %Y.%s "$work/a.exr" 2>/dev/null) || continue
        if [ "$now" != "$seen" ]; then
            seen=$now
            first=${first:-$(error_of "$work/a.exr")}
            n=$((n + 1))
        fi
    done
    wait $watcher
    last=$(error_of "$work/a.exr")
    local settled=$((seconds / 3 < 60 ? seconds / 3 : 60)) middle
    middle=$(((settled + seconds) / 2))
    local before after
    before=$(most $settled $middle)
    after=$(most $middle $((seconds - 2)))
    awk -v name="$(basename "$1") $2" -v first="$first" -v last="$last" -v n="$n" -v before="$before" \
        -v after="$after" 'BEGIN {
            grew = before > 0 ? 100 * (after / before - 1) : 999
            ok = grew <= 1 && last < first
            printf "%-24s memory %.1f MiB, then %.2f %% more; relMSE %.4g, %.4g after %d pictures: %s\n",
                name, before / 1024, grew, first, last, n, ok ? "good" : "BAD"
            exit !ok
        }' || bad=1
}

for scene in "$@"; do
    "$program" render "$scene" -q --size 128x128 --integrator vcm --seed 7 --time "$seconds" \
        -o "$work/reference.exr" --set denoise=off || exit 1
    for integrator in auto sppm vcm; do
        soak "$scene" $integrator
    done
done
exit $bad
