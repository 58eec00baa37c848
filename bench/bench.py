#!/usr/bin/env python3
"""One table of how near to the machine's limit, and to peers, everything runs.

usage: bench/bench.py [--build DIR] [--peers] [--long] [--quick] [ROW...]

Prints a table in markdown and writes DIR/bench/bench.json. What is compared takes turns,
five times, and the median counts; times are those of the processor (user and system), so
that others on the machine disturb little, but where threads or waiting are what is asked:
there the clock counts, and only a quiet machine tells the truth. ROW: only rows whose
group is named (map, trace, iteration, sppm, threads, photons, first, load, auto, view).
docs/performance.md explains each row.
"""
import argparse
import dataclasses
import json
import os
import pathlib
import platform
import re
import shutil
import statistics
import subprocess
import sys
import tempfile
import time

import peers

ROOT = pathlib.Path(__file__).resolve().parent.parent
SCENES = ROOT / "scenes"
OURS = ROOT / "bench/scenes"
CORNELL = SCENES / "cornell-box/cornell-box.pbrt"
GLASS = ROOT / "bench/equal_time/scenes/cornell-glass.pbrt"


@dataclasses.dataclass
class Row:
    """ours and peer in the unit; ratio as the target counts it, the larger the better
    unless the target begins with <."""
    what: str
    against: str
    unit: str
    ours: float
    peer: float | None
    ratio: float | None
    target: str
    note: str = ""


class Bench:
    """Where things are, and how often they are run."""

    def __init__(self, asked, folder):
        self.build = asked.build.resolve()
        self.rounds = 1 if asked.quick else 5
        self.peers = asked.peers
        self.long = asked.long
        self.folder = pathlib.Path(folder)

    def tool(self, name, *arguments):
        """What one of bench/*.c prints."""
        done = subprocess.run([self.build / "bench" / name, *map(str, arguments)],
                              check=True, stdout=subprocess.PIPE, text=True)
        return done.stdout

    def render(self, scene, *options):
        """A command that renders to a file of its own."""
        return [self.build / "cli/nephroid", "render", scene, "-q", "-o",
                self.folder / "ours.exr", *map(str, options)]

    def run(self, command):
        """Seconds of processor and of the clock."""
        start = time.monotonic()
        child = subprocess.Popen([str(word) for word in command],
                                 stdout=subprocess.DEVNULL, cwd=self.folder)
        _, status, used = os.wait4(child.pid, 0)
        child.returncode = os.waitstatus_to_exitcode(status)
        if child.returncode:
            sys.exit(f"bench: {' '.join(map(str, command))}: exit {child.returncode}")
        return used.ru_utime + used.ru_stime, time.monotonic() - start

    def turns(self, *commands, clock=False):
        """Medians, a command each, in seconds of processor or of the clock."""
        times = [[] for _ in commands]
        for _ in range(self.rounds):
            for command, seconds in zip(commands, times):
                seconds.append(self.run(command)[clock])
        return [statistics.median(seconds) for seconds in times]


# ---- Groups of rows ----

def map_rows(bench):
    """Finding and weighing photons against nanoflann; the better of our maps."""
    text = bench.tool("bench_map", 1000000, 4096 if bench.rounds == 1 else 32768)
    wanted = {"within, about 50": ("20", "8"), "within, about 200": ("30", "8"),
              "estimate of about 50": ("6", "4"), "estimate of about 200": ("6", "4"),
              "nearest 50": ("7", "7"), "nearest 200": ("18", "18")}
    section = None
    for line in text.splitlines():
        if line.startswith("IN "):
            section = line.startswith("IN PIXEL")
        found = re.match(r"(\D.*?\d+)\s+([\d.]+)\s+([\d.]+)\s+([\d.]+) us", line)
        if not found or found[1] not in wanted:
            continue
        ours, peer = min(float(found[2]), float(found[3])), float(found[4])
        order = "pixel order" if section else "no order"
        yield Row(f"{found[1]} of 1 M photons, {order}", "nanoflann", "µs", ours,
                  peer or None, peer / ours if peer else None,
                  f"≥ {wanted[found[1]][0 if section else 1]}")


def trace_rows(bench):
    """Photons and camera paths against Embree on the same rays, a thread each."""
    triangles = [16, 4000, 262144, 4000000] if bench.rounds > 1 else [16, 4000]
    for what, name in (("photons", "photon pass"), ("path", "path tracer")):
        text = bench.tool("bench_trace", what, CORNELL, *triangles)
        for line in text.splitlines():
            _, scene, rays, embree, ours, ratio = line.split("\t")
            scene = f"{scene} triangles" if scene.isdigit() else "Cornell box"
            yield Row(f"{name}, {scene}", "Embree, same rays", "µs a ray", float(ours),
                      float(embree), float(ratio), "≥ 0.5", f"{rays} rays")


