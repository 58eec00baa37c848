#!/bin/bash
# A disk that is full, may only be read, or goes away while a render is under way: what was
# there stays, the program says what it could not do and ends with 3 or 1.
# usage: test_disk.sh NEPHROID; speaks TAP. Disks of its own need root, else it is skipped.
program=$(realpath "$1")
if [ "${2:-}" != inside ]; then
    if ! unshare -m true 2>/dev/null; then
        echo "1..0 # SKIP no right to mount a small disk"
        exit 0
    fi
    exec unshare -m --propagation private bash "$0" "$program" inside
fi
work=$(mktemp -d) || exit 99
trap 'cd /; umount -l "$work/disk" 2>/dev/null; rm -rf "$work"' EXIT
number=0
mkdir "$work/disk"
mount -t tmpfs -o size=256k tmpfs "$work/disk" || exit 99
cd "$work" || exit 99

report() { # NAME STATUS: what was said is in log
    number=$((number + 1))
    if [ "$2" = 0 ]; then
        echo "ok $number /disk/$1"
    else
        sed 's/^/# /' log
        echo "not ok $number /disk/$1"
    fi
}

cat >box.pbrt <<'TEXT'
Film "rgb" "integer xresolution" 96 "integer yresolution" 64
LookAt 0 0 -2  0 0 0  0 1 0
Camera "perspective"
WorldBegin
LightSource "point" "rgb I" [4 4 4] "point3 from" [0 1 0]
Shape "sphere" "float radius" 3
TEXT

# refused WORDS FILE: it ended in an error that has these words, the old file is there, and
# nothing else was left beside it
refused() {
    [ "$status" != 0 ] && grep -q "$1" log && [ "$(cat "$2")" = old ] &&
        [ "$(find disk -mindepth 1 | wc -l)" = "$files" ]
}

echo 1..6
echo old >disk/a.exr
echo old >disk/c
echo old >disk/p
head -c 140000 /dev/zero >disk/ballast
files=4
"$program" render box.pbrt -q --passes 2 -o disk/a.exr >log 2>&1
status=$?
refused "No space left on device" disk/a.exr
report full/picture $?

"$program" render box.pbrt -q --passes 2 -o b.exr --checkpoint disk/c --checkpoint-every 0 >log 2>&1
status=$?
refused "No space left on device" disk/c && [ -s b.exr ]
report full/checkpoint $?

"$program" photons box.pbrt -q --set integrator=photonmap --save disk/p >log 2>&1
status=$?
refused "No space left on device" disk/p
report full/photons $?

mount -o remount,ro "$work/disk"
"$program" render box.pbrt -q -o disk/a.exr >log 2>&1
status=$?
refused "Read-only file system" disk/a.exr
report read-only/before $?

# begun PICTURE: until the first checkpoint is there, however slow the machine is
begun() {
    rm -f b.checkpoint
    "$program" render box.pbrt -q --passes 100000 -o "$1" --checkpoint b.checkpoint \
        --checkpoint-every 0 >log 2>&1 &
    job=$!
    while kill -0 $job 2>/dev/null && [ ! -s b.checkpoint ]; do
        sleep 0.05
    done
}

# ended: asked to write what there is
ended() {
    kill -TERM $job
    wait $job
    status=$?
}

mount -o remount,rw,size=4m "$work/disk"
begun disk/a.exr
mount -o remount,ro "$work/disk"
ended
refused "Read-only file system" disk/a.exr
report read-only/meanwhile $?

mkdir away
begun away/a.exr
rm -r away
ended
[ $status != 0 ] && grep -q "away/a.exr: No such file or directory" log && [ -s b.checkpoint ]
report gone $?
