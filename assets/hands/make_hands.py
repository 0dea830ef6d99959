#!/usr/bin/python3
"""Writes the hand paths beside it (100 Hz, metres, seconds): touch, free, proximal and circle for
the table, and one for each scene of the same name: those of models, and those with things that
move. Where something is picked up, the column `magnet` says from when to when.

Each path goes through way points. Between two of them, a and b, it follows the minimum-jerk curve
that people's reaching movements are known for (Flash and Hogan 1985), at rest at both ends:

    p(s) = a + (b - a) (10 s^3 - 15 s^4 + 6 s^5),   s = (t - t_a) / (t_b - t_a)

Those that stroke a surface follow curves on it with the same speeds, pressed in by a few
millimetres.

Usage: make_hands.py [DIRECTORY]
"""

import sys
import tomllib
from pathlib import Path

import numpy as np

SCENES = Path(__file__).resolve().parents[1] / "scenes"
sys.path.insert(0, str(SCENES))
import make_balls  # noqa: E402
import make_gears  # noqa: E402
import make_island  # noqa: E402
import make_leaf  # noqa: E402

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


def along(strokes):
    """Times and positions along strokes (seconds, places M x 3), each at rest at both ends."""
    places = [np.array(REST)[None]]
    for seconds, stroke in strokes:
        stroke = np.atleast_2d(stroke)
        if np.linalg.norm(stroke[0] - places[-1][-1]) > 1e-9:
            stroke = np.vstack([places[-1][-1], stroke])
        length = np.append(0, np.cumsum(np.linalg.norm(np.diff(stroke, axis=0), axis=1)))
        s = np.arange(1, round(seconds * RATE) + 1) / (seconds * RATE)
        way = length[-1] * s**3 * (10 - 15 * s + 6 * s**2)
        places.append(np.column_stack([np.interp(way, length, c) for c in stroke.T]))
    p = np.concatenate(places)
    return np.arange(len(p)) / RATE, p


class Stage:
    """A scene's tip radius and where it has its meshes."""

    def __init__(self, name):
        scene = tomllib.loads((SCENES / f"{name}.toml").read_text())
        self.tip = scene["tip_radius"]
        self.meshes = scene["mesh"]

    def place(self, mesh, points):
        """From the frame of a mesh that is turned about z, if at all, to the base frame."""
        turn = mesh.get("rpy", [0, 0, 0])[2]
        c, s = np.cos(turn), np.sin(turn)
        return np.asarray(points) @ np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]]) + mesh["position"]


def straight(*corners):
    return np.array(corners, dtype=float)


def rounded_off(corners, steps=40):
    """A smooth curve through corners (Catmull and Rom 1974)."""
    p = np.vstack([2 * np.array(corners[0]) - corners[1], corners,
                   2 * np.array(corners[-1]) - corners[-2]])
    t = np.linspace(0, 1, steps, endpoint=False)[:, None]
    parts = []
    for a, b, c, d in zip(p, p[1:], p[2:], p[3:]):
        parts.append(0.5 * (2 * b + (c - a) * t + (2 * a - 5 * b + 4 * c - d) * t**2 +
                            (3 * b - a - 3 * c + d) * t**3))
    return np.vstack(parts + [p[-2]])


def spheres():
    """A press on each ball from the hardest to the softest, then down the middle one's rings."""
    stage, press = Stage("spheres"), 0.005
    tops = [stage.place(mesh, [0, 0, 2 * make_balls.RADIUS + stage.tip]) for mesh in stage.meshes]
    strokes = []
    for top in tops[::-1]:
        strokes += [(0.65 if strokes else 1.0, top + [0, 0, 0.012]), (0.35, top - [0, 0, press]),
                    (0.2, top - [0, 0, press]), (0.3, top + [0, 0, 0.012])]
    middle = stage.place(stage.meshes[2], [0, 0, make_balls.RADIUS])
    reach = make_balls.RADIUS + stage.tip - 0.003
    angle = np.linspace(np.radians(85), np.radians(-5), 60)[:, None]
    down = middle + reach * (np.cos(angle) * [0.85, -0.53, 0] + np.sin(angle) * [0, 0, 1])
    strokes += [(0.6, down[0] + [0, 0, 0.012]), (0.3, down[0]), (1.3, down),
                (0.3, down[-1] + [0.017, -0.011, 0.005])]
    return along(strokes + [(0.8, REST)])


