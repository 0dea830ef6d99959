#!/usr/bin/python3
"""Contents of a session file, read as by a person who knows HDF5 and nothing of the program: units,
tips, forces, names. Arms move here by a forward kinematics in SI that is this file's own."""

from __future__ import annotations

import csv
import os
import re
import shutil
import subprocess
import sys
import unittest
from pathlib import Path

import h5py
import numpy as np

from limpid_check.urdf import Array, Chain, parse_chain
from support import ASSETS, LIMPID, SystemTest, limpid
from test_any_arm import SCARA

SLIDES = ASSETS / "devices" / "inverse3.urdf"
OLD = Path(__file__).with_name("recordings") / "three_slides_version_1.h5"
TEN_LINES = ASSETS / "python" / "read_session.py"
TORQUES = ("device/commanded_torque", "device/motor_torque", "proxy/torque", "proxy/contact_torque",
           "hand/torque", "hand/torque_estimate", "device/compensation_torque")
MOTIONS = ("device/position", "device/velocity", "device/measured_position",
           "device/measured_velocity", "proxy/position", "proxy/velocity")


def tip(chain: Chain, q: Array) -> Array:
    """Tip of a configuration in rad and m."""
    rotation, at = np.eye(3), np.zeros(3)
    for joint, value in zip(chain.joints, q):
        at = at + rotation @ joint.origin.translation
        rotation = rotation @ joint.origin.rotation
        if joint.slides:
            at = at + rotation @ joint.axis * value
            continue
        x, y, z = joint.axis
        cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
        turned = np.eye(3) + np.sin(value) * cross + (1 - np.cos(value)) * cross @ cross
        rotation = rotation @ turned
    return at + rotation @ chain.tip.translation


def tip_velocity(chain: Chain, q: Array, rate: Array) -> Array:
    """Velocity of the tip along q + s rate, by Richardson's difference."""
    def slope(s: float) -> Array:
        return (tip(chain, q + s * rate) - tip(chain, q - s * rate)) / (2 * s)

    return (4 * slope(1e-3) - slope(2e-3)) / 3


def text(value: object) -> str:
    return value.decode() if isinstance(value, bytes) else str(value)


def datasets(file: h5py.File) -> list[str]:
    names: list[str] = []
    file.visititems(lambda name, item: names.append(name) if isinstance(item, h5py.Dataset) else None)
    return names


