"""`limpid characterize`: a report of what an arm, or a device's arm, can render."""

from __future__ import annotations

import json
import signal
import subprocess
import sys
import time
import unittest
from pathlib import Path
from unittest import mock

from support import ASSETS, LIMPID, SystemTest, limpid

sys.path.insert(0, str(ASSETS / "python"))
sys.path.insert(0, str(Path(__file__).parent))
from test_look import Played  # noqa: E402


class Characterize(SystemTest):
    def setUp(self) -> None:
        self.folder = self.out("")
        self.folder.mkdir()
        (self.folder / "limpid").mkdir(mode=0o700)
        self.enterContext(mock.patch.dict("os.environ", XDG_RUNTIME_DIR=str(self.folder),
                                          XDG_CONFIG_HOME=str(self.folder / "config")))

    def numbers(self, out: Path) -> dict:
        found = json.loads((out / "characterize.json").read_text())
        self.assertIn("limpid", found["provenance"])
        return {number["key"]: number for number in found["numbers"]}

    def test_a_file_with_what_is_set_and_what_is_assumed(self) -> None:
        out = self.folder / "omni"
        result = limpid("characterize", "omni.urdf", "--out", out, "--set", "device.delay=1")
        self.assertEqual(result.status, 0, result.err)
        numbers = self.numbers(out)
        self.assertEqual((numbers["delay"]["value"], numbers["delay"]["assumed"]), (1, False))
        self.assertTrue(numbers["encoder_step"]["assumed"])
        self.assertIn("ASSUMED: exact", result.out)
        self.assertIn("----  direct coupling: stiffest wall, divided by (b_d + b_h)/(T/2 + delay)", result.out)
        for end in ("report.html", "characterize.svg", "characterize.csv"):
            self.assertTrue((out / end).exists(), end)

    def test_a_file_that_says_what_its_device_measures(self) -> None:
        out = self.folder / "touch"
        result = limpid("characterize", "touch.urdf", "--out", out)
        self.assertEqual(result.status, 0, result.err)
        numbers = self.numbers(out)
        step, delay = numbers["encoder_step"], numbers["delay"]
        self.assertEqual((step["value"], step["from"], step["assumed"]), (4.19e-4, "the arm's file", False))
        self.assertEqual((delay["value"], delay["assumed"]), (1, True))
        self.assertIn("assumed in the arm's file", delay["from"])

    def test_a_device_that_is_never_pushed(self) -> None:
        book = self.folder / "config/limpid/devices.toml"
        book.parent.mkdir(parents=True)
        arm = self.folder / "identified.urdf"
        arm.write_text((ASSETS / "devices/touch.urdf").read_text())
        book.write_text(f'[device."socket:played"]\narm = "{arm}"\ndelay = 0.0021\n')
        out = self.folder / "device"
        with Played("played") as device:
            result = limpid("characterize", "--device", "socket:played", "--out", out)
            self.assertIn(result.status, (0, 1), result.err)
            commands = device.commands[:]
        self.assertTrue(commands)
        self.assertFalse([each for each in commands if each[3] != 0 or any(each[6:])])
        numbers = self.numbers(out)
        self.assertEqual(numbers["delay"]["value"], 2)
        self.assertIn("identified as 2.10 ms", numbers["delay"]["from"])
        self.assertAlmostEqual(numbers["encoder_step"]["value"], 1e-4, delta=1e-9)
        self.assertAlmostEqual(numbers["friction"]["value"], 0.26, delta=0.01)
        self.assertFalse(any(number["assumed"] for number in numbers.values()), numbers)

    def test_a_device_of_which_nothing_is_known(self) -> None:
        out = self.folder / "unknown"
        with Played("played"):
            limpid("characterize", "--device", "socket:played", "--out", out)
        numbers = self.numbers(out)
        for key in ("mass", "damping", "delay"):
            self.assertTrue(numbers[key]["assumed"], key)

    def test_what_cannot_be_is_refused(self) -> None:
        out = self.folder / "out"
        file = self.folder / "file"
        file.write_text("")
        for words, said in ((("nothing.urdf",), "nothing.urdf"), ((), "needed: an arm's file"),
                            (("omni.urdf", "--coupling", "tank"), "measures every law"),
                            (("omni.urdf", "--set", "hand.stiffness=3"), "hand.stiffness: cannot be chosen here"),
                            (("--device", "socket:none"), "no device is connected. Plug the device in: "
                                                          "a connected device reports the encoder steps itself.")):
            with self.subTest(words=words):
                result = limpid("characterize", *words, "--out", out)
                self.assertEqual((result.status, len(result.error_lines)), (2, 1), result.err)
                self.assertIn(said, result.err)
                self.assertFalse(out.exists())
        result = limpid("characterize", "omni.urdf", "--out", file / "below")
        self.assertEqual((result.status, len(result.error_lines)), (2, 1), result.err)

    def test_a_device_that_is_not_plugged_in_has_an_arm_that_can_be_named(self) -> None:
        book = self.folder / "config/limpid/devices.toml"
        book.parent.mkdir(parents=True)
        for key in ("arm", "taken_for"):
            book.write_text(f'[device."socket:played"]\n{key} = "/home/me/identified.urdf"\n')
            result = limpid("characterize", "--device", "socket:played", "--out", self.folder / "out")
            self.assertEqual((result.status, len(result.error_lines)), (2, 1), result.err)
            self.assertIn("socket:played: is not connected; no device is connected. Plug the device in", result.err)
            self.assertIn("Without the device: limpid characterize /home/me/identified.urdf --set "
                          "device.encoder_step=STEP", result.err)
        book.write_text('[device."socket:played"]\ntaken_for = "built-in"\n')
        result = limpid("characterize", "--device", "socket:played", "--out", self.folder / "out")
        self.assertNotIn("Without the device", result.err)

    def test_ctrl_c_leaves_a_whole_message(self) -> None:
        out = self.folder / "stopped"
        process = subprocess.Popen([LIMPID, "characterize", "omni.urdf", "--out", out, "--set", "loop.tick=0.0001"],
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        while not out.exists():
            time.sleep(0.001)
        time.sleep(0.1)
        process.send_signal(signal.SIGINT)
        _, said = process.communicate(timeout=60)
        self.assertEqual((process.returncode, said), (1, "limpid: stopped; no results were written\n"))
        self.assertEqual([file.name for file in out.iterdir()], ["limpid.txt"])


if __name__ == "__main__":
    unittest.main()
