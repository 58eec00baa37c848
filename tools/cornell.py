"""What the Cornell box' published figures say of places that its lamp lights: paints, lamp and
corners in, XYZ out, by a closed form that shares nothing with the renderer.

The irradiance of a polygon of even radiance is Lambert's sum over its edges. Only places that see
all of the lamp are asked about.
"""
import math
import re

from renders import ROOT

LAMP = [(343, 548.7, 227), (343, 548.7, 332), (213, 548.7, 332), (213, 548.7, 227)]  # mm
RADIANCE = [(400, 0.0), (500, 8.0), (600, 15.6), (700, 18.4)]  # nm, times 20 in the scene
LUMINANCE = 20.0  # of the lamp in the scene: as in pbrt, its spectrum only tells the colour
EYE, FOV = (278.0, 273.0, -800.0), 2 * math.atan(12.5 / 35)
PAINTS = {"white": 0, "red": 1, "green": 2}

# Name, paint, place (mm) and normal: all see the whole lamp.
PATCHES = [
    ("floor, front left", "white", (430, 0, 60), (0, 1, 0)),
    ("floor, left", "white", (500, 0, 60), (0, 1, 0)),
    ("back wall, above", "white", (200, 400, 559.2), (0, 0, -1)),
    ("back wall, right", "white", (130, 250, 559.2), (0, 0, -1)),
    ("green wall, middle", "green", (0, 273, 280), (1, 0, 0)),
    ("green wall, front", "green", (0, 150, 120), (1, 0, 0)),
    ("short block, top", "white", (186, 165, 169), (0, 1, 0)),
]


def table(file, name):
    """The rows of a table of numbers in src/color/data."""
    text = (ROOT / "src/color/data" / file).read_text()
    body = text[text.index(name + "["):]
    rows = re.findall(r"\{([^{}]*)\}", body[:body.index("};")])
    return [[float(x) for x in re.findall(r"-?\d[\d.]*(?:e-?\d+)?", re.sub(r"/\*.*?\*/", "", r))]
            for r in rows]


def at(points, nm):
    """Linear between points, none beyond them."""
    for (a, x), (b, y) in zip(points, points[1:]):
        if a <= nm <= b:
            return x + (y - x) * (nm - a) / (b - a)
    return 0.0


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def unit(a):
    length = math.sqrt(dot(a, a))
    return tuple(x / length for x in a)


def irradiance(place, normal):
    """Of the lamp at radiance one."""
    to = [unit([x - y for x, y in zip(corner, place)]) for corner in LAMP]
    return abs(0.5 * sum(math.acos(dot(a, b)) * dot(normal, unit(cross(a, b)))
                         for a, b in zip(to, to[1:] + to[:1])))


def weighed_by_eye(light):
    """XYZ of a function of nanometres."""
    observer = [list(zip(range(360, 835, 5), row))
                for row in table("observer.c", "cie1931_observer")]
    return [sum(light(nm) * at(bar, nm) for nm in range(400, 701)) for bar in observer]


def paint_xyz(paint):
    """What a paint sends out under the lamp, per irradiance of a lamp of radiance one."""
    values = table("cornell.c", "cornell_paints")[PAINTS[paint]]
    rho = [(400 + 4 * i, value) for i, value in enumerate(values)]
    lamp = weighed_by_eye(lambda nm: at(RADIANCE, nm))[1]
    out = weighed_by_eye(lambda nm: at(RADIANCE, nm) * at(rho, nm))
    return [LUMINANCE * x / lamp / math.pi for x in out]


def pixel(place, size):
    """The pixel in which the camera of scenes/cornell-box sees it, of size x size, from above."""
    x, y, z = (a - b for a, b in zip(place, EYE))
    half = math.tan(FOV / 2)
    return tuple(int((1 - a / z / half) / 2 * size) for a in (x, y))


def seen(column, row, size, place, normal):
    """What the middle of a pixel shows of the plane through a place."""
    half = math.tan(FOV / 2)
    way = (half * (1 - (2 * column + 1) / size), half * (1 - (2 * row + 1) / size), 1.0)
    t = dot([a - b for a, b in zip(place, EYE)], normal) / dot(way, normal)
    return tuple(e + t * w for e, w in zip(EYE, way))


def xyz_of_srgb(rgb):
    """From linear sRGB."""
    m = ((0.412391, 0.357584, 0.180481), (0.212639, 0.715169, 0.072192),
         (0.019331, 0.119195, 0.950532))
    return [dot(row, rgb) for row in m]


def chromaticity(c):
    return [x / sum(c) for x in c[:2]]
