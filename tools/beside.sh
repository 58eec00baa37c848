#!/usr/bin/env bash
# Renders every scene that there is as the program does without being told anything, and
# puts each picture beside one that is made otherwise: the reference that came with the
# scene, and another algorithm of ours (paths alone where nothing casts caustics, else
# vertex connection and merging). Writes FOLDER/index.html and FOLDER/sheet.png.
# usage: beside.sh NEPHROID FOLDER [SECONDS]   SECONDS for each picture, 20
set -euo pipefail
nephroid=$1
folder=$2
seconds=${3:-20}
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
shared=$root/../shared/refs
side=320 # of the longer side of a picture, pixels
rows=() # of the sheet

mkdir -p "$folder"
page=$folder/index.html

# block FILE LANGUAGE: its first code block in that language
block() {
    awk -v start='```'"$2" '$0 == start { inside = 1; next } /^```/ { if (inside) exit } inside' "$1"
}

# field FILE NAME: a number or string of a JSON object of one level a line
field() {
    sed -n 's/.*"'"$2"'": *"\{0,1\}\([^",}]*\).*/\1/p' "$1" | head -n 1
}

# size_of INFO: the film's shape, its longer side $side pixels
size_of() {
    awk -v w="$(field "$1" width)" -v h="$(field "$1" height)" -v most="$side" 'BEGIN {
        longer = w > h ? w : h
        most = longer < most ? longer : most
        printf "%dx%d\n", w * most / longer + 0.5, h * most / longer + 0.5 }'
}

casts_caustics() {
    tr -d ' \n' <"$1" | grep -q '"casting_caustics":\["'
}

has_media() {
    tr -d ' \n' <"$1" | grep -q '"media":\[{'
}

# picture NAME: the picture as the page shows it
picture() {
    printf '<td><a href="%s.png"><img src="%s.png" alt="%s"></a></td>' "$1" "$1" "$1"
}

# row NAME WHAT OTHER: ours beside another picture, and how they differ
row() {
    local name=$1 what=$2 other=$3
    "$nephroid" compare "$folder/$name.exr" "$folder/$other.exr" --json \
        -o "$folder/$other-error.png" >"$folder/$other.json"
    rows+=("$folder/$name.png" "$folder/$other.png" "$folder/$other-error.png")
    {
        printf '<tr>'
        picture "$name"
        picture "$other"
        picture "$other-error"
        awk -v a="$(field "$folder/$other.json" mean_a)" -v b="$(field "$folder/$other.json" mean_b)" \
            -v relmse="$(field "$folder/$other.json" relmse)" -v flip="$(field "$folder/$other.json" flip)" \
            -v what="$what" 'BEGIN {
            printf "<td>%s<br>brightness %+.2f %%<br>relMSE %.4f<br>FLIP %.3f</td></tr>\n",
                what, 100 * (a / b - 1), relmse, flip }'
    } >>"$page"
    printf '  %-28s %s\n' "$what" "$(tail -n 1 "$page" | sed 's/.*<br>brightness/brightness/; s/<br>/, /g; s/<.*//')"
}

# scene NAME FILE [REFERENCE]
scene() {
    local name=$1 file=$2 reference=${3:-} info=$folder/$1-info.json size other=path
    echo "$name"
    if ! "$nephroid" info "$file" --json >"$info" 2>"$folder/$name.log"; then
        printf '<h2>%s</h2><pre>%s</pre>\n' "$name" \
            "$(sed "s|$root/||g; s/&/\&amp;/g; s/</\&lt;/g" "$folder/$name.log")" >>"$page"
        sed 's/^/  /' "$folder/$name.log"
        return
    fi
    size=$(size_of "$info")
    if has_media "$info"; then
        other=auto # vcm sees none
    elif casts_caustics "$info"; then
        other=vcm
    fi
    "$nephroid" render "$file" --quiet --size "$size" --time "$seconds" \
        -o "$folder/$name.exr" -o "$folder/$name.png" 2>>"$folder/$name.log"
    "$nephroid" render "$file" --quiet --size "$size" --time "$seconds" --integrator "$other" \
        --seed 7 -o "$folder/$name-$other.exr" -o "$folder/$name-$other.png" 2>>"$folder/$name.log"
    printf '<h2>%s</h2><table>\n' "$name" >>"$page"
    if [ -f "$reference" ]; then
        "$nephroid" image "$reference" --size "$size" -o "$folder/$name-reference.exr"
        "$nephroid" image "$folder/$name-reference.exr" -o "$folder/$name-reference.png"
        row "$name" "the reference" "$name-reference"
    fi
    row "$name" "--integrator $other" "$name-$other"
    echo '</table>' >>"$page"
}

cat >"$page" <<HTML
<!DOCTYPE html>
<html lang="en">
<meta charset="utf-8">
<meta name="viewport" content="width=device-width">
<title>Nephroid: every scene, without options</title>
<style>
body { font: 16px/1.5 sans-serif; max-width: 75em; margin: 2em auto; padding: 0 1em; color: #222; background: #fff }
img { max-width: 100%; display: block } td { padding: 0 8px 8px 0; vertical-align: top }
td:last-child { white-space: nowrap } pre { white-space: pre-wrap }
@media (prefers-color-scheme: dark) { body { color: #ddd; background: #181818 } a { color: #8bf } }
</style>
<h1>Every scene, without options</h1>
<p>On the left what <code>nephroid render SCENE</code> makes, given only a size and $seconds seconds; beside it the
reference, or the same scene by another algorithm; then where they differ: black where they agree, red where ours is
brighter, blue where it is darker, white where it is off by half or more.</p>
HTML
for file in "$root"/scenes/*/*.pbrt; do
    scene "$(basename "$file" .pbrt)" "$file"
done
block "$root/README.md" pbrt >"$folder/readme.pbrt"
scene readme "$folder/readme.pbrt"
if [ -d "$shared" ]; then
    for file in "$shared"/bitterli/*/scene-v4.pbrt; do
        at=$(dirname "$file")
        scene "bitterli-$(basename "$at")" "$file" "$at/TungstenRender.exr"
    done
    for file in "$shared"/spectral/*.pbrt; do
        scene "spectral-$(basename "$file" .pbrt)" "$file" "${file%.pbrt}.exr"
    done
fi
echo '</html>' >>"$page"
"$nephroid" image "${rows[@]}" --columns 3 -o "$folder/sheet.png"
echo "the page: $page"
echo "all of it: $folder/sheet.png"
