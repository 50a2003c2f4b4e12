#!/usr/bin/env python3
"""Thins the polylines of SVG files in place: points that lie within 0.1 px of the line without them go.

    docs/thin_svg.py FILE.svg...

The program draws up to 1500 points a line; on a page a tenth of them looks the same and the file is a tenth as large.
"""
import math
import re
import sys

TOLERANCE_PX = 0.1


def thin(points):
    """Ramer, Douglas and Peucker, without recursion."""
    keep = {0, len(points) - 1}
    spans = [(0, len(points) - 1)]
    while spans:
        a, b = spans.pop()
        (xa, ya), (xb, yb) = points[a], points[b]
        dx, dy = xb - xa, yb - ya
        length = math.hypot(dx, dy)
        worst, at = 0.0, a
        for i in range(a + 1, b):
            x, y = points[i][0] - xa, points[i][1] - ya
            along = min(max((x * dx + y * dy) / (length * length), 0.0), 1.0) if length else 0.0
            away = math.hypot(x - along * dx, y - along * dy)
            if away > worst:
                worst, at = away, i
        if worst > TOLERANCE_PX:
            keep.add(at)
            spans += [(a, at), (at, b)]
    return [points[i] for i in sorted(keep)]


def polyline(match):
    points = [tuple(map(float, p.split(","))) for p in match[1].split()]
    return 'points="' + " ".join(f"{x:g},{y:g}" for x, y in thin(points)) + '"'


for path in sys.argv[1:]:
    with open(path, encoding="utf-8") as file:
        text = file.read()
    with open(path, "w", encoding="utf-8") as file:
        file.write(re.sub(r'points="([^"]*)"', polyline, text))
