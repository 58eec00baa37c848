#!/usr/bin/env python3
"""What looking for edges is worth: error and processor time with `edges` on and off, at radii that
shrink, in a room full of corners, steps and thin things.

usage: edges.py [--reference FILE] [--passes N] NEPHROID [NEPHROID...]

The reference is path's; it is made where FILE is not yet. All indirect light, then all light, is
straight from the map. Of several programs each line has all, taken in turn, so that a comparison
holds where the machine's speed drifts. Error times processor time is what counts: it is what a
picture of the same error takes.
"""
import argparse
import os
import pathlib
import resource
import subprocess
import tempfile

SCENE = pathlib.Path(__file__).with_name("edges.pbrt")
RADII = [0.24, 0.12, 0.06, 0.03]
LIGHT = {"indirect": ["direct_illumination=true"], "all": ["direct_illumination=false"]}
REFERENCE = ["integrator=path", "passes=64", "spp=64", "max_backward_bounces=-1"]


def render(nephroid, words, output):
    """Renders; processor seconds."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    options = [part for word in words for part in ("--set", word)]
    subprocess.run([nephroid, "render", str(SCENE), "--threads", "1", "-o", output, *options],
                   check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def error(nephroid, picture, reference):
    out = subprocess.run([nephroid, "compare", "-m", "relmse", picture, reference],
                         check=True, capture_output=True, text=True)
    return float(out.stdout.split()[0])


def main():
    args = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    args.add_argument("--reference", default="")
    args.add_argument("--passes", type=int, default=4)
    args.add_argument("nephroid", nargs="+")
    args = args.parse_args()
    with tempfile.TemporaryDirectory() as work:
        reference = args.reference or f"{work}/reference.exr"
        picture = f"{work}/picture.exr"
        if not os.path.exists(reference):
            render(args.nephroid[0], REFERENCE, reference)
        print(f"{'light':9} {'radius':>6} {'edges':>5}   "
              + f"{'relMSE':>9} {'s':>6} {'product':>9}   " * len(args.nephroid))
        for light, more in LIGHT.items():
            for radius in RADII:
                for edges in "false", "true":
                    words = ["integrator=photonmap", f"passes={args.passes}", "spp=4",
                             "photons=100000", "alpha=1", "max_backward_bounces=-1",
                             f"radius={radius}", f"edges={edges}", *more]
                    line = f"{light:9} {radius:6} {edges:>5}   "
                    for nephroid in args.nephroid:
                        seconds = render(nephroid, words, picture)
                        off = error(nephroid, picture, reference)
                        line += f"{off:9.5f} {seconds:6.2f} {off * seconds:9.5f}   "
                    print(line, flush=True)


if __name__ == "__main__":
    main()
