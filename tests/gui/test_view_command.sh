#!/usr/bin/env bash
# nephroid-view from a shell: its options, a scene and a broken one on the command line, and
# what the desktop reads of it.
#
#   test_view_command.sh NEPHROID-VIEW SCENE DATA-FOLDER
set -u

viewer=$1
scene=$2
data=$3
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
export XDG_CONFIG_HOME=$folder XDG_DATA_HOME=$folder GSETTINGS_BACKEND=memory \
    GSK_RENDERER=cairo LIBGL_ALWAYS_SOFTWARE=1 GTK_A11Y=none
echo "1..6"

# check NUMBER NAME STATUS
check() {
    if [ "$3" = 0 ]; then echo "ok $1 - /view-command/$2"; else echo "not ok $1 - /view-command/$2"; fi
}

"$viewer" --version | grep -q '^nephroid-view [0-9]'
check 1 version $?
"$viewer" --nonsense 2>/dev/null && status=1 || status=0
check 2 wrong-option $status

if command -v xvfb-run >/dev/null; then
    # picture NAME SCENE: a window that closes itself leaves a picture of its size
    picture() {
        xvfb-run -a -s '-screen 0 1400x1000x24' "$viewer" "$2" --after 1 \
            --screenshot "$folder/$1.png" 2>/dev/null &&
            [ "$(od -An -tu1 -j16 -N8 "$folder/$1.png" | tr -s ' ')" = ' 0 0 5 0 0 0 3 32' ]
    }
    picture scene "$scene"
    check 3 scene $?
    picture nowhere "$folder/nowhere.pbrt"
    check 4 missing-scene $?
else
    echo "ok 3 - /view-command/scene # SKIP no xvfb-run"
    echo "ok 4 - /view-command/missing-scene # SKIP no xvfb-run"
fi

if command -v desktop-file-validate >/dev/null; then
    desktop-file-validate "$data"/*.desktop >&2
    check 5 desktop-file $?
else
    echo "ok 5 - /view-command/desktop-file # SKIP no desktop-file-validate"
fi
if command -v appstreamcli >/dev/null; then
    appstreamcli validate --no-net "$data"/*.metainfo.xml >&2
    check 6 appstream $?
else
    echo "ok 6 - /view-command/appstream # SKIP no appstreamcli"
fi