def relief():
    """Around the crater, down the ridge to the other hill, over the compass rose, along the coast
    to the islet."""
    stage = Stage("relief")
    height = make_island.carve()[0]
    bell = np.exp(-0.5 * (np.arange(-9, 10) / 3.0) ** 2)
    for _ in range(2):  # a hand does not follow every groove
        height = np.array([np.convolve(np.pad(row, 9, "edge"), bell / bell.sum(), "valid")
                           for row in height]).T
    x, y = make_island.field()

    def on_land(points, press=0.003):
        """x, y in millimetres to places on the map, pressed in."""
        i = np.clip(np.searchsorted(x, points[:, 0]), 0, len(x) - 1)
        j = np.clip(np.searchsorted(y, points[:, 1]), 0, len(y) - 1)
        z = 1e-3 * height[j, i] + stage.tip - press
        return stage.place(stage.meshes[0], np.column_stack([1e-3 * points, z]))

    angle = np.linspace(0, 3.6 * np.pi, 200)
    radius = 2 + 5.5 * angle / angle[-1]
    crater = np.column_stack([-13 + radius * np.cos(angle), 5 + radius * np.sin(angle)])
    ridge = rounded_off([crater[-1], (-1, -1), (14, -6), (24, 8), (29, -4), (33.5, -14)])
    rose = rounded_off([(33.5, -14), (33.5, -22.5), (39, -28), (34.5, -30), (28, -24), (42, -22)])
    coast = rounded_off([(42, -22), (30, -28), (8, -22), (-14, -26), (-35, -20), (-43, -14)])
    routes = [on_land(r) for r in (crater, ridge, rose, coast)]
    lift = np.array([0, 0, 0.02])
    return along([(0.7, routes[0][0] + lift), (0.4, routes[0][0]), (2.2, routes[0]),
                  (2.4, routes[1]), (1.5, routes[2]), (2.2, routes[3]),
                  (0.4, routes[3][-1] + lift), (0.6, REST)])


def gears():
    """Over the teeth from above, around in the bore and its keyway, across the pinion's teeth."""
    stage, press = Stage("gears"), 0.003
    wheel, pinion = stage.meshes
    upper = 1e-3 * (make_gears.LIFT + make_gears.WIDTH)

    def ring(mesh, radius, z, start, end):
        a = np.radians(np.linspace(start, end, 120))
        return stage.place(mesh, np.column_stack([radius * np.cos(a), radius * np.sin(a),
                                                  np.full(len(a), z)]))

    deep = upper - 0.006
    centre = stage.place(wheel, [0, 0, deep])
    over = stage.place(wheel, [0, 0, upper + 0.015])
    bore = ring(wheel, 0.008 - stage.tip + press, deep, -60, 330)
    pitch = 0.5e-3 * make_gears.MODULE * make_gears.GEAR
    teeth = ring(wheel, pitch, upper + stage.tip - 0.004, 100, -55)
    tip = 0.5e-3 * make_gears.MODULE * (make_gears.PINION + 2)
    flanks = ring(pinion, tip + stage.tip - 0.004, upper - 0.008, 20, -110)
    out = stage.place(pinion, [0.034, 0.012, upper - 0.008])
    return along([(0.6, teeth[0] + [0, 0, 0.012]), (0.3, teeth[0]), (2.6, teeth),
                  (0.3, teeth[-1] + [0, 0, 0.012]), (0.5, over), (0.5, centre), (0.3, bore[0]),
                  (2.0, bore), (0.3, centre), (0.4, over), (0.7, out + [0, 0, 0.015]), (0.3, out),
                  (0.3, flanks[0]), (2.0, flanks), (0.4, flanks[-1] + [0, -0.012, 0.012]),
                  (0.8, REST)])


