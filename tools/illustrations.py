#!/usr/bin/env python3
"""Draws the report's illustrations of the method, as SVG.

usage: tools/illustrations.py FOLDER

Each function is one drawing. Rays, points of the tree and photons are computed, not placed by
eye: mirrored, refracted and split as the text says.
"""
import math
import pathlib
import random
import sys

INK, LIGHT, DIRECT, INDIRECT, CAUSTIC, EYE, PALE = ("#222", "#e0a100", "#d98c00", "#2b6cb0",
                                                    "#c0392b", "#2f855a", "#e8e4da")


class Drawing:
    """Shapes in units of pixels, y downward."""

    def __init__(self, width, height):
        self.head = (f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" '
                     'font-family="sans-serif" font-size="13" fill="none" stroke-linecap="round">'
                     f'<rect width="{width}" height="{height}" fill="white"/>')
        self.parts = []

    def line(self, a, b, colour=INK, width=1.5, dash=None):
        dashed = f' stroke-dasharray="{dash}"' if dash else ""
        self.parts.append(f'<path d="M{a[0]:.1f} {a[1]:.1f}L{b[0]:.1f} {b[1]:.1f}" stroke="{colour}" '
                          f'stroke-width="{width}"{dashed}/>')

    def arrow(self, a, b, colour=INK, width=1.5, dash=None):
        self.line(a, b, colour, width, dash)
        angle = math.atan2(b[1] - a[1], b[0] - a[0])
        for turn in (2.7, -2.7):
            self.line(b, (b[0] + 8 * math.cos(angle + turn), b[1] + 8 * math.sin(angle + turn)),
                      colour, width)

    def circle(self, c, r, stroke=INK, fill="none", width=1.5, dash=None):
        dashed = f' stroke-dasharray="{dash}"' if dash else ""
        self.parts.append(f'<circle cx="{c[0]:.1f}" cy="{c[1]:.1f}" r="{r:.1f}" stroke="{stroke}" '
                          f'fill="{fill}" stroke-width="{width}"{dashed}/>')

    def dot(self, c, colour=INK, r=3.5):
        self.circle(c, r, "none", colour)

    def polygon(self, points, stroke=INK, fill="none", width=1.5):
        text = " ".join(f"{x:.1f},{y:.1f}" for x, y in points)
        self.parts.append(f'<polygon points="{text}" stroke="{stroke}" fill="{fill}" '
                          f'stroke-width="{width}"/>')

    def curve(self, points, colour=INK, width=2):
        text = " ".join(f"{x:.1f},{y:.1f}" for x, y in points)
        self.parts.append(f'<polyline points="{text}" stroke="{colour}" stroke-width="{width}"/>')

    def text(self, at, words, anchor="start", colour=INK):
        self.parts.append(f'<text x="{at[0]:.1f}" y="{at[1]:.1f}" text-anchor="{anchor}" '
                          f'fill="{colour}">{words}</text>')

    def done(self):
        return self.head + "\n".join(self.parts) + "\n</svg>\n"


def room(d, x, y, width, height):
    d.polygon([(x, y), (x + width, y), (x + width, y + height), (x, y + height)], INK, "#faf9f6", 2)


def refract_ball(entry, direction, centre, radius, index):
    """The way of a ray through a ball: points of entry and exit, and the last direction."""
    def bend(incoming, normal, ratio):
        cosine = -(incoming[0] * normal[0] + incoming[1] * normal[1])
        root = math.sqrt(1.0 - ratio * ratio * (1.0 - cosine * cosine))
        return tuple(ratio * i + (ratio * cosine - root) * n for i, n in zip(incoming, normal))

    def hit(p, v):
        offset = (p[0] - centre[0], p[1] - centre[1])
        b = offset[0] * v[0] + offset[1] * v[1]
        c = offset[0] ** 2 + offset[1] ** 2 - radius * radius
        root = math.sqrt(b * b - c)
        t = -b - root if -b - root > 1e-6 else -b + root
        return (p[0] + t * v[0], p[1] + t * v[1])

    first = hit(entry, direction)
    normal = tuple((f - c) / radius for f, c in zip(first, centre))
    inside = bend(direction, normal, 1.0 / index)
    second = hit(first, inside)
    normal = tuple((c - s) / radius for s, c in zip(second, centre))
    return first, second, bend(inside, normal, index)


def toward(a, b):
    length = math.dist(a, b)
    return ((b[0] - a[0]) / length, (b[1] - a[1]) / length)


