#!/bin/sh
# What a broken reader meets in program and library: no writable code, no table of functions
# to overwrite, no known address, a stack that is watched and calls that know their buffers.
# usage: test_hardening.sh PROGRAM LIBRARY; speaks TAP. CC chooses the compiler.
program=$1
library=$2
work=$(mktemp -d) || exit 99
trap 'rm -rf "$work"' EXIT
number=0

# report NAME STATUS
report() {
    number=$((number + 1))
    if [ "$2" = 0 ]; then
        echo "ok $number /hardening/$1"
    else
        echo "not ok $number /hardening/$1"
    fi
}

is_movable() {
    LC_ALL=C readelf -hW "$1" | grep -q 'Type: *DYN'
}

binds_at_once() {
    LC_ALL=C readelf -dW "$1" | grep -q -E 'BIND_NOW|FLAGS_1.*NOW' &&
        LC_ALL=C readelf -lW "$1" | grep -q GNU_RELRO
}

stack_is_no_code() {
    LC_ALL=C readelf -lW "$1" | grep 'GNU_STACK' | grep -q -v 'RWE'
}

# calls FILE PATTERN: whether it takes such a function from the C library
calls() {
    LC_ALL=C readelf --dyn-syms -W "$1" | grep -q -E "UND $2"
}

# A call through a pointer may only land where one is meant to.
marks_entries() {
    [ "$(uname -m)" = x86_64 ] || return 0
    LC_ALL=C objdump -d --disassemble="$2" "$1" | grep -A1 "<$2>:" | grep -q endbr64
}

echo 1..7
is_movable "$program" && is_movable "$library"
report any-address $?
binds_at_once "$program" && binds_at_once "$library"
report bound-at-once $?
stack_is_no_code "$program" && stack_is_no_code "$library"
report stack-is-no-code $?
calls "$program" __stack_chk_fail && calls "$library" __stack_chk_fail
report stack-watched $?
calls "$library" '__(memcpy|fread|printf|fprintf|vsnprintf|snprintf|sprintf|memset)_chk'
report buffers-known $?
marks_entries "$library" neph_version && marks_entries "$program" main
report entries-marked $?

cat >"$work/fault.c" <<'TEXT'
#include <string.h>
int main(int argc, char **argv)
{
    char text[64];
    strcpy(text, argv[argc - 1]);
    return text[0];
}
TEXT
"${CC:-cc}" -O2 -U_FORTIFY_SOURCE -fno-stack-protector -fcf-protection=none -no-pie \
    -z norelro -z lazy -z execstack -o "$work/fault" "$work/fault.c" 2>/dev/null ||
    "${CC:-cc}" -O2 -U_FORTIFY_SOURCE -fno-stack-protector -no-pie -Wl,-z,norelro \
        -Wl,-z,lazy -Wl,-z,execstack -o "$work/fault" "$work/fault.c"
! is_movable "$work/fault" && ! binds_at_once "$work/fault" &&
    ! stack_is_no_code "$work/fault" && ! calls "$work/fault" '__[a-z_]*chk' &&
    { [ "$(uname -m)" != x86_64 ] || ! marks_entries "$work/fault" main; }
report planted-fault $?
