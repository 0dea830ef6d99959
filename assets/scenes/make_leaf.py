#!/usr/bin/python3
"""Writes leaf.glb, a leaf's blade: an open sheet without thickness, and leaf_stand.glb, its stem in
a pebble. Both in one frame: the pebble stands on z = 0 over the origin, the blade's upper side
looks to -y. Run: python3 assets/scenes/make_leaf.py"""

import sys
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from glb_file import (Part, grid_triangles, smooth_normals, whole,  # noqa: E402
                      write_glb)
from glb_shapes import Shape  # noqa: E402

LENGTH, WIDTH = 0.084, 0.027       # of the blade; its greatest half width
BASE = (-0.003, 0.0, 0.021)        # where stem and blade meet
ALONG, ACROSS = 140, 96            # cells of the blade
VEINS, VEIN_SLOPE = 8, 0.75        # on each side; they rise by so much of their way outward

MATERIALS = {
    "leaf": dict(color=(1, 1, 1), metallic=0.0, roughness=0.46, two_sided=True),
    "stem": dict(color=(0.20, 0.25, 0.06), metallic=0.0, roughness=0.5),
    "pebble": dict(color=(0.115, 0.112, 0.105), metallic=0.0, roughness=0.55),
}


def midrib(u):
    """Where the middle of the blade is at u from 0, the base, to 1, the tip."""
    u = np.asarray(u)
    x = BASE[0] + LENGTH * (0.34 * u - 0.10 * u**2 + 0.05 * u**3)
    y = BASE[1] + LENGTH * (0.10 * u - 0.30 * u**2)
    z = BASE[2] + LENGTH * (0.90 * u - 0.08 * u**3)
    return np.stack([x, y, z], -1)


def half_width(u):
    """Widest below the middle, drawn out into a point."""
    return WIDTH * 1.72 * np.sqrt(np.maximum(u, 0)) * (1 - u) ** 0.78 * (1 - 0.22 * u) + 2e-4


def blade_points(u, v):
    """On the blade, v from -1 to 1 across; arrays of one shape. Also how much of a vein is here."""
    w = half_width(u)
    out = w * np.abs(v)
    middle = midrib(u)
    along = np.gradient(midrib(np.linspace(0, 1, 201)), axis=0)
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    up = np.stack([np.interp(u, np.linspace(0, 1, 201), along[:, k]) for k in range(3)], -1)
    side = np.cross(up, np.broadcast_to([0.0, 1.0, 0.0], up.shape))
    side /= np.linalg.norm(side, axis=-1, keepdims=True)
    face = np.cross(side, up)  # of the upper side
    # Half a step between the veins of both sides, as they grow.
    phase = (u * LENGTH - VEIN_SLOPE * out) / LENGTH * (VEINS + 1) + np.where(v > 0, 0.5, 0)
    from_vein = np.abs((phase + 0.5) % 1 - 0.5) * LENGTH / (VEINS + 1)
    vein = np.exp(-((from_vein / 0.00055) ** 2)) * (phase > 0.4)
    vein *= np.clip(1.25 - np.abs(v), 0, 1)
    vein = np.maximum(vein, np.exp(-((out / 0.0009) ** 2)) * (1.1 - u))
    # Folded along the midrib, arched between the veins, waved at the margin.
    lift = 0.34 * (np.sqrt(out**2 + 0.003**2) - 0.003) - 5.5 * out**2
    arched = np.minimum(w / 0.012, 1) * np.minimum(out / 0.006, 1)
    lift += 0.00045 * arched * np.cos(2 * np.pi * (phase + 0.5))
    wave = np.sin(2 * np.pi * 3.2 * u + np.where(v > 0, 0.6, 2.4))
    lift += 0.0016 * (w / WIDTH) * np.abs(v) ** 3 * wave
    lift -= 0.0004 * vein
    return middle + (w * v)[..., None] * side + lift[..., None] * face, vein


def blade():
    t = np.linspace(0, 1, ALONG + 1)
    u = 0.5 * t + 0.5 * (1 - np.cos(np.pi * t)) / 2  # closer together at both ends
    u, v = np.meshgrid(u, np.linspace(-1, 1, ACROSS + 1), indexing="ij")
    points, vein = blade_points(u, v)
    green = np.array((0.050, 0.150, 0.020))
    paint = green * (1 + 0.25 * np.cos(5 * u + 2 * v))[..., None]
    rim = np.clip((np.abs(v) - 0.80) / 0.2, 0, 1)[..., None] ** 2
    paint = paint * (1 - 0.6 * rim) + 0.6 * rim * np.array((0.33, 0.31, 0.05))
    paint += (np.array((0.25, 0.33, 0.09)) - paint) * (0.75 * vein)[..., None]
    flat = whole(points.reshape(-1, 3))
    triangles = grid_triangles(ALONG + 1, ACROSS + 1)[:, [0, 2, 1]]
    return [Part("leaf", flat, smooth_normals(flat, triangles), triangles, paint.reshape(-1, 3))]


def stand():
    s = Shape()
    t = np.linspace(-np.pi / 2, np.pi / 2, 15)
    pebble = [(0.0, 0.0)] + [(0.0205 * np.cos(a) ** 0.8, 0.0062 * (1 + np.sin(a))) for a in t[1:-1]]
    s.turned(pebble + [(0.0, 0.0124)], "z", "pebble", segments=48)
    # The stem bends out of the pebble into the blade's base and goes on beneath the midrib.
    base, a_little = midrib(0.0), midrib(0.03)
    forward = (a_little - base) / np.linalg.norm(a_little - base)
    foot = np.array([-0.005, 0.0, 0.009])
    ends = [foot, foot + [0, 0, 0.008], base - 0.006 * forward, base + 0.002 * forward]
    k = np.linspace(0, 1, 14)[:, None]
    path = ((1 - k) ** 3 * ends[0] + 3 * (1 - k) ** 2 * k * ends[1] +
            3 * (1 - k) * k**2 * ends[2] + k**3 * ends[3])
    angle = np.linspace(0, 2 * np.pi, 14, endpoint=False)
    rings = [np.tile(path[0], (14, 1))]
    for k, middle in enumerate(path):
        radius = 0.0013 - 0.0005 * k / 13
        rings.append(middle + radius * np.column_stack([np.cos(angle), np.sin(angle), 0 * angle]))
    rings.append(np.tile(path[-1] + 0.0006 * forward, (14, 1)))
    s.grid(np.array(rings), "stem")
    return [Part(name, *pieces[0]) for name, pieces in s.parts.items()]


if __name__ == "__main__":
    for name, make in (("leaf", blade), ("leaf_stand", stand)):
        path = HERE / (name + ".glb")
        print(path.name, write_glb(path, make(), MATERIALS, "make_leaf.py"), "triangles")