def photon_classes():
    """Direct, indirect and caustic photons of one lamp in a room."""
    d = Drawing(640, 330)
    room(d, 20, 20, 430, 290)
    lamp, ball, radius = (235, 45), (330, 190), 42
    d.circle(ball, radius, INK, "#eef6fb")
    for x in (70, 130):
        d.arrow(lamp, (x, 306), DIRECT)
        d.dot((x, 308), DIRECT)
    d.arrow(lamp, (24, 150), INDIRECT, dash="5 4")
    for end in ((95, 308), (175, 308)):
        d.arrow((22, 150), end, INDIRECT)
        d.dot(end, INDIRECT)
    for offset in (-0.15, -0.05, 0.05, 0.15):
        angle = math.atan2(ball[1] - lamp[1], ball[0] - lamp[0]) + offset
        a, b, out = refract_ball(lamp, (math.cos(angle), math.sin(angle)), ball, radius, 1.5)
        t = (308 - b[1]) / out[1]
        end = (b[0] + t * out[0], 308)
        d.line(lamp, a, CAUSTIC)
        d.line(a, b, CAUSTIC)
        d.arrow(b, end, CAUSTIC)
        d.dot(end, CAUSTIC)
    d.dot(lamp, LIGHT, 9)
    for i, (name, colour) in enumerate((("direct", DIRECT), ("indirect", INDIRECT),
                                        ("caustic", CAUSTIC))):
        d.dot((480, 60 + 26 * i), colour)
        d.text((495, 64 + 26 * i), f"{name} photons")
    d.dot((480, 140), LIGHT, 7)
    d.text((495, 144), "lamp")
    d.text((480, 180), "dashed: not stored,")
    d.text((480, 198), "direct light of the wall")
    return d


def two_passes():
    """From the lamp photons, from the eye rays; they meet where photons lie."""
    d = Drawing(640, 315)
    for x, title in ((20, "1: photons are traced and stored"), (330, "2: rays gather them")):
        room(d, x, 30, 290, 220)
        d.text((x + 145, 303), title, "middle")
    lamp = (120, 45)
    hits = [(60, 246), (110, 246), (170, 246), (230, 246), (306, 150), (22, 140)]
    for h in hits:
        d.arrow(lamp, h, DIRECT)
    for h, to in ((hits[4], (262, 246)), (hits[5], (85, 246)), (hits[2], (306, 90))):
        d.arrow(h, to, INDIRECT)
        hits = hits + [to]
    for h in hits:
        d.dot(h, CAUSTIC)
        d.dot((h[0] + 310, h[1]), CAUSTIC)
    d.dot(lamp, LIGHT, 9)
    eye = (350, 120)
    for h in ((395, 246), (490, 246), (555, 246)):
        d.arrow(eye, h, EYE)
        d.circle(h, 34, EYE, "none", 1.2, "4 3")
    d.polygon([(338, 112), (338, 128), (352, 120)], EYE, "#d8efe2")
    d.text((345, 100), "eye")
    return d


def emission():
    """How lamps of four kinds send photons out."""
    d = Drawing(640, 200)
    draw = random.Random(4)
    for i, name in enumerate(("point", "spot", "sphere", "parallel")):
        c = (85 + 157 * i, 85)
        d.text((c[0], 185), name, "middle")
        if name == "point":
            for k in range(12):
                a = 2 * math.pi * (k + 0.7 * draw.random()) / 12
                d.arrow(c, (c[0] + 58 * math.cos(a), c[1] + 58 * math.sin(a)), DIRECT)
            d.dot(c, LIGHT, 7)
        elif name == "spot":
            top = (c[0], 25)
            for k in range(7):
                a = math.pi / 2 + math.radians(52) * ((k + 0.5) / 7 - 0.5)
                d.arrow(top, (top[0] + 115 * math.cos(a), top[1] + 115 * math.sin(a)), DIRECT)
            d.dot(top, LIGHT, 7)
        elif name == "sphere":
            d.circle(c, 26, LIGHT, "#fff3cf", 2)
            for k in range(10):
                a = 2 * math.pi * (k + draw.random()) / 10
                tilt = a + math.asin(draw.uniform(-0.85, 0.85)) * 0.8
                p = (c[0] + 26 * math.cos(a), c[1] + 26 * math.sin(a))
                d.arrow(p, (p[0] + 38 * math.cos(tilt), p[1] + 38 * math.sin(tilt)), DIRECT)
        else:
            for k in range(6):
                x = c[0] - 48 + 19 * k
                d.arrow((x, 20), (x - 22, 140), DIRECT)
            d.line((c[0] - 55, 20), (c[0] + 55, 20), LIGHT, 5)
    return d


