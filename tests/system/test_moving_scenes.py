#!/usr/bin/python3
"""Every shipped scene with moving objects does in its recorded session what its sentence says, and
its energies are right."""

from __future__ import annotations

import tomllib
import unittest
from collections.abc import Callable
from pathlib import Path

import h5py
import numpy as np

from support import ASSETS

MOST_CONTROLLER = 5e-5  # highest E_c [J]
MOST_GAIN = 1e-6  # most energy that the bodies' world makes [J]


class Recorded:
    """A session, body by body."""

    def __init__(self, file: h5py.File) -> None:
        self.time = file["time"][()]
        pose = file["objects/pose"]
        names = [n.decode() if isinstance(n, bytes) else n for n in pose.attrs["names"]]
        self.center = {name: pose[:, i, :3] for i, name in enumerate(names)}
        self.turn = {name: pose[:, i, 3:] for i, name in enumerate(names)}
        self.names = names
        self.held = file["objects/held"][()]
        self.tip = file["proxy/tip"][()]
        self.force = file["contact/total_force"][()]
        self.energy = {name: file[f"energy/{name}"][()]
                       for name in ("controller_total", "objects_gain", "to_objects")}  # fmt: skip
        self.unsettled = file["coupling/unsettled"][()]

    def moved(self, name: str) -> np.ndarray:
        """Way from the first place [m]."""
        return self.center[name] - self.center[name][0]

    def turned(self, name: str) -> np.ndarray:
        """Angle from the first orientation [rad]."""
        turn = self.turn[name]
        return 2 * np.arccos(np.clip(np.abs((turn * turn[0]).sum(axis=1)), 0, 1))

    def upright(self, name: str) -> np.ndarray:
        """Angle between the body's z axis and the vertical [rad]."""
        _, x, y, _ = self.turn[name].T
        return np.arccos(np.clip(1 - 2 * (x**2 + y**2), -1, 1))

    @property
    def pushes(self) -> np.ndarray:
        """Force on the tip [N]."""
        return np.linalg.norm(self.force, axis=1)


def peaks(values: np.ndarray, least: float) -> int:
    """Number of times that the values rise by so much and fall by so much again."""
    count, low, high, rising = 0, values[0], values[0], True
    for value in values:
        low, high = min(low, value), max(high, value)
        if rising and value < high - least:
            count, rising, low = count + 1, False, value
        elif not rising and value > low + least:
            rising, high = True, value
    return count


