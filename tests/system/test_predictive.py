#!/usr/bin/python3
"""Sessions of the predictive coupling, recomputed from the file, and breaches that the
recomputation finds."""

from __future__ import annotations

import unittest
from collections.abc import Callable
from pathlib import Path

import h5py
import numpy as np

import arms
from limpid_check.checks import verify
from limpid_check.predictive import Replayed, replay
from limpid_check.report import Check, table
from limpid_check.session import Session, read_session
from limpid_check.urdf import Array
from limpid_check.wall import wall_force
from support import ASSETS, SystemTest, Words

_FINE = ["--set", "device.encoder_step=1e-4"]
_HEAVY = ["--set", "hand.mass=0.2", "--set", "device.torque_limit=5"]
# An undamped, firm hand: with a late damper it swings up until the reserve is used up.
_GRIP = ["hand.damping=0", "hand.stiffness=3000", "device.delay=3"]


class WallForce(unittest.TestCase):
    """F D is the change of K d^2 / 2 and the damper's work while inside."""

    def test_a_wall_neither_gains_nor_loses_energy_whether_it_is_made_kept_or_broken(self) -> None:
        rng = np.random.default_rng(3)
        k, b = rng.uniform(100, 20000, (2, 5000)) * [[1], [0.1]]
        c = rng.uniform(1e-5, 1e-4, 5000)
        d, a = rng.normal(scale=3e-4, size=(2, 5000))
        force = wall_force(k, b, d, a, c)
        change = a - c * force
        after = np.maximum(d + change, 0)
        inside = after - np.maximum(d, 0)  # part of the way that is inside
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


def _set(*settings: str) -> list[str]:
    return [word for setting in settings for word in ("--set", setting)]


def _nudged(path: str, amount: float, row: float = 0.3) -> Callable[[dict[str, Array]], None]:
    """Adds `amount` to one entry, at this part of the session."""

    def change(data: dict[str, Array]) -> None:
        data[path] = data[path].copy()
        data[path].reshape(len(data[path]), -1)[int(row * len(data[path])), 0] += amount

    return change


# the changed dataset, a small change, and the check that must notice
_BREACHES: list[tuple[str, Callable[[dict[str, Array]], None]]] = [
    ("tau1 predictive", _nudged("/device/commanded_torque", 1e-8)),
    ("tau2 predictive", _nudged("/proxy/torque", 1e-8)),
    ("motion predictive", _nudged("/proxy/position", 1e-8)),
    ("wall force", _nudged("/proxy/contact_torque", 1e-8)),
    ("wall potential", _nudged("/energy/contact_potential", 1e-9)),
    ("ledger", _nudged("/energy/ledger", 1e-9)),
    ("ledger", _nudged("/device/motor_torque", 1e-6)),
    ("governor", _nudged("/coupling/governor", -1e-6)),
    ("damping governor", _nudged("/coupling/damping_governor", -1e-6)),
    ("torque governor", _nudged("/coupling/torque_governor", -1e-6)),
    ("energy port", _nudged("/energy/port", 1e-9)),
    ("tau1 predictive", _nudged("/device/measured_position", 1e-8)),
    ("tau1 predictive", _nudged("/device/motor_torque", 1e-4)),
    ("tau1 predictive", _nudged("/hand/torque_estimate", 1e-2)),
]
# The same with encoder steps, for ticks that are recomputed from the row before.
_COARSE_BREACHES = [
    ("tau1 predictive", _nudged("/device/commanded_torque", 1e-8)),
    ("tau2 predictive", _nudged("/proxy/torque", 1e-8)),
    ("motion predictive", _nudged("/proxy/position", 1e-8)),
    ("motion predictive", _nudged("/device/measured_position", 1e-4)),
    ("motion predictive", _nudged("/device/motor_torque", 1e-5)),
]
# The same with an unknown delay and a reserve that runs low.
_LATE_BREACHES = [
    ("tau1 predictive", _nudged("/device/commanded_torque", 1e-8)),
    ("tau2 predictive", _nudged("/proxy/torque", 1e-8)),
    ("motion predictive", _nudged("/proxy/position", 1e-8)),
    ("wall force", _nudged("/proxy/contact_torque", 1e-8)),
    ("ledger", _nudged("/energy/ledger", 1e-9)),
    ("ledger", _nudged("/device/motor_torque", 1e-6, row=0.17)),
    ("damping governor", _nudged("/coupling/damping_governor", 1e-6)),
    ("tau1 predictive", _nudged("/device/measured_position", 1e-8)),
]
# Settings that differ from the run's, and the check that must notice.
_WRONG_SETTINGS = {
    "coupling.band": ("5.3", "5.31", "ledger"),
    "predictor.hand_mass": ("0.2", "0.201", "motion predictive"),
    "ledger.energy": ("0.001", "0.00101", "ledger"),
    "coupling.b_vc": ("0.001", "0.00101", "tau2 predictive"),
    "model.inertia_error": ("1.0", "1.001", "tau1 predictive"),
}