def roulette():
    """Ten photons meet a surface of albedo 0.6: six go on with all their flux."""
    d = Drawing(640, 220)
    d.line((20, 180), (620, 180), INK, 3)
    draw = random.Random(9)
    for k in range(10):
        x = 55 + 58 * k
        d.arrow((x - 26, 70), (x, 177), DIRECT, 3)
        if k % 5 in (0, 2, 3):
            a = -math.pi / 2 + math.asin(draw.uniform(-0.7, 0.7))
            d.arrow((x, 178), (x + 70 * math.cos(a), 178 + 70 * math.sin(a)), INDIRECT, 3)
        else:
            d.line((x - 5, 171), (x + 5, 185), CAUSTIC, 2.5)
            d.line((x - 5, 185), (x + 5, 171), CAUSTIC, 2.5)
    d.text((20, 30), "albedo 0.6: six of ten photons go on, each with the flux it came with,")
    d.text((20, 48), "in place of ten with 0.6 of it: as much light, fewer photons, all alike")
    return d


def gathering():
    """A fixed radius, the k nearest, and the flattened disc."""
    d = Drawing(640, 260)
    draw = random.Random(12)
    for i, name in enumerate(("within a radius", "the 8 nearest", "flattened, at a corner")):
        left = 20 + 210 * i
        d.line((left, 180), (left + 180, 180), INK, 2.5)
        x = (left + 90, 178)
        photons = [(left + 180 * draw.random() ** (1.0 if i < 1 else 1.4), 176) for _ in range(26)]
        reach = 42.0
        if i == 1:
            reach = sorted(abs(p[0] - x[0]) for p in photons)[8]
        if i == 2:
            d.line((left + 120, 180), (left + 120, 60), INK, 2.5)
            photons = [p for p in photons if p[0] < left + 118]
            wall = [(left + 117, 70 + 104 * draw.random()) for _ in range(12)]
            for p in wall:
                d.dot(p, "#bbb" if p[1] < 170 else INDIRECT, 3)
            d.circle(x, reach, "#999", "none", 1, "4 3")
            d.parts.append(f'<ellipse cx="{x[0]}" cy="{x[1]}" rx="{reach}" ry="9" stroke="{EYE}"/>')
        else:
            d.circle(x, reach, EYE, "none", 1.5)
        for p in photons:
            d.dot(p, CAUSTIC if abs(p[0] - x[0]) <= reach else "#bbb", 3)
        d.arrow((x[0] - 50, 60), x, EYE)
        d.text((left + 90, 248), name, "middle")
    return d


def kernels():
    """Weights of the kernels over the distance, each of volume one over the disc."""
    d = Drawing(640, 290)
    left, bottom, wide, tall = 60, 240, 400, 200
    alpha, beta = 0.918, 1.953
    shapes = (("constant", INK, lambda s: 1.0 / math.pi),
              ("cone, k = 1", CAUSTIC, lambda s: 3.0 / math.pi * (1.0 - s)),
              ("Epanechnikov", INDIRECT, lambda s: 2.0 / math.pi * (1.0 - s * s)),
              ("Gaussian (Jensen)", EYE, lambda s: alpha * (1.0 - (1.0 - math.exp(-beta * s * s / 2.0))
                                                           / (1.0 - math.exp(-beta)))))
    d.line((left, bottom), (left + wide + 10, bottom))
    d.line((left, bottom), (left, bottom - tall - 10))
    for i, (name, colour, f) in enumerate(shapes):
        volume = sum(f((k + 0.5) / 2000) * 2.0 * math.pi * (k + 0.5) / 2000 / 2000
                     for k in range(2000))
        d.curve([(left + wide * k / 100, bottom - tall * f(k / 100) / volume) for k in range(101)],
                colour)
        d.line((480, 60 + 24 * i), (500, 60 + 24 * i), colour, 2)
        d.text((508, 64 + 24 * i), name)
    d.text((left + wide / 2, 275), "distance over radius", "middle")
    d.text((left - 10, 30), "weight times r²")
    return d


def tree_points():
    draw = random.Random(3)
    return [(draw.uniform(0.04, 0.96), draw.uniform(0.04, 0.96)) for _ in range(15)]


