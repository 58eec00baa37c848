"""What pictures should show by closed forms, and how far they are from it."""
import array
import math

import cornell


def pixels(path):
    """Width, height and numbers of a PFM file, from the bottom row up."""
    with open(path, "rb") as file:
        assert file.readline() == b"PF\n"
        width, height = map(int, file.readline().split())
        assert float(file.readline()) < 0
        return width, height, array.array("f", file.read())


def cardioid(t):
    """What a unit circle's reflections of a lamp at (-1, 0) touch, cusp at t = 0."""
    return (2.0 * math.cos(t) - math.cos(2.0 * t)) / 3.0, (2.0 * math.sin(t) - math.sin(2.0 * t)) / 3.0


def nephroid(t):
    """The same for parallel light along +x."""
    return 0.75 * math.cos(t) - 0.25 * math.cos(3.0 * t), 0.75 * math.sin(t) - 0.25 * math.sin(3.0 * t)


def on_curve(curve, y):
    """x where a curve whose y grows with t from 0 to a quarter turn has this y."""
    low, high = 0.0, 0.5 * math.pi
    for _ in range(40):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if curve(middle)[1] < y else (low, middle)
    return curve(low)[0]


def brightest(image, row, first, last):
    width, _, values = image
    return max(range(first, last), key=lambda x: values[3 * (row * width + x) + 1])


def off_curve(image, curve, radius):
    """How far, in pixels, the brightest point of each row is from where the curve crosses it."""
    width, height, _ = image
    off = []
    for row in range(height):
        y = abs(row + 0.5 - 0.5 * height) / radius
        if 0.15 < y < 0.6:
            wall = 0.92 * math.sqrt(1.0 - y * y)
            found = brightest(image, row, width // 2, int(width / 2 + wall * radius))
            off.append(abs(found + 0.5 - 0.5 * width - radius * on_curve(curve, y)))
    return sorted(off)


def patch(image, paint, place, normal):
    """XYZ of 3 x 3 pixels around a place: as published figures foretell, and as rendered."""
    width, height, values = image
    column, row = cornell.pixel(place, width)
    foretold, rgb = [0.0] * 3, [0.0] * 3
    for x, y in ((column + i % 3 - 1, row + i // 3 - 1) for i in range(9)):
        lit = cornell.irradiance(cornell.seen(x, y, width, place, normal), normal)
        at = 3 * ((height - 1 - y) * width + x)
        for k in range(3):
            foretold[k] += lit * paint[k] / 9
            rgb[k] += values[at + k] / 9
    return foretold, cornell.xyz_of_srgb(rgb)
