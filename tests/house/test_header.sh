#!/bin/sh
# The installed header compiles alone, in every language that may include it.
# usage: test_header.sh HEADER; speaks TAP. CC and CXX choose the compilers.
header=$1
work=$(mktemp -d) || exit 99
trap 'rm -rf "$work"' EXIT
flags="$(pkg-config --cflags glib-2.0) -I$(dirname "$(dirname "$header")")"
for part in "$(dirname "$header")"/[ps]*.h "$header" "$header"; do # a part first, too
    printf '#include "%s"\n' "$part" >>"$work/twice.c"
done
cp "$work/twice.c" "$work/twice.cpp"
printf 'Gibberish *neph_gibberish(void);\n' >"$work/fault.c"
number=0

# shellcheck disable=SC2086 # the flags are words
# compile COMPILER OPTION... FILE: true if FILE compiles without a warning
compile() {
    "$@" -Wall -Wextra -pedantic -Werror -fsyntax-only $flags >"$work/log" 2>&1
}

# report NAME STATUS
report() {
    number=$((number + 1))
    if [ "$2" = 0 ]; then
        echo "ok $number /header/$1"
    else
        sed 's/^/# /' "$work/log"
        echo "not ok $number /header/$1"
    fi
}

echo 1..5
for std in gnu17 c11; do
    compile "${CC:-cc}" -std=$std "$work/twice.c"
    report "$std" $?
done
for std in c++11 c++20; do
    if command -v "${CXX:-c++}" >/dev/null; then
        compile "${CXX:-c++}" -std=$std "$work/twice.cpp"
        report "$std" $?
    else
        number=$((number + 1))
        echo "ok $number /header/$std # SKIP no C++ compiler"
    fi
done
! compile "${CC:-cc}" -std=c11 "$work/fault.c"
report planted-fault $?
