#!/usr/bin/env python3
"""Splits an OBJ file into one PLY a group, so that a scene can give each its material.

usage: tools/obj_groups.py FILE.obj FOLDER

Writes FOLDER/GROUP.ply: positions, normals where the file has them, triangles (polygons as fans).
Units and axes stay the file's. Prints each group and its number of triangles.
"""
import pathlib
import struct
import sys


class Group:
    """Corners that have been met, in order, and triangles of them."""

    def __init__(self):
        self.corners = {}
        self.triangles = []

    def add(self, polygon):
        numbers = [self.corners.setdefault(corner, len(self.corners)) for corner in polygon]
        for i in range(1, len(numbers) - 1):
            self.triangles.append((numbers[0], numbers[i], numbers[i + 1]))


def corner(word, n_positions, n_normals):
    """(position, normal or None) from v, v/vt, v//vn or v/vt/vn; numbers may count from the end."""
    parts = word.split("/")
    position = int(parts[0])
    position = position - 1 if position > 0 else n_positions + position
    if len(parts) < 3 or not parts[2]:
        return position, None
    normal = int(parts[2])
    return position, normal - 1 if normal > 0 else n_normals + normal


def read(path):
    positions, normals, groups = [], [], {}
    group = groups.setdefault("none", Group())
    for line in path.open(encoding="latin-1"):
        words = line.split()
        if not words:
            continue
        if words[0] == "v":
            positions.append(tuple(map(float, words[1:4])))
        elif words[0] == "vn":
            normals.append(tuple(map(float, words[1:4])))
        elif words[0] == "g":
            group = groups.setdefault("_".join(words[1:]) or "none", Group())
        elif words[0] == "f":
            group.add([corner(w, len(positions), len(normals)) for w in words[1:]])
    return positions, normals, {name: g for name, g in groups.items() if g.triangles}


def write(path, group, positions, normals):
    has_normals = all(n is not None for _, n in group.corners)
    names = ["x", "y", "z"] + (["nx", "ny", "nz"] if has_normals else [])
    with path.open("wb") as out:
        head = ["ply", "format binary_little_endian 1.0", f"element vertex {len(group.corners)}"]
        head += [f"property float {name}" for name in names]
        head += [f"element face {len(group.triangles)}", "property list uchar int vertex_indices",
                 "end_header", ""]
        out.write("\n".join(head).encode())
        for position, normal in group.corners:
            out.write(struct.pack("<3f", *positions[position]))
            if has_normals:
                out.write(struct.pack("<3f", *normals[normal]))
        for triangle in group.triangles:
            out.write(struct.pack("<B3i", 3, *triangle))


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    positions, normals, groups = read(pathlib.Path(sys.argv[1]))
    for name, group in sorted(groups.items()):
        write(pathlib.Path(sys.argv[2]) / f"{name}.ply", group, positions, normals)
        print(f"{name:24} {len(group.triangles):7}")


if __name__ == "__main__":
    main()
