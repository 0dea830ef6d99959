"""`limpid devices look`: a device is read and recorded, and never pushed.

Devices are a program here and stand-ins for makers' libraries; both note whatever they are told.
"""

from __future__ import annotations

import json
import math
import os
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest
from pathlib import Path
from unittest import mock

import h5py
import numpy as np

from support import ASSETS, LIMPID, limpid
from test_inverse3 import Service
from vendor_link import environment, motors_in

sys.path.insert(0, str(ASSETS / "python"))
from limpid_device import LimpidDevice  # noqa: E402

STEP = 1e-3  # of the played path [rad]


def at(t: float, rest: float) -> list[float]:
    """A path in whole steps: three joints at rest, one of them with a noise of half a step to either
    side, then each to its ends and back, for ever."""
    if t < rest:
        return [0.0, -0.5, 1 + STEP * (int(t / 2e-3) % 2)]
    way = lambda low, high: STEP * round((low + (high - low) * (0.5 - 0.5 * math.cos(t - rest))) / STEP)
    return [way(0.0, 0.7), way(-0.5, -1.5), way(1.0, 2.0)]


class Played(threading.Thread):
    """A device on a socket that follows `at` from when it is first connected, and keeps each command."""

    def __init__(self, name: str, version: int = 2, rest: float = 1.5, motors: bool = True) -> None:
        super().__init__()
        self.device = LimpidDevice(name, [-1, -1.735, 0.15], [1, 0.165, 2.9916],
                                   [0.64, 0.64, 0.45] if motors else [0.0] * 3, version=version)
        self.commands: list[tuple] = []
        self.over, self.rest, self.said = threading.Event(), rest, {}
        obey = self.device._obey
        self.device._obey = lambda command: (self.commands.append(command), obey(command))

    def run(self) -> None:
        begun = None
        while not self.over.wait(1e-3):
            if self.device._connection and begun is None:
                begun = time.monotonic()
            self.device.exchange(at(time.monotonic() - (begun or time.monotonic()), self.rest), **self.said)

    def __enter__(self) -> Played:
        self.start()
        return self

    def __exit__(self, *_: object) -> None:
        self.over.set()
        self.join()
        self.device._hang_up()
        self.device._listener.close()