def leaf():
    """Up across the veins on the upper side, over the margin, down again on the lower side."""
    stage, press = Stage("leaf"), 0.003
    mesh = stage.meshes[0]

    def beside(uv, side, off):
        """Places (u, v) of the blade, moved out of its upper (+1) or lower (-1) side."""
        u, v = np.array(uv, dtype=float).T
        inner = np.clip(v, -1, 1)
        step = 1e-3
        at = make_leaf.blade_points(u, inner)[0]
        du = make_leaf.blade_points(u + step, inner)[0] - make_leaf.blade_points(u - step, inner)[0]
        dv = (make_leaf.blade_points(u, np.minimum(inner + step, 1))[0] -
              make_leaf.blade_points(u, np.maximum(inner - step, -1))[0])
        normal = np.cross(du, dv)
        normal /= np.linalg.norm(normal, axis=1, keepdims=True)
        beyond = (v - inner)[:, None] * 0.02 * dv / np.linalg.norm(dv, axis=1, keepdims=True)
        return stage.place(mesh, at + beyond + side * off * normal)

    pressed = stage.tip - press
    up = beside(rounded_off([(0.25, -0.6), (0.34, 0.1), (0.5, -0.5), (0.62, 0.2), (0.5, 0.75)]), 1,
                pressed)
    first = beside([(0.25, -0.6)], 1, 0.02)
    rim = [beside([(0.5, v)], side, off)[0]
           for v, side, off in ((0.75, 1, pressed), (1.1, 1, 0.002), (1.3, -1, 0.003),
                                (1.1, -1, 0.006), (0.8, -1, pressed))]
    down = beside(rounded_off([(0.5, 0.8), (0.62, 0.3), (0.45, -0.2), (0.32, 0.4)]), -1, pressed)
    away = beside([(0.32, 0.4)], -1, 0.02)
    over = [away[0] + [-0.02, -0.005, 0.03], (0.165, 0.0, 0.04)]
    return along([(0.6, first), (0.4, up[0]), (2.4, up), (1.2, rounded_off(rim)), (2.2, down),
                  (0.4, away), (1.5, rounded_off([away[0], *over, REST]))])


class Toys:
    """A scene's tip radius, and its bodies as its file has them."""

    def __init__(self, name):
        scene = tomllib.loads((SCENES / f"{name}.toml").read_text())
        self.tip = scene["tip_radius"]
        self.bodies = {body["name"]: body for body in scene["body"]}

    def at(self, name):
        return np.array(self.bodies[name]["position"])


UP = np.array([0.0, 0.0, 1.0])


def keys():
    """Down each key to the bottom and up again, from the near one to the far one."""
    toys, strokes = Toys("keys"), []
    for name, key in toys.bodies.items():
        top = toys.at(name) + (key["box"][2] / 2 + toys.tip) * UP
        low = top - (key["joint"]["limits"][1] + 0.005) * UP
        strokes += [(0.3 if strokes else 0.45, top + 0.005 * UP), (0.3, low), (0.2, top + 0.004 * UP)]
    return along(strokes)


def switch():
    """Presses the upper half in until it snaps, then the lower half."""
    toys = Toys("switch")
    middle, inwards = toys.at("rocker"), np.array([0, 1.0, 0])
    strokes = []
    for height in (0.013, -0.013):
        before = middle + height * UP - (0.0125 + toys.tip) * inwards
        strokes += [(0.4, before), (0.4, before + 0.016 * inwards), (0.25, before - 0.004 * inwards)]
    return along(strokes + [(0.35, REST)])


