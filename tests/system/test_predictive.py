#!/usr/bin/python3
"""Sessions of the predictive coupling, recomputed from the file, and what the recomputation catches."""

from __future__ import annotations

import unittest
from collections.abc import Callable
from pathlib import Path

import h5py
import numpy as np

import arms
from limpid_check.checks import verify
from limpid_check.report import Check, table
from limpid_check.session import Session, read_session
from limpid_check.urdf import Array
from limpid_check.wall import wall_force
from support import ASSETS, SystemTest, Words

_FINE = ["--set", "device.encoder_step=1e-4"]
_HEAVY = ["--set", "hand.mass=0.2"]
_STIFF = 'stiffness = 3000.0\n'


class WallForce(unittest.TestCase):
    """F D is the change of K d^2 / 2 and what the damper took while inside."""

    def test_a_wall_neither_gains_nor_loses_energy_whether_it_is_made_kept_or_broken(self) -> None:
        rng = np.random.default_rng(3)
        k, b = rng.uniform(100, 20000, (2, 5000)) * [[1], [0.1]]
        c = rng.uniform(1e-5, 1e-4, 5000)
        d, a = rng.normal(scale=3e-4, size=(2, 5000))
        force = wall_force(k, b, d, a, c)
        change = a - c * force
        after = np.maximum(d + change, 0)
        inside = after - np.maximum(d, 0)  # what of the way lay inside
        stored = k / 2 * (after**2 - np.maximum(d, 0) ** 2)
        pushes = force > 0
        self.assertTrue(np.all(force >= 0))
        for name, which in {
            "made": (d < 0) & (after > 0), "kept": (d > 0) & (after > 0),
            "broken": (d > 0) & (after == 0),
        }.items():  # fmt: skip
            with self.subTest(name):
                which = which & pushes
                self.assertGreater(which.sum(), 100)
                work = (force * change)[which]
                np.testing.assert_allclose(work, (stored + b * inside * change)[which], atol=1e-12)
        self.assertTrue(np.all(force[(d < 0) & (d + a < 0)] == 0))


def _nudged(path: str, amount: float, row: float = 0.5) -> Callable[[dict[str, Array]], None]:
    """Adds `amount` to one entry that far into the session."""

    def change(data: dict[str, Array]) -> None:
        data[path] = data[path].copy()
        data[path].reshape(len(data[path]), -1)[int(row * len(data[path])), 0] += amount

    return change


# what is changed, by how little, and the check that must notice
_BREACHES: list[tuple[str, Callable[[dict[str, Array]], None]]] = [
    ("tau1 predictive", _nudged("/device/commanded_torque", 1e-7)),
    ("tau2 predictive", _nudged("/proxy/torque", 1e-7)),
    ("motion predictive", _nudged("/proxy/position", 1e-8)),
    ("wall force", _nudged("/proxy/contact_torque", 1e-7)),
    ("ledger", _nudged("/energy/ledger", 1e-9)),
    ("ledger", _nudged("/device/motor_torque", 1e-4)),
    ("governor", _nudged("/coupling/governor", -1e-6)),
    ("damping governor", _nudged("/coupling/damping_governor", -1e-6)),
    ("energy port", _nudged("/energy/port", 1e-9)),
    ("wall potential", _nudged("/energy/contact_potential", 1e-9)),
    ("tau1 predictive", _nudged("/device/measured_position", 1e-8)),
    ("tau1 predictive", _nudged("/hand/torque_estimate", 1.0)),
]


class Predictive(SystemTest):
    def arm(self, dof: int, *options: str | Path) -> Words:
        files = arms.write_arm(self.directory, dof)
        return ["--device", files.urdf, "--scene", files.scene, "--hand", files.hand, *options]

    def recorded(self, *options: str | Path) -> Session:
        s = self.run_and_read(*options, "--coupling", "predictive")
        self.assertEqual(set(s["/coupling/kind"]), {2})
        return s

    def assert_recomputed(self, s: Session, *names: str) -> list[Check]:
        checks = verify(s)
        self.assertTrue(all(check.passed for check in checks), "\n" + table(checks))
        applying = [check.name for check in checks if check.applies]
        for name in ("ledger", *names):
            self.assertIn(name, applying)
        return checks

    def test_a_plane_is_recomputed_whole_whatever_eta_hand_and_encoders(self) -> None:
        for eta in ("0.3", "1", "2"):
            for encoder in ([], _FINE):
                for hand in ([], _HEAVY):
                    options = ["--eta", eta, *encoder, *hand]
                    with self.subTest(" ".join(options)):
                        path = ["--hand", ASSETS / "hands/touch.csv", "--duration", "3"]
                        s = self.recorded(*path, *options)
                        touched = np.any(s["/proxy/contact_torque"] != 0, axis=1)
                        self.assertGreater(touched.sum(), 200, "the table was not touched")
                        self.assert_recomputed(s, "wall force", "tau1 predictive")
