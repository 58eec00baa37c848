#!/bin/sh
# Takes the manual's pictures of the window, on a screen of its own.
# usage: screenshots.sh NEPHROID_VIEW FOLDER
viewer=$1
folder=$2
root=$(cd "$(dirname "$0")/.." && pwd)
settings=$(mktemp -d) || exit 1
trap 'rm -rf "$settings"' EXIT
export XDG_CONFIG_HOME="$settings" XDG_DATA_HOME="$settings" GSETTINGS_BACKEND=memory \
    GSK_RENDERER=cairo LIBGL_ALWAYS_SOFTWARE=1 GTK_A11Y=none

# shot NAME SCENE SECONDS OPTION...
shot() {
    name=$1
    scene=$2
    seconds=$3
    shift 3
    xvfb-run -a -s '-screen 0 1400x900x24' "$viewer" "$root/scenes/$scene" \
        --screenshot "$folder/view-$name.png" --after "$seconds" "$@" 2>"$settings/log" ||
        cat "$settings/log" >&2
    echo "$folder/view-$name.png"
}

mkdir -p "$folder"
shot picture cornell-box/cornell-box.pbrt 60 --view picture --page settings --theme light
shot photons ring/ring.pbrt 20 --view photons --page photons --theme dark
shot inspect glass-ball/glass-ball.pbrt 60 --view picture --page inspect --theme dark
shot materials ring/ring.pbrt 8 --view materials --page settings --theme light