class Look(unittest.TestCase):
    def setUp(self) -> None:
        self.folder = Path(self.enterContext(tempfile.TemporaryDirectory()))
        (self.folder / "limpid").mkdir(mode=0o700)
        self.enterContext(mock.patch.dict("os.environ", XDG_RUNTIME_DIR=str(self.folder),
                                          XDG_CONFIG_HOME=str(self.folder / "config")))
        self.out = self.folder / "look.h5"

    def look(self, *words: str | Path, status: int = 0) -> dict:
        result = limpid("devices", "look", *words, "--record", self.out, "--json")
        self.assertEqual(result.status, status, result.err)
        self.said = result.err
        return json.loads(result.out)

    def assert_never_pushed(self, device: Played) -> None:
        self.assertGreater(len(device.commands), 500, "nothing was sent at all")
        for _, _, _, mode, _, _, *torque in device.commands:
            self.assertEqual(mode, 0)
            self.assertFalse(any(torque))

    def test_a_device_that_nobody_has_checked_is_read_and_never_pushed(self) -> None:
        for version in (1, 2):
            with self.subTest(version=version), Played(f"played{version}", version) as device:
                found = self.look(f"socket:played{version}", "--seconds", "6", "--force")
                self.assert_never_pushed(device)
                self.assertIn("gets no force", self.said)
                self.assertEqual((found["joints"][0]["name"], found["pushes"], found["axes_checked"]),
                                 ("turret", True, False))
                self.assertIn("a built-in arm", found["arm_why"])
                for joint, (least, most) in zip(found["joints"], ((0, 0.7), (-1.5, -0.5), (1, 2))):
                    self.assertAlmostEqual(joint["least"], least, delta=STEP)
                    self.assertAlmostEqual(joint["most"], most, delta=STEP)
                    self.assertAlmostEqual(joint["smallest_step"], STEP, delta=1e-6)
                    self.assertAlmostEqual(joint["declared_step"], 1e-4, delta=1e-9)
                self.assertLess(found["joints"][0]["noise"], 1e-9)
                self.assertAlmostEqual(found["joints"][2]["noise"], STEP / 2, delta=0.1 * STEP)
                self.assertGreater(found["readings"], 2000)
                self.assertAlmostEqual(found["rate_hz"] * found["median_gap_s"], 1, delta=0.4)

    def test_the_session_has_the_motion_that_was_played(self) -> None:
        with Played("played") as device:
            self.look("socket:played", "--seconds", "5")
            self.assert_never_pushed(device)
        with h5py.File(self.out) as file:
            seen = file["device/measured_position"][...]
            self.assertFalse(file["device/motor_torque"][...].any())
            self.assertEqual(set(file["device/force_wanted"][...]), {0})
            self.assertIn("device without force: played", str(file.attrs["source"]))
        # The phase of the path is the same for all joints.
        phase = (seen - [0, -0.5, 1]) / [0.7, -1.0, 1.0]
        moving = phase[:, 0] > 0.02
        self.assertGreater(np.ptp(seen[:, 0]), 0.69)
        self.assertLess(np.abs(phase[moving] - phase[moving, :1]).max(), 2 * STEP / 0.7)
        told = limpid("info", self.out)
        self.assertEqual(told.status, 0, told.err)
        self.assertIn("device without force: played", told.out)
        again = limpid("run", "--hand", self.out, "--record", self.folder / "again.h5")
        self.assertEqual(again.status, 0, again.err)

    def test_what_the_device_says_of_itself_is_told(self) -> None:
        with Played("played") as device:
            device.said = {"hand": False, "buttons": 0b101, "no_force": 1, "warmth": 0.25, "calibrated": False}
            found = self.look("socket:played", "--seconds", "2")
            self.assert_never_pushed(device)
            self.assertEqual(found["buttons"], [1, 3])
            self.assertAlmostEqual(found["warmth"], 0.25)
            for key in ("without_hand_s", "uncalibrated_s"):
                self.assertGreater(found[key], 1.5, key)
            self.assertGreater(found["no_force_s"][1], 1.5)
            text = limpid("devices", "look", "socket:played", "--record", self.out, "--force", "--seconds", "1").out
            for said in ("pressed: 1, 3", "a button on the device", "not calibrated for", "nobody held the switch",
                         "25 % of the hottest", "turret [rad]", "not checked yet", "got no force"):
                self.assertIn(said, text)

    def test_a_device_without_motors_is_read(self) -> None:
        with Played("paddle", motors=False) as device:
            found = self.look("socket:paddle", "--seconds", "1")
            self.assertFalse(found["pushes"])
            self.assertFalse([each for each in device.commands if each[3] != 0 or any(each[6:])])

    def test_a_device_that_is_unplugged_is_said_and_what_was_seen_is_kept(self) -> None:
        device = Played("played")
        with device:
            threading.Timer(2.5, device.over.set).start()
            threading.Timer(2.6, device.device._hang_up).start()
            found = self.look("socket:played", "--seconds", "60", status=1)
        self.assertIn("the device is disconnected", self.said)
        self.assertTrue(found["gone"])
        with h5py.File(self.out) as file:
            self.assertGreater(len(file["time"]), 1000)

    def test_what_cannot_be_is_refused(self) -> None:
        with Played("played"):
            for words, said in ((("nothing:1",), "nothing:1: is not connected; connected devices: socket:played"),
                                (("socket:played", "--seconds", "0"), "--seconds"),
                                (("socket:played", "--seconds", "1e9"), "--seconds")):
                result = limpid("devices", "look", *words, "--record", self.out)
                self.assertEqual((result.status, len(result.error_lines)), (2, 1), result.err)
                self.assertIn(said, result.err)
            self.assertFalse(self.out.exists())
            self.out.write_text("mine")
            result = limpid("devices", "look", "socket:played", "--record", self.out, "--seconds", "1")
            self.assertEqual(result.status, 2, result.err)
            self.assertIn("exists; --force overwrites it", result.err)
            self.assertEqual(self.out.read_text(), "mine")
        result = limpid("devices", "look", "socket:played")
        self.assertEqual(result.status, 2)
        self.assertIn("--record", result.err)
        result = limpid("devices", "socket:played", "look", "--record", self.out)
        self.assertIn("write device and options after", result.err)

    def test_ctrl_c_leaves_a_whole_session(self) -> None:
        with Played("played") as device:
            process = subprocess.Popen([LIMPID, "devices", "look", "socket:played", "--record", self.out],
                                       stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
            while len(device.commands) < 1500:
                time.sleep(0.01)
            process.send_signal(signal.SIGINT)
            out, said = process.communicate(timeout=30)
            self.assert_never_pushed(device)
        self.assertEqual(process.returncode, 1)
        self.assertIn("stopped at", said)
        self.assertIn("recorded", out)
        self.assertEqual(limpid("info", self.out).status, 0)

    @unittest.skipUnless(Path("/dev/full").exists(), "no device that is full")
    def test_a_full_disk_is_said(self) -> None:
        small = self.folder / "small"
        small.mkdir()
        if subprocess.run(["mount", "-t", "tmpfs", "-o", "size=256k", "tmpfs", small],
                          capture_output=True).returncode != 0:
            self.skipTest("a small disk cannot be mounted here")
        self.addCleanup(subprocess.run, ["umount", "-l", small])
        with Played("played"):
            begun = time.monotonic()
            result = limpid("devices", "look", "socket:played", "--record", small / "look.h5", "--seconds", "60")
        self.assertNotEqual(result.status, 0)
        self.assertLess(time.monotonic() - begun, 40, "goes on without its recording")
        self.assertIn("limpid: ", result.err)
        self.assertRegex(result.err, "space|full|written|recording")


class OfAService(unittest.TestCase):
    """An Inverse3 through a stand-in of its service, which says each force that it is asked for."""

    def test_is_read_and_gets_no_force(self) -> None:
        service = Service()
        self.addCleanup(service.end)
        service.tell("move 0.05 -0.12 0.2")
        with tempfile.TemporaryDirectory() as folder:
            out = Path(folder, "look.h5")
            process = subprocess.Popen(
                [LIMPID, "devices", "look", service.name, "--record", out, "--seconds", "3", "--json"],
                stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                env={**os.environ, "XDG_CONFIG_HOME": folder, "XDG_RUNTIME_DIR": folder})
            self.addCleanup(process.kill)
            service.wait(lambda line: line == "session")
            while process.poll() is None:  # to and fro along the service's z, which is up
                service.tell(f"move 0.05 -0.12 {0.2 + 0.03 * math.sin(4 * time.monotonic()):.4f}")
                time.sleep(0.01)
            text, said = process.communicate(timeout=60)
            self.assertEqual(process.returncode, 0, said)
            found = json.loads(text)
            self.assertIn("the device reports this arm itself", found["arm_why"])
            self.assertEqual((found["pushes"], found["force_given"]), (True, False))
            self.assertGreater(found["readings"], 300)
            spans = [joint["most"] - joint["least"] for joint in found["joints"]]
            self.assertEqual([joint["unit"] for joint in found["joints"]], ["m"] * 3)
            self.assertAlmostEqual(spans[2], 0.06, delta=2e-3)
            self.assertLess(max(spans[:2]), 1e-6)
            self.assertEqual(service.pushes(), [], "it was pushed")
            service.tell("count")
            messages = int(service.wait(lambda line: line.startswith("messages")).split()[1])
            self.assertGreater(messages, 300, "nothing was sent at all")
            with h5py.File(out) as file:
                self.assertIn("device without force: ", str(file.attrs["source"]))
                self.assertFalse(file["device/motor_torque"][...].any())


class OfAMaker(unittest.TestCase):
    """Devices of makers with a library of their own; the stand-in keeps what its motors hold."""

    def test_is_read_and_its_motors_stay_off(self) -> None:
        for device, library in (("openhaptics:Default Device", "libHD.so.3.4 3.40.0 (/"),
                                ("forcedimension:0", "libdrd.so.3 3.17.1.20 (/")):
            with self.subTest(device=device), tempfile.TemporaryDirectory() as folder:
                out = Path(folder, "look.h5")
                done = subprocess.run(
                    [LIMPID, "devices", "look", device, "--record", out, "--seconds", "3", "--json"],
                    capture_output=True, text=True, timeout=120,
                    env={**environment(folder, "sway:0.6"), "XDG_CONFIG_HOME": f"{folder}/config",
                         "XDG_RUNTIME_DIR": folder})
                self.assertEqual(done.returncode, 0, done.stderr)
                found = json.loads(done.stdout)
                self.assertIn(library, found["driven_by"])
                self.assertIn("the device reports this arm itself", found["arm_why"])
                self.assertFalse(any(any(held.force) or held.on for held in motors_in(folder)))
                # A spring of 40 N/m, 0.1 kg and 3 N s/m under 0.6 N at 12 rad/s.
                swing = 0.6 / math.hypot(40 - 0.1 * 12**2, 3 * 12)
                for joint in found["joints"]:
                    self.assertEqual(joint["unit"], "m")
                    self.assertAlmostEqual((joint["most"] - joint["least"]) / 2, swing, delta=0.2 * swing)
                with h5py.File(out) as file:
                    self.assertIn(library, str(file.attrs["source"]))
                    self.assertFalse(file["device/motor_torque"][...].any())


if __name__ == "__main__":
    unittest.main()
