#!/usr/bin/env python3
"""Makes the geometry that the scenes include: turned glass, waves, cut stones.

usage: tools/scene_geometry.py [--check]

Writes what scenes/*/*.pbrt include, each a few hundred control points in plain text: turned things and
waves as cages of Loop's subdivision, so that no facet shows in a caustic, cut stones as flat
polygons. With --check nothing is written, and the exit code is 1 where a file would change.
Lengths are metres, z is up.
"""
import itertools
import math
import pathlib
import random
import sys

SCENES = pathlib.Path(__file__).resolve().parent.parent / "scenes"


def mesh_text(comment, kind, points, triangles, options=""):
    """A Shape of pbrt, a few numbers a line."""
    def lines(items, per_line):
        rows = [items[i:i + per_line] for i in range(0, len(items), per_line)]
        return "\n".join("  " + "  ".join(row) for row in rows)
    numbers = [" ".join(f"{x:.6g}" for x in p) for p in points]
    corners = [" ".join(map(str, t)) for t in triangles]
    return (f"# {comment}\n# Made by tools/scene_geometry.py.\n"
            f"Shape \"{kind}\"{options}\n"
            f"\"point3 P\" [\n{lines(numbers, 4)}\n]\n\"integer indices\" [\n{lines(corners, 10)}\n]\n")


def subdivided(comment, points, triangles, levels=3):
    """Normals of Loop's surfaces point, in pbrt, to where the corners go clockwise."""
    triangles = [t[::-1] for t in triangles]
    return mesh_text(comment, "loopsubdiv", points, triangles, f" \"integer levels\" {levels}")


def turned(profile, around=24, is_open=False):
    """The cage of a body of revolution. profile: (radius, z) from one pole to the other, the
    first and the last on the axis, the outside to the right of the way; is_open: the last is
    an edge."""
    points = [(0.0, 0.0, profile[0][1])]
    rings = profile[1:] if is_open else profile[1:-1]
    for r, z in rings:
        for i in range(around):
            a = 2.0 * math.pi * i / around
            points.append((r * math.cos(a), r * math.sin(a), z))
    if not is_open:
        points.append((0.0, 0.0, profile[-1][1]))
    rows = len(rings)
    at = lambda row, i: 1 + row * around + i % around
    triangles = []
    for i in range(around):
        triangles.append((0, at(0, i + 1), at(0, i)))
        for row in range(rows - 1):
            a, b, c, d = at(row, i), at(row, i + 1), at(row + 1, i), at(row + 1, i + 1)
            triangles += [(a, b, d), (a, d, c)]
        if not is_open:
            triangles.append((len(points) - 1, at(rows - 1, i), at(rows - 1, i + 1)))
    return points, triangles


def waves(half_x, half_y, cells, z, components):
    """Water at rest at height z under waves (amplitude, wave vector x and y, phase)."""
    points = []
    for j in range(cells + 1):
        for i in range(cells + 1):
            x = half_x * (2.0 * i / cells - 1.0)
            y = half_y * (2.0 * j / cells - 1.0)
            points.append((x, y, z + sum(a * math.sin(kx * x + ky * y + phase)
                                         for a, kx, ky, phase in components)))
    triangles = []
    for j in range(cells):
        for i in range(cells):
            a = j * (cells + 1) + i
            b, c, d = a + 1, a + cells + 1, a + cells + 2
            triangles += [(a, b, d), (a, d, c)] if (i + j) % 2 == 0 else [(a, b, c), (b, d, c)]
    return points, triangles


def ripples(seed, n, shortest, longest, slope):
    """Waves of random direction, each of the same mean slope."""
    draw = random.Random(seed)
    out = []
    for _ in range(n):
        length = shortest * (longest / shortest) ** draw.random()
        k, angle = 2.0 * math.pi / length, draw.uniform(0.0, 2.0 * math.pi)
        out.append((slope / (k * math.sqrt(n)), k * math.cos(angle), k * math.sin(angle),
                    draw.uniform(0.0, 2.0 * math.pi)))
    return out


