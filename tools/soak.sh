#!/bin/bash
# Long renders: whether memory stays as it is after the first minute, and the picture goes on
# getting better. Each of auto, sppm and vcm on each scene renders for so many minutes; the
# picture of every 24th of it, or of 50 s, is compared in the end with a reference,
# rendered by sppm with another seed for as long.
# usage: soak.sh [--size WxH] [--threads N] [--together] [--integrator NAME]... [--keep FOLDER] NEPHROID MINUTES [SCENE...]
#   --size WxH      of each picture (128x128; a huge page of 2 MiB is 5 % of what that takes, 1 %
#                   at 512x512: memory is flat within 1 % only where pictures are larger)
#   --threads N     threads of each render (all processors')
#   --together      all renders, and the references, at the same time
#   --integrator    these in place of auto, sppm and vcm
#   --keep FOLDER   leaves pictures and memory there
# What follows the first minute (of the render's processor time, and as much as a third of the
# whole: with --together the clock's is over before some have planned) is cut into eight spans, or
# more of them, each as long as between three pictures; the most memory in each is exact: the
# kernel's high-water mark is set back where a span begins.
# Exits with 1 where the most in a span is not within 1 % of that in the first of them, where a
# picture was much worse than the one before, or the last not better than the first.
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
every=$(awk -v s="$seconds" 'BEGIN { print s / 24 < 50 ? s / 24 : 50 }')
span=$(awk -v e="$every" 'BEGIN { print int(2 * e) }')
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

# watch PID FOLDER: writes a line a span to FOLDER/memory (seconds of the clock and of the processor
# at its end, the most memory in it, KiB), and keeps each picture.
watch() {
    local start=$SECONDS next=$span now seen='' n=0
    while kill -0 "$1" 2>/dev/null; do
        if [ $((SECONDS - start)) -ge "$next" ]; then
            next=$((next + span))
            awk -v t=$((SECONDS - start)) -v took="$(processor "$1" 2>/dev/null)" '
                /^VmHWM/ && took != "" { print t, took, $2 }' "/proc/$1/status" 2>/dev/null >>"$2/memory"
            echo 5 2>/dev/null >"/proc/$1/clear_refs"
        fi
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
    awk -v name="$(basename "$1" .pbrt) $2" -v errors="$errors" '
        { took[NR] = $2; most[NR] = $3 }
        END {
            first = took[NR] / 3 < 60 ? took[NR] / 3 : 60
            for (from = 1; from < NR && took[from] <= first; from++)
                ;
            from++ # the minute ended within the span before
            for (i = from; i <= NR; i++) {
                change = 100 * (most[i] / most[from] - 1)
                if (change < low) low = change
                if (change > high) high = change
            }
            n = split(errors, error, " ")
            worse = 0
            for (i = 2; i <= n; i++) if (error[i] > 1.1 * error[i - 1]) worse++
            ok = NR >= from + 3 && high <= 1 && low >= -1 && n > 1 && !worse && error[n] < error[1]
            printf "%-20s memory %.1f MiB, then %+.2f to %+.2f %% in %d spans; relMSE %s: %s\n", name,
                most[from] / 1024, low, high, NR - from, errors, ok ? "good" : "BAD"
            exit !ok
        }' "$3/memory"
}

n=0
for scene in "$@"; do
    n=$((n + 1))
    render "$scene" "$work/$n.exr" --integrator sppm --seed 7 &
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
