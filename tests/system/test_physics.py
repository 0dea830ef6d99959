#!/usr/bin/python3
"""Claims of the paper, on sessions of the built program, and recomputations of their rows."""

from __future__ import annotations

import unittest
from collections.abc import Iterable
from pathlib import Path

import numpy as np

import arms
from limpid_check.dynamics import tip_position
from limpid_check.session import Session, read_session
from limpid_check.slopes import fit_slopes
from support import ASSETS, SystemTest, shared_hand

_NOTHING_TO_TOUCH = """
title = "Nothing in reach"
about = "A floor far below."
tip_radius = 0.0

[[plane]]
name = "floor"
point = [0.0, 0.0, -5.0]
normal = [0.0, 0.0, 1.0]
stiffness = 600.0
"""


def write_hand(path: Path, rows: Iterable[tuple[float, float, float, float]]) -> Path:
    lines = [",".join(repr(float(value)) for value in row) for row in rows]
    path.write_text("time_s,x_m,y_m,z_m\n" + "\n".join(lines) + "\n")
    return path


def free_motion(path: Path) -> Path:
    """Loops of 3 cm in the air at 1/2 and 1 Hz, 4 s, at rest at both ends."""
    time = np.linspace(0, 4, 801)
    fade = np.sin(np.pi * time / 4) ** 2
    x = 0.19 + 0.015 * fade * np.sin(2 * np.pi * time)
    y = 0.03 * fade * np.sin(np.pi * time)
    z = 0.03 + 0.02 * fade * np.cos(np.pi * time)
    return write_hand(path, zip(time, x, y, z))


class Contact(SystemTest):
    """Recorded people and the proximal contact, under both couplings."""

    HANDS = ("wiping_1.csv", "wiping_2.csv", "handwriting_1.csv")

    def assert_paper_holds(self, options: list[str | Path]) -> None:
        slopes = {}
        for kind, coupling in enumerate(("standard", "proposed")):
            s = self.run_and_read(*options, "--coupling", coupling, "--eta", "0.6")
            self.assert_verified(s)
            self.assert_total_energy_passive(s)
            slopes[coupling] = fit_slopes(s, kind)["all joints"].slope
            if coupling == "proposed":
                self.assertLess(s["/energy/controller_commanded"][-1], 0)
        self.assertAlmostEqual(slopes["standard"], -1, delta=0.02)
        self.assertLessEqual(abs(slopes["proposed"]), 0.01)

        s = self.run_and_read(*options, "--coupling", "proposed", "--eta", "0.4")
        self.assert_verified(s)
        self.assert_total_energy_passive(s)
        self.assertGreater(s["/energy/controller_commanded"][-1], 0)

    def assert_total_energy_passive(self, s: Session) -> None:
        total = s["/energy/controller_total"]
        self.assertLess(total[-1], 0)
        self.assertLessEqual(np.max(total), 1e-4)

    def test_coordination_does_not_depend_on_the_contact_and_the_energy_stays_passive(self) -> None:
        for name in self.HANDS:
            with self.subTest(name):
                self.assert_paper_holds(["--hand", shared_hand(name)])

    def test_the_same_holds_for_contacts_of_the_proximal_link(self) -> None:
        hand, scene = ASSETS / "hands/proximal.csv", ASSETS / "scenes/proximal.toml"
        self.assert_paper_holds(["--hand", hand, "--scene", scene])


