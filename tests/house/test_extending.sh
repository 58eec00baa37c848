#!/usr/bin/env bash
# What docs/extending.md shows compiles in the tree as it is, without a warning.
# usage: test_extending.sh ROOT; speaks TAP. CC chooses the compiler.
root=$1
work=$(mktemp -d) || exit 99
trap 'rm -rf "$work"' EXIT
read -ra flags <<<"$(pkg-config --cflags glib-2.0)"

# Writes each block of C that follows a line naming its file to that file's name.
awk -v work="$work" '
    /^`src\/.*\.c`:$/ { name = $0; gsub(/.*\/|`|:/, "", name) }
    /^```$/ && inside { inside = 0; name = "" }
    inside { print > (work "/" name) }
    /^```c$/ && name != "" { inside = 1 }' "$root/docs/extending.md"
printf 'int fault(void) { return neph_no_such_thing(); }\n' >"$work/planted.c"

# compile FILE: true if it compiles without a warning
compile() {
    "${CC:-cc}" -std=gnu17 -Wall -Wextra -Wshadow -Wno-psabi -Werror -fsyntax-only \
        -I"$root/src" -I"$root/include" "${flags[@]}" "$1" >"$work/log" 2>&1
}

number=0
# report NAME STATUS
report() {
    number=$((number + 1))
    if [ "$2" = 0 ]; then
        echo "ok $number /extending/$1"
    else
        sed 's/^/# /' "$work/log"
        echo "not ok $number /extending/$1"
    fi
}

echo 1..5
for name in material_chalk light_globe normals dots; do
    compile "$work/$name.c"
    report "$name" $?
done
! compile "$work/planted.c"
report planted-fault $?
