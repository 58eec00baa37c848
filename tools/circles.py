#!/usr/bin/env python3
"""Circles: lists files of src/ (or gui/) that call one another in a ring, and folders of
src/ that include one another so.

usage: circles.py BUILD_FOLDER

Calls are read off the object files: a file calls another if it needs a function that the
other one defines. Data does not count, so the table of a registry may name kinds that
call the registry. Speaks TAP; exits with 1 if there is a circle.
"""
import glob
import os
import pathlib
import re
import subprocess
import sys


def symbols(paths):
    """By object file: the functions that it defines, and the names that it needs."""
    defined = {path: set() for path in paths}
    needed = {path: set() for path in paths}
    lines = subprocess.run(['nm', '-A', '--format=posix', *paths], check=True, text=True,
                           capture_output=True).stdout.splitlines()
    for line in lines:
        path, _, rest = line.partition(': ')
        name, kind = rest.split()[:2]
        if kind in 'TW':
            defined[path].add(name)
        elif kind == 'U':
            needed[path].add(name)
    return defined, needed


def objects(build):
    """Object files by the name of their source: src/room/file."""
    found = {}
    for room in ('.', 'gui', 'cli'):
        for folder in glob.glob(os.path.join(build, room, '*.p')):
            for name in os.listdir(folder):
                of = re.fullmatch(r'(?:(src)_)?(\w+)\.(?:c|cpp)\.o', name)
                if of and (of[1] or room != '.'):
                    found.setdefault((of[1] or room) + '/' + of[2],
                                     os.path.join(folder, name))
    return found


def calls(files):
    """Who calls whom."""
    defined, needed = symbols(list(files.values()))
    home = {}
    for source, path in files.items():
        for name in defined[path]:
            home.setdefault(name, source)
    return {source: {home[n] for n in needed[path] if n in home} - {source}
            for source, path in files.items()}


def includes():
    """Which folder of src/ includes which others."""
    src = pathlib.Path(__file__).resolve().parent.parent / 'src'
    graph = {}
    for file in [*src.rglob('*.[ch]'), *src.rglob('*.cpp')]:
        own = str(file.parent.relative_to(src))
        names = re.findall(r'^ *# *include "([^"]+)/[^/"]+"', file.read_text(), re.M)
        graph.setdefault(own, set()).update(set(names) - {own})
    return {own: others & set(graph) for own, others in graph.items()}


def circles(graph):
    """Sets of nodes of which each reaches each other one (Tarjan 1972)."""
    number, low, stack, found = {}, {}, [], []

    def visit(at):
        number[at] = low[at] = len(number)
        stack.append(at)
        for to in graph[at]:
            if to not in number:
                visit(to)
                low[at] = min(low[at], low[to])
            elif to in stack:
                low[at] = min(low[at], number[to])
        if low[at] == number[at]:
            ring = []
            while not ring or ring[-1] != at:
                ring.append(stack.pop())
            if len(ring) > 1:
                found.append(sorted(ring))

    for at in sorted(graph):
        if at not in number:
            visit(at)
    return found


def tell(number, name, graph):
    """A line of TAP, and each ring before it; how many there are."""
    found = circles(graph)
    for ring in found:
        print('# circle:', ' '.join(ring))
        for at in ring:
            print('#    ', at, '->', ' '.join(sorted(graph[at] & set(ring))))
    print(f'# {len(graph)} {name}, {len(found)} circles')
    print('not ok' if found else 'ok', f'{number} /circles/{name}')
    return len(found)


def main():
    sys.setrecursionlimit(10000)
    files, folders = calls(objects(sys.argv[1])), includes()
    if min(len(files), len(folders)) < 10:
        sys.exit(f'circles: only {len(files)} object files in {sys.argv[1]}')
    print('1..3')
    found = tell(1, 'files', files) + tell(2, 'folders', folders)
    planted = circles({'a': {'b'}, 'b': {'c'}, 'c': {'a'}, 'd': {'a'}})
    print('ok' if planted == [['a', 'b', 'c']] else 'not ok', '3 /circles/planted-fault')
    sys.exit(1 if found else 0)


if __name__ == '__main__':
    main()