# --- cut stones ---

def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def meet(p, q, r):
    """The point of three planes (normal, distance), or None."""
    d = dot(p[0], cross(q[0], r[0]))
    if abs(d) < 1e-9:
        return None
    sums = [tuple(plane[1] * c for c in crossed) for plane, crossed in
            ((p, cross(q[0], r[0])), (q, cross(r[0], p[0])), (r, cross(p[0], q[0])))]
    return tuple(sum(s[i] for s in sums) / d for i in range(3))


def cut(planes):
    """The convex body under planes (unit normal, distance): points and triangles, each facet
    with corners of its own, so that it is flat."""
    corners = [c for c in (meet(*t) for t in itertools.combinations(planes, 3)) if c is not None
               and all(dot(n, c) <= d + 1e-9 for n, d in planes)]
    points, triangles = [], []
    for n, d in planes:
        on = []
        for c in corners:
            if abs(dot(n, c) - d) < 1e-8 and all(math.dist(c, o) > 1e-7 for o in on):
                on.append(c)
        if len(on) < 3:
            continue
        middle = tuple(sum(c[i] for c in on) / len(on) for i in range(3))
        u = tuple(on[0][i] - middle[i] for i in range(3))
        v = cross(n, u)
        on.sort(key=lambda c: math.atan2(dot(v, [c[i] - middle[i] for i in range(3)]),
                                         dot(u, [c[i] - middle[i] for i in range(3)])))
        first = len(points)
        points += on
        triangles += [(first, first + i, first + i + 1) for i in range(1, len(on) - 1)]
    return points, triangles


def facets(n, elevation, distance, turn=0.0):
    """n planes around the axis whose normals rise by elevation (degrees) over the girdle."""
    e = math.radians(elevation)
    out = []
    for i in range(n):
        a = 2.0 * math.pi * (i + turn) / n
        out.append(((math.cos(e) * math.cos(a), math.cos(e) * math.sin(a), math.sin(e)), distance))
    return out


def through(n, elevation, radius, z, turn=0.0):
    """The same planes, through the point at that radius and height in the middle of each."""
    e = math.radians(elevation)
    return facets(n, elevation, radius * math.cos(e) + z * math.sin(e), turn)


def brilliant(radius):
    """The round brilliant of Tolkowsky's angles (Diamond Design, 1919): crown 34.5 degrees,
    pavilion 40.75, table 0.53 of the width; star, upper and lower halves after common practice."""
    crown, pavilion, table = 34.5, 40.75, 0.53 * radius
    top = (radius - table) * math.tan(math.radians(crown))
    planes = [((0.0, 0.0, 1.0), top)]
    planes += through(8, 90.0 - crown, radius, 0.0)
    planes += through(16, 90.0 - 41.5, radius * 1.002, 0.0, 0.5)
    planes += through(8, 90.0 - 21.5, table * 0.985, top * 0.995, 0.5)
    planes += facets(16, 0.0, radius * 0.995)
    planes += through(8, -(90.0 - pavilion), radius, -0.03 * radius)
    planes += through(16, -(90.0 - 42.3), radius * 1.004, -0.03 * radius, 0.5)
    return cut(planes)


def pendant(radius, height):
    """A drop of a chandelier: eight long facets below, eight short ones above."""
    below = math.degrees(math.atan2(radius, 0.72 * height))
    above = math.degrees(math.atan2(radius, 0.28 * height))
    return cut(through(8, -below, radius, 0.0) + through(8, above, radius, 0.0, 0.5)
               + facets(8, 0.0, 0.97 * radius, 0.25))


# --- the scenes ---

