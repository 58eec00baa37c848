"""Plots as SVG, of both axes logarithmic."""
import math

WIDTH, HEIGHT, LEFT, RIGHT, TOP, BOTTOM = 600, 360, 70, 170, 16, 50
COLOURS = ["#0b6e99", "#c4501b", "#4f8a10", "#8a3ab9", "#b58900", "#555555"]


def decades(values):
    """Powers of ten around all values."""
    low = math.floor(math.log10(min(values)) + 1e-9)
    high = math.ceil(math.log10(max(values)) - 1e-9)
    return low, max(high, low + 1)


def ticks(low, high):
    return range(low, high + 1, 1 if high - low <= 6 else 2)


def log_log(series, x_label, y_label):
    """series: (name, xs, ys), positive numbers. @return the text of an SVG file"""
    x_low, x_high = decades([x for s in series for x in s[1]])
    y_low, y_high = decades([y for s in series for y in s[2]])
    wide, tall = WIDTH - LEFT - RIGHT, HEIGHT - TOP - BOTTOM

    def at(x, y):
        return (LEFT + wide * (math.log10(x) - x_low) / (x_high - x_low),
                TOP + tall * (1.0 - (math.log10(y) - y_low) / (y_high - y_low)))

    out = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" '
           'font-family="sans-serif" font-size="12"><rect width="100%" height="100%" fill="white"/>']
    for e in ticks(x_low, x_high):
        x, _ = at(10.0 ** e, 10.0 ** y_low)
        out.append(f'<path d="M{x:.1f} {TOP}V{TOP + tall}" stroke="#ddd"/><text x="{x:.1f}" '
                   f'y="{TOP + tall + 16}" text-anchor="middle">{10.0 ** e:g}</text>')
    for e in ticks(y_low, y_high):
        _, y = at(10.0 ** x_low, 10.0 ** e)
        out.append(f'<path d="M{LEFT} {y:.1f}H{LEFT + wide}" stroke="#ddd"/><text x="{LEFT - 6}" '
                   f'y="{y + 4:.1f}" text-anchor="end">{10.0 ** e:g}</text>')
    out.append(f'<text x="{LEFT + wide / 2}" y="{HEIGHT - 10}" text-anchor="middle">{x_label}</text>')
    out.append(f'<text transform="translate(16 {TOP + tall / 2}) rotate(-90)" '
               f'text-anchor="middle">{y_label}</text>')
    for i, (name, xs, ys) in enumerate(series):
        colour = COLOURS[i % len(COLOURS)]
        points = [at(x, y) for x, y in zip(xs, ys)]
        line = " ".join(f"{x:.1f},{y:.1f}" for x, y in points)
        out.append(f'<polyline points="{line}" fill="none" stroke="{colour}" stroke-width="2"/>')
        out += [f'<circle cx="{x:.1f}" cy="{y:.1f}" r="3" fill="{colour}"/>' for x, y in points]
        y = TOP + 14 + 18 * i
        out.append(f'<path d="M{LEFT + wide + 10} {y - 4}h16" stroke="{colour}" stroke-width="2"/>'
                   f'<text x="{LEFT + wide + 30}" y="{y}">{name}</text>')
    return "\n".join(out) + "\n</svg>\n"
