#!/usr/bin/env python3
"""What each algorithm needs to come as near to the truth, against the default's time.

usage: bench/equal_time/equal_time.py [--quick | --small | --time] [--build DIR] [--report]
       [SCENE...]

Runs equal_time (equal_time.c) on the scenes beside it and those of ../shared, and writes
points.tsv, error.svg (error against seconds, log-log) and table.txt to DIR/equal_time, where
references are kept too: `--quick` takes some minutes, `--small` (all scenes at 128 x 128, three
seeds) three quarters of an hour of two processors, all some hours. Seconds are the processor's;
`--time` asks for what all threads have after a quarter of a second to four of the clock, by five
seeds (an hour and a half of a quiet machine, and references). `--report` puts table and curves
into docs/report too, `--points FILE` reads what was measured before. Each algorithm stands there
twice: as rendered, and without its noise.
"""
import argparse
import collections
import math
import pathlib
import statistics
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
REPORT = ROOT / "docs/report"
SHARED = ROOT.parent / "shared/refs"
LEVELS = (0.05, 0.015, 0.005)  # of relMSE
FLIPS = (0.2, 0.1, 0.06)
QUICK = ["cornell", "cornell-glass", "ball", "window"]
QUICKLY = "--size 64x64 --seconds 1.5 --longest 12 --seeds 3".split()
SMALL_ONES = "--size 128x128 --seconds 3 --longest 12 --seeds 3".split()
TIMED = "--by time --seconds 4 --longest 30 --seeds 5".split()
ALL = QUICK + ["glossy", "textured", "lamps", "water", "prism", "fog"]
ELSEWHERE = [ROOT / "scenes/ring/ring.pbrt", SHARED / "bitterli/coffee/scene-v4.pbrt",
             SHARED / "bitterli/veach-mis/scene-v4.pbrt"]
COLOURS = {"auto": "#000000", "path": "#0072b2", "sppm": "#d55e00", "vcm": "#009e73",
           "final": "#cc79a7"}


def build(folder):
    subprocess.run(["ninja", "-C", folder, "bench/equal_time"], check=True,
                   stdout=subprocess.DEVNULL)


def measure(folder, scenes, options):
    """Lines of equal_time, kept as they come."""
    out = folder / "equal_time"
    out.mkdir(exist_ok=True)
    command = [folder / "bench/equal_time", "--cache", out, *options, *scenes]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as run, \
            open(out / "points.tsv", "w") as kept:
        for line in run.stdout:
            kept.write(line)
            kept.flush()
    if run.returncode:
        sys.exit(run.returncode)
    return out / "points.tsv"


def read(path):
    """{scene: {kind: [(seconds, relMSE, FLIP)]}}: medians over seeds; and {scene: (relMSE of
    the reference, relMSE and FLIP of one of its two renders to the other)}"""
    seeds = collections.defaultdict(list)
    floors = {}
    for line in path.read_text().splitlines():
        scene, kind, _, passes, *numbers = line.split("\t")
        numbers = [float(x) for x in numbers[:3]]
        if kind == "floor":
            floors[scene] = numbers
        else:
            seeds[scene, kind, int(passes)].append(numbers)
    curves = collections.defaultdict(lambda: collections.defaultdict(list))
    for (scene, kind, _), runs in sorted(seeds.items()):
        curves[scene][kind].append(tuple(statistics.median(x) for x in zip(*runs)))
    return curves, floors


def time_to(curve, level, column):
    """Seconds to an error and how it is known: " ": between points of a log-log curve; "<":
    its first picture is no worse; "~": by the slope of its last points, beyond them. None: it
    is nowhere near."""
    points = [(math.log(p[0]), math.log(p[column])) for p in curve]
    wanted = math.log(level)
    if points[0][1] <= wanted:
        return curve[0][0], "<"
    for (t0, e0), (t1, e1) in zip(points, points[1:]):
        if e1 <= wanted < e0:
            return math.exp(t0 + (t1 - t0) * (e0 - wanted) / (e0 - e1)), " "
    (t0, e0), (t1, e1) = points[-2:] if len(points) > 1 else (points[0],) * 2
    if e1 >= e0 or e1 - wanted > 1.5 * (e0 - e1):
        return None, "~"
    return math.exp(t1 + (t1 - t0) * (e1 - wanted) / (e0 - e1)), "~"


def table(curves, floors, shown):
    """Seconds of each to each error; of the default over the best of the others."""
    kinds = [k + "+" * shown for k in COLOURS]
    lines = []
    for column, name, levels in ((1, "relMSE", LEVELS), (2, "FLIP", FLIPS)):
        lines.append(f"{'seconds to ' + name:28}" + "".join(f"{k:>9}" for k in kinds) +
                     f"{'auto/best':>11}{'auto/path':>11}{'auto/sppm':>11}")
        for scene, by_kind in curves.items():
            floor = floors.get(scene, (0, 0, 0))[0 if column == 1 else 2]
            for level in levels:
                if level < floor:
                    continue
                lines.append(row(scene, by_kind, kinds, level, column))
    return "\n".join(lines)


