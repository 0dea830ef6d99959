#!/usr/bin/python3
"""Writes gear.glb and pinion.glb: a helical pair with involute teeth. Each stands on z = 0 with its
axis through the origin; they mesh where the pinion is at (0, -DISTANCE).
Run: python3 assets/scenes/make_gears.py"""

import sys
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from glb_file import (Part, grid_triangles, smooth_normals,  # noqa: E402
                      thinning_triangles, whole, write_glb)
from glb_shapes import Shape, rounded  # noqa: E402

# Millimetres up to the last step.
MODULE = 2.6                  # in the plane of rotation
PRESSURE = np.radians(20)
HELIX = np.radians(18)        # at the pitch circle
WIDTH = 16.0                  # of the teeth
LIFT = 2.0                    # of the teeth over the table, for the hub
PLAY = 0.12                   # each tooth is thinner by
EDGE = 0.25                   # broken edges of the teeth
GEAR, PINION = 24, 14         # teeth
DISTANCE = MODULE * (GEAR + PINION) / 2
THIN = 6                      # one column in so many goes on from the teeth to hub and bore

MATERIALS = {"brass": (0.78, 0.47, 0.155, 1.0, 0.27), "steel": (0.50, 0.51, 0.53, 1.0, 0.25),
             "dark steel": (0.20, 0.21, 0.23, 1.0, 0.35)}


def involute(angle):
    return np.tan(angle) - angle


def half_tooth(teeth):
    """Radius and angle from the middle of a tooth, from its tip's middle to its gap's middle."""
    pitch, tip, root = (MODULE * (teeth / 2 + k) for k in (0, 1, -1.25))
    base = pitch * np.cos(PRESSURE)

    def half_angle(radius):
        meet = np.arccos(np.minimum(base / radius, 1))
        return (np.pi / 2 / teeth - PLAY / 2 / pitch + involute(PRESSURE) - involute(meet))

    low, fillet, nose = max(base, root + 0.9), 0.8, 0.3
    gap = np.pi / teeth
    points = [(tip, 0.0), (tip, 0.5 * half_angle(tip)), (tip, half_angle(tip) - nose / tip),
              (tip - 0.09, half_angle(tip) - 0.09 / tip)]
    points += [(r, half_angle(r)) for r in np.linspace(tip - nose, low, 5)]
    foot = half_angle(low)
    reach = min(fillet / root, 0.85 * (gap - foot))
    for t in np.radians((30, 60, 90)):
        points.append((root + (low - root) * (1 - np.sin(t)), foot + reach * (1 - np.cos(t))))
    return np.array(points + [(root, gap)])


def tooth_outline(teeth):
    """Around the gear, counter-clockwise from a tooth's middle: columns x 2."""
    half = half_tooth(teeth)
    whole = np.concatenate([half, (half[1:-1] * [1, -1] + [0, 2 * np.pi / teeth])[::-1]])
    turn = (np.arange(teeth) * 2 * np.pi / teeth)[:, None] + whole[:, 1]
    radius = np.tile(whole[:, 0], (teeth, 1))
    return np.stack([radius * np.cos(turn), radius * np.sin(turn)], -1).reshape(-1, 2)


def inset(outline, by):
    along = np.roll(outline, -1, axis=0) - np.roll(outline, 1, axis=0)
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    return outline + by * np.column_stack([-along[:, 1], along[:, 0]])


def turned(points, angle):
    c, s = np.cos(angle), np.sin(angle)
    return points @ np.array([[c, s], [-s, c]])


def tooth_rows(teeth, hand):
    """From a circle on the lower face out and up over the flanks to one on the upper face."""
    outline = tooth_outline(teeth)
    twist = hand * np.tan(HELIX) / (MODULE * teeth / 2)
    # Below a tooth the circle's points crowd towards its middle, so that no face folds over.
    per_tooth = len(outline) // teeth
    share = np.interp(np.arange(per_tooth), np.array([0, 0.375, 0.5, 0.625, 1]) * per_tooth,
                      [0, 0.13, 0.5, 0.87, 1])
    angle = ((np.arange(teeth)[:, None] + share) * 2 * np.pi / teeth).reshape(-1)
    rim = MODULE * (teeth / 2 - 1.25) - 2 * EDGE
    circle = rim * np.column_stack([np.cos(angle), np.sin(angle)])
    rows = []
    heights = np.linspace(EDGE, WIDTH - EDGE, 11)
    for z, by in [(0, EDGE), (0.25 * EDGE, 0.25 * EDGE), *[(z, 0) for z in heights],
                  (WIDTH - 0.25 * EDGE, 0.25 * EDGE), (WIDTH, EDGE)]:
        row = turned(inset(outline, by), twist * (z - WIDTH / 2))
        rows.append(np.column_stack([row, np.full(len(row), z)]))
    circles = [np.column_stack([turned(circle, twist * (z - WIDTH / 2)),
                                np.full(len(outline), z)]) for z in (0, WIDTH)]
    return [circles[0], *rows, circles[1]]


