#!/usr/bin/python3
"""Writes island.glb: a map of an island that never was, carved and painted, in a walnut frame. Its
middle is the origin, it stands on z = 0, north is y. Run: python3 assets/scenes/make_island.py"""

import sys
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from glb_file import (Part, grid_triangles, smooth_normals,  # noqa: E402
                      thinning_triangles, whole, write_glb)

# Millimetres up to the last step.
COLUMNS, ROWS, STEP = 273, 205, 0.355   # of the carved field
SEA = 7.0                               # level of the sea above the table
CONTOUR = 2.0                           # between contour lines
BORDER = 2.6                            # width of the scale around the map
ROSE, ROSE_RADIUS = (34.5, -22.5), 8.6
SUB = (-1 / 3, 0, 1 / 3)                # places within a step at which the rose is painted

MATERIALS = {"painted stone": (1, 1, 1, 0.0, 0.55), "walnut": (0.060, 0.027, 0.013, 0.0, 0.36)}


def field():
    """x (columns,) and y (rows,)."""
    return ((np.arange(COLUMNS) - (COLUMNS - 1) / 2) * STEP,
            (np.arange(ROWS) - (ROWS - 1) / 2) * STEP)


def noise(seed, longest, shortest, slope):
    """Smooth noise of unit deviation with wavelengths between two [mm], amplitude ~ wavelength ^
    slope."""
    rows, columns = 2 * ROWS, 2 * COLUMNS
    white = np.random.default_rng(seed).standard_normal((rows, columns))
    per_mm = np.hypot(np.fft.fftfreq(rows, STEP)[:, None], np.fft.fftfreq(columns, STEP))
    wave = 1 / np.maximum(per_mm, 1e-9)
    gain = np.where((wave < longest) & (wave > shortest), wave ** (slope + 1), 0)
    out = np.fft.ifft2(np.fft.fft2(white) * gain).real[:ROWS, :COLUMNS]
    return (out - out.mean()) / out.std()


def hill(x, y, cx, cy, height, width, stretch=1.0, turn=0.0):
    c, s = np.cos(turn), np.sin(turn)
    u, v = (x - cx) * c + (y - cy) * s, (y - cy) * c - (x - cx) * s
    return height * np.exp(-((u / stretch) ** 2 + v**2) / (2 * width**2))


def smooth_step(low, high, value):
    t = np.clip((value - low) / (high - low), 0, 1)
    return t * t * (3 - 2 * t)


def land():
    """Height over the sea before anything is engraved, negative below it."""
    x, y = np.meshgrid(*field())
    x, y = x + 2.2 * noise(1, 60, 7, 1.0), y + 2.2 * noise(2, 60, 7, 1.0)
    volcano = np.hypot(x + 13, y - 5)
    h = hill(x, y, -13, 5, 15.5, 9.0) + hill(x, y, -10, 3, 5.5, 17)
    h += hill(x, y, 12, -4, 7.0, 5.5, 2.6, -0.35) + hill(x, y, 24, 9, 6.5, 5.5, 1.5, 0.9)
    h += hill(x, y, -35, -20, 4.4, 3.6, 1.5, 0.5) + hill(x, y, 39, -3, 3.8, 2.6, 1.4, 1.2)
    h += hill(x, y, -27, -9, 3.4, 5.0)
    # Ravines run down from the crater, ridges stay between them.
    turn = np.arctan2(y - 5, x + 13)
    ravines = np.abs(np.sin(4.5 * turn + 0.8 * noise(3, 40, 10, 1)))
    h += (ravines - 0.6) * 2.2 * smooth_step(4, 9, volcano) * smooth_step(21, 11, volcano)
    ridged = 1 - np.abs(noise(4, 24, 3.2, 1.1))
    h += 0.75 * ridged * smooth_step(1.5, 6, h)
    h -= 6.3 * np.exp(-(volcano / 3.3) ** 2)
    return h - 3.1 + 0.55 * noise(5, 30, 4, 1.2)


def distance_to_coast(h):
    """From every place [mm]."""
    x, y = field()
    wet = h < 0
    coast = np.argwhere((wet[1:-1, 1:-1] != wet[2:, 1:-1]) | (wet[1:-1, 1:-1] != wet[1:-1, 2:])) + 1
    points = np.column_stack([x[coast[:, 1]], y[coast[:, 0]]])
    gx, gy = np.meshgrid(x, y)
    nearest = np.full(h.shape, np.inf)
    for px, py in points:
        np.minimum(nearest, (gx - px) ** 2 + (gy - py) ** 2, out=nearest)
    return np.sqrt(nearest)


