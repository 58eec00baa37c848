#!/usr/bin/env python3
"""Makes the report's experiments: pictures, plots and tables of what each parameter does.

usage: tools/experiments.py PROGRAM FOLDER [--quick] [EXPERIMENT...]

Writes docs/report/figures/*.jpg and *.svg and docs/report/results.md, from renders that are kept in
FOLDER; with --quick smaller ones, to FOLDER/report instead. Where EXPERIMENTs are named, only their
sections are made anew. Every figure in the text is taken from the renders: nothing is typed in.
Times are seconds of all processors together, so that a busy machine finds what a quiet one does.
"""
import argparse
import pathlib
import re
import subprocess

import cornell
from closed_forms import cardioid, nephroid, off_curve, patch, pixels
from plot import log_log
from renders import ROOT, Kept

WATER, BOX, RING = ("scenes/water-box/water-box.pbrt", "scenes/point-light/point-light.pbrt",
                    "scenes/cardioid/cardioid.pbrt")
CORNER, BALLS = "scenes/corner/corner.pbrt", "scenes/spheres/spheres.pbrt"
RAW = ["--denoise", "off"]
CLASSIC = [*RAW, "--integrator", "photonmap", "--passes", "1", "--spp", "4", "--set", "alpha=1"]
ALL_BY_PHOTONS = [*CLASSIC, "--set", "direct_illumination=false"]
PLAIN = [*ALL_BY_PHOTONS, "--set", "edges=false"]  # as in the texts: what probes edges is grain of its own
EXPERIMENTS = []


def experiment(function):
    EXPERIMENTS.append(function)
    return function


def setting(name, value):
    return ["--set", f"{name}={value}"]


def for_each_class(name, value):
    return [w for c in ("direct", "indirect", "caustic") for w in setting(f"{c}_{name}", value)]