class MovingScenes(unittest.TestCase):
    def keys(self, r: Recorded, scene: dict) -> None:
        """Keys go all the way down and up; the one that clicks yields where its table falls."""
        for body in scene["body"]:
            depth = -r.moved(body["name"])[:, 2]
            self.assertGreater(depth.max(), 0.0058, body["name"])
            self.assertLess(depth[-1], 0.0005, body["name"])
        depth = -r.moved("clicky")[:, 2]
        table = np.array(next(b for b in scene["body"] if b["name"] == "clicky")["joint"]["travel"])
        top, bottom = table[1:3]
        down = np.arange(len(depth)) < depth.argmax()
        near = (np.abs(depth - top[0]) < 2e-4) & down, (np.abs(depth - bottom[0]) < 2e-4) & down
        self.assertGreater(r.pushes[near[0]].max() - r.pushes[near[1]].min(),
                           0.5 * (top[1] - bottom[1]))  # fmt: skip

    def switch(self, r: Recorded, scene: dict) -> None:
        """The switch goes over and back: beyond the middle it runs ahead of the finger, and stays
        without one."""
        turned, free = r.turned("rocker"), r.pushes == 0
        stop = scene["body"][0]["joint"]["limits"][1]  # the switch presses against its stop
        self.assertGreater(np.median(turned[free & (turned > 0.3)]), stop + 1e-4)
        self.assertLess(turned[-1], 0.02)
        speed = np.abs(np.diff(turned)) / np.diff(r.time)
        beyond = (turned[1:] > 0.15) & (turned[1:] < 0.25)
        self.assertGreater(speed[beyond & free[1:]].max(initial=0), 10)
        self.assertLess(speed[~free[1:] & (turned[1:] > 0.05) & (turned[1:] < 0.12)].max(), 5)

    def drawer_door(self, r: Recorded, scene: dict) -> None:
        self.assertGreater(-r.moved("drawer")[-1, 1], 0.03)
        self.assertGreater(r.turned("door").max(), 1)
        self.assertLess(r.turned("door")[-1], 0.03)

    def dial(self, r: Recorded, scene: dict) -> None:
        """The torque clicks as many times as numbers went by."""
        turn = np.unwrap(2 * np.arctan2(r.turn["dial"][:, 3], r.turn["dial"][:, 0]))
        body = scene["body"][0]
        period = body["joint"]["detent"]["period"]
        self.assertGreaterEqual(round(2 * np.pi / period), 12)
        passed = abs(turn[-1] - turn[0]) / period
        self.assertGreater(passed, 4)
        arm = r.tip - r.center["dial"]
        torque = (np.cross(arm, -r.force) * body["joint"]["axis"]).sum(axis=1)
        clicks = peaks(torque, 0.8 * body["joint"]["detent"]["force"])
        self.assertAlmostEqual(clicks, passed, delta=1.5)
        self.assertGreater(torque.max(), 0.8 * body["joint"]["detent"]["force"])
        self.assertLess(torque.min(), -0.4 * body["joint"]["detent"]["force"])
        self.assertGreater(r.pushes.max(), 0.4, "too weak to be felt")

    def dominoes(self, r: Recorded, scene: dict) -> None:
        """All dominoes fall, one after the other, though the tip is near the first one only."""
        self.assertGreaterEqual(len(r.names), 10)
        fell = []
        for name in r.names:
            self.assertGreater(np.degrees(r.upright(name)[-1]), 45, name)
            fell.append(np.argmax(r.upright(name) > np.radians(20)))
        self.assertEqual(fell, sorted(fell))
        touched = r.tip[r.pushes > 0]
        first = r.center["domino 1"][0]
        self.assertLess(np.linalg.norm(touched - first, axis=1).max(), 0.04)

    def marbles(self, r: Recorded, scene: dict) -> None:
        middle = np.array(scene["mesh"][0]["position"])
        away = {name: np.linalg.norm((r.center[name] - middle)[:, :2], axis=1) for name in r.names}
        self.assertGreater(max(each.max() for each in away.values()), 0.022)
        for name in r.names:
            self.assertGreater(np.linalg.norm(r.moved(name), axis=1).max(), 0.004, name)
            self.assertLess(away[name][-1], 0.024, name)
            self.assertGreater(r.center[name][:, 2].min(), middle[2] + 0.0105, name)

    def stack(self, r: Recorded, scene: dict) -> None:
        standing = r.time < 0.6  # before the tip is there
        for name in r.names:
            self.assertLess(np.linalg.norm(r.moved(name)[standing], axis=1).max(), 0.001, name)
        for name in r.names[2:]:
            self.assertLess(r.center[name][-1, 2], -0.015, name)

    def cup(self, r: Recorded, scene: dict) -> None:
        held = r.held > 0
        self.assertGreater(r.moved("cup")[held, 2].max(), 0.03)
        self.assertFalse(held[-1])
        stands = np.linalg.norm(np.diff(r.center["cup"][-50:], axis=0), axis=1).max()
        self.assertLess(stands, 1e-5)
        self.assertGreater(r.moved("cup")[-1, 1], 0.05)

    def pucks(self, r: Recorded, scene: dict) -> None:
        """The same motion takes a hundred times the force, apart from friction."""
        most = []
        for name in r.names:
            self.assertGreater(r.moved(name)[:, 0].max(), 0.05, name)
            at = np.abs(r.tip[:, 1] - r.center[name][0, 1]) < 0.02
            most.append(r.pushes[at & (r.tip[:, 2] < -0.02)].max())
            self.assertLess(np.abs(r.moved(name)[:, 2]).max(), 0.0005, name)
        self.assertGreater(most[1], 10 * most[0])

    def seesaw(self, r: Recorded, scene: dict) -> None:
        """In slow motion the block stays on the plank; in fast motion it leaves it."""
        self.assertGreater(r.moved("block")[:, 2].max(), 0.02)
        self.assertGreater(r.turned("plank").max(), 0.3)
        lever = r.center["block"] - r.center["plank"]
        away = np.linalg.norm(lever, axis=1)
        slow = r.time < 1.6
        self.assertLess(np.abs(away[slow] - away[0]).max(), 0.002)
        self.assertGreater(np.abs(away - away[0]).max(), 0.004)

    def cradle(self, r: Recorded, scene: dict) -> None:
        """The last ball swings nearly as far as the first was pulled, the others stay."""
        released = np.flatnonzero(np.diff(r.held) < 0)[-1]
        pulled = -r.moved("ball 1")[released, 0]
        self.assertGreater(pulled, 0.02)
        far = {name: r.moved(name)[released:released + 400, 0].max() for name in r.names}
        self.assertGreater(far["ball 5"], 0.8 * pulled)
        for name in ("ball 1", "ball 2", "ball 3"):
            self.assertLess(far[name], 0.25 * pulled, name)

    def pendulum(self, r: Recorded, scene: dict) -> None:
        """The pendulum goes, comes back, and hits the tip, which has not moved meanwhile."""
        out = r.moved("pendulum")[:, 0].argmax()
        self.assertGreater(r.moved("pendulum")[out, 0], 0.02)
        apart = np.flatnonzero(r.pushes[:out] > 0)[-1]
        self.assertEqual(r.pushes[apart + 1:out].max(), 0)
        self.assertGreater(r.pushes[out:].max(), 0.3)

    def test_each_does_what_its_sentence_says(self) -> None:
        scenes = [path for path in sorted((ASSETS / "scenes").glob("*.toml"))
                  if "body" in tomllib.loads(path.read_text())]  # fmt: skip
        self.assertGreaterEqual(len(scenes), 12)
        for path in scenes:
            with self.subTest(path.stem):
                self.check(path)

    def check(self, path: Path) -> None:
        scene = tomllib.loads(path.read_text())
        self.assertTrue(scene["about"].endswith("."))
        with h5py.File(ASSETS / f"sessions/{path.stem}.h5") as file:
            text = file.attrs["scene"]
            self.assertEqual(tomllib.loads(text.decode() if isinstance(text, bytes) else text),
                             scene, "recorded in another scene: run make_sessions.py")  # fmt: skip
            r = Recorded(file)
        self.assertLessEqual(r.energy["controller_total"].max(), MOST_CONTROLLER)
        self.assertLessEqual(r.energy["objects_gain"].max(), MOST_GAIN)
        self.assertEqual(r.unsettled.max(), 0)
        self.assertGreater(r.pushes.max() + r.held.max(), 0.03, "nothing was touched")
        says: Callable[[Recorded, dict], None] | None = getattr(self, path.stem, None)
        self.assertIsNotNone(says, "nothing is checked of what this scene does")
        says(r, scene)


if __name__ == "__main__":
    unittest.main()
