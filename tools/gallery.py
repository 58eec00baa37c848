#!/usr/bin/env python3
"""Renders every scene and makes the gallery of them.

usage: tools/gallery.py PROGRAM FOLDER [--quick] [--seconds S] [--clock] [SCENE...]

Each scenes/*/*.pbrt with a WorldBegin is rendered as the program does it without being told
anything but the time, and written to FOLDER as EXR and JPEG: S seconds of all processors together
(150), with --clock by the clock, or if quick 10 by the clock at half the size. A run that was stopped goes on where it was.
FOLDER/index.html shows all, with settings, times and statistics; without --quick so do
docs/gallery.md and the pictures beside the scenes, of the SCENEs alone where some are named.
"""
import argparse
import html
import pathlib
import re
import shutil
import sys

from renders import ROOT, Kept


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("scenes", nargs="*")
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--seconds", type=float)
    parser.add_argument("--clock", action="store_true")
    return parser.parse_intermixed_args()


def all_scenes():
    """Scenes that are whole; those whose model was not fetched are said and left out."""
    for path in sorted((ROOT / "scenes").glob("*/*.pbrt")):
        text = path.read_text()
        if not re.search(r"^WorldBegin", text, re.M):
            continue
        missing = missing_models(path)
        if missing:
            print(f"{path.stem}: left out, {missing} is not here (./dev models)", file=sys.stderr)
            continue
        yield path


def missing_models(path):
    text = re.sub(r"^Film\b.*?^(?=\S)", "", path.read_text(), flags=re.M | re.S)
    for name in re.findall(r'"([\w-]+\.(?:ply|pbrt|exr))"', text):
        file = path.parent / name
        if not file.exists():
            return name
        if name.endswith(".pbrt"):
            inside = missing_models(file)
            if inside:
                return inside
    return None


def film_size(path):
    """Of the scene's own file, or of the view that it includes."""
    text = path.read_text()
    for name in re.findall(r'^Include "(view[\w-]*\.pbrt)"', text, re.M):
        text += (path.parent / name).read_text()
    width = re.search(r'"integer xresolution" (\d+)', text)
    height = re.search(r'"integer yresolution" (\d+)', text)
    return int(width[1]), int(height[1])


def render(kept, path, asked):
    width, height = film_size(path)
    small = ["--size", f"{width // 2}x{height // 2}"] if asked.quick else []
    if asked.quick or asked.clock:
        return kept.render(path.stem, path, *small, "--time", f"{asked.seconds or 10:g}")
    return kept.render(path.stem, path, processor=asked.seconds or 150)


def first_sentences(path):
    """The comment that a scene begins with, without its commands."""
    lines = []
    for line in path.read_text().split("\n"):
        if not line.startswith("#"):
            break
        lines.append(line[1:].strip())
    blocks = "\n".join(lines).split("\n\n")
    return " ".join(b.replace("\n", " ") for b in blocks if "nephroid " not in b and "./dev" not in b)


def figures(kept, exr):
    """What the statistics say, in a few words."""
    stats = kept.statistics(exr)
    return (f"{stats['passes'] + stats.get('part', 0):.3g} passes, {stats['processor']:.0f} s of "
            "one processor")


def page(kept, made):
    rows = []
    for path, exr in made:
        name = html.escape(path.stem)
        rows.append(f"<figure><img src='{name}.jpg' alt='{name}'><figcaption><b>{name}</b> "
                    f"{html.escape(first_sentences(path))}<br><code>{path.relative_to(ROOT)}</code>, "
                    f"{figures(kept, exr)}</figcaption></figure>")
    return ("<!doctype html><meta charset='utf-8'><title>Nephroid: gallery</title><style>"
            "body{font:16px/1.5 sans-serif;max-width:70rem;margin:2rem auto;background:#151515;"
            "color:#ddd}figure{margin:0 0 3rem}img{max-width:100%}</style><h1>Gallery</h1>\n"
            + "\n".join(rows) + "\n")


def section(kept, path, exr):
    picture = path.relative_to(ROOT).with_suffix(".jpg")
    return "\n".join([f"## {path.stem}", "", first_sentences(path), "",
                      f"![{path.stem}](../{picture})", "",
                      f"[`{path.relative_to(ROOT)}`](../{path.relative_to(ROOT)}), "
                      f"{figures(kept, exr)}.", ""])


def write_document(kept, made):
    """Sections of what was made, in place of those that were there; others stay."""
    document = ROOT / "docs/gallery.md"
    sections = {}
    if document.exists():
        for part in re.split(r"^(?=## )", document.read_text(), flags=re.M)[1:]:
            sections[re.search(r"`(scenes/.*?)`", part)[1]] = part.rstrip() + "\n"
    for path, exr in made:
        sections[str(path.relative_to(ROOT))] = section(kept, path, exr)
    there = [text for scene, text in sorted(sections.items()) if (ROOT / scene).exists()]
    document.write_text("\n".join([
        "# Gallery", "", "Each picture is what the program makes of its scene without being told "
        "anything but", "the time. Made by `./dev gallery`.", "", *there]))


def main():
    asked = arguments()
    kept = Kept(asked.program, asked.folder)
    scenes = [p for p in all_scenes() if not asked.scenes or p.stem in asked.scenes]
    if not scenes:
        sys.exit("gallery: no such scene")
    made = []
    for i, path in enumerate(scenes):
        print(f"{i + 1} of {len(scenes)}", file=sys.stderr)
        exr = render(kept, path, asked)
        kept.picture([exr], asked.folder / f"{path.stem}.jpg")
        made.append((path, exr))
    (asked.folder / "index.html").write_text(page(kept, made))
    if not asked.quick:
        for path, _ in made:
            picture = asked.folder / f"{path.stem}.jpg"
            shutil.copy(picture, path.with_suffix(".jpg"))
        write_document(kept, made)
    print(asked.folder / "index.html")


if __name__ == "__main__":
    main()
