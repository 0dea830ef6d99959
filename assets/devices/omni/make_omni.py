#!/usr/bin/python3
"""Writes the four models of the desktop arm (base, turret, upper_arm, forearm) beside this file.

Metres, x forward along the link, y left, z up; every model sits in the frame of its link, and is
written with y up, as arms expect of glTF. The joints' common origin is 40 mm above the table. Run: python3 assets/devices/omni/make_omni.py
"""

import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1]))
from glb_shapes import Shape, rounded  # noqa: E402

LINK = 0.135   # joint to joint, and elbow to tip
TABLE = -0.04

MATERIALS = {  # linear red, green, blue, metallic, roughness
    "graphite": (0.035, 0.038, 0.045, 0.0, 0.42),
    "shell": (0.78, 0.79, 0.80, 0.0, 0.38),
    "steel": (0.62, 0.64, 0.66, 1.0, 0.28),
    "rubber": (0.06, 0.065, 0.075, 0.0, 0.6),
    "ball": (0.9, 0.9, 0.92, 0.6, 0.2),
}


def base():
    s = Shape()
    # The foot: an egg that lies flat and rises towards the collar, heavier behind the arm.
    rows = [(TABLE, -0.032, 0, 0, 0, 2.4)]
    for height, centre, half_x, half_y in [
        (0.0000, -0.032, 0.074, 0.062), (0.0008, -0.032, 0.0765, 0.0645),
        (0.0028, -0.032, 0.078, 0.066), (0.0060, -0.032, 0.0775, 0.0655),
        (0.0088, -0.031, 0.0745, 0.0625), (0.0106, -0.030, 0.069, 0.0575),
        (0.0118, -0.027, 0.060, 0.050), (0.0128, -0.020, 0.048, 0.042),
        (0.0136, -0.012, 0.040, 0.037)]:
        rows.append((TABLE + height, centre, 0, half_x, half_y, 2.4))
    rows.append((TABLE + 0.0138, -0.005, 0, 0, 0, 2.4))
    s.loft(rows, "z", "graphite", 40)
    s.turned(rounded([(0, 0, 0), (0.034, 0, 0.001), (0.031, 0.0045, 0.0012), (0, 0.0045, 0)], 2),
             "z", "steel", (0, 0, TABLE + 0.0118), 36)
    s.disc(0.0055, 0.002, 0.0008, "z", "steel", (-0.078, 0, TABLE + 0.0108), 18, 2)
    return s


def turret():
    s = Shape()
    bottom = TABLE + 0.0172
    s.turned(rounded([(0, 0, 0), (0.029, 0, 0.0015), (0.0285, 0.006, 0.004), (0, 0.0075, 0)], 3),
             "z", "shell", (0, 0, bottom), 26)
    for side in (-1, 1):  # the two cheeks hold the shoulder between them
        y = side * 0.0215
        rows = []
        for z, half_x, half_y in [(bottom + 0.003, 0.0215, 0.0055), (-0.014, 0.0205, 0.0052),
                                  (-0.006, 0.0202, 0.0049), (0.004, 0.0200, 0.0048)]:
            rows.append((z, 0, y, half_x, half_y, 2.6))
        s.loft(rows, "z", "shell", 20)
        s.disc(0.0205, 0.0100, 0.0030, "y", "shell", (0, y, 0), 24, 2)
        s.disc(0.0115, 0.0030, 0.0009, "y", "steel", (0, side * 0.0268, 0), 18, 1)
        s.disc(0.0050, 0.0030, 0.0009, "y", "graphite", (0, side * 0.0276, 0), 12, 1)
    return s


def beam(s, material, stations, exponent=3.0, segments=20):
    """Lofts (x, half width, half height) along x with softly closed ends."""
    (x0, a0, b0), (x1, a1, b1) = stations[0], stations[-1]
    rows = [(x0 - 0.002, 0, 0, 0, 0, exponent),
            (x0 - 0.0014, 0, 0, 0.8 * a0, 0.8 * b0, exponent)]
    rows += [(x, 0, 0, a, b, exponent) for x, a, b in stations]
    rows += [(x1 + 0.0014, 0, 0, 0.8 * a1, 0.8 * b1, exponent),
             (x1 + 0.002, 0, 0, 0, 0, exponent)]
    s.loft(rows, "x", material, segments)


def upper_arm():
    s = Shape()
    s.disc(0.0188, 0.0310, 0.0030, "y", "graphite", (0, 0, 0), 26, 2)
    beam(s, "shell", [(0.008, 0.0135, 0.0150), (0.022, 0.0140, 0.0150), (0.045, 0.0128, 0.0130),
                      (0.080, 0.0114, 0.0112), (0.104, 0.0116, 0.0112), (0.1135, 0.0120, 0.0112)])
    for side in (-1, 1):  # ears around the elbow
        y = side * 0.0112
        rows = [(x, y, 0, a, b, 3.0) for x, a, b in
                [(0.104, 0.0028, 0.0108), (0.120, 0.0030, 0.0112), (LINK, 0.0030, 0.0118)]]
        s.loft(rows, "x", "shell", 14)
        s.disc(0.0124, 0.0062, 0.0018, "y", "shell", (LINK, y, 0), 22, 2)
        s.disc(0.0068, 0.0024, 0.0007, "y", "steel", (LINK, side * 0.0145, 0), 14, 1)
    return s


def forearm():
    s = Shape()
    s.disc(0.0108, 0.0158, 0.0020, "y", "graphite", (0, 0, 0), 22, 2)
    beam(s, "shell", [(0.006, 0.0064, 0.0078), (0.020, 0.0064, 0.0074), (0.046, 0.0054, 0.0056),
                      (0.056, 0.0052, 0.0052)], 2.4, 18)
    s.disc(0.0066, 0.0050, 0.0014, "x", "steel", (0.0595, 0, 0), 18, 1)
    # The pen: a grip that swells where the fingers hold it, then a cone to the ball.
    pen = [(0.0, 0.061), (0.0048, 0.061), (0.0056, 0.0635), (0.0062, 0.069), (0.0067, 0.079),
           (0.0070, 0.089), (0.0068, 0.098), (0.0062, 0.1045), (0.0053, 0.109), (0.0, 0.1095)]
    s.turned(pen, "x", "rubber", segments=20)
    s.disc(0.0071, 0.0022, 0.0007, "x", "steel", (0.0865, 0, 0), 18, 1)
    cone = [(0.0, 0.108), (0.0049, 0.1085), (0.0046, 0.1105), (0.0024, 0.1265), (0.0017, 0.1325),
            (0.0, 0.134)]
    s.turned(cone, "x", "steel", segments=16)
    s.ball(0.0030, "ball", (LINK, 0, 0), 14, 7)
    return s


if __name__ == "__main__":
    for make in (base, turret, upper_arm, forearm):
        path = HERE / (make.__name__ + ".glb")
        print(path.name, make().write(path, MATERIALS, y_up=True), "triangles")
