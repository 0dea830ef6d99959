#!/usr/bin/env python3
"""Writes the hand paths beside it: touch.csv, free.csv, proximal.csv, circle.csv (100 Hz, metres,
seconds).

Each path goes through way points. Between two of them, a and b, it follows the minimum-jerk curve
that people's reaching movements are known for (Flash and Hogan 1985), at rest at both ends:

    p(s) = a + (b - a) (10 s^3 - 15 s^4 + 6 s^5),   s = (t - t_a) / (t_b - t_a)

Usage: make_hands.py [DIRECTORY]
"""

import sys
from pathlib import Path

import numpy as np

RATE = 100  # samples a second
REST = (0.19092, 0.0, 0.0)  # tip of the built-in arm at rest
TABLE = -0.04  # height of the table top
PRESS = 0.005  # how far below it the hand wants to be


def minimum_jerk(way_points):
    """Times (N,) and coordinates (N, C) through rows of (time, C coordinates)."""
    times = np.array([w[0] for w in way_points])
    points = np.array([w[1:] for w in way_points])
    t = np.arange(round(times[-1] * RATE) + 1) / RATE
    i = np.clip(np.searchsorted(times, t, side="right") - 1, 0, len(times) - 2)
    s = ((t - times[i]) / (times[i + 1] - times[i]))[:, None]
    blend = s**3 * (10 - 15 * s + 6 * s**2)
    return t, points[i] + (points[i + 1] - points[i]) * blend


def touch():
    """Down to the table, press, slide, lift; twice, the second slide across the first."""
    low = TABLE - PRESS
    return minimum_jerk([
        (0.0, *REST), (0.5, *REST),
        (1.5, 0.20, -0.04, low), (2.0, 0.20, -0.04, low), (4.0, 0.20, 0.04, low),
        (5.0, 0.19, 0.0, 0.01), (5.5, 0.19, 0.0, 0.01),
        (6.5, 0.17, 0.0, low), (7.0, 0.17, 0.0, low), (8.5, 0.22, 0.0, low),
        (9.5, *REST), (10.0, *REST),
    ])


def free():
    """Through the whole workspace, slow and fast, touching nothing."""
    return minimum_jerk([
        (0.0, *REST), (0.5, *REST), (1.5, 0.22, 0.05, 0.03), (2.5, 0.17, -0.05, 0.02),
        (3.2, 0.21, 0.04, -0.01), (3.9, 0.15, 0.0, 0.05), (4.6, 0.22, -0.05, 0.0),
        (5.1, 0.19, 0.0, 0.04), (5.6, 0.19, 0.0, -0.01), (6.1, 0.19, 0.06, 0.02),
        (6.6, 0.19, -0.06, 0.02), (7.5, *REST), (8.0, *REST),
    ])


def proximal():
    """Three pushes of the upper arm up against its stop, then three touches of the table."""
    # Along the forearm, which pushes on the elbow and turns the shoulder alone.
    up = np.array([-1.0, 0.0, 1.0]) / np.sqrt(2)
    path = [(0.0, *REST), (0.5, *REST)]
    for start, depth in ((0.5, 0.030), (2.4, 0.034), (4.3, 0.038)):
        pushed = np.array(REST) + depth * up
        path += [(start + 0.7, *pushed), (start + 1.1, *pushed), (start + 1.8, *REST)]
    for start, x, y in ((6.3, 0.18, 0.03), (8.2, 0.20, -0.03), (10.1, 0.21, 0.05)):
        path += [(start, *REST), (start + 0.7, x, y, TABLE - PRESS),
                 (start + 1.1, x, y, TABLE - PRESS), (start + 1.8, *REST)]
    return minimum_jerk(path + [(12.0, *REST)])


def circle():
    """In the air for a while, down to the table, twice around on it, back."""
    low, turn = TABLE - PRESS, 2 * np.pi
    t, way = minimum_jerk([
        # height, radius and angle about the vertical through the rest position
        (0.0, 0.0, 0.0, 0.0), (0.3, 0.0, 0.0, 0.0), (1.0, 0.03, 0.03, 0.5), (1.7, 0.0, 0.03, 3.0),
        (2.3, 0.01, 0.0, 3.0), (3.0, low, 0.0, 3.0), (3.4, low, 0.0, 3.0), (3.9, low, 0.025, 3.0),
        (7.1, low, 0.025, 3.0 + 2 * turn), (7.7, 0.0, 0.0, 3.0 + 2 * turn),
        (8.0, 0.0, 0.0, 3.0 + 2 * turn),
    ])
    z, radius, angle = way.T
    return t, np.array(REST) + np.column_stack((radius * np.cos(angle), radius * np.sin(angle), z))


def write(path, t, p):
    rows = [f"{ti:.2f},{x:.6f},{y:.6f},{z:.6f}\n" for ti, (x, y, z) in zip(t, p)]
    path.write_text("time_s,x_m,y_m,z_m\n" + "".join(rows))


if __name__ == "__main__":
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).resolve().parent
    for make in (touch, free, proximal, circle):
        write(folder / f"{make.__name__}.csv", *make())
