#!/usr/bin/env bash
# README's words in a root where nothing is: a Debian of its own, made by debootstrap, in which
# `./dev install` gets its packages, a program in C is built against what was installed, and
# `./dev uninstall` leaves nothing.
# usage: fresh_root.sh SOURCE_ROOT ROOT [SUITE]; as root. ROOT is made anew and removed if all is
# well. What apt has as its mirror here is the mirror there.
set -euo pipefail

source=$1
root=$2
suite=${3:-bookworm}
house=/srv/nephroid # where the sources are, in the root

mirror() {
    local sites
    sites=$(apt-get indextargets --format '$(REPO_URI)' 'Created-By: Packages' |
        grep -v -e security -e '^file:' || true)
    head -n 1 <<<"${sites:-http://deb.debian.org/debian/}"
}

make_root() {
    local network
    rm -rf --one-file-system "$root"
    mkdir -p "$root"
    debootstrap --variant=minbase "$suite" "$root" "$(mirror)" >"$root.log" ||
        { tail -n 5 "$root.log" >&2; return 1; }
    rm "$root.log"
    for network in /etc/resolv.conf /etc/hosts; do
        [ ! -f "$network" ] || cat "$network" >"$root$network"
    done
    grep -rhi '^ *acquire::https\?::proxy' /etc/apt/apt.conf.d >"$root/etc/apt/apt.conf.d/90proxy" ||
        true
    mkdir -p "$root$house"
    git -C "$source" ls-files -z --cached --others --exclude-standard |
        (cd "$source" && while IFS= read -r -d '' file; do
            [ ! -e "$file" ] || printf '%s\0' "$file"
        done) |
        tar -C "$source" --null -T - -c | tar -C "$root$house" -x
}

# inside COMMAND...: in the root, with mounts that end with it.
inside() {
    unshare --mount -- sh -c 'mount -t proc proc "$1/proc" && shift && exec "$@"' - "$root" \
        env -i HOME=/root PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin \
        LANG=C.UTF-8 NEPHROID_JOBS="${NEPHROID_JOBS:-$(nproc)}" \
        ${http_proxy:+http_proxy="$http_proxy"} ${https_proxy:+https_proxy="$https_proxy"} \
        chroot "$root" "$@"
}

# block LANGUAGE: README's first code block in that language.
block() {
    awk -v language="$1" '/^```/ && inside { exit }
        inside
        $0 == "```" language { inside = 1 }' "$source/README.md"
}

# What is below /usr/local, but folders.
list_installed() {
    inside find /usr/local ! -type d | LC_ALL=C sort
}

write_example() {
    local try=$root/root/try
    mkdir -p "$try"
    block c >"$try/render.c"
    block pbrt | sed 's/480/48/; s/360/36/' >"$try/ball.pbrt"
    grep '^cc render\.c ' "$source/README.md" >"$try/build.sh"
    grep '^nephroid render ball\.pbrt ' "$source/README.md" |
        sed 's/$/ --passes 1/' >"$try/render.sh"
    cat >"$try/all.sh" <<'TEXT'
set -eux
cd /root/try
sh -eux render.sh
test -s ball.png
sh -eux build.sh
sed -i 's/^WorldBegin/Integrator "path"\n&/' ball.pbrt
./render ball.pbrt example.png
test -s example.png
test -x /usr/local/bin/nephroid-view
nephroid-view --help >help
TEXT
}

make_root
list_installed >"$root/before"
write_example
inside sh -c "cd $house && ./dev install"
inside sh /root/try/all.sh
list_installed >"$root/installed"
grep -q /bin/nephroid-view "$root/installed"
inside sh -c "cd $house && ./dev uninstall"
list_installed >"$root/after"
diff "$root/before" "$root/after"
if inside pkg-config --exists nephroid || inside ldconfig -p | grep libnephroid; then
    echo 'fresh_root: the loader or pkg-config still finds the library' >&2
    exit 1
fi
echo "fresh_root: $(LC_ALL=C comm -13 "$root/before" "$root/installed" | wc -l) files were installed and removed in a $suite"
rm -rf --one-file-system "$root"
