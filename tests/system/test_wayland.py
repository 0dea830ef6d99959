#!/usr/bin/python3
"""The window on Wayland, in a Weston that shows nobody anything. Needs GLFW 3.4, as Debian 13 has it."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import tempfile
import time
import unittest
from pathlib import Path

from support import LIMPID


@unittest.skipUnless(shutil.which("weston"), "needs weston")
class OnWayland(unittest.TestCase):
    def setUp(self) -> None:
        self.home = Path(tempfile.mkdtemp(prefix="limpid-wayland-"))
        self.addCleanup(shutil.rmtree, self.home, ignore_errors=True)
        self.home.chmod(0o700)
        self.environment = {
            **{name: value for name, value in os.environ.items() if name != "DISPLAY"},
            "XDG_RUNTIME_DIR": str(self.home), "WAYLAND_DISPLAY": "limpid-test",
            "XDG_CONFIG_HOME": str(self.home / "config"), "XDG_DATA_HOME": str(self.home / "data"),
            "XDG_CACHE_HOME": str(self.home / "cache"), "LIBGL_ALWAYS_SOFTWARE": "1"}  # fmt: skip
        if "Xwayland" in self.window_found():
            self.skipTest("GLFW knows X11 only here")

    def window_found(self) -> str:
        done = subprocess.run([LIMPID, "doctor", "--json"], env=self.environment, capture_output=True,
                              text=True, timeout=120)  # fmt: skip
        (window,) = [f for f in json.loads(done.stdout)["findings"] if f["what"] == "window"]
        return window["found"]

    def weston(self, scale: int) -> None:
        """A desktop whose screen has so many pixels for each unit."""
        server = subprocess.Popen(
            ["weston", "--backend=headless", "--renderer=pixman", "--width=3200", "--height=1800",
             f"--scale={scale}", "--idle-time=0", "--no-config", "--socket=limpid-test"],
            env=self.environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)  # fmt: skip
        self.addCleanup(server.wait)
        self.addCleanup(server.terminate)
        end = time.monotonic() + 30
        while not (self.home / "limpid-test").exists():
            self.assertLess(time.monotonic(), end, "weston does not start")
            time.sleep(0.1)

    def window(self) -> tuple[list[dict], str]:
        """Its states until it has drawn some frames, and what it said to the desktop."""
        with (self.home / "states").open("w") as states, (self.home / "said").open("w") as said:
            app = subprocess.Popen([LIMPID, "--print-state"], stdout=states, stderr=said,
                                   env=self.environment | {"WAYLAND_DEBUG": "client"})  # fmt: skip
            try:
                end = time.monotonic() + 60
                while True:
                    lines = (self.home / "states").read_text().split("\n")[:-1]
                    seen = [json.loads(line) for line in lines]
                    if seen and seen[-1]["frames"] > 20 and seen[-1]["ticks"] > 500:
                        break
                    self.assertIsNone(app.poll(), (self.home / "said").read_text()[-2000:])
                    self.assertLess(time.monotonic(), end, seen[-1:])
                    time.sleep(0.1)
            finally:
                app.terminate()
                status = app.wait(20)
        self.assertEqual(status, 0)
        return seen, (self.home / "said").read_text()

    def test_it_opens_with_the_desktops_name_for_it(self) -> None:
        self.weston(scale=1)
        self.assertIn("on Wayland", self.window_found())
        _, said = self.window()
        self.assertIn('set_app_id("limpid")', said)

    def test_two_pixels_for_a_unit_are_drawn(self) -> None:
        self.weston(scale=2)
        _, said = self.window()
        self.assertRegex(said, r"set_buffer_scale\(2\)|wp_viewport")


if __name__ == "__main__":
    unittest.main()
