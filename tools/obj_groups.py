#!/usr/bin/env python3
"""Splits an OBJ file into one PLY a group, so that a scene can give each its material.

usage: tools/obj_groups.py FILE.obj FOLDER

Writes FOLDER/GROUP.ply: positions, normals, triangles (polygons as fans). Units and axes stay the
file's. Its normals are not taken: where they are means over all faces at a point, edges of stone are
shaded black. Ours are means over those faces at a point that meet at less than CREASE degrees.
Prints each group and its number of triangles.
"""
import math
import pathlib
import struct
import sys


CREASE = 35.0


def normal_of(a, b, c):
    """Of a triangle, as long as twice its area."""
    u, v = [q - p for p, q in zip(a, b)], [q - p for p, q in zip(a, c)]
    return (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])


def unit(v):
    length = math.sqrt(sum(x * x for x in v))
    return tuple(x / length for x in v) if length > 0.0 else v


def index(word, n_positions):
    """Of the position of v, v/vt, v//vn or v/vt/vn; numbers may count from the end."""
    number = int(word.split("/")[0])
    return number - 1 if number > 0 else n_positions + number


def read(path):
    """Positions, and triangles by the groups' names."""
    positions, groups = [], {}
    group = groups.setdefault("none", [])
    for line in path.open(encoding="latin-1"):
        words = line.split()
        if not words:
            continue
        if words[0] == "v":
            positions.append(tuple(map(float, words[1:4])))
        elif words[0] == "g":
            group = groups.setdefault("_".join(words[1:]) or "none", [])
        elif words[0] == "f":
            polygon = [index(w, len(positions)) for w in words[1:]]
            group += [(polygon[0], *polygon[i:i + 2]) for i in range(1, len(polygon) - 1)]
    return positions, {name: g for name, g in groups.items() if g}


def with_normals(triangles, positions):
    """Corners (position, normal), each once, and triangles of their numbers."""
    faces = [normal_of(*[positions[i] for i in t]) for t in triangles]
    units = [unit(f) for f in faces]
    around = {}
    for face, triangle in enumerate(triangles):
        for i in triangle:
            around.setdefault(positions[i], []).append(face)
    least = math.cos(math.radians(CREASE))
    corners, numbered = {}, []
    for face, triangle in enumerate(triangles):
        numbers = []
        for i in triangle:
            near = [f for f in around[positions[i]]
                    if sum(a * b for a, b in zip(units[f], units[face])) >= least]
            normal = unit([sum(faces[f][k] for f in near) for k in range(3)])
            numbers.append(corners.setdefault((positions[i], tuple(normal)), len(corners)))
        numbered.append(numbers)
    return corners, numbered


def write(path, triangles, positions):
    corners, triangles = with_normals(triangles, positions)
    with path.open("wb") as out:
        head = ["ply", "format binary_little_endian 1.0", f"element vertex {len(corners)}"]
        head += [f"property float {name}" for name in ("x", "y", "z", "nx", "ny", "nz")]
        head += [f"element face {len(triangles)}", "property list uchar int vertex_indices",
                 "end_header", ""]
        out.write("\n".join(head).encode())
        for position, normal in corners:
            out.write(struct.pack("<6f", *position, *normal))
        for triangle in triangles:
            out.write(struct.pack("<B3i", 3, *triangle))


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    positions, groups = read(pathlib.Path(sys.argv[1]))
    for name, triangles in sorted(groups.items()):
        write(pathlib.Path(sys.argv[2]) / f"{name}.ply", triangles, positions)
        print(f"{name:24} {len(triangles):7}")


if __name__ == "__main__":
    main()
