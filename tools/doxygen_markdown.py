#!/usr/bin/env python3
"""Writes Markdown, as forges show it, the way Doxygen reads it.

usage: tools/doxygen_markdown.py FILE.md    (docs/Doxyfile's filter)

Formulas between dollars get Doxygen's marks; headings within a page get the names that links
use for them, with the file's own before them, since Doxygen knows them all in one. Files that are no
pages are named from the project's root, under files/ where they are links (tools/doxygen_links.py
puts them there). What is code stays, and so does the number of lines, so that warnings name the right one.
"""
import pathlib
import re
import sys

CODE = re.compile(r"(^```.*?^```|`[^`\n]*`)", re.S | re.M)
DISPLAYED = re.compile(r"\$\$(.+?)\$\$", re.S)
INLINE = re.compile(r"(?<![\\$\w])\$(?!\s)((?:[^$`\n]|\n(?!\n))+?)(?<!\s)\$(?![\w$])")
HEADING = re.compile(r"^(##+ +)(.*)$")
LINK = re.compile(r"\]\(([\w./-]*\.md)?#([\w-]+)\)")
FILE = re.compile(r"(!\[[^][]*)?\]\((?![a-z]+:)([\w./-]+\.(?!md\b)\w+)\)")
ROOT = pathlib.Path(__file__).resolve().parent.parent


def formulas(text):
    parts = DISPLAYED.split(text)
    for i, part in enumerate(parts):
        parts[i] = rf"\f[{part}\f]" if i % 2 else INLINE.sub(r"\\f$\1\\f$", part)
    return "".join(parts)


def anchor(title):
    """What links call a heading."""
    words = re.sub(r"\[([^]]*)\]\([^)]*\)", r"\1", title).strip().lower()
    return re.sub(r"[^\w\- ]", "", words).replace(" ", "-")


def named_headings(text, stem):
    in_code = False
    for line in text.split("\n"):
        in_code ^= line.startswith("```")
        heading = HEADING.match(line)
        if heading and not in_code:
            line += f" {{#{stem}--{anchor(heading[2])}}}"
        yield line


def files(text, folder):
    def from_root(match):
        path = (folder / match[2]).resolve().relative_to(ROOT)
        if match[1]:
            return f"{match[1]}]({path})"
        return f"](@ref {path})" if path.suffix in (".c", ".h") else f"](files/{path})"

    return FILE.sub(from_root, text)


def main():
    path = pathlib.Path(sys.argv[1])
    stem = path.parent.name if path.stem == "README" else path.stem
    text = "\n".join(named_headings(path.read_text(), stem))
    text = LINK.sub(lambda m: f"](#{pathlib.Path(m[1] or stem).stem}--{m[2]})", text)
    for i, part in enumerate(CODE.split(text)):
        sys.stdout.write(part if i % 2 else formulas(files(part, path.parent)))


if __name__ == "__main__":
    main()
