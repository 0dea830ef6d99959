"""A program that plays a device is listed like one that is plugged in."""

from __future__ import annotations

import os
import subprocess
import tempfile
import time
import unittest
from pathlib import Path

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


if __name__ == "__main__":
    unittest.main()
