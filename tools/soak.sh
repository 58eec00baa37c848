#!/bin/bash
# Long renders: whether memory stays as it is after the first minute, and the picture goes on
# getting better. Each of auto, sppm and vcm on each scene renders for so many minutes; the
# picture of every eighth of it, or of 50 s, is compared in the end with a reference,
# rendered by vcm with another seed for as long.
# usage: soak.sh [--size WxH] [--threads N] [--together] [--integrator NAME]... [--keep FOLDER] NEPHROID MINUTES [SCENE...]
#   --size WxH      of each picture (128x128; a huge page of 2 MiB is 5 % of what that takes, and
#                   1 % at 512x512)
#   --threads N     threads of each render (all processors')
#   --together      all renders, and the references, at the same time
#   --integrator    these in place of auto, sppm and vcm
#   --keep FOLDER   leaves pictures and memory by the second there
# Exits with 1 where memory is more than 1 % larger in the second half of what follows the
# first minute than in the first half (nine tenths of the time: each pass takes some and gives
# it back), where the most it ever took grew by more than 1 % after the first minute, where a picture
# was much worse than the one before, or the last not better than the first. The first minute is
# one of the render's processor time, as much as a third of the whole: with --together the clock's
# is over before some have planned.
set -u
size=128x128 threads=0 together='' keep='' integrators=()
while [ $# -gt 0 ]; do
    case $1 in
    --size) size=$2 && shift ;;
    --threads) threads=$2 && shift ;;
    --together) together=yes ;;
    --integrator) integrators+=("$2") && shift ;;
    --keep) keep=$2 && shift ;;
    *) break ;;
    esac
    shift
done
[ ${#integrators[@]} -gt 0 ] || integrators=(auto sppm vcm)
program=$(realpath "$1") || exit 99
minutes=$2
shift 2
root=$(cd "$(dirname "$0")/.." && pwd)
[ $# -gt 0 ] || set -- "$root/scenes/ring/ring.pbrt" "$root/bench/equal_time/scenes/cornell-glass.pbrt"
seconds=$(awk -v m="$minutes" 'BEGIN { print int(60 * m) }')
if [ -n "$keep" ]; then
    work=$keep
    mkdir "$work" || exit 99
else
    work=$(mktemp -d) || exit 99
    trap 'rm -rf "$work"' EXIT
fi

render() { # SCENE FILE OPTION...; becomes the program, so that who begins it has its process
    exec "$program" render "$1" -q --size "$size" --threads "$threads" --time "$seconds" -o "$2" \
        --set denoise=off "${@:3}"
}

processor() { # PID: seconds of processor time it has taken
    awk -v ticks="$(getconf CLK_TCK)" '{ sub(/.*\) /, ""); print ($12 + $13) / ticks }' "/proc/$1/stat"
}

# watch PID FOLDER: writes seconds, KiB of memory, the most it ever was and seconds of processor
# time to FOLDER/memory, and keeps each picture.
watch() {
    local start=$SECONDS now seen='' n=0
    while kill -0 "$1" 2>/dev/null; do
        awk -v t=$((SECONDS - start)) -v took="$(processor "$1" 2>/dev/null)" '
            /^VmRSS/ { now = $2 } /^VmHWM/ { most = $2 }
            END { if (now && took != "") print t, now, most, took }' "/proc/$1/status" 2>/dev/null >>"$2/memory"
        now=$(stat -c %i.%Y "$2/a.exr" 2>/dev/null) || now=''
        if [ -n "$now" ] && [ "$now" != "$seen" ]; then
            seen=$now
            n=$((n + 1))
            cp "$2/a.exr" "$2/$(printf 'at.%03d.exr' "$n")"
        fi
        sleep 1
    done
}

soak() { # SCENE INTEGRATOR FOLDER
    local every
    every=$(awk -v s="$seconds" 'BEGIN { print s / 8 < 50 ? s / 8 : 50 }')
    render "$1" "$3/a.exr" --integrator "$2" --every "${every}s" &
    local job=$!
    watch "$job" "$3"
    wait "$job" || touch "$3/failed"
}

# judge SCENE INTEGRATOR FOLDER REFERENCE: one line, and whether all is well.
judge() {
    local errors picture
    errors=$(for picture in "$3"/at.*.exr "$3/a.exr"; do
        "$program" compare "$picture" "$4" --metric relmse
    done | tr '\n' ' ')
    [ ! -e "$3/failed" ] || errors=''
    awk -v name="$(basename "$1" .pbrt) $2" -v errors="$errors" -v seconds="$seconds" '
        function high(from, to,    n, size, i, j, t) { # KiB not exceeded nine tenths of the time
            for (i = 1; i <= NR; i++)
                if (time[i] >= from && time[i] < to) {
                    for (j = n++; j > 0 && size[j] > now[i]; j--) size[j + 1] = size[j]
                    size[j + 1] = now[i]
                }
            return n ? size[int(0.9 * (n - 1)) + 1] : 0
        }
        { time[NR] = $1; now[NR] = $2; most[NR] = $3; took[NR] = $4 }
        END {
            first = took[NR] / 3 < 60 ? took[NR] / 3 : 60
            for (i = 1; i <= NR && took[i] <= first; i++) {
                settled = time[i]
                first_most = most[i]
            }
            middle = (settled + seconds) / 2
            before = high(settled, middle)
            after = high(middle, seconds - 2)
            grew = before > 0 ? 100 * (after / before - 1) : 999
            peak = first_most > 0 ? 100 * (most[NR] / first_most - 1) : 999
            n = split(errors, error, " ")
            worse = 0
            for (i = 2; i <= n; i++) if (error[i] > 1.1 * error[i - 1]) worse++
            ok = grew <= 1 && peak <= 1 && n > 1 && !worse && error[n] < error[1]
            printf "%-20s memory %.1f MiB, then %+.2f %%; most %.1f MiB, then %+.2f %%; relMSE %s: %s\n",
                name, before / 1024, grew, first_most / 1024, peak, errors, ok ? "good" : "BAD"
            exit !ok
        }' "$3/memory"
}

n=0
for scene in "$@"; do
    n=$((n + 1))
    render "$scene" "$work/$n.exr" --integrator vcm --seed 7 &
    [ -n "$together" ] || wait
    for integrator in "${integrators[@]}"; do
        mkdir -p "$work/$n.$integrator"
        soak "$scene" "$integrator" "$work/$n.$integrator" &
        [ -n "$together" ] || wait
    done
done
wait
n=0
bad=0
for scene in "$@"; do
    n=$((n + 1))
    for integrator in "${integrators[@]}"; do
        judge "$scene" "$integrator" "$work/$n.$integrator" "$work/$n.exr" || bad=1
    done
done
exit $bad
