#!/usr/bin/python3
"""The verification itself: it passes good sessions and finds each single breach."""

from __future__ import annotations

import dataclasses
import tempfile
import unittest
from collections.abc import Callable
from pathlib import Path

import h5py
import numpy as np

import arms
import reference_session
from limpid_check.checks import verify
from limpid_check.dynamics import coriolis, inertia, tip_jacobian, tip_position
from limpid_check.report import Check, table
from limpid_check.session import SessionError, read_session
from limpid_check.urdf import Array, parse_chain

_GENERAL = np.random.default_rng(7)


def _planar_urdf(mass: float, length: float, inertia_zz: float) -> str:
    """Two equal links in the plane, centre of mass in the middle."""
    link = (
        '<link name="{0}"><inertial><origin xyz="{1} 0 0"/><mass value="{2}"/>'
        '<inertia ixx="0" iyy="0" izz="{3}" ixy="0" ixz="0" iyz="0"/></inertial></link>'
    )
    joint = (
        '<joint name="{0}" type="revolute"><parent link="{1}"/><child link="{2}"/>'
        '<origin xyz="{3} 0 0"/><axis xyz="0 0 1"/>'
        '<limit lower="-3" upper="3" effort="1" velocity="1"/></joint>'
    )
    parts = ['<link name="base"/>']
    parts += [link.format(name, length / 2, mass, inertia_zz) for name in ("upper", "lower")]
    parts += [joint.format("a", "base", "upper", 0), joint.format("b", "upper", "lower", length)]
    return f'<robot name="planar">{"".join(parts)}</robot>'


class Dynamics(unittest.TestCase):
    def test_a_planar_arm_has_the_textbook_inertia_and_coriolis_matrix(self) -> None:
        m, l, i = 0.3, 0.2, 0.001
        chain = parse_chain(_planar_urdf(m, l, i))
        x, v = _GENERAL.normal(size=(2, 9, 2))
        c2, s2 = np.cos(x[:, 1]), np.sin(x[:, 1])
        expected = np.empty((9, 2, 2))
        expected[:, 0, 0] = 2 * i + m * l * l * (1 / 4 + 1 + 1 / 4 + c2)
        expected[:, 0, 1] = expected[:, 1, 0] = i + m * l * l * (1 / 4 + c2 / 2)
        expected[:, 1, 1] = i + m * l * l / 4
        h = -m * l * l / 2 * s2
        textbook = np.stack(
            [h * v[:, 1], h * (v[:, 0] + v[:, 1]), -h * v[:, 0], np.zeros(9)], axis=1
        ).reshape(9, 2, 2)
        np.testing.assert_allclose(inertia(chain, x), expected, rtol=1e-13)
        np.testing.assert_allclose(coriolis(chain, x, v), textbook, atol=1e-15)

    def test_a_turning_slide_has_the_inertia_and_coriolis_matrix_of_polar_coordinates(self) -> None:
        m = 0.3
        link = (
            '<link name="{0}"><inertial><mass value="{1}"/><inertia/></inertial></link>'
        )
        joint = (
            '<joint name="{0}" type="{1}"><parent link="{2}"/><child link="{3}"/>'
            '<axis xyz="{4}"/></joint>'
        )
        chain = parse_chain(
            '<robot name="polar"><link name="base"/>'
            + link.format("turret", 0) + link.format("ball", m)
            + joint.format("turn", "revolute", "base", "turret", "0 0 1")
            + joint.format("out", "prismatic", "turret", "ball", "1 0 0") + "</robot>"
        )
        x, v = _GENERAL.normal(size=(2, 9, 2))
        r, rdot, w = 0.1 * x[:, 1], 0.1 * v[:, 1], v[:, 0]  # [m, m/s, rad/s]
        zero = np.zeros(9)
        expected = np.stack([m * r * r, zero, zero, zero + m * 0.01], axis=1).reshape(9, 2, 2)
        force = np.stack([2 * m * r * rdot * w, -0.1 * m * r * w * w], axis=1)
        np.testing.assert_allclose(inertia(chain, x), expected, atol=1e-15)
        np.testing.assert_allclose(
            np.einsum("rij,rj->ri", coriolis(chain, x, v), v), force, atol=1e-14
        )
        np.testing.assert_allclose(
            tip_position(chain, x), np.stack([r * np.cos(x[:, 0]), r * np.sin(x[:, 0]), zero], 1)
        )

    def test_mdot_minus_2c_is_skew_and_c_v_is_lagranges_force(self) -> None:
        for dof in (1, 3, 7):
            chain = parse_chain(arms.arm_urdf(dof))
            x, v = _GENERAL.normal(size=(2, 4, dof))
            h = 1e-6
            mdot = (inertia(chain, x + h * v) - inertia(chain, x - h * v)) / (2 * h)
            c = coriolis(chain, x, v)
            np.testing.assert_allclose(c + c.transpose(0, 2, 1), mdot, atol=1e-9)

            def energy(at: Array) -> Array:
                return np.einsum("ri,rij,rj->r", v, inertia(chain, at), v) / 2

            steps = h * np.eye(dof)
            gradient = [(energy(x + e) - energy(x - e)) / (2 * h) for e in steps]
            force = np.einsum("rij,rj->ri", mdot, v) - np.stack(gradient, axis=1)
            np.testing.assert_allclose(np.einsum("rij,rj->ri", c, v), force, atol=1e-8)

    def test_the_tip_jacobian_is_the_tips_derivative(self) -> None:
        chain = parse_chain(arms.arm_urdf(6))
        x, v = _GENERAL.normal(size=(2, 4, 6))
        h = 1e-6
        slope = (tip_position(chain, x + h * v) - tip_position(chain, x - h * v)) / (2 * h)
        moved = np.einsum("rij,rj->ri", tip_jacobian(chain, x), v)
        np.testing.assert_allclose(moved, slope, atol=1e-8)


