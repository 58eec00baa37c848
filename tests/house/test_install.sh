#!/bin/sh
# What is installed is whole: the program runs from where it was put, README's program in C is
# compiled by README's words against it and renders, and the list that uninstall goes by has
# every file.
# usage: test_install.sh SOURCE_ROOT BUILD_ROOT COMPILER...; speaks TAP.
source=$1
build=$2
shift 2
work=$(mktemp -d) || exit 99
trap 'rm -rf "$work"' EXIT
top=$work/root
number=0

# report NAME STATUS: the test's own words are in log
report() {
    number=$((number + 1))
    if [ "$2" = 0 ]; then
        echo "ok $number /install/$1"
    else
        sed 's/^/# /' "$work/log"
        echo "not ok $number /install/$1"
    fi
    : >"$work/log"
}

# The build as it is, but with a list of its own of what was installed: that of the real one is
# what `./dev uninstall` goes by.
shadow() {
    mkdir -p "$work/build/meson-private" "$work/build/meson-logs" &&
        for entry in "$build"/*; do
            case ${entry##*/} in
            meson-private | meson-logs) ;;
            *) if [ -d "$entry" ]; then
                ln -s "$entry" "$work/build/"
            else
                cp -P "$entry" "$work/build/"
            fi || return ;;
            esac
        done &&
        cp "$build/meson-private/"*.dat "$work/build/meson-private/" &&
        ln -s "$build/meson-private/"*.pc "$work/build/meson-private/"
}

echo 1..4
{ shadow && meson install -C "$work/build" --no-rebuild --destdir "$top"; } >"$work/log" 2>&1
report files $?

# Files and links, by their names after the installation.
(cd "$top" && find . ! -type d | sed 's/^\.//' | sort) >"$work/there"
grep -v '^#' "$work/build/meson-logs/install-log.txt" | sed "s|^$top||" |
    while read -r path; do [ -d "$top$path" ] && [ ! -L "$top$path" ] || echo "$path"; done |
    sort >"$work/listed"
[ -s "$work/there" ] && diff "$work/there" "$work/listed" >"$work/log"
report uninstall-knows-all $?

cat >"$work/scene.pbrt" <<'TEXT'
Film "rgb" "integer xresolution" 8 "integer yresolution" 6
Integrator "path"
LookAt 0 0 4  0 0 0  0 1 0
Camera "perspective"
WorldBegin
LightSource "infinite"
Shape "sphere"
TEXT
program=$(grep '/bin/nephroid$' "$work/there")
"$top$program" render "$work/scene.pbrt" --passes 1 -o "$work/program.png" >"$work/log" 2>&1 &&
    [ -s "$work/program.png" ]
report program-runs $?

# README's words, with the compiler of this build; only the prefix is another.
package=$top$(grep '/nephroid\.pc$' "$work/there")
prefix=$(sed -n 's/^prefix=//p' "$package")
mkdir "$work/pkgconfig" "$work/try"
sed "s|^prefix=.*|prefix=$top$prefix|" "$package" >"$work/pkgconfig/nephroid.pc"
awk '/^```/ && inside { exit } inside; $0 == "```c" { inside = 1 }' "$source/README.md" \
    >"$work/try/render.c"
words=$(sed -n 's/^cc render\.c /render.c /p' "$source/README.md")
PKG_CONFIG_PATH=$work/pkgconfig:$PKG_CONFIG_PATH
LD_LIBRARY_PATH=$top$(dirname "$(grep '/libnephroid\.so$' "$work/there")")
export PKG_CONFIG_PATH LD_LIBRARY_PATH
(cd "$work/try" && [ -n "$words" ] && eval "$* $words" &&
    ./render ../scene.pbrt ../example.png && [ -s ../example.png ]) >"$work/log" 2>&1
report example $?