def iteration_rows(bench):
    """vcm and ppm as SmallVCM has them: its scenes, radius and path length."""
    program = peers.find("NEPHROID_SMALLVCM") if bench.peers else None
    few, many = 1, 3
    for scene in (0, 1):
        for ours, theirs in (("all", "vcm"), ("ppm", "ppm")):
            commands = [bench.render(
                OURS / f"smallvcm-{scene}.pbrt", "-j1", "--integrator", "vcm", "--denoise",
                "off", "--spp", 1, "--size", "512x512", "--passes", passes, "-s", "maxdepth=10", "-s",
                f"vcm_strategies={ours}", "-s", "photons=262144") for passes in (few, many)]
            if program:
                commands += [peers.smallvcm(program, scene, theirs, n, bench.folder)
                             for n in (few, many)]
            times = bench.turns(*commands)
            mine = (times[1] - times[0]) / (many - few)
            peer = (times[3] - times[2]) / (many - few) if program else None
            yield Row(f"{theirs} iteration, SmallVCM's box {scene}, 512 × 512",
                      "SmallVCM", "s", mine, peer, peer / mine if peer else None, "≥ 1.5")


def sppm_rows(bench):
    """A pass of a hundred thousand photons and a camera ray a pixel of 256²."""
    program = peers.find("NEPHROID_PBRT") if bench.peers else None
    few, many, photons, side = 4, 20, 100000, 256
    scenes = {"ring": SCENES / "ring/ring.pbrt", "glass Cornell": GLASS,
              "point light, glass": SCENES / "point-light/point-light.pbrt",
              "Cornell": CORNELL}
    for name, scene in scenes.items():
        commands = [bench.render(scene, "-j1", "--integrator", "sppm", "--denoise", "off",
                                 "--size",
                                 f"{side}x{side}", "--passes", passes, "-s",
                                 "maxdepth=16", "-s", f"photons={photons}")
                    for passes in (few, many)]
        if program:
            commands += [peers.pbrt(program, scene, photons, n, side, bench.folder)
                         for n in (few, many)]
        times = bench.turns(*commands)
        mine = (times[1] - times[0]) / (many - few)
        peer = (times[3] - times[2]) / (many - few) if program else None
        yield Row(f"SPPM pass, {name}", "pbrt-v4", "s", mine, peer,
                  peer / mine if peer else None, "≥ 4")


def thread_rows(bench):
    """From the start of the process to the file."""
    for integrator in ("auto", "path", "photonmap", "sppm", "vcm"):
        one, two = bench.turns(*(bench.render(GLASS, f"-j{n}", "--integrator", integrator,
                                              "--passes", 4, "--size", "256x256")
                                 for n in (1, 2)), clock=True)
        yield Row(f"{integrator}, 2 threads", "1 thread, by the clock", "s", two, one,
                  one / two, "≥ 1.9")
        times = [list(map(float, bench.tool("bench_serial", integrator, GLASS,
                                            bench.folder / "ours.exr").split()))
                 for _ in range(bench.rounds)]
        whole, serial = (statistics.median(column) for column in zip(*times))
        yield Row(f"{integrator}, 2 threads, by what is serial", "1 thread", "s",
                  serial + (whole - serial) / 2, whole,
                  whole / (serial + (whole - serial) / 2), "≥ 1.9",
                  f"{100 * serial / whole:.1f} % serial")


def photon_rows(bench):
    """Time and memory of photons, a decade after the other."""
    decades = range(5, 9 if bench.long else 8)
    before = None
    for decade in decades:
        n = 10 ** decade
        kept = bench.folder / "statistics.json"
        command = bench.render(CORNELL, "-j1", "--integrator", "photonmap", "--passes", 1,
                               "--spp", 1, "--size", "32x32", "--denoise", "off", "-s",
                               f"photons={n}", "--stats", kept)
        took, = bench.turns(command)
        said = json.loads(kept.read_text())
        stored = sum(kind["stored"] for kind in said["photons"].values())
        yield Row(f"10^{decade} photons", "10 times the decade before", "s", took,
                  before and 10 * before, took / (10 * before) if before else None,
                  "< 1.3", f"peak {said['memory']['peak'] / 2 ** 20:.0f} MiB")
        yield Row(f"10^{decade} photons, kept", "48 B", "B a photon",
                  said["memory"]["photons"] / stored, 48.0,
                  said["memory"]["photons"] / stored / 48.0, "< 1")
        before = took


def first_rows(bench):
    """The first picture, as rendered, from the start of the process to the file."""
    command = bench.render(CORNELL, "--passes", 1, "-s", "first_spp=1", "--size", "256x256",
                           "--denoise", "off")
    took, = bench.turns(command, clock=True)
    worked, = bench.turns(command)
    yield Row("first picture of the Cornell box, 256 × 256", "the clock", "s", took, 0.3,
              took / 0.3, "< 1", f"{worked:.2f} s of processor, {os.cpu_count()} threads")


def load_rows(bench):
    """A mesh, from its file to what can be rendered."""
    text = bench.tool("bench_load", *([] if bench.rounds > 1 else [1000000]))
    whole = re.search(r"whole\s+([\d.]+) s, ([\d.]+)", text)
    triangles = int(text.split()[0])
    yield Row(f"loading {triangles} triangles", "reading bytes, Embree's build", "s",
              float(whole[1]), float(whole[1]) / float(whole[2]), float(whole[2]), "< 2")


