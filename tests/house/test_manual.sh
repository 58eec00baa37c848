#!/bin/sh
# The manual says what the program does: its settings, its options, its first scene.
# usage: test_manual.sh SOURCE_ROOT NEPHROID EXAMPLE; speaks TAP.
root=$1
nephroid=$2
example=$3
work=$(mktemp -d) || exit 99
trap 'rm -rf "$work"' EXIT
number=0

# report NAME STATUS: the test's own words are in log
report() {
    number=$((number + 1))
    if [ "$2" = 0 ]; then
        echo "ok $number /manual/$1"
    else
        sed 's/^/# /' "$work/log"
        echo "not ok $number /manual/$1"
    fi
    : >"$work/log"
}

# block FILE LANGUAGE N: the N-th code block of a Markdown file
block() {
    awk -v language="$2" -v wanted="$3" '
        /^```/ && inside { inside = 0; next }
        $0 == "```" language { inside = 1; n++; next }
        inside && n == wanted' "$1"
}

# options_of_program: long options in the help of all commands
options_of_program() {
    for command in render photons info convert compare image settings bsdf; do
        "$nephroid" "$command" --help
    done | grep -o -E '^ +(-[a-zA-Z], )?--[a-z-]+' | grep -o -E '\-\-[a-z-]+' | sort -u
}

options_of_man_page() {
    grep -o -E 'Fl -[a-z-]+' "$root/docs/nephroid.1" | sed 's/Fl -/--/' | sort -u
}

echo 1..6
"$root/tools/settings_page.sh" "$nephroid" >"$work/settings.md"
diff "$root/docs/settings.md" "$work/settings.md" >"$work/log" 2>&1
report settings $?

"$root/tools/features_page.sh" "$nephroid" >"$work/features.md"
diff "$root/docs/features.md" "$work/features.md" >"$work/log" 2>&1
report features $?

options_of_program >"$work/program"
options_of_man_page >"$work/page"
[ -s "$work/program" ] && diff "$work/program" "$work/page" >"$work/log"
report options $?

block "$root/README.md" c 1 >"$work/render.c"
diff "$root/examples/render.c" "$work/render.c" >"$work/log"
report example-is-shown $?

block "$root/README.md" pbrt 1 >"$work/ball.pbrt"
"$nephroid" render "$work/ball.pbrt" --size 24x18 --passes 1 -o "$work/ball.png" \
    >"$work/log" 2>&1 && [ -s "$work/ball.png" ]
report first-scene $?

sed 's/480/24/; s/360/18/; s/passes" 16/passes" 1/' "$work/ball.pbrt" >"$work/small.pbrt"
"$example" "$work/small.pbrt" "$work/small.exr" >"$work/log" 2>&1 && [ -s "$work/small.exr" ]
report example-runs $?
