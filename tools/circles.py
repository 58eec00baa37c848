#!/usr/bin/env python3
"""Circles of files: lists files of src/ (or gui/) that call one another in a ring.

usage: circles.py BUILD_FOLDER

Read off the object files: a file calls another if it needs a function that the other one
defines. Data does not count, so the table of a registry may name kinds that call the
registry. Speaks TAP; exits with 1 if there is a circle.
"""
import glob
import os
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


def circles(graph):
    """Sets of files of which each reaches each other one (Tarjan 1972)."""
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


def main():
    sys.setrecursionlimit(10000)
    graph = calls(objects(sys.argv[1]))
    if len(graph) < 10:
        sys.exit(f'circles: only {len(graph)} object files in {sys.argv[1]}')
    found = circles(graph)
    for ring in found:
        print('# circle:', ' '.join(ring))
        for at in ring:
            print('#    ', at, '->', ' '.join(sorted(graph[at] & set(ring))))
    print(f'# {len(graph)} files, {len(found)} circles\n1..2')
    print('not ok' if found else 'ok', '1 /circles/none')
    planted = circles({'a': {'b'}, 'b': {'c'}, 'c': {'a'}, 'd': {'a'}})
    print('ok' if planted == [['a', 'b', 'c']] else 'not ok', '2 /circles/planted-fault')
    sys.exit(1 if found else 0)


if __name__ == '__main__':
    main()