def auto_rows(bench):
    """What `auto` costs where photons bring nothing."""
    found = re.search(r"time ([\d.]+) of path", bench.tool("bench_auto"))
    yield Row("auto in a dull room", "path", "path's time", float(found[1]), 1.0,
              float(found[1]), "< 1.1")


def view_rows(bench):
    """The window, where it was built and there is Xvfb: how soon it shows a picture."""
    program = bench.build / "bench/bench_view"
    if not program.exists() or not shutil.which("xvfb-run"):
        return
    done = subprocess.run(["xvfb-run", "-a", "-s", "-screen 0 1280x1024x24", program],
                          stdout=subprocess.PIPE, text=True, check=True,
                          env=os.environ | {"GTK_A11Y": "none",
                                            "XDG_CONFIG_HOME": "/nonexistent"})
    print(done.stdout, file=sys.stderr)
    took = float(re.search(r"first picture\s+(\d+) ms", done.stdout)[1]) / 1e3
    yield Row("first picture in the window", "the clock", "s", took, 0.3, took / 0.3,
              "< 1")


GROUPS = {"map": map_rows, "trace": trace_rows, "iteration": iteration_rows,
          "sppm": sppm_rows, "threads": thread_rows, "photons": photon_rows,
          "first": first_rows, "load": load_rows, "auto": auto_rows, "view": view_rows}


# ---- What is said ----

def compiler(build):
    """The first line of what it says of itself."""
    words = json.loads((build / "compile_commands.json").read_text())[0]["command"].split()
    program = words[1] if words[0].endswith("ccache") else words[0]
    done = subprocess.run([program, "--version"], stdout=subprocess.PIPE, text=True)
    return done.stdout.splitlines()[0]


def machine(build):
    """What the figures hold for."""
    cpu = re.search(r"model name\s*: (.*)", pathlib.Path("/proc/cpuinfo").read_text())
    options = json.loads((build / "meson-info/intro-buildoptions.json").read_text())
    chosen = {o["name"]: o["value"] for o in options}
    return {"cpu": cpu[1] if cpu else platform.processor(), "processors": os.cpu_count(),
            "compiler": compiler(build),
            "built_for": chosen.get("cpu"), "buildtype": chosen.get("buildtype"),
            "b_lto": chosen.get("b_lto"), "system": platform.platform(),
            "load": os.getloadavg()[0],
            "commit": subprocess.run(["git", "-C", ROOT, "describe", "--always", "--dirty"],
                                     stdout=subprocess.PIPE, text=True).stdout.strip()}


def meets(row):
    if row.ratio is None:
        return ""
    relation, wanted = row.target.split()
    good = row.ratio < float(wanted) if relation == "<" else row.ratio >= float(wanted)
    return "yes" if good else "no"


def print_row(row):
    def cell(x):
        return "absent" if x is None else f"{x:.3g}"
    print(f"| {row.what} | {row.against} | {row.unit} | {cell(row.ours)} | "
          f"{cell(row.peer)} | {'' if row.ratio is None else f'{row.ratio:.2f}'} | "
          f"{row.target} | {meets(row)} | {row.note} |", flush=True)


def print_head(on, bench):
    print(f"{on['cpu']}, {on['processors']} processors (load {on['load']:.1f}), "
          f"{on['compiler']}, cpu={on['built_for']}, commit {on['commit']}\n")
    if bench.peers and peers.absent():
        print(f"absent peers: {', '.join(peers.absent())}\n")
    print("| what | against | unit | ours | that | ratio | target | met | |")
    print("|---|---|---|---|---|---|---|---|---|", flush=True)


def main():
    arguments = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    arguments.add_argument("--build", type=pathlib.Path, default=ROOT / "build")
    arguments.add_argument("--peers", action="store_true",
                           help="also run programs of others: see peers.py")
    arguments.add_argument("--long", action="store_true", help="up to 10^8 photons")
    arguments.add_argument("--quick", action="store_true", help="once, not five times")
    arguments.add_argument("rows", nargs="*", metavar="ROW",
                           help=f"only these of {', '.join(GROUPS)}")
    asked = arguments.parse_args()
    for name in asked.rows:
        if name not in GROUPS:
            arguments.error(f"no row '{name}': expected {', '.join(GROUPS)}")
    rows = []
    with tempfile.TemporaryDirectory(prefix="nephroid-bench-") as folder:
        bench = Bench(asked, folder)
        on = machine(bench.build)
        print_head(on, bench)
        for name, group in GROUPS.items():
            if asked.rows and name not in asked.rows:
                continue
            for row in group(bench):
                rows.append(dataclasses.asdict(row) | {"group": name, "met": meets(row)})
                print_row(row)
    kept = bench.build / "bench/bench.json"
    kept.write_text(json.dumps({"machine": on, "rows": rows}, indent=1,
                               ensure_ascii=False) + "\n")
    print(f"\nas JSON: {kept}", file=sys.stderr)


if __name__ == "__main__":
    main()
