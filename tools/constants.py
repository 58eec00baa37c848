#!/usr/bin/env python3
"""Counts the constants that tune photons and transport, each of which someone has to have found.

usage: tools/constants.py [--list]

Counted are numbers by name in src/photon and src/transport: #define NAME NUMBER, NAME = NUMBER in an
enum, and static const floats (an array is one). Not counted is what tunes nothing: a number whose
comment, beside or above it, begins with

    size:   of memory or of a thread's work; the picture is the same with any other
    id:     tells things apart
    math:   follows from the mathematics

Fails where there are more than MOST: a new one has to take an old one's place.
"""
import pathlib
import re
import sys

MOST = 30

ROOT = pathlib.Path(__file__).resolve().parent.parent
FOLDERS = ["src/photon", "src/transport"]
NUMBER = r"\(?-?(?:0x[0-9a-fA-F.p+-]+|\d[\d.]*(?:e-?\d+)?)(?:[fuUlL]*)\b"
DEFINE = re.compile(r"^#define\s+([A-Z_][A-Z0-9_]*)\s+" + NUMBER)
IN_ENUM = re.compile(r"\b([A-Z][A-Z0-9_]*) = " + NUMBER)
STATIC = re.compile(r"\bstatic const (?:float|double)\s+(\w+)(?:\[[^\]]*\])*\s*=")
ENUM = re.compile(r"\benum\b[^;{]*\{.*?\}", re.S)
NOT_TUNING = re.compile(r"/\*+<?\s*(?:size|id|math):")


def enum_lines(text):
    """The numbers of lines within an enum."""
    lines = set()
    for match in ENUM.finditer(text):
        first = text.count("\n", 0, match.start()) + 1
        lines.update(range(first, first + match.group().count("\n") + 1))
    return lines


def is_marked(lines, i):
    """Whether the comment beside line i, or the one that ends right above it, says so."""
    if "/*" in lines[i]:
        return bool(NOT_TUNING.search(lines[i]))
    above = i - 1
    while above >= 0 and lines[above].startswith(("#define", "static const")):
        above -= 1
    if above < 0 or not lines[above].rstrip().endswith("*/"):
        return False
    while above > 0 and "/*" not in lines[above]:
        above -= 1
    return bool(NOT_TUNING.search(lines[above]))


def constants(path):
    text = path.read_text()
    lines = text.split("\n")
    in_enum = enum_lines(text)
    for i, line in enumerate(lines):
        names = DEFINE.findall(line) + STATIC.findall(line)
        if i + 1 in in_enum:
            names += IN_ENUM.findall(line)
        for name in names:
            if not is_marked(lines, i):
                yield f"{path.relative_to(ROOT)}:{i + 1}: {name}"


def main():
    found = []
    for folder in FOLDERS:
        for path in sorted((ROOT / folder).rglob("*.[ch]")):
            found += list(constants(path))
    if "--list" in sys.argv[1:] or len(found) > MOST:
        print("\n".join(found))
    print(f"{len(found)} constants tune photons and transport, {MOST} at most")
    return len(found) > MOST


if __name__ == "__main__":
    sys.exit(main())
