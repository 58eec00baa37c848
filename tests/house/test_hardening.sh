#!/bin/sh
# What a broken reader meets in programs and library: no writable code, no table of functions
# to overwrite, no known address, a stack that is watched and calls that know their buffers.
# usage: test_hardening.sh LIBRARY PROGRAM...; speaks TAP. CC chooses the compiler.
library=$1
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

# each CHECK FILE...: whether all of them pass
each() {
    check=$1
    shift
    for file in "$@"; do
        "$check" "$file" || { echo "# $file"; return 1; }
    done
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

is_watched() {
    calls "$1" __stack_chk_fail
}

# A call through a pointer may only land where one is meant to.
marks_entries() {
    [ "$(uname -m)" = x86_64 ] || return 0
    LC_ALL=C objdump -d --disassemble="$2" "$1" | grep -A1 "<$2>:" | grep -q endbr64
}

echo 1..7
each is_movable "$@"
report any-address $?
each binds_at_once "$@"
report bound-at-once $?
each stack_is_no_code "$@"
report stack-is-no-code $?
each is_watched "$@"
report stack-watched $?
calls "$library" '__(memcpy|fread|printf|fprintf|vsnprintf|snprintf|sprintf|memset)_chk'
report buffers-known $?
marks_entries "$library" neph_version && marks_entries "$2" main
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