def whole_text(curves, floors):
    """Both tables, and what references differ by."""
    return "\n".join([
        "as rendered", "", table(curves, floors, False), "",
        "without noise, with the time to take it out", "", table(curves, floors, True), "",
        "<: its first picture is no worse; ~: by its last points, beyond them", "",
        "relMSE of the reference; relMSE and FLIP between its two renders:"] + [
            f"    {s:16} {f[0]:.5f} {f[1]:.5f} {f[2]:.3f}" for s, f in floors.items()])


def row(scene, by_kind, kinds, level, column):
    found = {k: time_to(by_kind[k], level, column) if by_kind.get(k) else (None, "~")
             for k in kinds}
    cells = "".join(
        "        -" if t is None else f"{t:8.2f}{mark}" for t, mark in found.values())
    mine = found[kinds[0]][0]
    rest = [found[k][0] for k in kinds[1:] if found[k][0]]
    def ratio(t):
        return f"{mine / t:11.2f}" if mine and t else f"{'-':>11}"
    return (f"{scene:20}{level:7.3f} {cells}" + ratio(min(rest, default=None)) +
            ratio(found[kinds[1]][0]) + ratio(found[kinds[2]][0]))


def panel(by_kind, scene, x0, y0, side):
    """One scene's curves: 0.1 .. 1000 s, relMSE 1 .. 0.0001."""
    def place(seconds, error):
        x = x0 + side * (math.log10(seconds) + 1.5) / 4
        y = y0 - side * max(min(math.log10(error), 0), -4) / 4
        return f"{x:.1f},{y:.1f}"
    out = [f'<rect x="{x0}" y="{y0}" width="{side}" height="{side}" fill="none" '
           'stroke="#999"/>', f'<text x="{x0 + 4}" y="{y0 + side - 6}">{scene}</text>']
    for decade in (1, 2, 3):
        y = y0 + side * decade / 4
        out.append(f'<path d="M{x0} {y}h{side}" stroke="#ddd"/>')
        out.append(f'<text x="{x0 - 4}" y="{y + 4}" text-anchor="end">1e-{decade}</text>')
    for decade in (-1, 0, 1, 2):
        x = x0 + side * (decade + 1.5) / 4
        out.append(f'<path d="M{x} {y0}v{side}" stroke="#ddd"/>')
        out.append(f'<text x="{x}" y="{y0 + side + 13}" text-anchor="middle">'
                   f'{10 ** decade:g} s</text>')
    for kind, curve in by_kind.items():
        points = " ".join(place(p[0], p[1]) for p in curve)
        dashes = ' stroke-dasharray="4 3"' if kind.endswith("+") else ""
        out.append(f'<polyline points="{points}" fill="none" '
                   f'stroke="{COLOURS[kind.rstrip("+")]}"{dashes} '
                   f'stroke-width="{2.5 if kind.startswith("auto") else 1.2}"/>')
    return out


def plot(curves):
    side, gap, columns = 220, 50, 4
    rows = -(-len(curves) // columns)
    size = (gap + columns * (side + gap), 2 * gap + rows * (side + gap))
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{size[0]}" height="{size[1]}" '
           'font-family="sans-serif" font-size="11">',
           '<rect width="100%" height="100%" fill="white"/>']
    for i, (kind, colour) in enumerate(COLOURS.items()):
        out.append(f'<text x="{gap + 80 * i}" y="25" fill="{colour}">{kind}</text>')
    out.append(f'<text x="{gap + 80 * len(COLOURS)}" y="25">dashed: without noise</text>')
    for i, (scene, by_kind) in enumerate(curves.items()):
        out += panel(by_kind, scene, gap + i % columns * (side + gap),
                     gap + i // columns * (side + gap), side)
    return "\n".join(out + ["</svg>\n"])


def main():
    arguments = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    arguments.add_argument("--quick", action="store_true")
    arguments.add_argument("--small", action="store_true")
    arguments.add_argument("--time", action="store_true")
    arguments.add_argument("--build", type=pathlib.Path, default=ROOT / "build")
    arguments.add_argument("--report", action="store_true")
    arguments.add_argument("--points", type=pathlib.Path, help="measured before")
    arguments.add_argument("scenes", nargs="*", type=pathlib.Path)
    asked = arguments.parse_args()
    scenes = asked.scenes or [HERE / f"scenes/{s}.pbrt"
                              for s in (QUICK if asked.quick else ALL)]
    if not asked.scenes and not asked.quick:
        scenes += [s for s in ELSEWHERE if s.exists()]
    options = (QUICKLY if asked.quick else SMALL_ONES if asked.small else
               TIMED if asked.time else [])
    if not asked.points:
        build(asked.build)
    points = asked.points or measure(asked.build, scenes, options)
    curves, floors = read(points)
    text = whole_text(curves, floors)
    print(text)
    (points.parent / "table.txt").write_text(text + "\n")
    (points.parent / "error.svg").write_text(plot(curves))
    if asked.report:
        name = "equal_time_by_time" if asked.time else "equal_time"
        (REPORT / f"{name}.txt").write_text(text + "\n")
        (REPORT / f"figures/{name}.svg").write_text(plot(curves))


if __name__ == "__main__":
    main()