def glass_block(size, depth, wall, ribs, height):
    """A hollow block: a box outside; inside a cavity whose front is a wave of ribs along z and
    whose back is flat. Two Shapes: flat sides, and the ribs with their normals."""
    h, d = 0.5 * size, 0.5 * depth
    points, triangles = [], []

    def quad(a, b, c, e):  # counter-clockwise seen from outside of the glass
        n = len(points)
        points.extend((a, b, c, e))
        triangles.extend([(n, n + 1, n + 2), (n, n + 2, n + 3)])

    def box(x, y, z, outward):
        for axis in range(3):
            for side in (-1.0, 1.0):
                if not outward and axis == 1 and side < 0.0:
                    continue  # the ribs are there
                u, v = (axis + 1) % 3, (axis + 2) % 3
                half = (x, y, z)
                corner = []
                for s, t in ((-1, -1), (1, -1), (1, 1), (-1, 1)):
                    p = [0.0, 0.0, 0.0]
                    p[axis], p[u], p[v] = side * half[axis], s * half[u], t * half[v]
                    corner.append(tuple(p))
                quad(*(corner if (side > 0.0) == outward else corner[::-1]))

    box(h, d, h, True)
    i, front = h - wall, d - wall
    box(i, front, i, False)
    flat = mesh_text("A glass block, 19.6 cm square.", "trianglemesh", points, triangles)
    steps = 24 * ribs
    points, normals, triangles = [], [], []
    for k in range(steps + 1):
        t = k / steps
        x = i * (2.0 * t - 1.0)
        phase = 2.0 * math.pi * ribs * t
        slope = height * math.pi * ribs / i * 0.5 * math.sin(phase)
        y = -front + 0.5 * height * (1.0 - math.cos(phase))
        length = math.hypot(1.0, slope)
        for z in (-i, i):
            points.append((x, y, z))
            normals.append((-slope / length, 1.0 / length, 0.0))
    for k in range(steps):
        a = 2 * k
        triangles += [(a, a + 1, a + 3), (a, a + 3, a + 2)]
    ribbed = mesh_text("Its ribs.", "trianglemesh", points, triangles)
    numbers = "\n".join("  " + "  ".join(" ".join(f"{c:.6g}" for c in n) for n in normals[j:j + 4])
                        for j in range(0, len(normals), 4))
    return flat + ribbed + f"\"normal N\" [\n{numbers}\n]\n"


def block_wall(n, pitch):
    lines = ["# Made by tools/scene_geometry.py.",
             "Material \"diffuse\" \"rgb reflectance\" [0.55 0.53 0.50]"]
    joint, high = 0.006, pitch * n

    def bar(x, z, across, up):  # a joint of mortar, a little narrower than the wall
        for y in (-0.036, 0.036):
            p, q = (x - across, y, z - up), (x + across, y, z + up)
            lines.append(f"Shape \"bilinearmesh\" \"point3 P\" [{p[0]:.4g} {y} {p[2]:.4g}  "
                         f"{q[0]:.4g} {y} {p[2]:.4g}  {p[0]:.4g} {y} {q[2]:.4g}  "
                         f"{q[0]:.4g} {y} {q[2]:.4g}]")

    for k in range(n + 1):
        bar(pitch * (k - 0.5 * n), 0.5 * high, joint, 0.5 * high)
        bar(0.0, pitch * k, 0.5 * high, joint)
    for j in range(n):
        for i in range(n):
            x, z = pitch * (i - 0.5 * (n - 1)), pitch * (j + 0.5)
            lines.append(f"AttributeBegin Translate {x:.4g} 0 {z:.4g} ObjectInstance \"block\" "
                         "AttributeEnd")
    return "\n".join(lines) + "\n"