def _scaled(path: str, factor: float) -> Callable[[dict[str, Array]], None]:
    def change(rows: dict[str, Array]) -> None:
        rows[path] = rows[path] * factor

    return change


def _nudged(path: str, amount: float) -> Callable[[dict[str, Array]], None]:
    """Adds `amount` to one entry in the middle."""

    def change(rows: dict[str, Array]) -> None:
        rows[path] = rows[path].copy()
        rows[path].reshape(len(rows[path]), -1)[len(rows[path]) // 2, 0] += amount

    return change


# the changed dataset, a small change, and the check that must notice
_BREACHES: list[tuple[str, Callable[[dict[str, Array]], None]]] = [
    ("energy total", _scaled("/energy/controller_total", 1 + 1e-8)),
    ("energy commanded", _nudged("/energy/controller_commanded", 1e-9)),
    ("proxy balance", _nudged("/energy/proxy_kinetic", 1e-16)),
    ("proxy kinetic", _scaled("/proxy/velocity", 1 + 1e-8)),
    ("tau1 (1)/(14)", _nudged("/device/commanded_torque", 1e-5)),
    ("tau2 (2)/(15)", _nudged("/proxy/torque", 1e-5)),
    ("motor torque", _nudged("/device/motor_torque", 1e-9)),
    ("observer (18)", _scaled("/hand/torque", 1.05)),
    ("observer (18)", _scaled("/coupling/alpha", 0.5)),
    ("time steps", _nudged("/time", 1e-7)),
    ("not finite", _nudged("/proxy/torque", float("nan"))),
    ("raw velocity", _nudged("/device/measured_velocity", 1e-6)),
    ("encoder", _nudged("/device/measured_position", 1e-6)),
]


class Verification(unittest.TestCase):
    directory: Path
    setups: dict[str, reference_session.Setup]
    rows: dict[str, dict[str, Array]]

    @classmethod
    def setUpClass(cls) -> None:
        folder = tempfile.TemporaryDirectory(prefix="limpid-")
        cls.addClassCleanup(folder.cleanup)
        cls.directory = Path(folder.name)
        proposed = reference_session.Setup(arms.arm_urdf(2), np.array([-0.8, 0.8]), eta=0.7)
        cls.setups = {
            "proposed": proposed,
            "standard": dataclasses.replace(proposed, proposed=False),
        }
        cls.rows = {name: reference_session.simulate(s) for name, s in cls.setups.items()}

    def verified(
        self,
        name: str,
        change: Callable[[dict[str, Array]], None] = lambda rows: None,
        **attributes: str,
    ) -> list[Check]:
        rows = dict(self.rows[name])
        change(rows)
        path = self.directory / "session.h5"
        reference_session.write(path, self.setups[name], rows)
        with h5py.File(path, "r+") as file:
            file.attrs.update(attributes)
        return verify(read_session(path))

    def assert_caught(self, name: str, checks: list[Check]) -> None:
        failed = [check.name for check in checks if not check.passed]
        self.assertTrue(any(f.startswith(name) for f in failed), f"{name}\n{table(checks)}")

    def test_a_session_that_obeys_the_contract_passes_every_check(self) -> None:
        for name in self.rows:
            checks = self.verified(name)
            self.assertTrue(all(check.passed for check in checks), "\n" + table(checks))
            names = [check.name for check in checks if check.applies]
            self.assertIn("observer (18)", names)
            self.assertIn(f"slope f2 {name} all joints", names)

    def test_each_breach_is_caught(self) -> None:
        for name, change in _BREACHES:
            with self.subTest(name):
                self.assert_caught(name, self.verified("proposed", change))

    def test_a_coupling_under_the_wrong_name_is_caught(self) -> None:
        other = {"/coupling/kind": self.rows["proposed"]["/coupling/kind"]}
        as_proposed = self.verified("standard", lambda rows: rows.update(other))
        self.assert_caught("tau1", as_proposed)
        self.assert_caught("slope f2", as_proposed)

    def test_wrong_settings_and_a_wrong_arm_are_caught(self) -> None:
        setup = self.setups["proposed"]
        stiffer = dataclasses.replace(setup, k_vc=setup.k_vc * 1.001)
        self.assert_caught("tau1", self.verified("proposed", config=stiffer.config()))
        heavier = setup.urdf.replace('mass value="0.015"', 'mass value="0.016"')
        self.assertNotEqual(heavier, setup.urdf)
        self.assert_caught("proxy kinetic", self.verified("proposed", device_urdf=heavier))
        weaker = dataclasses.replace(setup, torque_limit=0.01)
        self.assert_caught("motor limit", self.verified("proposed", config=weaker.config()))

    def test_settings_changed_on_the_way_hold_from_their_row_on(self) -> None:
        path = self.directory / "events.h5"
        reference_session.write(path, self.setups["standard"], self.rows["standard"])
        with h5py.File(path, "r+") as file:
            file["/events/row"] = np.array([200], dtype=np.uint64)
            file["/events/setting"] = ["coupling.k_vc = 8"]
        session = read_session(path)
        self.assertEqual([session.settings["coupling.k_vc"][k] for k in (199, 200)], [10.0, 8])
        self.assert_caught("tau1", verify(session, ["torques"]))

    def test_a_breach_of_the_layout_is_named(self) -> None:
        path = self.directory / "layout.h5"
        for dataset in ("/proxy/torque", "/hand/target"):
            rows = dict(self.rows["standard"])
            rows[dataset] = rows[dataset][:-1]
            reference_session.write(path, self.setups["standard"], rows)
            with self.assertRaisesRegex(SessionError, dataset):
                read_session(path)
            with h5py.File(path, "r+") as file:
                del file[dataset]
            with self.assertRaisesRegex(SessionError, f"{dataset} is missing"):
                read_session(path)


if __name__ == "__main__":
    unittest.main()
