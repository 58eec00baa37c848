#!/usr/bin/env python3
"""Puts the files that Doxygen's pages link to beside them, and says which links lead nowhere.

usage: tools/doxygen_links.py FOLDER    (of the HTML pages; exit code 1 if there are any)
"""
import html.parser
import os
import pathlib
import re
import shutil
import sys
import urllib.parse

ROOT = pathlib.Path(__file__).resolve().parent.parent


class Page(html.parser.HTMLParser):
    """What a page is linked by, and what it links to."""

    def __init__(self, path):
        super().__init__()
        self.names, self.links = set(), set()
        self.feed(path.read_text(errors="replace"))

    def handle_starttag(self, tag, attributes):
        for name, value in attributes:
            if value and name in ("id", "name"):
                self.names.add(value)
            elif value and name in ("href", "src", "data"):
                self.links.add(value)


def fetch(folder, target):
    """Copies what is linked under files/ from the project."""
    source = ROOT / pathlib.Path(target).relative_to("files")
    if source.is_file():
        (folder / target).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(source, folder / target)


def leads_somewhere(folder, pages, page, link):
    if re.match(r"(?!file:)[a-z]+:|/", link):
        return True
    path, _, name = link.partition("#")
    target = os.path.normpath(urllib.parse.unquote(path)) if path else page
    if target.startswith("files/"):
        fetch(folder, target)
    if target in pages:
        return not name or urllib.parse.unquote(name) in pages[target].names
    return (folder / target).exists()


def main():
    folder = pathlib.Path(sys.argv[1])
    pages = {path.name: Page(path) for path in folder.glob("*.html")}
    lost = [f"{page}: {link} leads nowhere" for page, its in sorted(pages.items())
            for link in sorted(its.links) if not leads_somewhere(folder, pages, page, link)]
    print("\n".join(lost or [f"{len(pages)} pages, whose links all lead somewhere"]))
    sys.exit(1 if lost or not pages else 0)


if __name__ == "__main__":
    main()