def chandelier():
    lines = ["# Made by tools/scene_geometry.py."]

    def ring(radius, z, candles, drops):
        lines.append(f"AttributeBegin Translate 0 0 {z:.4g}")
        for r in (radius - 0.006, radius + 0.006):
            lines.append(f"  Shape \"cylinder\" \"float radius\" {r:.4g} \"float zmin\" -0.012 "
                         "\"float zmax\" 0.012")
        for height in (-0.012, 0.012):
            lines.append(f"  Shape \"disk\" \"float height\" {height} \"float radius\" "
                         f"{radius + 0.006:.4g} \"float innerradius\" {radius - 0.006:.4g}")
        for i in range(4):
            lines.append(f"  AttributeBegin Rotate {90 * i + 20} 0 0 1 Rotate 90 0 1 0 "
                         f"Shape \"cylinder\" \"float radius\" 0.004 \"float zmin\" 0.008 "
                         f"\"float zmax\" {radius:.4g} AttributeEnd")
        for i in range(candles):
            a = 360.0 * (i + 0.25) / candles
            lines.append(f"  AttributeBegin Rotate {a:.5g} 0 0 1 Translate {radius:.4g} 0 0.012 "
                         "ObjectInstance \"candle\"")
            lines.append("    Translate 0 0 0.108 Scale 0.005 0.005 0.014 AreaLightSource "
                         "\"diffuse\" \"blackbody L\" 3400 \"float scale\" 260 Material "
                         "\"diffuse\" \"rgb reflectance\" [0 0 0] Shape \"sphere\" AttributeEnd")
        for i in range(drops):
            a = 360.0 * i / drops
            lines.append(f"  AttributeBegin Rotate {a:.5g} 0 0 1 Translate {radius:.4g} 0 -0.033 "
                         f"Rotate {(37 * i) % 90} 0 0 1 ObjectInstance \"drop\" AttributeEnd")
        lines.append("AttributeEnd")

    ring(0.42, 2.12, 10, 40)
    ring(0.24, 2.32, 6, 24)
    ring(0.10, 2.06, 0, 10)
    return "\n".join(lines) + "\n"


def egg(length, width):
    """An egg that stands on its blunt end: a circle drawn out, narrower above."""
    n = 14
    profile = []
    for i in range(n + 1):
        t = math.pi * i / n
        z = -0.5 * length * math.cos(t)
        profile.append((0.5 * width * math.sin(t) * math.exp(-0.22 * z / (0.5 * length)),
                        z + 0.5 * length))
    return turned(profile, 20)


def cup_profile(outside, inside):
    """A vessel: up the outside from the middle of the foot, over the rim, down the inside."""
    return turned([(0.0, outside[0][1])] + outside + inside + [(0.0, inside[-1][1])], 28)


SNIFTER_OUT = [(0.012, 0.0), (0.030, 0.0), (0.0335, 0.0008), (0.0335, 0.0022), (0.028, 0.0034),
               (0.012, 0.0052), (0.0050, 0.009), (0.0042, 0.016), (0.0050, 0.025), (0.012, 0.0305),
               (0.026, 0.037), (0.0375, 0.048), (0.042, 0.062), (0.0405, 0.080), (0.0345, 0.100),
               (0.0290, 0.1160), (0.0280, 0.1195)]
SNIFTER_IN = [(0.0274, 0.1202), (0.0266, 0.1195), (0.0276, 0.1155), (0.0331, 0.0995),
              (0.0391, 0.0795), (0.0406, 0.062), (0.0362, 0.0490), (0.0250, 0.0388),
              (0.012, 0.0332)]
# The liquid reaches halfway into the glass; its surface bends up at the wall.
COGNAC = [(0.0, 0.0322), (0.0122, 0.0325), (0.0254, 0.0381), (0.0368, 0.0486), (0.0402, 0.0550),
          (0.0412, 0.0600), (0.0411, 0.0612), (0.0404, 0.0609), (0.0390, 0.0602), (0.034, 0.0600),
          (0.018, 0.0600), (0.0, 0.0600)]
COFFEE_CUP_OUT = [(0.020, 0.0), (0.026, 0.0), (0.0275, 0.0015), (0.0290, 0.004), (0.0345, 0.016),
                  (0.0385, 0.034), (0.0405, 0.055), (0.0412, 0.0605)]
COFFEE_CUP_IN = [(0.0405, 0.0620), (0.0392, 0.0605), (0.0382, 0.055), (0.0362, 0.035),
                 (0.0325, 0.018), (0.0260, 0.0085), (0.014, 0.0058)]
