#!/bin/sh
# Takes the manual's pictures of the window, on a screen of its own.
# usage: screenshots.sh NEPHROID_VIEW FOLDER
viewer=$1
folder=$2
most_bytes=400000 # of a picture in the repository
root=$(cd "$(dirname "$0")/.." && pwd)
settings=$(mktemp -d) || exit 1
trap 'rm -rf "$settings"' EXIT
export XDG_CONFIG_HOME="$settings" XDG_DATA_HOME="$settings" GSETTINGS_BACKEND=memory \
    GSK_RENDERER=cairo LIBGL_ALWAYS_SOFTWARE=1 GTK_A11Y=none

# shot NAME SECONDS OPTION... [SCENE]
shot() {
    name=$1
    seconds=$2
    shift 2
    xvfb-run -a -s '-screen 0 1400x900x24' "$viewer" --screenshot "$folder/view-$name.png" \
        --after "$seconds" "$@" 2>"$settings/log" || cat "$settings/log" >&2
    echo "$folder/view-$name.png"
    if [ "$(stat -c %s "$folder/view-$name.png")" -gt "$most_bytes" ]; then
        echo "screenshots: view-$name.png is too large to keep" >&2
        exit 1
    fi
}

scenes=$root/scenes
cornell=$scenes/cornell-box/cornell-box.pbrt
ring=$scenes/ring/ring.pbrt
ball=$scenes/glass-ball/glass-ball.pbrt
# Few enough photons to see each.
few=$settings/cornell-box.pbrt
sed 's/"integer photons" [0-9]*/"integer photons" 30000/' "$cornell" >"$few"
# Misspelt twice.
broken=$settings/broken.pbrt
sed '0,/"diffuse"/s//"difuse"/; 0,/Shape "trianglemesh"/s//Shape "trianglemsh"/' "$cornell" >"$broken"

mkdir -p "$folder"
shot welcome 2 --theme dark
shot errors 3 --theme light "$broken"
shot materials 4 --view materials --page settings --theme light "$ring"
shot numbers 70 --view picture --page numbers --theme dark "$ball"
shot camera 60 --view picture --page camera --theme light "$ring"
shot photons 30 --view photons --page photons --pick 0.33,0.52 --theme dark "$few"
shot ring 60 --view photons --page photons --theme light "$ring"
shot inspect 70 --view picture --page inspect --theme dark "$ball"
shot picture 80 --view picture --page settings --theme light "$cornell"
