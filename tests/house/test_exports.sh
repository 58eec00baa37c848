#!/bin/sh
# The shared library shows what the installed header declares and nothing else.
# usage: test_exports.sh LIBRARY HEADER; speaks TAP. CC chooses the compiler.
library=$1
header=$2
work=$(mktemp -d) || exit 99
trap 'rm -rf "$work"' EXIT
number=0

# names LIBRARY: what it defines for others
names() {
    nm -D --defined-only "$1" | awk '{ print $3 }' | sort
}

# strangers LIBRARY: names without our prefix
strangers() {
    names "$1" | grep -v -E '^(neph_|Neph)'
}

# report NAME STATUS
report() {
    number=$((number + 1))
    if [ "$2" = 0 ]; then
        echo "ok $number /exports/$1"
    else
        echo "not ok $number /exports/$1"
    fi
}

echo 1..4
found=$(strangers "$library")
[ -z "$found" ] || echo "# not ours: $(echo "$found" | tr '\n' ' ')"
[ -z "$found" ]
report only-ours $?

cat "$(dirname "$header")"/*.h | tr '\n' ' ' | grep -o 'NEPH_API [^;(]*(' |
    sed -n -E 's/.*[ *](neph_[a-z0-9_]*)\($/\1/p' | sort >"$work/declared"
names "$library" >"$work/defined"
missing=$(comm -23 "$work/declared" "$work/defined")
[ -z "$missing" ] || echo "# declared, but not there: $(echo "$missing" | tr '\n' ' ')"
[ -s "$work/declared" ] && [ -z "$missing" ]
report all-declared $?

# What programs may be linked with stays: a name that goes breaks them. A new one is added to
# the list by hand, so that nothing becomes public by accident.
list=$(dirname "$0")/exports.txt
changed=$(diff "$list" "$work/defined")
[ -z "$changed" ] || echo "$changed" | sed 's/^/# tests\/house\/exports.txt: /'
[ -z "$changed" ]
report list $?

echo 'int neph_ours(void) { return 0; } int stranger(void) { return 0; }' >"$work/fault.c"
"${CC:-cc}" -shared -fPIC -o "$work/fault.so" "$work/fault.c"
[ "$(strangers "$work/fault.so")" = stranger ]
report planted-fault $?
