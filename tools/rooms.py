#!/usr/bin/env python3
"""What the house is to keep to, counted: files in a folder (of any kind), and the places in which a
kind of things has to be named beside its own file and its line of a .def.

Prints both; exits with 1 above MOST_FILES or if a kind is named anywhere else, be it in a text
or an array that lists kinds.
"""
import os
import re
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
MOST_FILES = 30
SOURCE = re.compile(r'\.(c|h|cpp)$')

# .def, what its symbols are called, and what lies in the same file or folder
REGISTRIES = [
    ('src/material/material.def', 'material_{0}', 'src/material/material_{1}.c'),
    ('src/texture/texture.def', 'texture_{0}', 'src/texture/texture_{1}.c'),
    ('src/shape/shape.def', 'shape_{0}', 'src/shape/shape_{1}.c'),
    ('src/light/light.def', 'light_{0}', 'src/light/light_{1}.c'),
    ('src/image/codec.def', 'codec_{0}', 'src/image/{1}.c'),
    ('src/format/format.def', '{0}_reader', 'src/format/{0}/'),
    ('src/settings/integrator.def', 'transport_{1}', 'src/transport/{1}/'),
    ('src/settings/map.def', 'point_index_{1}', 'src/photon/map/map_{1}.c'),
]


# Kinds that others are made of: a mesh by subdivision and readers, an area light of a
# shape that shines, the algorithms that auto joins.
PARTS = {'shape_mesh', 'light_area', 'transport_photonmap', 'transport_path'}


# Arrays that list what is another's, whose kinds are ours by name.
OTHERS = {'src/format/model/model_light.c'}  # the three lamps that an importer's files have

STRING = r'"[^"\\\n]*(?:\\.[^"\\\n]*)*"'
TEXT = re.compile(rf'{STRING}(?:\s+{STRING})*')
ARRAY = re.compile(rf'{STRING}(?:\s*,\s*(?:\[\w+\] = )?{STRING})+')
# "a, b or c", each perhaps in quotes
LISTED = re.compile(r'\w+(?=,| or )|(?<= or )\w+')


def sources(*folders):
    """Paths of source files and their text."""
    for folder in folders:
        for at, _, names in os.walk(os.path.join(ROOT, folder)):
            for name in sorted(names):
                if SOURCE.search(name):
                    path = os.path.join(at, name)
                    with open(path, encoding='utf-8') as file:
                        yield os.path.relpath(path, ROOT), file.read()


def count_files():
    """Files of any kind, by folder."""
    return {os.path.relpath(at, ROOT): len(names)
            for folder in ('src', 'gui', 'cli')
            for at, _, names in os.walk(os.path.join(ROOT, folder))}


def kinds(registry):
    """The words of each line of a .def."""
    with open(os.path.join(ROOT, registry), encoding='utf-8') as file:
        for line in file:
            entry = re.fullmatch(r'[A-Z]+\((\w+)(?:, (\w+))?\)\n', line)
            if entry:
                yield entry[1], entry[2] or entry[1]


def find_places(registry, symbol, own, texts):
    """Files that define or name a kind as a value, its own apart."""
    for words in kinds(registry):
        kind = symbol.format(*words)
        if kind in PARTS:
            continue
        name = re.compile(rf'&{kind}\b|\b{kind}\.')
        for path, text in texts:
            if name.search(text) and not path.startswith(own.format(*words)):
                yield kind, path


def lists_in(text):
    """Words of each text that lists some, and of each array of words."""
    for said in TEXT.findall(text):
        plain = re.sub(r'"\s+"', '', said).replace('\\"', '')
        yield LISTED.findall(plain)
    for array in ARRAY.findall(text):
        yield re.findall(r'"(\w+)"', array)


def find_lists(registry, own, texts, lists):
    """Files with a list of kinds by name, which is to be made from the .def."""
    file = re.compile(own.format(r'\w+', r'\w+'))
    names = {n for path, text in texts if file.match(path)
             for n in re.findall(r'\.name = "(\w+)"', text)}
    names.update(word for words in kinds(registry) for word in words)
    for path, words in lists:
        listed = names.intersection(words)
        if len(listed) > 2:
            yield ' '.join(sorted(listed)), path


def main():
    wrong = 0
    for folder, n in sorted(count_files().items(), key=lambda c: (-c[1], c[0]))[:8]:
        too_many = n > MOST_FILES
        wrong += too_many
        print(f'{n:4} files in {folder}' + (f', more than {MOST_FILES}' if too_many else ''))
    texts = list(sources('src', 'gui', 'cli'))
    lists = [(path, words) for path, text in texts if path not in OTHERS
             for words in lists_in(text)]
    for registry, symbol, own in REGISTRIES:
        places = (list(find_places(registry, symbol, own, texts)) +
                  list(find_lists(registry, own, texts, lists)))
        print(f'{len(list(kinds(registry))):4} kinds in {registry}, '
              f'{len(places)} named elsewhere')
        for kind, path in places:
            print(f'     {kind}: {path}')
        wrong += len(places)
    sys.exit(1 if wrong else 0)


if __name__ == '__main__':
    main()
