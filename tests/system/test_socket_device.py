"""A program that plays a device is listed like one that is plugged in."""

from __future__ import annotations

import os
import subprocess
import tempfile
import time
import unittest
from pathlib import Path

import h5py
import numpy as np

from support import ASSETS, LIMPID

CLIENT = ASSETS / "python" / "limpid_device.py"


class SocketDevice(unittest.TestCase):
    def listed(self, folder: str) -> str:
        environment = {**os.environ, "XDG_RUNTIME_DIR": folder}
        done = subprocess.run([str(LIMPID), "devices"], capture_output=True, text=True,
                              timeout=60, env=environment)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout

    def test_is_listed_while_its_program_runs(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            socket = Path(folder, "limpid", "pendulum.device")
            environment = {**os.environ, "XDG_RUNTIME_DIR": folder}
            client = subprocess.Popen(["/usr/bin/python3", CLIENT, "pendulum", "1"],
                                      env=environment)
            try:
                line = f"pendulum\n  device on a socket, socket:pendulum at {socket}"
                for _ in range(600):
                    if line in self.listed(folder):
                        break
                    time.sleep(0.1)
                self.assertIn(line, self.listed(folder))
            finally:
                client.kill()
                client.wait()
            self.assertNotIn("pendulum", self.listed(folder), "it has left its socket only")

    def test_the_orientation_of_its_tool_and_its_warmth_are_recorded(self) -> None:
        program = (
            "import sys, time; sys.path.insert(0, sys.argv[1]); from limpid_device import LimpidDevice\n"
            "device = LimpidDevice('pen', [-0.1] * 3, [0.1] * 3, [3.0] * 3, version=2, slides=[True] * 3)\n"
            "while True:\n"
            "    x = 1e-5 * (time.monotonic() % 1)\n"
            "    device.exchange([x, x, 0.05 + x], warmth=0.25, orientation=(0.5, -0.5, 0.5, -0.5))\n"
            "    time.sleep(1e-3)\n")
        with tempfile.TemporaryDirectory() as folder:
            environment = {**os.environ, "XDG_RUNTIME_DIR": folder, "XDG_CONFIG_HOME": folder}
            Path(folder, "limpid").mkdir(mode=0o700)
            Path(folder, "limpid", "devices.toml").write_text('[device."socket:pen"]\nchecked = true\n')
            device = subprocess.Popen(["/usr/bin/python3", "-c", program, CLIENT.parent], env=environment)
            try:
                for _ in range(600):
                    if Path(folder, "limpid", "pen.device").exists():
                        break
                    time.sleep(0.1)
                out = Path(folder, "pen.h5")
                # Whether force was on all the time is another test's question.
                done = subprocess.run(
                    [str(LIMPID), "run", "--live", "socket:pen", "--device",
                     str(ASSETS / "devices/openhaptics.urdf"), "--yes", "--duration", "1", "--record", str(out)],
                    capture_output=True, text=True, timeout=60, env=environment)
                self.assertTrue(out.exists(), done.stderr)
                with h5py.File(out) as file:
                    orientation, warmth = file["device/orientation"][...], file["device/warmth"][...]
                    self.assertEqual(file["device/orientation"].attrs["unit"], "-")
                known = ~np.isnan(orientation[:, 0])
                self.assertGreater(known.sum(), 500)
                np.testing.assert_array_equal(orientation[known], np.tile((0.5, -0.5, 0.5, -0.5), (known.sum(), 1)))
                self.assertEqual(warmth.max(), 0.25)
            finally:
                device.kill()
                device.wait()


if __name__ == "__main__":
    unittest.main()
