#!/bin/sh
# Plain structs of the installed header lie in memory as structs.txt says: a field that moves
# breaks programs, new ones come at the ends and are added to the list by hand.
# usage: test_structs.sh HEADER; speaks TAP. CC chooses the compiler.
header=$1
list=$(dirname "$0")/structs.txt
work=$(mktemp -d) || exit 99
trap 'rm -rf "$work"' EXIT
number=0

# fields HEADER...: a line "STRUCT" or "STRUCT FIELD" for each
fields() {
    cat "$@" | tr '\n' ' ' | sed -E 's:/\*([^*]|\*+[^*/])*\*+/::g' |
        grep -oE 'typedef struct Neph[A-Za-z]+ \{[^}]*\}' | awk -F'[{}]' '{
            split($1, head, " "); print head[3]
            n = split($2, lines, ";")
            for (i = 1; i < n; i++) {
                m = split(lines[i], names, ",")
                for (k = 1; k <= m; k++) {
                    sub(/\[.*/, "", names[k]); sub(/ *$/, "", names[k])
                    sub(/.*[ *]/, "", names[k]); print head[3], names[k]
                }
            }
        }'
}

# layout HEADER...: where they are: "STRUCT SIZE", "STRUCT.FIELD OFFSET SIZE"
layout() {
    {
        for part in "$@"; do echo "#include \"$part\""; done
        echo '#include <stdio.h>'
        echo 'int main(void) {'
        fields "$@" | awk 'NF == 1 { printf "printf(\"%s %%zu\\n\", sizeof(%s));\n", $1, $1 }
            NF == 2 { printf "printf(\"%s.%s %%zu %%zu\\n\", offsetof(%s, %s), sizeof(((%s *)0)->%s));\n",
                             $1, $2, $1, $2, $1, $2 }'
        echo 'return 0; }'
    } >"$work/say.c"
    # shellcheck disable=SC2046 # the flags are words
    "${CC:-cc}" $(pkg-config --cflags glib-2.0) -I"$(dirname "$(dirname "$header")")" \
        -o "$work/say" "$work/say.c" $(pkg-config --libs glib-2.0) -Wl,--unresolved-symbols=ignore-all &&
        "$work/say"
}

# report NAME STATUS
report() {
    number=$((number + 1))
    if [ "$2" = 0 ]; then
        echo "ok $number /structs/$1"
    else
        echo "not ok $number /structs/$1"
    fi
}

echo 1..3
layout "$(dirname "$header")"/[np]*.h >"$work/found" 2>"$work/log" || sed 's/^/# /' "$work/log"
[ "$(grep -c . "$work/found")" -gt 100 ]
report found $?
changed=$(diff "$list" "$work/found")
[ -z "$changed" ] || echo "$changed" | sed 's/^/# tests\/house\/structs.txt: /'
[ -z "$changed" ]
report list $?

# A field that comes before others is seen.
for part in "$(dirname "$header")"/[nps]*.h; do
    sed 's/^typedef struct NephStatistics {/&  char planted;/' "$part" >"$work/$(basename "$part")"
done
header=$work/nephroid/nephroid.h
mkdir "$work/nephroid" && mv "$work"/*.h "$work/nephroid"
layout "$work"/nephroid/[np]*.h 2>"$work/log" | diff "$list" - | grep -q 'NephStatistics.time_total'
report planted-fault $?