def drawer_door():
    """Hooks behind the drawer's handle and pulls it open, then opens the door and lets go of it."""
    toys, towards = Toys("drawer_door"), np.array([0, -1.0, 0])
    handle = toys.at("drawer") + [0, -0.008, 0.004]
    strokes = [(0.45, handle + 0.02 * UP), (0.25, handle), (0.6, handle + 0.038 * towards),
               (0.25, handle + 0.034 * towards + 0.022 * UP)]
    door = toys.bodies["door"]
    hinge = toys.at("door") + door["joint"]["point"]
    grip = toys.at("door") + [-0.02, -0.008, 0]

    def opened(angle, place):
        """Where a place of the closed door is when it is open by so much."""
        c, s = np.cos(angle), np.sin(angle)
        x, y, z = place - hinge
        return hinge + [c * x - s * y, s * x + c * y, z]

    # From the hinge's side, for on the other one there is the drawer.
    beside = grip + [0.016, -0.002, 0]
    arc = np.array([opened(angle, grip) for angle in np.linspace(0, 1.2, 30)])
    strokes += [(0.35, beside + 0.024 * UP), (0.2, beside), (0.2, grip), (0.7, arc),
                (0.2, opened(1.2, beside)), (0.2, opened(1.2, beside) + [0, -0.01, 0.03]),
                (0.3, opened(1.2, beside) + [0, -0.01, 0.03])]
    return along(strokes)


def dial():
    """Between the two pins, and round by three quarters of a turn."""
    toys = Toys("dial")
    body = toys.bodies["dial"]
    lean = body["rotation"][0]
    turn = np.array([[1, 0, 0], [0, np.cos(lean), -np.sin(lean)], [0, np.sin(lean), np.cos(lean)]])

    def face(angle, high):
        angle = np.atleast_1d(angle)[:, None]
        radius = body["part"][0]["position"][0]
        own = np.hstack([radius * np.cos(angle), radius * np.sin(angle), 0 * angle + high])
        return toys.at("dial") + own @ turn.T

    round_it = face(np.linspace(0, np.radians(200), 120), 0.0085)
    return along([(0.4, face(0, 0.022)), (0.25, round_it[0]), (1.9, round_it),
                  (0.25, face(np.radians(195), 0.022))])


def dominoes():
    """Leans on the first one until it goes."""
    toys = Toys("dominoes")
    first, heading = toys.at("domino 1"), toys.bodies["domino 1"]["rotation"][2]
    ahead = np.array([np.cos(heading), np.sin(heading), 0])
    touch = first + 0.011 * UP - (0.0025 + toys.tip) * ahead
    return along([(0.5, touch - 0.008 * ahead), (0.6, touch + 0.011 * ahead),
                  (0.3, touch - 0.01 * ahead + 0.01 * UP), (0.4, touch - 0.01 * ahead + 0.01 * UP)])


def marbles():
    """Round among the marbles, out of them and to the middle again."""
    toys = Toys("marbles")
    middle = np.mean([toys.at(name) for name in toys.bodies], axis=0)
    angle = np.linspace(0, 3 * np.pi, 90)
    radius = np.interp(angle, [0, np.pi, 3 * np.pi], [0, 0.018, 0.024])
    way = middle + np.column_stack([radius * np.cos(angle), radius * np.sin(angle),
                                    0.0015 + 4.5 * radius**2])
    return along([(0.35, middle + 0.02 * UP), (0.25, way[0]), (1.5, way),
                  (0.3, way[-1] + 0.03 * UP), (0.5, way[-1] + 0.03 * UP)])


def stack():
    """Pushes the tower a little, feels it rock, and then knocks it over."""
    toys = Toys("stack")
    ahead = toys.at("block 4") * [1, 1, 0] - np.array(REST)
    ahead /= np.linalg.norm(ahead)
    touch = toys.at("block 4") - (0.01 + toys.tip) * ahead + [0, 0, 0.004]
    return along([(0.4, touch - 0.012 * ahead), (0.3, touch), (0.35, touch + 0.004 * ahead),
                  (0.2, touch - 0.004 * ahead), (0.35, touch + 0.03 * ahead), (0.3, touch),
                  (0.5, touch)])


def cup():
    """Takes the cup by its brim with the magnet, carries it over to the coaster and puts it down."""
    toys = Toys("cup")
    high = 0.04 + toys.tip
    brim = toys.at("cup") + [0.0, 0.0215, high]
    put = np.array([0.19, 0.052 + 0.0215, brim[2] + 0.01])
    # It hangs aslant: put down on its edge, it is drawn upright.
    lower = put + [0, -0.04, 0.003]
    strokes = [(0.4, brim + 0.012 * UP), (0.2, brim - 0.002 * UP), (0.6, brim + 0.04 * UP),
               (0.6, lower + 0.03 * UP), (0.4, lower), (0.5, put), (0.2, put),
               (0.25, put + 0.025 * UP), (0.25, put + 0.025 * UP)]
    return held(along(strokes), 0.6, 2.85)