def groove(distance, half_width):
    return np.exp(-((distance / half_width) ** 2))


def contour_lines(h):
    """1 in the middle of a line, 0 away from it; equally wide on slopes and flats."""
    steepness = np.hypot(*np.gradient(h, STEP))
    off = np.abs((h + CONTOUR / 2) % CONTOUR - CONTOUR / 2) / np.maximum(steepness, 0.12)
    return groove(off, 0.42) * smooth_step(0.5 * CONTOUR, CONTOUR, h)


def star(x, y, outer, inner, turn):
    """A four-pointed pyramid of height 1, and which half of a point is meant (0, 1)."""
    angle = np.arctan2(y, x) - turn
    half = np.floor(angle / (np.pi / 4)).astype(int) % 2
    away = np.abs((angle + np.pi / 4) % (np.pi / 2) - np.pi / 4)
    u, v = np.hypot(x, y) * np.cos(away), np.hypot(x, y) * np.sin(away)
    c = inner * np.sqrt(0.5)
    edge = (c * u + (outer - c) * v) / (outer * c)  # 1 on the line from a point to a notch
    return np.maximum(1 - edge, 0), half


def rose_stars(x, y):
    return star(x, y, ROSE_RADIUS - 0.4, 2.4, 0), star(x, y, 6.2, 2.2, np.pi / 4)


def star_paint(under, x, y, ivory):
    for points, half in rose_stars(x, y)[::-1]:
        facet = np.where((half == 0)[..., None], ivory, (0.22, 0.040, 0.018))
        under = np.where((points > 0)[..., None], facet, under)
    return under


def border(x, y):
    """How far inside of the map's edge; 1 where the scale is dark; 1 on its engraved lines."""
    half_x, half_y = (COLUMNS - 1) / 2 * STEP, (ROWS - 1) / 2 * STEP
    inside = np.minimum(half_x - np.abs(x), half_y - np.abs(y))
    along = np.where(half_x - np.abs(x) < half_y - np.abs(y), y, x)
    bar = half_x / 12
    dark = (np.floor((along + 10 * bar) / bar).astype(int) % 2).astype(float)
    on_scale = (inside > 0.6) & (inside < BORDER - 0.6)
    ticks = np.abs((along + bar / 2) % bar - bar / 2)
    lines = np.maximum(groove(inside - BORDER, 0.4), groove(ticks, 0.3) * on_scale)
    return inside, dark * on_scale, lines


RAMP = [(0.0, (0.50, 0.38, 0.20)), (0.5, (0.40, 0.32, 0.13)), (1.2, (0.115, 0.150, 0.035)),
        (4.0, (0.155, 0.165, 0.040)), (7.0, (0.29, 0.185, 0.060)), (10.5, (0.155, 0.080, 0.040)),
        (13.5, (0.19, 0.14, 0.11)), (16.0, (0.72, 0.69, 0.64))]


def mixed(color, other, share):
    return color + (np.asarray(other) - color) * share[..., None]