class InertiaScaling(SystemTest):
    """The hand's torque in slow free motion, which is mostly damping, is proportional to eta."""

    def test_the_human_torque_of_the_same_free_motion_is_proportional_to_eta(self) -> None:
        hand = free_motion(self.out(".csv"))
        scene = self.out(".toml")
        scene.write_text(_NOTHING_TO_TOUCH)
        rms, motion = {}, {}
        for eta in (0.6, 1.0, 5.0):
            s = self.run_and_read(
                "--hand", hand, "--scene", scene, "--eta", str(eta),
                "--set", "hand.stiffness=6000", "--set", "hand.damping=20",
            )  # fmt: skip
            self.assert_verified(s)
            rms[eta] = float(np.sqrt(np.mean(s["/hand/torque"] ** 2)))
            motion[eta] = s["/device/position"]
        reach = np.ptp(motion[1.0], axis=0).max()
        for eta in (0.6, 5.0):
            with self.subTest(eta=eta):
                self.assertLess(np.abs(motion[eta] - motion[1.0]).max(), 0.02 * reach)
                self.assertAlmostEqual(rms[eta] / rms[1.0] / eta, 1, delta=0.1)


class AnyArm(SystemTest):
    """Recomputations for arms of other sizes and with other settings."""

    def arm(self, dof: int) -> list[str | Path]:
        files = arms.write_arm(self.directory, dof)
        return ["--device", files.urdf, "--scene", files.scene, "--hand", files.hand]

    def test_sessions_of_two_three_six_and_seven_joints_verify(self) -> None:
        for dof in (2, 3, 6, 7):
            for coupling in ("standard", "proposed"):
                with self.subTest(dof=dof, coupling=coupling):
                    s = self.run_and_read(*self.arm(dof), "--coupling", coupling)
                    self.assertEqual(s.dof, dof)
                    self.assertEqual(len(s), 4000)
                    self.assert_verified(s)
                    touched = np.any(s["/proxy/contact_torque"] != 0, axis=1)
                    self.assertGreater(touched.sum(), 200, "the wall was not touched")

    def test_sessions_of_one_fifteen_and_thirty_joints_verify(self) -> None:
        for dof, seconds in ((1, "4"), (15, "1"), (30, "0.3")):
            with self.subTest(dof=dof):
                self.assert_verified(
                    self.run_and_read(*self.arm(dof), "--duration", seconds, "--eta", "1.5")
                )

    def test_a_proxy_as_heavy_as_the_device_verifies(self) -> None:
        for coupling in ("standard", "proposed"):
            with self.subTest(coupling):
                options = ["--coupling", coupling, "--set", "proxy.inertia_ratio=1"]
                self.assert_verified(self.run_and_read(*self.arm(3), *options))

    def test_other_settings_verify(self) -> None:
        settings = {
            "another tick": ["loop.tick=0.002"],
            "saturated motors": ["device.torque_limit=0.05"],
            "saturated, no remedy": ["device.torque_limit=0.05", "observer.anti_windup=false"],
            "a wrong model": ["model.inertia_error=1.5"],
            "other gains": [
                "coupling.k_vc=6", "coupling.b_vc=0.002", "coupling.b_v=0.01",
                "coupling.eta=2", "observer.alpha=0.02", "device.damping=0.02",
            ],
            "encoder steps": ["device.encoder_step=4e-4", "observer.velocity=adaptive"],
            "friction": ["device.friction=0.005"],
            "low-pass": ["observer.velocity=lowpass"],
            "a weight that is held": ["device.gravity=true", "model.gravity=true"],
            "one that hangs": ["device.gravity=true", "model.gravity=true", 'device.down="+z"'],
            "friction taken off": ["device.friction=0.005", "model.friction=0.7"],
        }  # fmt: skip
        for name, values in settings.items():
            with self.subTest(name):
                options = [word for value in values for word in ("--set", value)]
                self.assert_verified(self.run_and_read(*self.arm(3), *options))

    def test_motors_that_get_warm_verify(self) -> None:
        # A hand that presses a Touch onto the table for 12 s, then lifts it.
        hand = write_hand(self.directory / "press.csv", (
            (0, 0.2, 0, -0.02), (0.5, 0.2, 0, -0.02), (1, 0.2, 0, -0.055), (13, 0.2, 0.002, -0.055),
            (14, 0.2, 0, -0.02), (15, 0.2, 0, -0.02)))
        for coupling in ("predictive", "proposed"):
            with self.subTest(coupling):
                s = self.run_and_read("--device", ASSETS / "devices/touch.urdf", "--scene",
                                      ASSETS / "scenes/table.toml", "--hand", hand, "--coupling", coupling)
                self.assert_verified(s)
                warmth, torque = s["/device/warmth"], np.abs(s["/device/motor_torque"])
                self.assertGreater(warmth.max(), 0.9)
                self.assertLessEqual(warmth.max(), 1)
                # The shoulder: what it gives at first, and what it bears for hours.
                self.assertGreater(torque[2000, 1], 0.5)
                self.assertLess(torque[12900, 1], 1.2 * 0.17)
                # First order, from the torque in the rows alone.
                bears = np.array([j.continuous for j in s.chain.joints])
                gain, modelled = 1 - np.exp(-s.tick / 60), np.zeros(3)
                for k in range(1, len(s)):
                    modelled += gain * ((torque[k - 1] / bears) ** 2 - modelled)
                    if k % 1000 == 0:
                        np.testing.assert_allclose(warmth[k], modelled, rtol=1e-9, atol=1e-12)

    def test_the_tip_starts_at_rest_on_the_first_point_of_the_path(self) -> None:
        for dof in (1, 3, 7, 30):
            with self.subTest(dof=dof):
                s = self.run_and_read(*self.arm(dof), "--duration", "0.01")
                tip = tip_position(s.chain, s["/device/position"][:1])[0]
                np.testing.assert_allclose(tip, s["/hand/target"][0], atol=1e-6)
                self.assertEqual(np.abs(s["/device/velocity"][0]).max(), 0)
                self.assertEqual(np.abs(s["/proxy/velocity"][0]).max(), 0)
                np.testing.assert_array_equal(s["/proxy/position"][0], s["/device/position"][0])


