#!/usr/bin/python3
"""Writes table.glb: a desk top with rounded corners whose surface is at z = -0.04 m, in the device
base frame. Run: python3 assets/scenes/make_table.py"""

import sys
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from glb_shapes import Shape, rounded  # noqa: E402

TOP, THICK = -0.04, 0.018
X = (-0.17, 0.36)
HALF_Y, CORNER = 0.30, 0.035
MATERIALS = {"desk": (0.50, 0.49, 0.47, 0.0, 0.85)}


def outline(inset, steps=8):
    """A rounded rectangle, counter-clockwise from above; a large inset shrinks it to its centre."""
    middle, half_x = (X[0] + X[1]) / 2, (X[1] - X[0]) / 2
    points = []
    for quarter, (sx, sy) in enumerate([(1, 1), (-1, 1), (-1, -1), (1, -1)]):
        for t in np.linspace(0, np.pi / 2, steps + 1) + quarter * np.pi / 2:
            radius = CORNER - inset
            points.append((middle + sx * (half_x - CORNER) + radius * np.cos(t),
                           sy * (HALF_Y - CORNER) + radius * np.sin(t)))
    return np.array(points)


def table():
    profile = rounded([(0.02, TOP - THICK, 0), (0, TOP - THICK, 0.004), (0, TOP, 0.005),
                       (0.02, TOP, 0)], 4)
    rings = [np.column_stack([outline(inset), np.full(36, z)]) for inset, z in profile]
    middle = np.array([(X[0] + X[1]) / 2, 0, 0])
    rings = [np.tile(middle + [0, 0, TOP - THICK], (36, 1))] + rings
    rings.append(np.tile(middle + [0, 0, TOP], (36, 1)))
    s = Shape()
    s.grid(np.array(rings), "desk")
    return s


if __name__ == "__main__":
    print("table.glb", table().write(HERE / "table.glb", MATERIALS), "triangles")
