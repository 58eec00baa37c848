#!/bin/bash
# One picture by ranks on several hosts, each a network namespace of this machine with an
# address, a name and processes of its own, joined by a bridge. Needs root; says how long jobs of
# 1, 2 and more hosts take, that their pictures are alike, and what the network carried.
# usage: mpi_hosts.sh NEPHROID_MPI NEPHROID SCENE [HOSTS [PASSES [RATE]]]; RATE: of each host's network card, as 1gbit
set -u
many=$(realpath "$1")
one=$(realpath "$2")
scene=$(realpath "$3")
hosts=${4:-3}
passes=${5:-32}
rate=${6:-}
work=$(mktemp -d) || exit 99
bridge=nephbr$$

clean() {
    for i in $(seq 0 "$hosts"); do ip netns del "neph$$-$i" 2>/dev/null; done
    ip link del "$bridge" 2>/dev/null
    rm -rf "$work"
}
trap clean EXIT

# host NUMBER: a namespace with the address 10.77.0.NUMBER + 1
host() {
    local name=neph$$-$1 link=nv$$-$1
    ip netns add "$name" && ip link add "$link" type veth peer name eth0 netns "$name" &&
        ip link set "$link" master "$bridge" up &&
        ip -n "$name" addr add "10.77.0.$(($1 + 1))/24" dev eth0 &&
        ip -n "$name" link set eth0 up && ip -n "$name" link set lo up || return 1
    [ -z "$rate" ] || tc -n "$name" qdisc add dev eth0 root tbf rate "$rate" burst 256kb latency 50ms
}

if ! ip link add "$bridge" type bridge 2>/dev/null || ! ip link set "$bridge" up; then
    echo "network namespaces are not to be had here" >&2
    exit 77
fi
for i in $(seq 0 "$hosts"); do host "$i" || exit 77; done

# What mpirun calls in place of ssh: HOST COMMAND..., HOST being an address.
cat >"$work/rsh" <<TEXT
#!/bin/bash
while [[ \$1 == -* ]]; do shift; done
number=\$((\${1##*.} - 1))
shift
exec ip netns exec neph$$-\$number unshare --uts sh -c "hostname host\$number; \$*"
TEXT
chmod +x "$work/rsh"
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
export OMPI_MCA_mpi_yield_when_idle=1

# job N PASSES FILE: by one rank on each of N hosts; the root is on the first of them
job() {
    local list
    list=$(seq -f '10.77.0.%g:1' -s, 2 $(($1 + 1)))
    ip netns exec "neph$$-0" unshare --uts sh -c 'hostname mpihead; exec "$@"' sh \
        mpirun --mca plm_rsh_agent "$work/rsh" --mca btl tcp,self --mca btl_tcp_if_include 10.77.0.0/24 \
        --mca oob_tcp_if_include 10.77.0.0/24 --host "$list" -n "$1" \
        "$many" render "$scene" -j1 -q --passes "$2" --stats "$3.json" -o "$3.exr"
}

carried() { # bytes that host 1, the root's, sent and received
    ip netns exec "neph$$-1" cat /sys/class/net/eth0/statistics/tx_bytes /sys/class/net/eth0/statistics/rx_bytes |
        awk '{ sum += $1 } END { print sum }'
}

echo "| hosts | wall s | MB through the root's card | rmse over mean, against one process |"
echo "|---|---|---|---|"
"$one" render "$scene" -q -j1 --passes "$passes" -o "$work/one.exr" || exit 1
n=1
while [ "$n" -le "$hosts" ]; do
    before=$(carried)
    TIMEFORMAT='%R'
    { time job "$n" "$passes" "$work/$n" >"$work/log" 2>&1; } 2>"$work/time" || {
        cat "$work/log" >&2
        exit 1
    }
    difference=$("$one" compare "$work/$n.exr" "$work/one.exr" --json |
        awk '/"mean_a"/ { m = $2 + 0 } /"rmse"/ { r = $2 + 0 } END { printf "%.1e", r / m }')
    awk -v n="$n" -v b="$(($(carried) - before))" -v d="$difference" \
        '{ printf "| %d | %.1f | %.1f | %s |\n", n, $1, b / 1e6, d }' "$work/time"
    awk -v d="$difference" 'BEGIN { exit !(d < 1e-5) }' || exit 1
    n=$((n * 2))
done
