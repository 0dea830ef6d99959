#!/usr/bin/python3
"""Writes ball_1.glb to ball_5.glb, from felt to brass: the number of rings carved into a ball says
how hard it is. Each stands on z = 0 over the origin. Run: python3 assets/scenes/make_balls.py"""

import sys
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from glb_file import (Part, grid_triangles, smooth_normals, whole,  # noqa: E402
                      write_glb)

RADIUS = 0.019
SEGMENTS, ROWS = 72, 30   # around, and from pole to pole besides the rings
RING, DEEP = 0.0014, 0.0006  # half width and depth of a ring
APART = np.radians(15)    # between rings, seen from the centre
HIGHEST = np.radians(52)  # of the uppermost ring

BALLS = {  # linear red, green, blue, metallic, roughness; and the rings' colour
    "felt": ((0.055, 0.20, 0.075, 0.0, 1.0), (0.015, 0.06, 0.02)),
    "rubber": ((0.36, 0.075, 0.065, 0.0, 0.62), (0.09, 0.015, 0.014)),
    "wood": ((0.30, 0.135, 0.045, 0.0, 0.42), (0.09, 0.035, 0.012)),
    "glass": ((0.36, 0.58, 0.60, 0.0, 0.04), (0.75, 0.88, 0.88)),
    "brass": ((0.70, 0.46, 0.15, 1.0, 0.22), (0.16, 0.09, 0.02)),
}


def ball(material, rings, color, ring_color):
    middles = HIGHEST - APART * np.arange(rings)
    near = RING / RADIUS * np.array([-1.5, -1, -0.6, -0.25, 0.25, 0.6, 1, 1.5])
    latitude = np.linspace(-np.pi / 2, np.pi / 2, ROWS + 1)
    free = np.abs(latitude[:, None] - middles).min(axis=1) > 1.9 * RING / RADIUS
    latitude = np.sort(np.concatenate([latitude[free], (middles[:, None] + near).ravel()]))
    off = np.abs(latitude[:, None] - middles).min(axis=1) * RADIUS / RING
    carved = np.where(off < 1, np.cos(np.pi / 2 * np.minimum(off, 1)) ** 2, 0)
    radius = RADIUS - DEEP * carved

    angle = np.linspace(0, 2 * np.pi, SEGMENTS, endpoint=False)
    points = np.stack([(radius * np.cos(latitude))[:, None] * np.cos(angle),
                       (radius * np.cos(latitude))[:, None] * np.sin(angle),
                       RADIUS + (radius * np.sin(latitude))[:, None] + 0 * angle], -1)
    share = np.clip(2 * carved, 0, 1)[:, None, None]
    paint = np.broadcast_to(np.asarray(color) * (1 - share) + np.asarray(ring_color) * share,
                            points.shape).copy()
    if material == "wood":  # year rings of a tree that stood upright, a little off the middle
        to_pith = np.hypot(points[..., 0] + 0.011, points[..., 1] - 0.004)
        to_pith += 0.0006 * np.sin(140 * points[..., 2])
        paint *= (0.86 + 0.20 * np.abs(np.sin(np.pi * to_pith / 0.0035)))[..., None]
    if material == "felt":  # fibres
        paint *= 1 - 0.45 * np.random.default_rng(1).random(points.shape[:2])[..., None] ** 3

    # One point at each pole instead of a whole row.
    flat = whole(np.concatenate([points[:1, 0], points[1:-1].reshape(-1, 3), points[-1:, 0]]))
    paint = np.concatenate([paint[:1, 0], paint[1:-1].reshape(-1, 3), paint[-1:, 0]])
    count = len(latitude)
    number = np.clip(np.arange(count * SEGMENTS) - SEGMENTS + 1, 0, len(flat) - 1)
    triangles = number[grid_triangles(count, SEGMENTS, around=True)]
    a, b, c = triangles.T
    triangles = triangles[(a != b) & (b != c) & (c != a)]
    return Part(material, flat, smooth_normals(flat, triangles), triangles, paint)


if __name__ == "__main__":
    for k, (name, (look, ring_color)) in enumerate(BALLS.items(), 1):
        part = ball(name, k, look[:3], ring_color)
        count = write_glb(HERE / f"ball_{k}.glb", [part], {name: (1, 1, 1, *look[3:])},
                          "make_balls.py")
        print(f"ball_{k}.glb", count, "triangles")