# The gilding, 0.2 mm thick, from the middle of the bottom to below the rim.
GILDING = [(0.0, 0.0060), (0.0135, 0.0060), (0.0257, 0.0088), (0.0322, 0.0182), (0.0359, 0.0351),
           (0.0379, 0.0550), (0.0387, 0.0600)]
CARAFE_OUT = [(0.030, 0.0), (0.052, 0.0), (0.057, 0.002), (0.0585, 0.006), (0.0570, 0.050),
              (0.0500, 0.110), (0.0320, 0.165), (0.0250, 0.200), (0.0270, 0.230), (0.0330, 0.2475)]
CARAFE_IN = [(0.0330, 0.2500), (0.0308, 0.2485), (0.0246, 0.230), (0.0225, 0.200), (0.0292, 0.165),
             (0.0470, 0.110), (0.0540, 0.050), (0.0550, 0.014), (0.0520, 0.0085), (0.028, 0.0075)]
CARAFE_WATER = [(0.0, 0.0065), (0.0285, 0.0066), (0.0530, 0.0072), (0.0562, 0.0135),
                (0.0555, 0.050), (0.0524, 0.0820), (0.0512, 0.0915), (0.0500, 0.0920),
                (0.0480, 0.0911), (0.044, 0.0905), (0.024, 0.0905), (0.0, 0.0905)]


def files():
    yield "egg", "egg-shape", subdivided("A glass egg, 12 cm tall.", *egg(0.12, 0.088))
    yield "cognac", "glass-shape", subdivided("A cognac glass.", *cup_profile(SNIFTER_OUT, SNIFTER_IN))
    yield "cognac", "cognac-shape", subdivided("What is in the glass.", *turned(COGNAC, 28))
    yield "water-box", "water-shape", subdivided(
        "Wavy water in a box of 1 m.",
        *waves(0.52, 0.52, 52, 0.3, ripples(2, 9, 0.14, 0.30, 0.26)), 2)
    yield "pool", "water-shape", subdivided(
        "The water of a pool, 4 m by 6.",
        *waves(2.1, 3.1, 56, 0.0, ripples(5, 9, 0.35, 1.1, 0.16)), 2)
    yield "diamond", "brilliant-shape", mesh_text(
        "A round brilliant of 1 m girdle radius, its girdle at z = 0.", "trianglemesh",
        *brilliant(1.0))
    yield "chandelier", "pendant-shape", mesh_text(
        "A cut drop, 5 cm long.", "trianglemesh", *pendant(0.012, 0.05))
    yield "glass-blocks", "block-shape", glass_block(0.196, 0.08, 0.008, 3, 0.006)
    yield "glass-blocks", "wall", block_wall(8, 0.2)
    yield "chandelier", "rings", chandelier()
    yield "breakfast", "brilliant-shape", mesh_text(
        "A round brilliant of 1 m girdle radius, its girdle at z = 0.", "trianglemesh",
        *brilliant(1.0))
    yield "breakfast", "cup-shape", subdivided(
        "A coffee cup.", *cup_profile(COFFEE_CUP_OUT, COFFEE_CUP_IN))
    yield "breakfast", "gilding-shape", subdivided(
        "The gilding of the cup's inside.", *turned(GILDING, 28, is_open=True))
    yield "breakfast", "carafe-shape", subdivided("A carafe.", *cup_profile(CARAFE_OUT, CARAFE_IN))
    yield "breakfast", "carafe-water-shape", subdivided("Water in the carafe.", *turned(CARAFE_WATER, 28))


def main():
    changed = []
    for scene, name, text in files():
        path = SCENES / scene / f"{name}.pbrt"
        if path.exists() and path.read_text() == text:
            continue
        changed.append(path)
        if "--check" not in sys.argv[1:]:
            path.parent.mkdir(exist_ok=True)
            path.write_text(text)
    for path in changed:
        print(path.relative_to(SCENES.parent), "is not what it would be" if "--check" in sys.argv
              else "written")
    return 1 if changed and "--check" in sys.argv else 0


if __name__ == "__main__":
    sys.exit(main())
