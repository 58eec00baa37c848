#!/bin/sh
# The shared library shows only names with our prefix.
# usage: test_exports.sh LIBRARY; speaks TAP. CC chooses the compiler.
library=$1
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

echo 1..2
found=$(strangers "$library")
[ -z "$found" ] || echo "# not ours: $(echo "$found" | tr '\n' ' ')"
[ -z "$found" ]
report only-ours $?

echo 'int neph_ours(void) { return 0; } int stranger(void) { return 0; }' >"$work/fault.c"
"${CC:-cc}" -shared -fPIC -o "$work/fault.so" "$work/fault.c"
[ "$(strangers "$work/fault.so")" = stranger ]
report planted-fault $?