def bore_radius(radius, angle, key):
    """A round bore with a keyway towards +x."""
    across = radius * np.abs(np.sin(angle))
    slot = (across < key / 2) & (np.cos(angle) > 0)
    return np.where(slot, (radius + 0.45 * key) / np.maximum(np.cos(angle), 0.1), radius)


def body_rows(teeth, hand, profile, bore, key):
    """From the upper face inward, down the bore, outward along the lower face. profile: (radius,
    height above the upper face), the last one the bore's edge; the gear is the same on both
    sides."""
    twist = hand * np.tan(HELIX) / (MODULE * teeth / 2) * WIDTH / 2
    columns = len(tooth_outline(teeth)) // THIN
    angle = np.arange(columns) * 2 * np.pi / columns
    rows = []
    for side in (1, -1):
        half = []
        for k, (radius, height) in enumerate(profile):
            at = angle + side * twist * max(0, 1 - k / 4)
            r = np.full(len(at), radius)
            if radius < bore + 1:
                r = bore_radius(bore, at, key) + radius - bore
            z = WIDTH / 2 + side * (WIDTH / 2 + height)
            half.append(np.column_stack([r * np.cos(at), r * np.sin(at), np.full(len(at), z)]))
        rows += half if side == 1 else half[::-1]
    return rows


def gear_part(material, teeth, hand, profile, bore, key=0.0):
    fine, coarse = tooth_rows(teeth, hand), body_rows(teeth, hand, profile, bore, key)
    n, m = len(fine[0]), len(coarse[0])
    points = whole(1e-3 * (np.concatenate(fine + coarse) + [0, 0, LIFT]))
    first = n * len(fine)

    def ring(start, count):
        return np.append(start + np.arange(count), start)

    upper = thinning_triangles(ring(n * (len(fine) - 1), n), ring(first, m), THIN)
    lower = thinning_triangles(ring(0, n), ring(first + m * (len(coarse) - 1), m), THIN)
    triangles = np.concatenate([grid_triangles(len(fine), n, around=True), upper,
                                first + grid_triangles(len(coarse), m, around=True),
                                lower[:, [0, 2, 1]]])
    return Part(material, points, smooth_normals(points, triangles), triangles)


def fillet(corners, steps=3):
    return [tuple(p) for p in rounded(corners, steps)]


def gear():
    web = fillet([(26.6, 0, 0), (24.6, 0, 0.5), (23.6, -3.2, 0.9), (14.0, -3.2, 0.9),
                  (13.0, 2.0, 0.6), (8.6, 2.0, 0.5), (8.0, 1.4, 0)])
    return [gear_part("brass", GEAR, 1, web + [(8.0, -0.5)], 8.0, 4.0)]


def pinion():
    face = fillet([(13.6, 0, 0), (11.4, 0, 0.4), (11.0, 2.0, 0.5), (6.6, 2.0, 0.3), (6.3, 1.7, 0)])
    s = Shape()
    s.turned(rounded([(0, 0.0, 0), (0.0062, 0.0, 0.0004), (0.0062, 0.027, 0.0008),
                      (0, 0.027, 0)], 3), "z", "dark steel", segments=48)
    shaft = [Part("dark steel", *pieces[0]) for pieces in s.parts.values()]
    return [gear_part("steel", PINION, -1, face, 6.3)] + shaft


if __name__ == "__main__":
    for make in (gear, pinion):
        path = HERE / (make.__name__ + ".glb")
        print(path.name, write_glb(path, make(), MATERIALS, "make_gears.py"), "triangles")