class Report:
    """The page under way: where pictures go, and what has been written of it."""

    def __init__(self, kept, folder, quick):
        self.kept, self.folder, self.quick = kept, folder, quick
        (folder / "figures").mkdir(parents=True, exist_ok=True)
        self.lines = []

    def size(self, width, height):
        part = 2 if self.quick else 1
        return ["--size", f"{width // part}x{height // part}"]

    def say(self, *lines):
        self.lines += [*lines, ""]

    def sheet(self, name, images, columns, caption):
        out = self.folder / "figures" / f"{name}.jpg"
        self.kept.picture(images, out, columns=columns)
        self.say(f"![{caption}](figures/{name}.jpg)", f"*{caption}*")

    def plot(self, name, series, x, y, caption):
        (self.folder / "figures" / f"{name}.svg").write_text(log_log(series, x, y))
        self.say(f"![{caption}](figures/{name}.svg)", f"*{caption}*")

    def table(self, head, rows):
        self.say("\n".join(["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
                           + ["| " + " | ".join(map(str, r)) + " |" for r in rows]))

    def relmse(self, image, reference):
        return self.kept.compare(image, reference)["relmse"]


def truth(r, name, scene, width, height, integrator):
    """What a scene looks like, to compare with: by a render of 60 s."""
    return r.kept.render(f"truth-{name}", scene, *RAW, *r.size(width, height), "--integrator", integrator,
                         processor=15 if r.quick else 60)


@experiment
def emitted(r):
    """Photons emitted"""
    counts = [10 ** e for e in range(3, 6 if r.quick else 8)]
    images = [r.kept.render("emitted", WATER, *PLAIN, *r.size(240, 192),
                            *setting("photons", n),
                            *for_each_class("nearest", min(max(2, n // 3000), 500)))
              for n in counts]
    r.say("A third of the photons for each class, tenfold from picture to picture, and each estimate "
          "takes the nearest thousandth of its class, at most 500: the pictures differ in sharpness, not in "
          "grain.")
    r.sheet("emitted", images, 3, "Water in a box by " + ", ".join(f"{n:,}" for n in counts)
            + " photons")
    water = truth(r, "water", WATER, 240, 192, "sppm")
    r.plot("emitted-error", [("one pass", counts, [r.relmse(i, water) for i in images])], "photons", "relMSE",
           "Error against photons emitted")
    r.say("Of two or three nearest photons the error is a matter of luck: the variance of two has no bound, that of "
          "three is the light's square. What is left of many is bias, for edges are not looked at: the front wall is too bright at its foot, by "
          "photons on its other side, and the rear one too dark along its upper edge.")


@experiment
def nearest(r):
    """Photons in an estimate"""
    counts = [10, 100, 1000] if r.quick else [10, 100, 1000, 10000]
    images = [r.kept.render("nearest", WATER, *PLAIN, *r.size(240, 192),
                            *setting("photons", 600000), *for_each_class("nearest", n))
              for n in counts]
    r.say("With 200,000 photons a class, the nearest ten make an estimate, or more, tenfold from "
          "picture to picture: few are grain, many are blur. The best number is where the two errors meet.")
    r.sheet("nearest", images, 2, "The nearest " + ", ".join(f"{n:,}" for n in counts) + " photons")
    water = truth(r, "water", WATER, 240, 192, "sppm")
    r.plot("nearest-error", [("one pass", counts, [r.relmse(i, water) for i in images])],
           "nearest photons", "relMSE", "Error against photons in an estimate")
    r.say("The floor of the curve is wide: where grain falls, light that leaks through the thin walls rises.")


@experiment
def kernels(r):
    """Kernels and the cone filter"""
    words = ["constant", "cone", "epanechnikov", "gaussian"]
    images = [r.kept.render("kernel", RING, *CLASSIC, *r.size(320, 320),
                            *setting("caustic_photons", 150000), *setting("caustic_nearest", 120),
                            *setting("caustic_kernel", word)) for word in words]
    r.say("The cardioid by 150,000 caustic photons, 120 in an estimate. A constant kernel has the "
          "least noise and draws the curve as wide as its disc; a cone that falls to its rim "
          "(k = 1) draws it narrower, and grainier.")
    r.sheet("kernels", images, 4, "Constant, cone (k = 1), Epanechnikov, Gaussian")
    cones = [1, 1.5, 3]
    images = [r.kept.render("cone", RING, *CLASSIC, *r.size(320, 320),
                            *setting("caustic_photons", 150000), *setting("caustic_nearest", 120),
                            *setting("caustic_kernel", "cone"), *setting("caustic_cone_k", k))
              for k in cones]
    r.sheet("cones", images, 3, "The cone filter with k = 1, 1.5 and 3")
    ring = truth(r, "ring", RING, 160, 160, "sppm")

    def errors(*options):
        return [r.relmse(r.kept.render("kernel-error", RING, *CLASSIC, *r.size(160, 160),
                                       *setting("caustic_photons", 150000), *setting("caustic_nearest", n),
                                       *options), ring) for n in near]

    near = [30, 120, 480] if r.quick else [10, 30, 100, 300, 1000]
    series = [(word, near, errors(*setting("caustic_kernel", word))) for word in words]
    series += [(f"cone, k = {k}", near, errors(*setting("caustic_kernel", "cone"), *setting("caustic_cone_k", k)))
               for k in cones[1:]]
    r.plot("kernels-error", series, "nearest photons", "relMSE", "Error against photons in an estimate, by kernel")


@experiment
def radius(r):
    """The radius, and the bias it brings"""
    radii = [0.01, 0.03, 0.1, 0.3] if r.quick else [0.01, 0.02, 0.04, 0.08, 0.16, 0.32]
    fixed = [*ALL_BY_PHOTONS, "--spp", 1, *r.size(200, 150), *setting("photons", 100000)]
    images = [r.kept.render("radius", CORNER, *fixed, *setting("radius", x),
                            *setting("edges", "false")) for x in radii]
    with_edges = [r.kept.render("radius", CORNER, *fixed, *setting("radius", x)) for x in radii]
    corner = r.kept.render("radius-truth", CORNER, *r.size(200, 150), "--integrator", "path",
                          "--passes", 16, "--spp", 16)
    r.say("A wall of 4 mm parts a bright room from a dark one. As the radius grows, light comes "
          "through the wall, round the corners, and the shadow's edge goes soft: all of it is "
          "bias, and none of it goes away with more photons.")
    shown = [0, len(radii) // 2, -1]
    r.sheet("radius", [images[i] for i in shown] + [with_edges[i] for i in shown], 3,
            "Radius " + ", ".join(f"{radii[i]:g} m" for i in shown)
            + "; above without, below with what keeps estimates from reaching round edges")
    passes = 8 if r.quick else 32
    many = [r.kept.render("radius", CORNER, *fixed, *setting("radius", x), "--passes", passes)
            for x in radii]
    errors = [[r.relmse(i, corner) for i in row] for row in (images, with_edges, many)]
    r.plot("radius-error", [("as found", radii, errors[0]), ("edges probed", radii, errors[1]),
                            (f"probed, {passes} passes", radii, errors[2])],
           "radius, m", "relMSE", "Error against radius: grain on the left, bias on the right")
    r.say(f"After {passes} passes of the same radius the grain's share is 1/{passes} of what it was, and "
          "the bias is still all there:")
    r.table(["radius, m", "one pass", "one pass, edges probed", f"{passes} passes, edges probed"],
            [(f"{x:g}", *[f"{row[i]:.4f}" for row in errors]) for i, x in enumerate(radii)])


@experiment
def gather_rays(r):
    """Final gathering"""
    counts = [1, 4, 16, 64]
    base = [*CLASSIC, *r.size(256, 256), *setting("photons", 200000)]
    plain = r.kept.render("gather", BALLS, *base)
    images = [r.kept.render("gather", BALLS, *base, *setting("final_gather", "true"),
                            *setting("gather_rays", n)) for n in counts]
    r.say("Indirect light straight from the map shows the map's blotches; rays to the "
          "surroundings turn them into grain, which more rays smooth.")
    r.sheet("gather", [plain, *images[-2:]], 3, "Straight from the map; by "
            + " and ".join(map(str, counts[-2:])) + " rays")
    balls = truth_of_balls(r)
    errors = [r.relmse(i, balls) for i in images]
    r.plot("gather-error", [("gathered", counts, errors),
                            ("straight", counts, [r.relmse(plain, balls)] * len(counts))],
           "gather rays", "relMSE", "Error against gather rays")
    r.table(["gather rays", "camera's time, s"],
            [(n, f"{r.kept.camera_seconds(i):.2f}") for n, i in zip(["none", *counts], [plain, *images])])


@experiment
def bounces(r):
    """Bounces"""
    limits = [0, 1, 3, 8]
    images = [r.kept.render("bounces", BALLS, *CLASSIC, *r.size(256, 256), "--spp", 8,
                            *setting("photons", 300000), *setting("max_forward_bounces", n))
              for n in limits]
    r.say("With max_forward_bounces of 0, 1, 3 and 8: first no light comes through glass or from "
          "wall to wall, then colours begin to bleed.")
    r.sheet("bounces", images, 4, "Photons that scatter at most 0, 1, 3 and 8 times")
    balls = truth_of_balls(r)
    r.plot("bounces-error", [("one pass", [n + 1 for n in limits], [r.relmse(i, balls) for i in images])],
           "max_forward_bounces + 1", "relMSE", "Error against bounces")


@experiment
def maps(r):
    """List, tree and grid"""
    counts = [10 ** e for e in range(3, 5 if r.quick else 7)]
    rows, series = [], {word: ([], []) for word in ("list", "kdtree", "grid")}
    for n in counts:
        row = [f"{n:,}"]
        for word in series:
            image = r.kept.render(f"map-{word}", BOX, *ALL_BY_PHOTONS, "--size", "128x128", "--spp", 1,
                                  "--threads", 1, *setting("photons", n), *setting("photon_map", word),
                                  *setting("radius", 0.1))
            seconds = r.kept.camera_seconds(image)
            series[word][0].append(n)
            series[word][1].append(seconds)
            row.append(f"{seconds:.3f}")
        rows.append(row)
    r.say("The time of the camera's pass at 128 × 128, one thread, by the structure that photons are "
          "looked up in. All three give the same picture; a list looks at every photon.")
    r.table(["photons", "list, s", "kdtree, s", "grid, s"], rows)
    r.plot("maps", [(word, *xy) for word, xy in series.items()], "photons", "seconds",
           "A list of photons grows out of hand, a tree and a grid do not")


@experiment
def bsdfs(r):
    """Four materials"""
    r.say("How aluminium foil, opaque purple plastic, green cloth and green glass scatter light that "
          "comes from 45 degrees, for red, green and blue.")
    names = ("aluminium-foil", "purple-plastic", "green-cloth", "green-glass")
    for name in names:
        r.kept.run("bsdf", name, "--scene", ROOT / "docs/report/materials.pbrt", "-o",
                   r.folder / "figures" / f"{name}.svg")
    cells = [f"![{name}](figures/{name}.svg)" for name in names]
    r.table(["", ""], [cells[:2], cells[2:]])


@experiment
def failures(r):
    """Two failures worth seeing"""
    right, wrong = [r.kept.render("bubble", scene, *r.size(320, 240), processor=8 if r.quick else 20)
                    for scene in ("scenes/egg/egg.pbrt", "docs/report/bubble.pbrt")]
    r.say("A surface whose normals point inward makes glass a bubble of air in an endless block of "
          "glass: the egg's own shadow has no light in it. It looks nearly right.")
    r.sheet("bubble", [right, wrong], 2, "The egg, and the egg inside out")
    leak = [*ALL_BY_PHOTONS, *r.size(320, 240), *setting("photons", 400000), *setting("radius", 0.12)]
    r.sheet("leak", [r.kept.render("leak", CORNER, *leak),
                     r.kept.render("leak", CORNER, *leak, *setting("edges", "false"))], 2,
            "A wide radius at a thin wall, with and without a look at the edges")


@experiment
def classes(r):
    """Each map alone"""
    size = r.size(200, 200)
    kinds = ("direct", "indirect", "caustic")
    few = ["--preset", "002", *for_each_class("photons", 6000)]
    drawn = [r.kept.photons(BALLS, *size, *few, "--class", c) for c in kinds]
    drawn.append(r.kept.photons(BALLS, *size, *few))
    image = r.kept.render("classes", BALLS, *ALL_BY_PHOTONS, *size, *setting("photons", 450000))
    r.say("The photons of each map and of all, 6,000 a map; below, what 150,000 a map make of direct "
          "light, indirect light and caustics, and their sum.")
    r.sheet("classes", [*drawn, *[r.kept.layer(image, c) for c in kinds], image], 4,
            "The direct, the indirect and the caustic map; all")


@experiment
def few(r):
    """Few photons, one by one"""
    size = r.size(320, 320)
    drawn = [r.kept.photons(BOX, *size, "--preset", "003", *setting("photons", n))
             for n in (5000, 50000)]
    r.say("A point light in a box, by `--preset 003`: photons that do not bounce, half of which survive "
          "the roulette and are stored, in a list that is gone through.")
    r.sheet("few-photons", drawn, 2, "5,000 and 50,000 photons over the wireframe, coloured by their power")
    counts = (100, 1000, 10000)
    images = [r.kept.render("few", BOX, "--preset", "003", *RAW, *size, "--spp", 1,
                            *setting("photons", n), *setting("radius", x))
              for n, x in zip(counts, (0.25, 0.15, 0.08))]
    r.sheet("few", images, 3, "100, 1,000 and 10,000 photons emitted")
    r.table(["photons", "stored", "trace, s", "camera, s"],
            [(f"{n:,}", f"{sum(c['stored'] for c in said['photons'].values()):,}",
              f"{said['time']['trace']:.4f}", f"{r.kept.camera_seconds(i):.3f}")
             for n, i, said in zip(counts, images, map(r.kept.statistics, images))])


@experiment
def beside(r):
    """Photon maps beside paths"""
    seconds = 4 if r.quick else 8
    r.say("Two scenes for the same time, with photon maps of shrinking radius and with paths from the "
          "eye (Monte Carlo), as rendered. A small lamp behind water or glass is found by chance alone.")
    for name, scene, width, height in (("beside-water", WATER, 400, 320), ("beside-balls", BALLS, 320, 320)):
        images = [r.kept.render(name, scene, *RAW, *r.size(width, height), "--integrator", integrator,
                                processor=seconds) for integrator in ("sppm", "path")]
        r.sheet(name, images, 2, f"Photon maps and paths, {seconds} s each")


@experiment
def where_time_goes(r):
    """Where the time goes"""
    rows = []
    for scene, width, height in ((BALLS, 320, 320), (WATER, 400, 320), (RING, 320, 320),
                                 ("scenes/cornell-box/cornell-box.pbrt", 320, 320)):
        image = r.kept.render("parts", scene, *RAW, *r.size(width, height), "--integrator", "photonmap",
                              "--passes", 2, *setting("photons", 400000))
        said = r.kept.statistics(image)["time"]
        parts = [said[k] for k in ("trace", "build", "gather")] + [said["camera"] - said["gather"]]
        rows.append([pathlib.Path(scene).stem, *[f"{100.0 * p / sum(parts):.0f} %" for p in parts]])
    r.say("The shares of a render's time, 400,000 photons a pass and four samples a pixel: photons sent "
          "forward, sorted into maps, gathered into estimates, and all else that the camera's paths take, "
          "tracing above all.")
    r.table(["scene", "photons traced", "maps built", "estimates", "camera's paths without them"], rows)


@experiment
def budget(r):
    """What to spend a second on"""
    counts = [1000, 10000, 100000] if r.quick else [1000, 10000, 100000, 1000000]
    seconds, size = 4 if r.quick else 8, r.size(256, 256)
    balls = truth_of_balls(r)
    rows = []
    for n in counts:
        image = r.kept.render("budget", BALLS, *RAW, *size, "--integrator", "sppm", "--spp", 1,
                              *setting("photons", n), processor=seconds)
        rows.append((f"{n:,}", r.kept.statistics(image)["passes"], f"{r.relmse(image, balls):.4f}"))
    r.say(f"{seconds} s of sppm each: many passes of few photons, or few passes of many. Photons are cheaper "
          "than camera rays with their estimates, up to where a pass is nothing but photons.")
    r.table(["photons a pass", "passes", "relMSE"], rows)


@experiment
def curves(r):
    """The curves, against their closed forms"""
    across, half = 400, 0.11  # pixels, and metres from the middle to the edge of the picture
    radius = 0.1 / half * 0.5 * across
    rows, images = [], []
    for name, curve in (("cardioid", cardioid), ("nephroid", nephroid)):
        image = r.kept.render(f"above-{name}", f"docs/report/above-{name}.pbrt", *RAW, "--size",
                              f"{across}x{across}", "--integrator", "photonmap",
                              *setting("caustic_photons", 300000), *setting("radius", 0.0006),
                              *setting("alpha", 1), processor=6 if r.quick else 20)
        off = off_curve(pixels(r.kept.layer(image, "caustic", "pfm")), curve, radius)
        rows.append((name, len(off), f"{off[len(off) // 2]:.1f}", f"{off[int(0.9 * len(off))]:.1f}"))
        images.append(image)
    r.say("Rays that a circle reflects touch a cardioid where the lamp stands on the circle, with its cusp a "
          "third of the radius behind the middle, and a nephroid where light is parallel, with its cusp at one "
          "half. A low ring of silver from straight above, 182 pixels in radius; in each row of pixels the "
          "brightest, and where the curve crosses the row:")
    r.sheet("curves", images, 2, "The cardioid and the nephroid, from above")
    r.table(["curve", "rows", "pixels off: median", "nine in ten below"], rows)


@experiment
def measured(r):
    """The Cornell box as it was measured"""
    image = r.kept.render("measured", "scenes/cornell-box/cornell-box.pbrt", "--integrator", "path",
                          "--size", "256x256", "--passes", 4 if r.quick else 8, "--spp", 32)
    direct = pixels(r.kept.layer(image, "direct", "pfm"))
    paints = {name: cornell.paint_xyz(name) for name in cornell.PAINTS}
    rows, off, off_xy = [], 0.0, 0.0
    for name, paint, place, normal in cornell.PATCHES:
        foretold, found = patch(direct, paints[paint], place, normal)
        xy, found_xy = cornell.chromaticity(foretold), cornell.chromaticity(found)
        off = max(off, abs(found[1] / foretold[1] - 1))
        off_xy = max([off_xy, *[abs(a - b) for a, b in zip(xy, found_xy)]])
        rows.append((name, f"{xy[0]:.4f} {xy[1]:.4f}", f"{foretold[1]:.4f}",
                     f"{found_xy[0]:.4f} {found_xy[1]:.4f}", f"{found[1]:.4f}",
                     f"{100 * (found[1] / foretold[1] - 1):+.2f} %"))
    r.say("No photograph of glass or water with a scene to go with it could be shipped, so what is "
          "matched is the box whose paints, lamp and corners were measured. Direct light of seven places is "
          "worked out from the published figures by a closed form (tools/cornell.py) and read from our "
          f"picture: luminance is off by at most {100 * off:.2f} %, chromaticity by {off_xy:.4f}.")
    r.table(["place", "x y from figures", "Y", "x y rendered", "Y", "off"], rows)


@experiment
def window(r):
    """The window"""
    r.say("The Cornell box while it is rendered, and the photons that made a caustic "
          "(`./dev screenshots`).", "![The window](../images/view-picture.png)",
          "![Photons in the window](../images/view-photons.png)")


def truth_of_balls(r):
    return r.kept.render("truth", BALLS, *r.size(256, 256), "--integrator", "vcm",
                         processor=60 if r.quick else 150)


@experiment
def convergence(r):
    """Error against time"""
    times = [1, 2, 4] if r.quick else [2, 4, 8, 16]
    size = r.size(256, 256)
    balls = truth_of_balls(r)
    series = []
    for integrator in ("path", "photonmap", "sppm", "vcm", "auto"):
        images = [r.kept.render(f"time-{integrator}", BALLS, *size, "--integrator", integrator,
                                "--spp", 1, processor=t) for t in times]
        series.append((integrator, [r.kept.statistics(i)["processor"] for i in images],
                       [r.relmse(i, balls) for i in images]))
    r.say("Two balls in a box, rough metal and glass, by each integrator for about the same time, as "
          "rendered, against vcm for much longer. Taking the noise out of what is shown is part of the time.")
    r.plot("convergence", series, "seconds", "relMSE", "Error against time")
    r.table(["seconds, about", *[s[0] for s in series]],
            [[t, *[f"{s[2][i]:.4f}" for s in series]] for i, t in enumerate(times)])


def sections(path):
    """Those of a page that is there already, by their titles."""
    if not path.exists():
        return {}
    parts = re.split(r"^(?=## )", path.read_text(), flags=re.M)[1:]
    return {part.split("\n")[0][3:]: part.rstrip("\n").split("\n") + [""] for part in parts}


def write(r, asked):
    quick = " --quick" if r.quick else ""
    lines = ["# Results", "", f"Made by `tools/experiments.py{quick}` (`./dev gallery{quick}`), section by section: every",
             "number and picture below is from its renders. Where pictures are small and few they are those of "
             "`--quick`.", ""]
    page = r.folder / "results.md"
    there = sections(page) if asked else {}
    for i, run in enumerate(EXPERIMENTS):
        if asked and run.__name__ not in asked:
            lines += there.get(run.__doc__, [])
            continue
        print(f"experiment {i + 1} of {len(EXPERIMENTS)}: {run.__doc__}", flush=True)
        r.lines = []
        r.say(f"## {run.__doc__}")
        run(r)
        lines += r.lines
    page.write_text("\n".join(lines))


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("experiments", nargs="*")
    parser.add_argument("--quick", action="store_true")
    asked = parser.parse_intermixed_args()
    folder = asked.folder / "report" if asked.quick else ROOT / "docs/report"
    subprocess.run([ROOT / "tools/illustrations.py", folder / "figures"], check=True)
    write(Report(Kept(asked.program, asked.folder), folder, asked.quick), asked.experiments)
    print(folder / "results.md")


if __name__ == "__main__":
    main()