def split(points, depth, box, out):
    """The median splits of a balanced tree, with the depth of each."""
    if len(points) < 2 or depth > 2:
        return
    axis = depth % 2
    points = sorted(points, key=lambda p: p[axis])
    at = points[len(points) // 2][axis]
    low, high = [list(b) for b in box], [list(b) for b in box]
    low[axis][1], high[axis][0] = at, at
    out.append((depth, axis, at, box))
    split(points[:len(points) // 2], depth + 1, low, out)
    split(points[len(points) // 2 + 1:], depth + 1, high, out)


def kd_tree():
    """Building the balanced tree: the median along x, then y, then x again."""
    d = Drawing(640, 240)
    splits = []
    split(tree_points(), 0, [[0.0, 1.0], [0.0, 1.0]], splits)
    for step in range(3):
        left, top, side = 20 + 210 * step, 15, 180
        d.polygon([(left, top), (left + side, top), (left + side, top + side), (left, top + side)])
        for depth, axis, at, box in splits:
            if depth > step:
                continue
            colour = CAUSTIC if depth == step else "#999"
            if axis == 0:
                ends = ((at, box[1][0]), (at, box[1][1]))
            else:
                ends = ((box[0][0], at), (box[0][1], at))
            d.line(*[(left + side * x, top + side * y) for x, y in ends], colour, 2)
        for x, y in tree_points():
            d.dot((left + side * x, top + side * y), INDIRECT)
        d.text((left + side / 2, 220), f"{['first', 'second', 'third'][step]} split", "middle")
    return d


def nearest_search():
    """The search for the nearest photon: near child first, the other only if the ball reaches it."""
    d = Drawing(640, 240)
    points, query = tree_points(), (0.42, 0.30)
    splits = []
    split(points, 0, [[0.0, 1.0], [0.0, 1.0]], splits)
    _, axis, at, _ = splits[0]
    near_side = [p for p in points if (p[axis] < at) == (query[axis] < at)]
    first = min(near_side[:3], key=lambda p: math.dist(p, query))
    second = min(near_side, key=lambda p: math.dist(p, query))
    last = min(points, key=lambda p: math.dist(p, query))
    titles = ("a first candidate", "nearer ones in the same half", "the other half, if in reach")
    for step, best in enumerate((first, second, last)):
        left, top, side = 20 + 210 * step, 15, 180
        d.polygon([(left, top), (left + side, top), (left + side, top + side), (left, top + side)])
        d.line((left + side * at, top), (left + side * at, top + side), CAUSTIC, 2)
        for x, y in points:
            d.dot((left + side * x, top + side * y), INDIRECT if (x, y) != best else CAUSTIC,
                  3.5 if (x, y) != best else 5)
        centre = (left + side * query[0], top + side * query[1])
        d.circle(centre, side * math.dist(query, best), EYE, "none", 1.5, "4 3")
        d.dot(centre, EYE, 4)
        d.text((left + side / 2, 220), titles[step], "middle")
    return d


def by_area():
    """Points on specular surfaces are chosen by area, so that a fine mesh is not preferred."""
    d = Drawing(640, 210)
    big = [(50, 170), (250, 170), (150, 20)]
    d.polygon(big, INK, "#eef6fb")
    d.text((150, 125), "A", "middle")
    d.text((150, 195), "one triangle, P = A / 2A", "middle")
    a, b, c = ((340, 170), (540, 170), (440, 20))
    at = lambda i, j: (a[0] + (b[0] - a[0]) * i / 3 + (c[0] - a[0]) * j / 3,
                       a[1] + (b[1] - a[1]) * i / 3 + (c[1] - a[1]) * j / 3)
    for i in range(3):
        for j in range(3 - i):
            d.polygon([at(i, j), at(i + 1, j), at(i, j + 1)], INK, "#fbeeee")
            if i + j < 2:
                d.polygon([at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)], INK, "#fbeeee")
    d.text((440, 195), "nine of a ninth, together P = A / 2A", "middle")
    return d


def signs():
    """What the signs of the other drawings mean."""
    d = Drawing(650, 150)
    d.dot((30, 30), LIGHT, 9)
    d.text((50, 35), "lamp")
    d.polygon([(22, 62), (22, 78), (36, 70)], EYE, "#d8efe2")
    d.text((50, 75), "eye, and rays from it")
    d.circle((30, 112), 11, INK, "#eef6fb")
    d.text((50, 117), "glass, mirror: specular")
    for i, (colour, words) in enumerate(((DIRECT, "photon straight from a lamp"), (INDIRECT, "after a diffuse bounce"),
                                         (CAUSTIC, "by way of glass or mirrors"))):
        y = 30 + 41 * i
        d.arrow((260, y), (305, y), colour)
        d.dot((309, y), colour)
        d.text((325, y + 5), words)
    d.line((532, 45), (612, 45), INK, 2.5)
    d.text((572, 65), "diffuse surface", "middle")
    d.circle((572, 105), 20, EYE, "none", 1.2, "4 3")
    d.text((572, 143), "reach of an estimate", "middle")
    return d


def shadow_rays():
    """One ray to a point tells whether it is seen, an area takes several."""
    d = Drawing(640, 240)
    for x, size in ((20, 0), (330, 46)):
        room(d, x, 20, 290, 190)
        lamp, block = (x + 145, 45), (x + 160, 105, 70, 22)
        d.polygon([(block[0], block[1]), (block[0] + block[2], block[1]),
                   (block[0] + block[2], block[1] + block[3]), (block[0], block[1] + block[3])], INK, "#d9d4c7")
        for px in (x + 60, x + 165, x + 235):
            for k in range(-2, 3) if size else (0,):
                to = (lamp[0] + k * size / 2, lamp[1])
                step = lambda y: px + (to[0] - px) * (208 - y) / (208 - to[1])
                stopped = any(block[0] < step(y) < block[0] + block[2] for y in (block[1], block[1] + block[3]))
                d.arrow((px, 208), to, CAUSTIC if stopped else EYE, 1.2, "4 3" if stopped else None)
            d.dot((px, 208))
        if size:
            d.line((lamp[0] - size, lamp[1]), (lamp[0] + size, lamp[1]), LIGHT, 6)
        else:
            d.dot(lamp, LIGHT, 9)
    d.text((165, 230), "a point: seen or not", "middle")
    d.text((475, 230), "an area: how much of it is seen", "middle")
    return d


def aimed():
    """Photons for caustics are sent to where glass and metal are."""
    d = Drawing(640, 230)
    room(d, 20, 20, 600, 190)
    lamp, balls = (320, 60), ((150, 165, 34), (500, 150, 42))
    for x, y, radius in balls:
        d.circle((x, y), radius, INK, "#eef6fb")
        far, aim = math.dist(lamp, (x, y)), math.atan2(y - lamp[1], x - lamp[0])
        for k in range(-3, 4):
            angle = aim + k / 3.4 * math.asin(radius / far)
            v = (math.cos(angle), math.sin(angle))
            hit, _, _ = refract_ball((lamp[0] + 22 * v[0], lamp[1] + 22 * v[1]), v, (x, y), radius, 1.5)
            d.arrow((lamp[0] + 22 * v[0], lamp[1] + 22 * v[1]), hit, CAUSTIC)
    d.circle(lamp, 20, LIGHT, "#fff3cf", 2)
    return d


def reflection():
    """Light from the whole hemisphere is reflected to one direction; a Lambertian surface sends it anywhere."""
    d = Drawing(640, 220)
    for x, title in ((165, "incoming light and one way out"), (475, "Lambert: alike in all directions")):
        d.line((x - 130, 180), (x + 130, 180), INK, 2.5)
        d.arrow((x, 180), (x, 50), INK, 1.2, "5 4")
        d.text((x + 8, 58), "n")
        d.text((x, 208), title, "middle")
    arc = [(165 + 115 * math.cos(math.radians(a)), 180 - 115 * math.sin(math.radians(a))) for a in range(0, 181, 4)]
    d.curve(arc, "#999", 1.2)
    for a in (25, 62, 118, 150):
        rim = (165 + 115 * math.cos(math.radians(a)), 180 - 115 * math.sin(math.radians(a)))
        d.arrow(rim, (165 + 8 * math.cos(math.radians(a)), 180 - 8 * math.sin(math.radians(a))), DIRECT)
    d.arrow((165, 180), (165 + 140 * math.cos(math.radians(42)), 180 - 140 * math.sin(math.radians(42))), EYE, 2.2)
    d.text((275, 80), "v", colour=EYE)
    d.text((60, 92), "L", colour=DIRECT)
    d.arrow((375, 95), (470, 175), DIRECT)
    for a in range(10, 171, 20):
        length = 75
        d.arrow((475, 180), (475 + length * math.cos(math.radians(a)), 180 - length * math.sin(math.radians(a))),
                INDIRECT, 1.3)
    return d


DRAWINGS = (signs, photon_classes, two_passes, shadow_rays, emission, aimed, roulette, gathering, reflection,
            kernels, kd_tree, nearest_search, by_area)


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    folder = pathlib.Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    for drawing in DRAWINGS:
        (folder / f"{drawing.__name__.replace('_', '-')}.svg").write_text(drawing().done())


if __name__ == "__main__":
    main()