class SessionFile(SystemTest):
    def scara(self) -> Path:
        arm = self.directory / "scara.urdf"
        arm.write_text(SCARA)
        return arm

    def recorded(self, arm: Path, *options: str) -> Path:
        return self.record("--device", arm, "--coupling", "proposed", "--eta", "0.7", *options)

    def test_positions_are_in_si_so_that_a_plain_forward_kinematics_finds_the_tips(self) -> None:
        for arm, kinds in ((self.scara(), "rrpr"), (SLIDES, "ppp")):
            with self.subTest(arm=arm.name), h5py.File(self.recorded(arm)) as file:
                chain = parse_chain(text(file.attrs["device_urdf"]))
                self.assertEqual("".join("p" if j.slides else "r" for j in chain.joints), kinds)
                moved = 0.0
                for body in ("device", "proxy"):
                    tips, speeds = file[body + "/tip"][:], file[body + "/tip_velocity"][:]
                    self.assertEqual((file[body + "/tip"].attrs["unit"], speeds.shape[1]), ("m", 3))
                    q, rate = file[body + "/position"][:], file[body + "/velocity"][:]
                    for k in range(0, len(q), 97):
                        np.testing.assert_allclose(tips[k], tip(chain, q[k]), atol=1e-12)
                        np.testing.assert_allclose(speeds[k], tip_velocity(chain, q[k], rate[k]),
                                                   atol=1e-8)
                    moved = max(moved, np.abs(speeds).max())
                self.assertGreater(moved, 1e-2, "nothing moved, and nothing was shown")

    def test_forces_of_slides_are_newtons(self) -> None:
        """Slides along x, y, z: a force at the proxy's tip is the force of its joints."""
        with h5py.File(self.recorded(SLIDES)) as file:
            chain = parse_chain(text(file.attrs["device_urdf"]))
            axes = np.array([tip(chain, e) - tip(chain, np.zeros(3)) for e in np.eye(3)])  # per metre
            force = file["contact/total_force"][:]
            touched = np.abs(force).max(axis=1) > 0.1
            self.assertGreater(touched.sum(), 20)
            np.testing.assert_allclose(file["proxy/contact_torque"][:][touched],
                                       (force @ axes.T)[touched], rtol=1e-9, atol=1e-12)

    def test_every_dataset_says_the_unit_of_each_joint(self) -> None:
        with h5py.File(self.recorded(self.scara())) as file:
            for name in MOTIONS[::2]:
                self.assertEqual([text(u) for u in file[name].attrs["unit"]], ["rad", "rad", "m", "rad"])
            for name in MOTIONS[1::2]:
                self.assertEqual([text(u) for u in file[name].attrs["unit"]],
                                 ["rad/s", "rad/s", "m/s", "rad/s"])
            for name in TORQUES:
                self.assertEqual([text(u) for u in file[name].attrs["unit"]], ["N m", "N m", "N", "N m"])
        with h5py.File(self.record("--duration", "0.1")) as file:
            self.assertEqual(file["device/position"].attrs["unit"], "rad")

    def test_a_table_names_the_unit_of_each_joint_and_holds_what_the_file_holds(self) -> None:
        session = self.recorded(self.scara(), "--duration", "0.3", "--twin")
        out = session.with_suffix(".csv")
        self.assertEqual(limpid("info", session, "--csv", out).status, 0)
        with out.open() as lines, h5py.File(session) as file:
            rows = list(csv.DictReader(lines))
            for column, name, part in (
                ("device_position_3_m", "device/position", 2),
                ("device_position_2_rad", "device/position", 1),
                ("proxy_velocity_3_m_s", "proxy/velocity", 2),
                ("device_motor_torque_3_N", "device/motor_torque", 2),
                ("device_motor_torque_1_N_m", "device/motor_torque", 0),
                ("device_tip_z_m", "device/tip", 2),
                ("proxy_tip_velocity_x_m_s", "proxy/tip_velocity", 0),
                ("contact_total_force_y_N", "contact/total_force", 1),
                ("contact_point_1_x_m", "contact/point", 0),
                ("twin_device_position_3_m", "twin/device/position", 2),
                ("twin_device_tip_x_m", "twin/device/tip", 0),
            ):
                self.assertNotEqual(len(rows), 0)
                found = np.array([float(row[column]) for row in rows])
                np.testing.assert_array_equal(found, file[name][:, part], column)

    def test_a_summary_of_slides_is_in_millimetres_and_newtons(self) -> None:
        session = self.recorded(SLIDES)
        said = limpid("info", session).out
        with h5py.File(session) as file:
            apart = np.linalg.norm(file["device/position"][:] - file["proxy/position"][:], axis=1).max()
            force = np.linalg.norm(file["proxy/contact_torque"][:], axis=1).max()
        self.assertIn(f" {1e3 * apart:.3f} mm\n", said)
        self.assertIn(f" {force:.4f} N\n", said)

    def test_a_session_of_slides_comes_again_bit_for_bit(self) -> None:
        for arm in (self.scara(), SLIDES):
            first = self.recorded(arm, "--twin", "coupling.eta=1.5")
            again = limpid("run", "--hand", first, "--record", again_file := self.out())
            self.assertEqual((again.status, again.err), (0, ""))
            with h5py.File(first) as a, h5py.File(again_file) as b:
                for name in datasets(a):
                    if "timing/" not in name:
                        self.assertEqual(a[name][()].tobytes(), b[name][()].tobytes(), name)

    def test_it_says_what_it_is_of(self) -> None:
        with h5py.File(self.recorded(self.scara(), "--duration", "0.1", "--tip", "flange")) as file:
            attributes = file.attrs
            self.assertEqual(attributes["version"], 2)
            self.assertEqual([text(j) for j in attributes["joints"]],
                             ["base_inner", "inner_outer", "outer_spindle", "spindle_flange"])
            self.assertEqual([text(j) for j in attributes["joint_types"]],
                             ["revolute", "revolute", "prismatic", "revolute"])
            self.assertEqual(attributes["tip"], "flange")
            self.assertIn("rad/s", attributes["conventions"])
            said = limpid("--version").out.strip()
            self.assertTrue(attributes["build"].startswith(said + ", "), attributes["build"])
            self.assertRegex(attributes["build"], r", (GCC|clang) [^;]*, build [0-9a-f]{16}; \w+")

    def test_its_dimensions_have_scales(self) -> None:
        with h5py.File(self.recorded(self.scara(), "--duration", "0.1", "--twin")) as file:
            for run in ("", "twin/"):
                time = file[run + "time"]
                self.assertEqual(text(time.attrs["CLASS"]), "DIMENSION_SCALE")
                names = [n for n in datasets(file) if n.startswith(run) and "twin/" not in n[len(run):]]
                for name in names:
                    data, short = file[name], name[len(run):]
                    if short.startswith(("check/", "events/", "marks/")) or short in (
                            "time", "joint", "axis", "quaternion", "contact_axis"):
                        continue
                    self.assertEqual(data.dims[0][0], time, name)
                    if data.ndim == 2 and data.shape[1] == 4:
                        other = "quaternion" if short == "device/orientation" else "joint"
                        self.assertEqual(data.dims[1][0], file[other], name)
                    if data.ndim == 2 and data.shape[1] == 3:
                        self.assertEqual(data.dims[1][0], file["axis"], name)
                    if data.ndim == 2 and data.shape[1] == 12:
                        self.assertEqual(data.dims[1][0], file["contact_axis"], name)
                    # xarray opens a group where all dimensions have one
                    self.assertTrue(all(len(dimension) == 1 for dimension in data.dims), name)
            self.assertEqual([text(n) for n in file["joint"]],
                             [text(n) for n in file.attrs["joints"]])

    def test_where_nothing_touches_there_is_no_place_and_no_force(self) -> None:
        with h5py.File(self.record()) as file:
            point, force = file["contact/point"][:], file["contact/force"][:]
            total = file["contact/total_force"][:]
            self.assertTrue(np.isfinite(force).all() and np.isfinite(total).all())
            places, forces = point.reshape(len(point), -1, 3), force.reshape(len(force), -1, 3)
            touched = (forces != 0).any(axis=2)
            self.assertGreater(touched.sum(), 100)
            self.assertGreater((~touched).sum(), 100)
            np.testing.assert_array_equal(np.isnan(places), np.repeat(~touched[..., None], 3, axis=2))
            np.testing.assert_allclose(total, forces.sum(axis=1), rtol=1e-15, atol=1e-15)
            # the tip is a sphere, so the contact is near it
            apart = np.linalg.norm(places[:, 0] - file["proxy/tip"][:], axis=1)[touched[:, 0]]
            self.assertLess(apart.max(), 0.05)

    def test_equal_runs_have_equal_sums(self) -> None:
        first, second = self.record("--duration", "1"), self.record("--duration", "1")
        with h5py.File(first) as a, h5py.File(second) as b:
            self.assertGreater(len(a["check/sums"]), 0)
            self.assertEqual(a["check/sums"][()].tobytes(), b["check/sums"][()].tobytes())
            self.assertNotEqual(a["timing/compute"][()].tobytes(), b["timing/compute"][()].tobytes())

    def test_numbers_of_32_bits_are_read(self) -> None:
        session = self.record("--duration", "0.3")
        with h5py.File(session, "r+") as file:
            values = file["hand/target"][()].astype("float32")
            del file["check"], file["hand/target"]
            file["hand/target"] = values
        again = self.out()
        self.assertEqual(limpid("run", "--hand", session, "--record", again).status, 0)
        with h5py.File(again) as file:
            np.testing.assert_array_equal(file["hand/target"][()], values.astype("float64"))

    def test_a_recording_of_version_1_opens_and_runs_again_as_it_always_did(self) -> None:
        """An older program made this recording before slides were in SI. It rendered no friction
        under its law: so the table is smooth."""
        again, table, smooth = self.out(), self.out(".csv"), self.directory / "smooth.h5"
        shutil.copy(OLD, smooth)
        with h5py.File(smooth, "a") as old:
            scene = re.sub(r"(friction_\w+) = [\d.]+", r"\1 = 0", str(old.attrs["scene"]))
            old.attrs["scene"] = scene
        done = limpid("run", "--hand", smooth, "--record", again)
        self.assertEqual(done.status, 0, done.err)
        self.assertEqual(limpid("info", OLD, "--csv", table).status, 0)
        header = table.read_text().splitlines()[0]
        self.assertIn(",device_position_1_m,", header)
        self.assertIn(",twin_proxy_torque_3_N,", header)
        with h5py.File(OLD) as old, h5py.File(again) as new:
            self.assertEqual((old.attrs["version"], new.attrs["version"]), (1, 2))
            self.assertGreater(np.abs(old["proxy/contact_torque"][:]).max(), 0.01)
            # The recording comes from another build: its numbers agree up to round-off.
            def same(name: str, factor: float) -> None:
                was = old[name][:] * factor
                largest = float(np.abs(was).max())
                np.testing.assert_allclose(new[name][:], was, 1e-12, 1e-12 * largest, err_msg=name)

            for run in ("", "twin/"):
                for name in MOTIONS:
                    same(run + name, 0.1)
                for name in TORQUES:
                    same(run + name, 10)
                for name in ("energy/controller_total", "energy/proxy_kinetic", "contact/force"):
                    same(run + name, 1)

    def test_what_a_killed_recording_of_version_1_left_is_recovered_in_si(self) -> None:
        part = self.directory / "left.h5.part"
        shutil.copy(OLD, part)
        self.assertEqual(limpid("recover", part).status, 0)
        with h5py.File(OLD) as old, h5py.File(self.directory / "left.h5") as new:
            self.assertEqual(new.attrs["version"], 2)
            np.testing.assert_array_equal(new["proxy/position"][:], old["proxy/position"][:] / 10)
            self.assertIn("proxy/tip", new)

    def test_a_re_run_says_once_that_another_build_recorded_it(self) -> None:
        session = self.record("--duration", "0.1", "--twin")
        own = limpid("run", "--hand", session)
        self.assertEqual((own.status, own.err), (0, ""))
        with h5py.File(session, "r+") as file:
            build = file.attrs["build"]
            file.attrs["build"] = "limpid 0.0.1, GCC 2.95, build 0123456789ab; vax"
        other = limpid("run", "--hand", session)
        self.assertEqual((other.status, len(other.error_lines)), (0, 1), other.err)
        for words in ("another build", "GCC 2.95", build):
            self.assertIn(words, other.err)
        with h5py.File(session, "r+") as file:
            file.attrs["build"] = build.split("; ")[0] + "; vax"
        moved = limpid("run", "--hand", session)
        self.assertEqual((moved.status, len(moved.error_lines)), (0, 1), moved.err)
        self.assertIn("another kind of processor", moved.err)

    def test_the_kind_of_processor_is_what_the_arithmetic_is_chosen_for(self) -> None:
        session, without = self.record("--duration", "0.1"), self.out()
        with h5py.File(session) as file:
            build = file.attrs["build"]
        if "avx2" not in Path("/proc/cpuinfo").read_text().split():
            raise unittest.SkipTest("this processor has no AVX2 to do without")
        self.assertIn("AVX2", build)
        tunables = {**os.environ, "GLIBC_TUNABLES": "glibc.cpu.hwcaps=-AVX2,-FMA"}
        subprocess.run([LIMPID, "run", "--duration", "0.1", "--record", without], env=tunables,
                       check=True, capture_output=True)
        with h5py.File(without) as file:
            self.assertNotRegex(file.attrs["build"], "AVX2|FMA")

    def test_ten_lines_of_python_plot_force_over_depth(self) -> None:
        session = self.record()
        done = subprocess.run([sys.executable, TEN_LINES, session], capture_output=True, text=True,
                              cwd=self.directory, check=True)
        out = session.with_suffix(".force.csv")
        self.assertIn(out.name, done.stdout)
        table = np.loadtxt(out, delimiter=",", skiprows=1)
        with h5py.File(session) as file:
            apart = file["device/tip"][:] - file["proxy/tip"][:]
            force = file["contact/total_force"][:]
        np.testing.assert_allclose(table[:, 0], 1e3 * np.sqrt((apart**2).sum(axis=1)), rtol=1e-6)
        np.testing.assert_allclose(table[:, 1], np.sqrt((force**2).sum(axis=1)), rtol=1e-6, atol=1e-9)
        self.assertGreater(table[:, 1].max(), 0.1)


if __name__ == "__main__":
    unittest.main()
