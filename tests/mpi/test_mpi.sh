#!/bin/bash
# One picture by 1, 2 and 4 ranks is that of one process; a rank that dies ends the job, and
# another number of ranks goes on. usage: test_mpi.sh MPIRUN NEPHROID_MPI NEPHROID; speaks TAP.
mpirun=$1
many=$(realpath "$2")
one=$(realpath "$3")
number=0
work=$(mktemp -d) || exit 99
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 99
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
export OMPI_MCA_rmaps_base_oversubscribe=1 OMPI_MCA_mpi_yield_when_idle=1
export OMPI_MCA_btl_vader_single_copy_mechanism=none

report() { # NAME STATUS: what was said is in log
    number=$((number + 1))
    if [ "$2" = 0 ]; then
        echo "ok $number /mpi/$1"
    else
        sed 's/^/# /' log
        echo "not ok $number /mpi/$1"
    fi
}

ranks() { # N ARGUMENT...
    local n=$1
    shift
    timeout 200 "$mpirun" -n "$n" "$many" render box.pbrt -j1 "$@" >log 2>&1
}

# same A B: the pictures differ by rounding alone, and do not show nothing
same() {
    "$one" compare "$1" "$2" --json >>log 2>&1 &&
        "$one" compare "$1" "$2" --json |
        awk '/"mean_a"/ { mean = $2 + 0 } /"rmse"/ { rmse = $2 + 0 }
             END { exit !(mean > 0.01 && rmse < 1e-5 * mean) }'
}

cat >box.pbrt <<'TEXT'
Film "rgb" "integer xresolution" 24 "integer yresolution" 20
LookAt 0 -3 1  0 0 0.6  0 0 1
Camera "perspective" "float fov" 50
Integrator "auto" "integer passes" 9 "integer spp" 1 "integer photons" 5000
WorldBegin
AttributeBegin
AreaLightSource "diffuse" "rgb L" [8 8 8]
Translate 0 0 2.2 Rotate 180 1 0 0
Shape "disk" "float radius" 0.4
AttributeEnd
Shape "disk" "float radius" 4
AttributeBegin
Translate 0 0 0.6 Material "dielectric"
Shape "sphere" "float radius" 0.5
AttributeEnd
TEXT

echo 1..18
for how in auto/1 auto/2 auto/4 vcm/3 sppm/2; do
    integrator=${how%/*} n=${how#*/}
    rm -f many.exr
    "$one" render box.pbrt -q --integrator "$integrator" -o one.exr >log 2>&1
    ranks "$n" -q --integrator "$integrator" -o many.exr && same one.exr many.exr
    report "same/$how" $?
done

# Without an end of its own, so that it is under way when a rank is killed.
"$one" render box.pbrt -q --passes 3000 --set planned_passes=9 --size 24x20 -o whole.exr >log 2>&1 &
whole=$!
"$mpirun" -n 3 "$many" render box.pbrt -j1 -q --passes 100000000 --set planned_passes=9 \
    -o cut.exr --checkpoint kept --checkpoint-every 0.3 >log 2>&1 &
job=$!
for _ in $(seq 600); do
    grep -q 'go on with --resume kept' log && break
    sleep 0.1
done
victim=$(pgrep -P $job | tail -1)
[ -n "$victim" ] && kill -9 "$victim"
wait $job
status=$?
[ $status != 0 ] && [ ! -e cut.exr ] && grep -q 'rank' log && grep -q 'go on with --resume kept' log
report rank-dies $?
ranks 2 -q --resume kept --passes 3000 -o resumed.exr
resumed=$?
wait $whole
[ $resumed = 0 ] && same whole.exr resumed.exr
report resumed-by-others $?

"$one" render box.pbrt -q --resume kept --passes 3000 -o alone.exr >log 2>&1 && same whole.exr alone.exr
report resumed-by-one $?

