#!/usr/bin/env python3
"""Makes the report's experiments: pictures, plots and tables of what each parameter does.

usage: tools/experiments.py PROGRAM FOLDER [--quick] [EXPERIMENT...]

Writes docs/report/figures/*.jpg and *.svg and docs/report/results.md, from renders that are kept in
FOLDER; with --quick smaller ones, to FOLDER/report instead. Every figure in the text is taken from
the renders: nothing is typed in.
"""
import argparse
import array
import pathlib
import subprocess

import cornell
from plot import log_log
from renders import ROOT, Kept

WATER, BOX, RING = ("scenes/water-box/water-box.pbrt", "scenes/point-light/point-light.pbrt",
                    "scenes/cardioid/cardioid.pbrt")
CORNER, BALLS = "scenes/corner/corner.pbrt", "scenes/spheres/spheres.pbrt"
CLASSIC = ["--integrator", "photonmap", "--passes", "1", "--spp", "4", "--set", "alpha=1"]
ALL_BY_PHOTONS = [*CLASSIC, "--set", "direct_illumination=false"]
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

    def sheet(self, name, images, columns, caption, exposure=None):
        out = self.folder / "figures" / f"{name}.jpg"
        self.kept.picture(images, out, columns=columns, exposure=exposure)
        self.say(f"![{caption}](figures/{name}.jpg)", f"*{caption}*")

    def plot(self, name, series, x, y, caption):
        (self.folder / "figures" / f"{name}.svg").write_text(log_log(series, x, y))
        self.say(f"![{caption}](figures/{name}.svg)", f"*{caption}*")

    def table(self, head, rows):
        self.say("\n".join(["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
                           + ["| " + " | ".join(map(str, r)) + " |" for r in rows]))

    def relmse(self, image, reference):
        return self.kept.compare(image, reference)["relmse"]


@experiment
def emitted(r):
    """Photons emitted"""
    counts = [1000, 10000, 100000] if r.quick else [1000, 10000, 100000, 1000000]
    images = [r.kept.render("emitted", WATER, *ALL_BY_PHOTONS, "--spp", 1, *r.size(400, 320),
                            *setting("photons", 3 * n), *for_each_class("nearest", max(2, n // 1000)))
              for n in counts]
    r.say("Each class of photons is emitted a thousand times and more, tenfold from picture to "
          "picture, and each estimate takes the nearest thousandth of them: the pictures differ in sharpness, not "
          "in grain.")
    r.sheet("emitted", images, 2, "Water in a box by " + ", ".join(f"{n:,}" for n in counts)
            + " photons a class")


@experiment
def nearest(r):
    """Photons in an estimate"""
    counts = [10, 100, 1000] if r.quick else [10, 100, 1000, 10000]
    images = [r.kept.render("nearest", WATER, *ALL_BY_PHOTONS, "--spp", 1, *r.size(400, 320),
                            *setting("photons", 600000), *for_each_class("nearest", n))
              for n in counts]
    r.say("With 200,000 photons a class, the nearest ten make an estimate, or more, tenfold from "
          "picture to picture: few are grain, many are blur. The best number is where the two errors meet.")
    r.sheet("nearest", images, 2, "The nearest " + ", ".join(f"{n:,}" for n in counts) + " photons")


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


@experiment
def radius(r):
    """The radius, and the bias it brings"""
    radii = [0.01, 0.03, 0.1, 0.3] if r.quick else [0.01, 0.02, 0.04, 0.08, 0.16, 0.32]
    fixed = [*ALL_BY_PHOTONS, *r.size(280, 210), *setting("photons", 400000)]
    images = [r.kept.render("radius", CORNER, *fixed, *setting("radius", x),
                            *setting("edges", "false")) for x in radii]
    with_edges = [r.kept.render("radius", CORNER, *fixed, *setting("radius", x)) for x in radii]
    truth = r.kept.render("radius-truth", CORNER, *r.size(280, 210), "--integrator", "path",
                          "--passes", 16 if r.quick else 64, "--spp", 16)
    r.say("A wall of 4 mm parts a bright room from a dark one. As the radius grows, light comes "
          "through the wall, round the corners, and the shadow's edge goes soft: all of it is "
          "bias, and none of it goes away with more photons.")
    shown = [0, len(radii) // 2, -1]
    r.sheet("radius", [images[i] for i in shown] + [with_edges[i] for i in shown], 3,
            "Radius " + ", ".join(f"{radii[i]:g} m" for i in shown)
            + "; above without, below with what keeps estimates from reaching round edges")
    r.plot("radius-error", [("all photons within the radius", radii,
                             [r.relmse(i, truth) for i in images]),
                            ("edges probed", radii, [r.relmse(i, truth) for i in with_edges])],
           "radius, m", "relMSE", "Error against radius: grain on the left, bias on the right")


@experiment
def gather_rays(r):
    """Final gathering"""
    counts = [1, 8, 64] if r.quick else [1, 8, 64, 256]
    base = [*CLASSIC, *r.size(320, 320), *setting("photons", 200000)]
    plain = r.kept.render("gather", BALLS, *base)
    images = [r.kept.render("gather", BALLS, *base, *setting("final_gather", "true"),
                            *setting("gather_rays", n)) for n in counts]
    r.say("Indirect light straight from the map shows the map's blotches; rays to the "
          "surroundings turn them into grain, which more rays smooth.")
    r.sheet("gather", [plain, *images[-2:]], 3, "Straight from the map; by "
            + " and ".join(map(str, counts[-2:])) + " rays")
    r.table(["gather rays", "camera's time, s"],
            [("none", f"{r.kept.statistics(plain)['time']['camera']:.2f}")]
            + [(n, f"{r.kept.statistics(i)['time']['camera']:.2f}") for n, i in zip(counts, images)])


@experiment
def bounces(r):
    """Bounces"""
    limits = [0, 1, 3, 8]
    images = [r.kept.render("bounces", BALLS, *CLASSIC, *r.size(240, 240), "--spp", 8,
                            *setting("photons", 300000), *setting("max_forward_bounces", n))
              for n in limits]
    r.say("With max_forward_bounces of 0, 1, 3 and 8: first no light comes through glass or from "
          "wall to wall, then colours begin to bleed.")
    r.sheet("bounces", images, 4, "Photons that scatter at most 0, 1, 3 and 8 times")


@experiment
def maps(r):
    """List, tree and grid"""
    counts = [1000, 4000] if r.quick else [1000, 4000, 16000, 64000]
    rows, series = [], {word: ([], []) for word in ("list", "kdtree", "grid")}
    for n in counts:
        row = [f"{n:,}"]
        for word in series:
            image = r.kept.render(f"map-{word}", BOX, *ALL_BY_PHOTONS, "--size", "64x64", "--spp", 1,
                                  "--threads", 1, *setting("photons", n), *setting("photon_map", word),
                                  *setting("radius", 0.1))
            seconds = r.kept.statistics(image)["time"]["camera"]
            series[word][0].append(n)
            series[word][1].append(seconds)
            row.append(f"{seconds:.3f}")
        rows.append(row)
    r.say("The time of the camera's pass at 64 × 64, one thread, by the structure that photons are "
          "looked up in. All three give the same picture; a list looks at every photon.")
    r.table(["photons", "list, s", "kdtree, s", "grid, s"], rows)
    r.plot("maps", [(word, *xy) for word, xy in series.items()], "photons", "seconds",
           "A list of photons grows out of hand, a tree and a grid do not")


@experiment
def bsdfs(r):
    """Four materials"""
    r.say("How aluminium foil, opaque purple plastic, green cloth and green glass scatter light that "
          "comes from 45 degrees, for red, green and blue.")
    for name in ("aluminium-foil", "purple-plastic", "green-cloth", "green-glass"):
        r.kept.run("bsdf", name, "--scene", ROOT / "docs/report/materials.pbrt", "-o",
                   r.folder / "figures" / f"{name}.svg")
        r.say(f"![{name}](figures/{name}.svg)")


@experiment
def failures(r):
    """Two failures worth seeing"""
    right, wrong = [r.kept.render("bubble", scene, *r.size(320, 240), "--time", 6 if r.quick else 20)
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
    base = [*ALL_BY_PHOTONS, *r.size(320, 320), *setting("photons", 450000)]
    image = r.kept.render("classes", BALLS, *base)
    layers = [r.kept.layer(image, name) for name in ("direct", "indirect", "caustic")]
    r.say("Direct light, indirect light and caustics, each from its own map, and their sum.")
    r.sheet("classes", [*layers, image], 4, "The direct, the indirect and the caustic map; all")


def pixels(path):
    """Width, height and numbers of a PFM file, from the bottom row up."""
    with open(path, "rb") as file:
        assert file.readline() == b"PF\n"
        width, height = map(int, file.readline().split())
        assert float(file.readline()) < 0
        return width, height, array.array("f", file.read())


def patch(image, paint, place, normal):
    """XYZ of 3 x 3 pixels around a place: as published figures foretell, and as rendered."""
    width, height, values = image
    column, row = cornell.pixel(place, width)
    foretold, rgb = [0.0] * 3, [0.0] * 3
    for x, y in ((column + i % 3 - 1, row + i // 3 - 1) for i in range(9)):
        lit = cornell.irradiance(cornell.seen(x, y, width, place, normal), normal)
        at = 3 * ((height - 1 - y) * width + x)
        for k in range(3):
            foretold[k] += lit * paint[k] / 9
            rgb[k] += values[at + k] / 9
    return foretold, cornell.xyz_of_srgb(rgb)


@experiment
def measured(r):
    """The Cornell box as it was measured"""
    image = r.kept.render("measured", "scenes/cornell-box/cornell-box.pbrt", "--integrator", "path",
                          "--size", "256x256", "--passes", 4 if r.quick else 16, "--spp", 32)
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


@experiment
def convergence(r):
    """Error against time"""
    times = [1, 2, 4] if r.quick else [2, 4, 8, 16, 32]
    size = r.size(256, 256)
    truth = r.kept.render("truth", BALLS, *size, "--integrator", "vcm", "--time",
                          30 if r.quick else 600)
    series = []
    for integrator in ("path", "photonmap", "sppm", "vcm", "auto"):
        images = [r.kept.render(f"time-{integrator}", BALLS, *size, "--integrator", integrator,
                                "--time", t) for t in times]
        series.append((integrator, times, [r.relmse(i, truth) for i in images]))
    r.say("Two balls in a box, rough metal and glass, by each integrator for the same time, "
          "against vcm for much longer.")
    r.plot("convergence", series, "seconds", "relMSE", "Error against time")
    r.table(["seconds", *[s[0] for s in series]],
            [[t, *[f"{s[2][i]:.4f}" for s in series]] for i, t in enumerate(times)])


def write(r, asked):
    quick = " --quick" if r.quick else ""
    lines = ["# Results", "", f"Made by `tools/experiments.py{quick}` (`./dev gallery{quick}`): every",
             "number and picture below is from its renders.", ""]
    for run in EXPERIMENTS:
        if asked and run.__name__ not in asked:
            continue
        r.lines = []
        r.say(f"## {run.__doc__}")
        run(r)
        lines += r.lines
    (r.folder / "results.md").write_text("\n".join(lines))


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("experiments", nargs="*")
    parser.add_argument("--quick", action="store_true")
    asked = parser.parse_intermixed_args()
    is_draft = asked.quick or asked.experiments
    folder = asked.folder / "report" if is_draft else ROOT / "docs/report"
    subprocess.run([ROOT / "tools/illustrations.py", folder / "figures"], check=True)
    write(Report(Kept(asked.program, asked.folder), folder, asked.quick), asked.experiments)
    print(folder / "results.md")


if __name__ == "__main__":
    main()
