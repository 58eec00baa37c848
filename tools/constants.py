#!/usr/bin/env python3
"""Counts the constants of photons and transport, each of which someone has to have found.

usage: tools/constants.py [--list]

Counted in src/photon and src/transport are

    named    #define NAME, NAME = in an enum, static const floats (an array is one), where a
             number other than 0 and 1 stands in what they are;
    unnamed  fractions and other floats in the code, but for 0, 1/2, 1 and 2; and whole numbers
             from 3 on that something is divided by or compared with, loops over axes, lanes
             and corners apart.

Such a number tunes what is rendered or how long it takes, unless its comment, beside or above it,
begins with

    size:   of memory or of a thread's work; the picture is the same with any other
    id:     tells things apart
    math:   follows from the mathematics

Fails where more than MOST tune, or all of them together are more than MOST_OF_ALL: a new one has
to take an old one's place.
"""
import pathlib
import re
import sys

MOST = 30
MOST_OF_ALL = 64

ROOT = pathlib.Path(__file__).resolve().parent.parent
FOLDERS = ["src/photon", "src/transport"]
NUMBER = re.compile(r"(?<![\w.])(0x[0-9a-fA-F.]+(?:p[+-]?\d+)?|\d+\.?\d*(?:e[+-]?\d+)?)[fuUlL]*")
DEFINE = re.compile(r"^#define\s+([A-Z_][A-Z0-9_]*)\s+(.+)")
IN_ENUM = re.compile(r"\b([A-Z][A-Z0-9_]*) = ([^,}]+)")
STATIC = re.compile(r"\bstatic const (?:float|double)\s+(\w+)(?:\[[^\]]*\])*\s*=(.*)")
ENUM = re.compile(r"\benum\b[^;{()]*\{.*?\}", re.S)
NOT_TUNING = re.compile(r"/\*+<?\s*(?:size|id|math):")
COMMENT = re.compile(r"/\*.*?\*/", re.S)
TEXT = re.compile(r'"(?:\\.|[^"\\])*"')
PLAIN = {"0", "1", "1.0"}
PLAIN_FLOATS = {0.0, 0.5, 1.0, 2.0}


def blank(match):
    return re.sub(r"[^\n]", " ", match.group())


def code_lines(text):
    """The lines without comments and texts, in their places."""
    return TEXT.sub(blank, COMMENT.sub(blank, text)).split("\n")


def enum_lines(code):
    """The numbers of lines within an enum."""
    lines = set()
    for match in ENUM.finditer(code):
        first = code.count("\n", 0, match.start())
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


def named(line, in_enum):
    """The names that a line of code gives to numbers."""
    found = DEFINE.findall(line) + STATIC.findall(line)
    if in_enum:
        found += IN_ENUM.findall(line)
    return [name for name, value in found
            if any(n not in PLAIN for n in NUMBER.findall(value)) or value.strip() == "{"]


def unnamed(line):
    """The numbers of a line of code that have none and are not plain."""
    if line.lstrip().startswith(("#if", "#elif", "typedef", "_Static_assert")):
        return []
    floats = [n for n in NUMBER.findall(line) if not n.startswith("0x") and
              ("." in n or "e" in n) and float(n) not in PLAIN_FLOATS]
    counts = line.lstrip().startswith("for (")
    whole = [] if counts else [n for n in re.findall(r"(?<![<>])[/%<>]=? (\d+)[uUlL]*(?![\w.])", line) if int(n) > 2]
    if "parallel_for(" in line:
        whole += [n for n in re.findall(r", (\d+)[uUlL]*(?: <<|,)", line) if int(n) > 0 and n != "1"]
        whole += re.findall(r", 1 << (\d+),", line)
    return floats + whole


def constants(path):
    """What stands in a file: (what tells where, whether it tunes)."""
    text = path.read_text()
    lines, code = text.split("\n"), code_lines(text)
    in_enum = enum_lines("\n".join(code))
    for i, line in enumerate(code):
        what = named(line, i in in_enum)
        in_array = line.lstrip()[:1].isdigit() and code[i - 1].rstrip().endswith("{")
        if not (what or line.startswith("#define") or i in in_enum or in_array):
            what = unnamed(line)
        for name in what:
            yield f"{path.relative_to(ROOT)}:{i + 1}: {name}", not is_marked(lines, i)


def main():
    found = []
    for folder in FOLDERS:
        for path in sorted((ROOT / folder).rglob("*.[ch]")):
            found += constants(path)
    tuning = [where for where, tunes in found if tunes]
    bad = len(tuning) > MOST or len(found) > MOST_OF_ALL
    if "--list" in sys.argv[1:] or bad:
        print("\n".join(tuning))
        print("\n".join(f"{where} (does not tune)" for where, tunes in found if not tunes))
    print(f"{len(tuning)} constants tune photons and transport, {MOST} at most; with those of size, "
          f"identity and mathematics they are {len(found)}, {MOST_OF_ALL} at most")
    return bad


if __name__ == "__main__":
    sys.exit(main())