def carve():
    """Heights above the table [mm] and colours (linear), rows x columns."""
    x, y = np.meshgrid(*field())
    h = land()
    coast = distance_to_coast(h)
    inside, dark, scale_lines = border(x, y)
    dry = (h > 0) & (inside > BORDER)

    # Water lines follow the coast ever wider apart, as engravers drew them.
    water = np.zeros_like(h)
    for k in range(6):
        at = 1.2 + 1.15 * k + 0.16 * k * k
        water = np.maximum(water, groove(coast - at, 0.36) * (1 - k / 7.5))
    rx, ry = x - ROSE[0], y - ROSE[1]
    far = np.hypot(rx, ry)
    water *= smooth_step(ROSE_RADIUS + 1, ROSE_RADIUS + 2.5, far)
    turn = np.arctan2(ry, rx)
    rhumb = far * np.abs(np.sin((turn + np.pi / 16) % (np.pi / 8) - np.pi / 16))
    rhumb = groove(rhumb, 0.26) * smooth_step(ROSE_RADIUS + 1, ROSE_RADIUS + 1.6, far)
    rhumb *= smooth_step(8.5, 10.5, coast)
    rings = np.maximum(groove(far - ROSE_RADIUS, 0.4), groove(far - ROSE_RADIUS + 1.3, 0.3))
    (long_star, _), (short_star, _) = rose_stars(rx, ry)
    lines = contour_lines(h) * dry

    sea = (inside > BORDER) & ~dry
    z = np.where(dry, 0.35 + h, 0.0)
    z -= 0.4 * lines + sea * (0.28 * water + 0.14 * rhumb + 0.3 * rings)
    rose = np.maximum(1.3 * long_star, 0.9 * short_star)
    z += rose
    z += np.where(inside < BORDER, 0.5 * smooth_step(BORDER, BORDER - 0.5, inside), 0)
    z -= 0.35 * scale_lines

    heights, colors = zip(*RAMP)
    paint = np.stack([np.interp(h, heights, channel) for channel in zip(*colors)], -1)
    paint *= (1 + 0.07 * noise(6, 6, 0.8, 0.5))[..., None]
    paint = mixed(paint, (0.030, 0.018, 0.010), 0.8 * lines)
    shore = np.exp(-coast / 4.0)
    wet = mixed(np.full(paint.shape, (0.016, 0.044, 0.056)), (0.075, 0.150, 0.150), shore)
    wet = mixed(wet, (0.007, 0.018, 0.024), 0.7 * np.maximum(water, np.maximum(rhumb, rings)))
    ivory, ink = np.array((0.58, 0.50, 0.35)), np.array((0.025, 0.018, 0.014))
    wet = sum(star_paint(wet, rx + STEP * dx, ry + STEP * dy, ivory)
              for dx in SUB for dy in SUB) / len(SUB) ** 2
    paint = np.where(dry[..., None], paint, wet)
    scale = mixed(np.full(paint.shape, ivory), ink, dark)
    paint = np.where((inside < BORDER)[..., None], scale, paint)
    return SEA + z, mixed(paint, ink, 0.8 * scale_lines * (inside < BORDER + 0.4))


# From the field's edge outward and down: distance and height [mm].
FRAME = [(0.5, 7.3), (0.6, 8.5), (0.8, 9.0), (1.2, 9.35), (1.8, 9.5), (3.0, 9.5), (3.6, 9.35),
         (4.0, 9.0), (4.2, 8.5), (4.2, 1.0), (4.0, 0.3), (3.5, 0.0)]


def frame(points):
    """The four sides of walnut around the field; they meet in mitres. Every fourth place of the
    field's edge goes on, the others end there. points: of the field, in metres."""
    side_points, side_triangles, count = [], [], 0
    edges = [(points[0], (0, -1)), (points[:, -1], (1, 0)), (points[-1, ::-1], (0, 1)),
             (points[::-1, 0], (-1, 0))]
    for edge, outward in edges:
        coarse = edge[::4]
        along = np.array((-outward[1], outward[0]))
        share = np.linspace(-1, 1, len(coarse))[:, None]
        rows = []
        for offset, z in FRAME:
            row = coarse.copy()
            corner = np.where(np.abs(share) > 0.999, share, 0)  # corners move both ways
            row[:, :2] += 1e-3 * offset * (np.array(outward) + corner * along)
            row[:, 2] = 1e-3 * z
            rows.append(whole(row))
        middle = np.tile([0.0, 0.0, 0.0], (len(coarse), 1))
        rows.append(middle)
        n, m = len(edge), len(coarse)
        to_frame = thinning_triangles(np.arange(n), n + np.arange(m), 4)
        triangles = np.concatenate([to_frame, n + grid_triangles(len(rows), m)])[:, [0, 2, 1]]
        side = np.concatenate([edge, *rows])
        spread = np.linalg.norm(np.cross(side[triangles[:, 1]] - side[triangles[:, 0]],
                                         side[triangles[:, 2]] - side[triangles[:, 0]]), axis=1)
        side_points.append(side)
        side_triangles.append(triangles[spread > 1e-14] + count)
        count += len(side)
    side, triangles = np.concatenate(side_points), np.concatenate(side_triangles)
    return Part("walnut", side, smooth_normals(side, triangles), triangles)


def field_points(z):
    x, y = np.meshgrid(*field())
    return whole(1e-3 * np.stack([x, y, z], -1))


def island():
    z, paint = carve()
    points = field_points(z)
    flat = points.reshape(-1, 3)
    triangles = grid_triangles(ROWS, COLUMNS)
    return [Part("painted stone", flat, smooth_normals(flat, triangles), triangles,
                 paint.reshape(-1, 3)), frame(points)]


if __name__ == "__main__":
    print("island.glb", write_glb(HERE / "island.glb", island(), MATERIALS, "make_island.py"),
          "triangles")