class Predictive(SystemTest):
    taps: Path

    @classmethod
    def setUpClass(cls) -> None:
        """Two taps on the table of a quarter of a second each."""
        super().setUpClass()
        time = np.linspace(0, 0.5, 101)
        height = -0.034 - 0.014 * (1 - np.cos(8 * np.pi * time)) / 2
        lines = [f"{t!r},{0.19 + 0.02 * t!r},{0.01 * t!r},{z!r}" for t, z in zip(time.tolist(), height.tolist())]
        cls.taps = cls.directory / "taps.csv"
        cls.taps.write_text("time_s,x_m,y_m,z_m\n" + "\n".join(lines) + "\n")
        cls.smooth = cls.directory / "smooth.toml"
        cls.smooth.write_text('title = "Table without friction"\nabout = "It does not hold on."\n'
                              '[[plane]]\nname = "top"\npoint = [0.2, 0.0, -0.04]\n'
                              'normal = [0.0, 0.0, 1.0]\nstiffness = 600.0\n')

    @property
    def tap(self) -> Words:
        return ["--hand", self.taps]

    @property
    def tap_smooth(self) -> Words:
        """Taps on a material whose force can be recomputed."""
        return [*self.tap, "--scene", self.smooth]

    def recorded(self, *options: str | Path) -> Session:
        return self.run_and_read("--coupling", "predictive", *options)

    def replayed(self, s: Session) -> Replayed:
        done = replay(s)
        self.assertIsNotNone(done)
        return done

    def assert_recomputed(self, s: Session, *names: str) -> list[Check]:
        """Asserts the recomputation of a new run. It begins with the whole reserve, less what the
        spring holds as the encoders' steps are not where the proxy is."""
        apart = s["/device/measured_position"][0] - s["/proxy/position"][0]
        held = s.number("coupling.k_vc")[0, 0] * np.sum(apart**2) / 2
        self.assertAlmostEqual(s["/energy/ledger"][0], s.number("ledger.energy")[0, 0] - held, delta=1e-15)
        checks = verify(s)
        self.assertTrue(all(check.passed for check in checks), "\n" + table(checks))
        applying = {check.name: check.value for check in checks if check.applies}
        self.assertLess(applying["unchecked rows"], 0.05)
        for name in ("ledger", *names):
            self.assertIn(name, applying)
        return checks

    def assert_touched(self, s: Session) -> None:
        touched = np.any(s["/proxy/contact_torque"] != 0, axis=1)
        self.assertGreater(touched.sum(), 100, "nothing was touched")

    def test_a_plane_is_recomputed_whole_whatever_eta_encoder_and_hand(self) -> None:
        for eta in ("0.3", "1", "2"):
            for encoder in ([], _FINE):
                for hand in ([], _HEAVY):
                    options = ["--eta", eta, *encoder, *hand]
                    with self.subTest(" ".join(options)):
                        s = self.recorded(*self.tap_smooth, *options)
                        self.assert_touched(s)
                        self.assert_recomputed(s, "wall force", "tau1 predictive")

    def test_arms_of_other_sizes_are_recomputed(self) -> None:
        for dof, seconds in ((1, "3"), (2, "1.2"), (6, "1.2")):
            with self.subTest(dof=dof):
                files = arms.write_arm(self.directory, dof)
                s = self.recorded("--device", files.urdf, "--scene", files.scene, "--hand",
                                  files.hand, "--duration", seconds, "--eta", "0.5")  # fmt: skip
                self.assert_touched(s)
                self.assert_recomputed(s, "wall force", "tau1 predictive")

    def test_other_scenes_are_recomputed_from_their_contact_torque(self) -> None:
        for name in ("spheres", "proximal"):
            with self.subTest(name):
                files = [ASSETS / f"scenes/{name}.toml", ASSETS / f"hands/{name}.csv"]
                s = self.recorded("--scene", files[0], "--hand", files[1], "--duration", "2")
                self.assert_touched(s)
                self.assert_recomputed(s, "tau1 predictive")

    def test_motors_at_their_limit_are_recomputed(self) -> None:
        for limit in ("0.02", "0.1"):
            with self.subTest(limit):
                s = self.recorded(*self.tap_smooth, "--set", f"device.torque_limit={limit}", "--eta",
                                  "0.6", "--set", "hand.stiffness=2000")  # fmt: skip
                spent = np.any(np.abs(s["/device/motor_torque"]) >= float(limit), axis=1)
                self.assertGreater(spent.sum(), 100)
                self.assert_recomputed(s, "wall force at the limit", "tau1 at the limit", "ticks with limits")

    def test_governors_that_act_are_recomputed(self) -> None:
        scene = self.out(".toml")
        scene.write_text(self.smooth.read_text().replace("600.0", "15000.0"))
        settings = ["ledger.energy=1e-4", "predictor.hand_mass=0", "predictor.mu=0.3",
                    "hand.mass=0.3", "hand.stiffness=3000", "hand.damping=0",
                    "device.torque_limit=50"]  # fmt: skip
        s = self.recorded("--scene", scene, *self.tap, "--eta", "0.3", *_set(*settings))
        self.assertLess(s["/coupling/governor"].min(), 0.5)
        self.assertLess(s["/coupling/damping_governor"].min(), 0.5)
        self.assert_recomputed(s, "wall force", "tau1 predictive")

    def test_delays_are_recomputed_whether_they_are_known_or_not(self) -> None:
        for eta, delays in (("3", ["device.delay=2"]), ("3", ["device.delay=2", "model.delay=2"]),
                            ("0.3", ["device.delay=2", "model.delay=1"]),
                            ("2", ["device.delay=1", "model.delay_most=3.5"]),
                            ("20", ["model.delay_most=20"]), ("8", [])):  # fmt: skip
            # An added mass with a known delay amplifies round-off in the encoder's steps faster
            # than it fades: such a run cannot be recomputed.
            again = eta != "3" or "model.delay=2" not in delays
            for encoder in ([], _FINE) if again else ([],):
                with self.subTest(eta=eta, delays=delays, encoder=encoder):
                    s = self.recorded(*self.tap_smooth, "--eta", eta, *_set(*delays), *encoder)
                    self.assert_touched(s)
                    self.assert_recomputed(s, "wall force", "tau1 predictive")

    def test_heavy_arms_with_encoder_steps_are_recomputed(self) -> None:
        for weight, stiffness, step in ((8, 600, "2e-5"), (8, 2000, "5e-4"), (2.5, 20000, "1e-4")):
            with self.subTest(weight=weight, stiffness=stiffness, step=step):
                files = arms.write_arm(self.directory, 2, weight)
                scene = files.scene.read_text()
                files.scene.write_text(scene.replace("stiffness = 600.0", f"stiffness = {stiffness}"))
                s = self.recorded("--device", files.urdf, "--scene", files.scene, "--hand",
                                  files.hand, "--duration", "1.2", "--eta", "0.5",
                                  *_set(f"device.encoder_step={step}"))  # fmt: skip
                self.assert_touched(s)
                self.assert_recomputed(s, "wall force", "tau1 predictive")

    def test_arms_whose_motion_dies_within_a_tick_are_recomputed(self) -> None:
        for eta, delays in (("1", []), ("0.5", ["device.delay=2", "model.delay=2"])):
            with self.subTest(eta=eta, delays=delays):
                s = self.recorded(*self.tap_smooth, "--eta", eta, *_set("device.damping=1", *delays))
                self.assert_touched(s)
                self.assert_recomputed(s, "wall force", "tau1 predictive")
                self.assertFalse(np.allclose(self.replayed(s).prediction.ahead, 2))

    def test_a_plane_that_damps_is_recomputed(self) -> None:
        for damping in ("1.0", "50.0"):
            with self.subTest(damping=damping):
                scene = self.out(".toml")
                scene.write_text(self.smooth.read_text() + f"damping = {damping}\n")
                s = self.recorded("--scene", scene, *self.tap, "--eta", "0.6")
                self.assert_touched(s)
                self.assert_recomputed(s, "wall force", "tau1 predictive")

    def test_the_governor_of_all_torque_is_recomputed(self) -> None:
        for energy in ("1e-4", "0.002", "0.005"):
            for encoder in ([], _FINE):
                with self.subTest(energy=energy, encoder=encoder):
                    settings = _set(*_GRIP, f"ledger.energy={energy}")
                    s = self.recorded(*self.tap_smooth, "--eta", "3", *settings, *encoder)
                    self.assert_recomputed(s, "wall force", "tau1 predictive")
                    share = self.replayed(s).reserve.torque_governor
                    self.assertLess(share.min(), 0.9)
                    self.assertTrue(np.any((share > 0) & (share < 1)))

    def test_other_settings_are_recomputed(self) -> None:
        for name, settings in {
            "predictor": ["predictor.p=0.3", "predictor.mu=1.2", "model.inertia_error=1.5"],
            "coupling": ["coupling.damping=0.5", "coupling.band=8", "coupling.k_vc=20",
                         "coupling.b_vc=0.003", "coupling.b_v=0.01", "device.damping=0.02"],
            "a heavy proxy": ["proxy.inertia_ratio=1e-2", "ledger.energy=0.002"],
            "another tick": ["loop.tick=0.002"],
            "coarse encoders": ["device.encoder_step=5e-4", "device.friction=0.005"],
            "as recordings of 0.2": ["device.encoder_step=5e-4", "predictor.p=0.45"],
        }.items():  # fmt: skip
            with self.subTest(name):
                s = self.recorded(*self.tap_smooth, "--eta", "0.8", *_set(*settings))
                self.assert_recomputed(s, "wall force", "tau1 predictive")

    def assert_caught(self, name: str, path: Path) -> None:
        checks = verify(read_session(path), ["predictive"])
        failed = [check.name for check in checks if not check.passed]
        self.assertTrue(any(f.startswith(name) for f in failed), f"{name}\n{table(checks)}")

    def test_each_breach_is_caught(self) -> None:
        late = ["--eta", "3", *_set(*_GRIP, "ledger.energy=1e-4")]
        for options, breaches in ((["--eta", "0.3"], _BREACHES),
                                  (["--eta", "0.3", *_FINE], _COARSE_BREACHES),
                                  (late, _LATE_BREACHES)):  # fmt: skip
            path = self.record("--coupling", "predictive", *options, *self.tap_smooth)
            with h5py.File(path, "r") as file:
                names = {name for name, _ in _columns(file)}
                rows = {name: file[name][()] for name in names}
            for check, change in breaches:
                with self.subTest(check, options=" ".join(options)):
                    changed = dict(rows)
                    change(changed)
                    other = self.out()
                    other.write_bytes(path.read_bytes())
                    with h5py.File(other, "r+") as file:
                        for name, values in changed.items():
                            if values is not rows[name]:
                                file[name][...] = values
                    self.assert_caught(check, other)

    def test_wrong_settings_are_caught(self) -> None:
        path = self.record("--coupling", "predictive", "--eta", "0.3", *self.tap_smooth,
                           *_set("ledger.energy=0.001"))  # fmt: skip
        config = read_session(path).attributes["config"]
        self.assert_wrong_settings_caught(path, config, _WRONG_SETTINGS)

    def test_wrong_delays_are_caught(self) -> None:
        delays = _set("device.delay=2", "model.delay=1", "model.delay_most=3")
        path = self.record("--coupling", "predictive", "--eta", "3", *delays, *self.tap_smooth)
        config = read_session(path).attributes["config"]
        self.assert_wrong_settings_caught(path, config, {
            "model.delay": ("1", "2", "tau1 predictive"),
            "model.delay_most": ("3.0", "4.0", "tau1 predictive"),
        })  # fmt: skip

    def assert_wrong_settings_caught(
        self, path: Path, config: str, settings: dict[str, tuple[str, str, str]]
    ) -> None:
        for key, (right, wrong, check) in settings.items():
            with self.subTest(key):
                line = f"{key.split('.')[1]} = "
                self.assertIn(line + right, config)
                with h5py.File(path, "r+") as file:
                    file.attrs["config"] = config.replace(line + right, line + wrong)
                self.assert_caught(check, path)


def _columns(file: h5py.File) -> list[tuple[str, h5py.Dataset]]:
    found: list[tuple[str, h5py.Dataset]] = []

    def look(name: str, item: h5py.Dataset | h5py.Group) -> None:
        if isinstance(item, h5py.Dataset):
            found.append((f"/{name}", item))

    file.visititems(look)
    return found


if __name__ == "__main__":
    unittest.main()