# in_time N SIZE: from the root's start to the written picture no more than 5 % and 0.5 s over.
# Where other programs hold the machine up the best of some tries counts, and the picture is
# written to memory where that can be: a disk may be busy for any time.
in_time() {
    local out=time.exr
    [ ! -w /dev/shm ] || out=$(mktemp -p /dev/shm --suffix=.exr)
    in_time_to "$1" "$2" "$out"
    local status=$?
    rm -f "$out"
    return $status
}

in_time_to() { # N SIZE FILE
    for _ in 1 2 3 4 5; do
        : >"$3"
        ranks "$1" --time 4 --size "$2" -o "$3" --stats time.json || return 1
        [ -s "$3" ] && grep -q 'stopped by time' log &&
            awk '/"total"/ { exit !($2 + 0 > 1 && $2 + 0 <= 1.05 * 4 + 0.5) }' time.json && return 0
        grep '"total"' time.json >>log
    done
    return 1
}

for how in 1/200x160 2/200x160 4/200x160 2/800x600; do
    in_time "${how%/*}" "${how#*/}"
    report "time/$how" $?
done

# What is left of a job whose time was too short for whole passes is a picture of parts of one.
ranks 2 -q --time 1 --size 2000x1500 -o parts.exr --stats parts.json
[ $? = 0 ] && [ -s parts.exr ] && awk '/"passes"/ { n = $2 + 0 } /"part"/ { part = $2 + 0 }
    END { exit !(n + part > 0) }' parts.json
report time/parts $?

number_in() { # NAME FILE
    awk -v name="\"$1\":" '$1 == name { print $2 + 0; exit }' "$2"
}

# The noise of all ranks' passes is that of one process' as many passes, and ends the job as
# soon as it is looked at with enough of them.
ranks 3 --noise 0.2 --passes 100000 -o noise.exr --stats noise.json && grep -q 'stopped by noise' log
ended=$?
passes=$(number_in passes noise.json)
"$one" render box.pbrt -q --passes "$passes" --set planned_passes=100000 -o alone.exr --stats alone.json >>log 2>&1
"$one" render box.pbrt -q --noise 0.2 --passes 100000 -o soon.exr --stats soon.json >>log 2>&1
found="$(number_in noise noise.json) $(number_in noise alone.json) $passes $(number_in passes soon.json)"
echo "noise of many, of one, passes of many, of one: $found" >>log
[ $ended = 0 ] && same alone.exr noise.exr && echo "$found" |
    awk '{ exit !($1 > 0 && $1 <= 0.2 && ($1 - $2) ^ 2 < 1e-8 && $3 >= $4 && $3 <= 2 * $4 + 8) }'
report noise $?

# The root's plan is that of all: its memory is short, and the others send as few photons as it.
timeout 200 "$mpirun" -n 1 "$many" render box.pbrt -j1 --integrator sppm --set photons=2000000 --passes 2 \
    --memory 60M -o few.exr --stats few.json : \
    -n 1 "$many" render box.pbrt -j1 --integrator sppm --set photons=2000000 --passes 2 >log 2>&1 &&
    grep -q 'fit into memory' log &&
    awk '/"indirect"/ { on = 1 } on && /"emitted"/ { n = $2 + 0; on = 0 }
         END { exit !(n > 1000 && n < 1800000) }' few.json
report plan-of-root $?

# Nor does one begin into whose memory they do not fit.
timeout 200 "$mpirun" -n 1 "$many" render box.pbrt -j1 --integrator sppm --set photons=2000000 --passes 2 \
    -o few.exr : \
    -n 1 "$many" render box.pbrt -j1 --integrator sppm --set photons=2000000 --passes 2 --memory 60M >log 2>&1
[ $? != 0 ] && [ "$(grep -c 'for rendering.*photons a pass, beyond the limit of 60.0 MiB' log)" = 1 ]
report memory-of-others $?

ranks 2 --resume box.pbrt
[ $? != 0 ] && [ "$(grep -c 'found another file' log)" = 1 ]
report refused $?

ranks 2 --passes x
[ $? != 0 ] && [ "$(grep -c "expected a number" log)" = 1 ]
report usage $?
