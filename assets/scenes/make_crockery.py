#!/usr/bin/python3
"""Writes cup.glb and bowl.glb. Each stands on z = 0 over the origin.
Run: python3 assets/scenes/make_crockery.py"""

import sys
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from glb_file import smooth_normals, whole  # noqa: E402
from glb_shapes import Shape, rounded  # noqa: E402

MATERIALS = {"glaze": (0.72, 0.70, 0.64, 0.0, 0.25), "blue glaze": (0.055, 0.16, 0.34, 0.0, 0.2)}

# The inside of the bowl is part of a ball of this radius, and its lowest point is so high.
HOLLOW, FLOOR = 0.055, 0.004
BRIM = 0.026  # height of the bowl's brim
CUP = (0.017, 0.023, 0.040)  # a cup's radius at its foot and at its brim, and its height
WALL = 0.003


RINGS = 10  # of triangles in the hollow, all about as large: marbles meet few of them at a time


def hollow(steep):
    """Rings of six points, twelve and so on around the lowest point, out to an angle."""
    points, triangles = [np.array([0.0, 0.0, FLOOR])], []

    def at(ring, i):
        return 0 if ring == 0 else 1 + 3 * ring * (ring - 1) + i % (6 * ring)

    for ring in range(1, RINGS + 1):
        a = steep * ring / RINGS
        for i in range(6 * ring):
            turn = 2 * np.pi * i / (6 * ring)
            points.append(np.array([HOLLOW * np.sin(a) * np.cos(turn),
                                    HOLLOW * np.sin(a) * np.sin(turn),
                                    HOLLOW + FLOOR - HOLLOW * np.cos(a)]))
        for side in range(6):
            for i in range(ring):
                inner, outer = side * (ring - 1) + i, side * ring + i
                triangles.append([at(ring - 1, inner), at(ring, outer), at(ring, outer + 1)])
                if i < ring - 1:
                    triangles.append([at(ring - 1, inner), at(ring, outer + 1),
                                      at(ring - 1, inner + 1)])
    return np.array(points), np.array(triangles)


def bowl():
    """From the middle of the underside around the brim, and the hollow."""
    edge = np.sqrt(HOLLOW**2 - (HOLLOW + FLOOR - BRIM) ** 2)  # radius of the hollow at the brim
    outside = rounded([(0.0, 0.0, 0), (0.020, 0.0, 0.001), (0.022, 0.003, 0.002),
                       (edge + WALL, BRIM - 0.002, 0)])
    half = WALL / 2
    angle = np.linspace(-0.3, np.pi - 0.5, 7)
    brim = list(zip(edge + half + half * np.cos(angle), BRIM - 0.0015 + half * np.sin(angle)))
    steep = np.arcsin((edge - 0.0005) / HOLLOW)
    last = (HOLLOW * np.sin(steep), HOLLOW + FLOOR - HOLLOW * np.cos(steep))
    s = Shape()
    s.turned(outside + brim + [last], "z", "blue glaze", segments=6 * RINGS)
    points, triangles = hollow(steep)
    s.parts["glaze"] = [(points, smooth_normals(points, triangles), triangles)]
    for pieces in s.parts.values():  # where both meet they have the same points
        pieces[:] = [(whole(at), normals, triangles) for at, normals, triangles in pieces]
    return s


def handle(s, radius, thick):
    """Two thirds of a ring at the side of the cup, closed at both ends."""
    middle = np.array([(CUP[0] + CUP[1]) / 2 + 0.001, 0, 0.52 * CUP[2]])
    along = np.radians(np.linspace(-96, 96, 25))
    around = np.linspace(0, 2 * np.pi, 14, endpoint=False)
    rows = []
    for i, a in enumerate(along):
        out = np.array([np.cos(a), 0, np.sin(a)])
        tube = np.outer(np.cos(around), out) + np.outer(np.sin(around), [0, 1, 0])
        rows.append(middle + radius * out + thick * tube)
        if i in (0, len(along) - 1):
            rows.insert(len(rows) if i else 0, np.tile(middle + radius * out, (len(around), 1)))
    s.grid(np.array(rows), "glaze")


def cup():
    foot, brim, height = CUP
    lip = WALL / 2
    angle = np.linspace(0, np.pi, 7)
    outside = rounded([(0.0, 0.0, 0), (foot - 0.002, 0.0, 0.001), (foot, 0.003, 0.002),
                       (brim, height - lip, 0)])
    edge = list(zip(brim - lip + lip * np.cos(angle), height - lip + lip * np.sin(angle)))
    inside = rounded([(brim - WALL, height - lip, 0), (foot - WALL, 0.004, 0.004), (0, 0.004, 0)], 6)
    s = Shape()
    s.turned(outside + edge[1:], "z", "glaze", segments=48)
    s.turned([edge[-1]] + inside[1:], "z", "blue glaze", segments=48)
    handle(s, 0.012, 0.0026)
    return s


if __name__ == "__main__":
    print("cup.glb", cup().write(HERE / "cup.glb", MATERIALS), "triangles")
    print("bowl.glb", bowl().write(HERE / "bowl.glb", MATERIALS), "triangles")