def pucks():
    """Pushes the light puck and leaves it, then the heavy one in just the same way."""
    toys, strokes, ahead = Toys("pucks"), [], np.array([1.0, 0, 0])
    for name, puck in toys.bodies.items():
        behind = toys.at(name) - (puck["cylinder"][0] + toys.tip + 0.002) * ahead
        strokes += [(0.3, behind + 0.018 * UP), (0.2, behind), (0.45, behind + 0.045 * ahead),
                    (0.25, behind + 0.03 * ahead + 0.018 * UP)]
    return along(strokes + [(0.3, REST)])


def seesaw():
    """Presses the free end down slowly, lets it up again, and then presses it fast."""
    toys = Toys("seesaw")
    plank = toys.bodies["plank"]
    lean, half = plank["rotation"][1], plank["box"][0] / 2 - 0.009
    top = plank["box"][2] / 2 + toys.tip

    def end(angle, off=0.0):
        c, s = np.cos(angle), np.sin(angle)
        return toys.at("plank") + [-half * c + (top + off) * s, 0, half * s + (top + off) * c]

    return along([(0.45, end(lean, 0.008)), (0.2, end(lean)), (0.6, end(-lean, -0.004)),
                  (0.5, end(lean, 0.002)), (0.1, end(-lean, -0.008)), (0.6, end(-lean, -0.008))])


def cradle():
    """Takes the first ball, pulls it aside along its circle and lets go."""
    toys = Toys("cradle")
    ball = toys.bodies["ball 1"]
    pivot = toys.at("ball 1") + ball["joint"]["point"]
    length = ball["joint"]["point"][2]
    off = ball["sphere"] + toys.tip

    def beside(angle, gap=0.0):
        """To the left of the ball when it is lifted by so much."""
        c, s = np.cos(angle), np.sin(angle)
        return pivot + [-length * s - (off + gap) * c, 0, -length * c + (off + gap) * s]

    swing = np.array([beside(a, 0.0005) for a in np.linspace(0, 0.6, 20)])
    strokes = [(0.35, beside(0, 0.025) + 0.035 * UP), (0.3, beside(0, 0.008)),
               (0.2, beside(0, -0.001)), (0.6, swing), (0.1, swing[-1]), (0.15, beside(0.75, 0.012)),
               (1.2, beside(0.75, 0.012))]
    return held(along(strokes), 0.7, 1.55)


def pendulum():
    """Pushes the ball away and waits for it."""
    toys = Toys("pendulum")
    ball = toys.bodies["pendulum"]
    touch = toys.at("pendulum") - [ball["sphere"] + toys.tip, 0, 0]
    ahead = np.array([1.0, 0, 0])
    return along([(0.4, touch - 0.01 * ahead), (0.22, touch + 0.034 * ahead), (0.25, touch),
                  (1.2, touch)])


def held(path, start, end):
    """The path with the magnet on from start to end [s]."""
    t, p = path
    return t, p, (t >= start) & (t < end)


def write(path, t, p, magnet=None):
    rows = [f"{ti:.2f},{x:.6f},{y:.6f},{z:.6f}" for ti, (x, y, z) in zip(t, p)]
    header = "time_s,x_m,y_m,z_m"
    if magnet is not None:
        header += ",magnet"
        rows = [f"{row},{on:d}" for row, on in zip(rows, magnet)]
    path.write_text("\n".join([header, *rows]) + "\n")


if __name__ == "__main__":
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).resolve().parent
    for make in (touch, free, proximal, circle, spheres, relief, gears, leaf, keys, switch,
                 drawer_door, dial, dominoes, marbles, stack, cup, pucks, seesaw, cradle, pendulum):
        write(folder / f"{make.__name__}.csv", *make())