COMPENSATED = [
    word
    for value in ("device.gravity", "model.gravity", "device.springs", "model.springs")
    for word in ("--set", f"{value}=true")
] + ["--set", "device.friction=0.01", "--set", "model.friction=0.7"]


class Replay(SystemTest):
    """A session fed back in with its own settings gives the same rows, bit for bit."""

    def replay_of_its_parts(self, recorded: Path) -> Path:
        """A replay whose input parts are taken out of the session and given as files."""
        options: list[str | Path] = ["--hand", recorded]
        attributes = read_session(recorded).attributes
        for option, attribute, end in (
            ("--config", "config", ".toml"),
            ("--device", "device_urdf", ".urdf"),
            ("--scene", "scene", ".toml"),
        ):
            text = self.directory / f"{recorded.stem}-{attribute}{end}"
            text.write_text(attributes[attribute])
            options += [option, text]
        options += ["--seed", str(int(attributes["seed"]))]
        return self.record(*options)

    def test_a_run_as_fast_as_it_goes(self) -> None:
        files = arms.write_arm(self.directory, 3)
        for options in (
            ["--eta", "0.7", "--seed", "5", "--set", "device.encoder_step=4e-4"],
            ["--coupling", "standard", "--duration", "1.5"],
            ["--coupling", "predictive", *COMPENSATED],
        ):
            with self.subTest(options=options):
                recorded = self.record(
                    "--device", files.urdf, "--scene", files.scene, "--hand", files.hand, *options
                )
                self.assert_same_rows(recorded, self.replay_of_its_parts(recorded))
                alone = self.record("--hand", recorded)
                self.assert_same_rows(recorded, alone)
                for name in ("seed", "config", "device_urdf", "scene"):
                    values = (read_session(f).attributes[name] for f in (recorded, alone))
                    self.assertEqual(*values, name)

    def test_a_run_in_real_time_with_the_default_arm(self) -> None:
        hand = free_motion(self.out(".csv"))
        recorded = self.record("--hand", hand, "--realtime", "--duration", "1.5")
        self.assert_same_rows(recorded, self.record("--hand", recorded))


if __name__ == "__main__":
    unittest.main()
