#!/bin/bash
# Bash completes commands, options and settings, and says what the program says.
# usage: test_completion.sh COMPLETION PROGRAM; speaks TAP.
completion=$1
program=$2
number=0

# complete WORD...: what is offered for the last word
offered() {
    COMP_WORDS=("$program" "$@")
    COMP_CWORD=$#
    COMPREPLY=()
    _nephroid 2>/dev/null
    printf '%s\n' "${COMPREPLY[@]}"
}

# expect NAME PATTERN WORD...: the pattern is among the offers
expect() {
    local name=$1 pattern=$2 result=not\ ok
    shift 2
    number=$((number + 1))
    offered "$@" | grep -qx -- "$pattern" && result=ok
    echo "$result $number /completion/$name"
}

echo 1..8
# shellcheck source=../cli/nephroid.bash
. "$completion"
expect command render ren
expect option '--passes' render --pa
expect json '--json' info --j
expect setting 'final_gather=' render --set final
expect metric relmse compare --metric rel
expect integrator photonmap render --integrator pho
expect preset 002 render --preset 00
number=$((number + 1))
[ -z "$(offered render --nothing)" ] && echo "ok $number /completion/nothing" ||
    echo "not ok $number /completion/nothing"
