#!/usr/bin/python3
"""The window on Wayland: in a Weston that is a window under Xvfb. Needs GLFW 3.4, as Debian 13 has it."""

from __future__ import annotations

import ctypes
import json
import os
import shutil
import subprocess
import tempfile
import time
import unittest
from pathlib import Path

from support import LIMPID


NEEDED = ("Xvfb", "weston", "xdotool")


@unittest.skipUnless(all(shutil.which(tool) for tool in NEEDED), f"needs {', '.join(NEEDED)}")
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
        if not hasattr(ctypes.CDLL("libglfw.so.3"), "glfwGetWaylandWindow"):
            self.skipTest("GLFW knows X11 only here")

    def window_found(self) -> str:
        done = subprocess.run([LIMPID, "doctor", "--json"], env=self.environment, capture_output=True,
                              text=True, timeout=120)  # fmt: skip
        (window,) = [f for f in json.loads(done.stdout)["findings"] if f["what"] == "window"]
        return window["found"]

    def serve(self, *words: str, display: str = "", **how) -> None:
        server = subprocess.Popen(words, env=self.environment | ({"DISPLAY": display} if display else {}),
                                  stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, **how)  # fmt: skip
        self.addCleanup(server.wait)
        self.addCleanup(server.terminate)

    def weston(self, scale: int) -> None:
        """A desktop whose screen has so many pixels for each unit."""
        read, write = os.pipe()
        self.serve("Xvfb", "-displayfd", str(write), "-screen", "0", "2500x1500x24", "-nolisten", "tcp",
                   "-ac", pass_fds=[write])  # fmt: skip
        os.close(write)
        with os.fdopen(read) as pipe:
            self.display = f":{pipe.readline().strip()}"
        self.serve("weston", "--backend=x11", "--renderer=pixman", "--width=1200", "--height=700",
                   f"--scale={scale}", "--idle-time=0", "--no-config", "--socket=limpid-test",
                   display=self.display)  # fmt: skip
        end = time.monotonic() + 30
        while not (self.home / "limpid-test").exists():
            self.assertLess(time.monotonic(), end, "weston does not start")
            time.sleep(0.1)

    def xdotool(self, *words: str) -> None:
        subprocess.run(["xdotool", *words], env=self.environment | {"DISPLAY": self.display}, check=True)

    def window(self) -> str:
        """Opens the window and its help by a key; returns the program's messages to the desktop."""
        with (self.home / "states").open("w") as states, (self.home / "said").open("w") as said:
            app = subprocess.Popen([LIMPID, "--print-state"], stdout=states, stderr=said,
                                   env=self.environment | {"WAYLAND_DEBUG": "client"})  # fmt: skip
            try:
                self.wait(app, lambda s: s["frames"] > 20 and s["ticks"] > 500)
                self.xdotool("mousemove", "600", "350", "key", "--delay", "200", "F1")  # it has to be over it
                self.wait(app, lambda s: s["dialog"] == "help")
            finally:
                app.terminate()
                app.wait(20)
        return (self.home / "said").read_text()

    def wait(self, app: subprocess.Popen, holds) -> None:
        end = time.monotonic() + 60
        state = None
        while state is None or not holds(state):
            self.assertIsNone(app.poll(), (self.home / "said").read_text()[-2000:])
            self.assertLess(time.monotonic(), end, state)
            time.sleep(0.1)
            lines = (self.home / "states").read_text().split("\n")[:-1]
            state = json.loads(lines[-1]) if lines else None

    def test_it_opens_with_the_desktops_name_for_it(self) -> None:
        self.weston(scale=1)
        self.assertIn("on Wayland", self.window_found())
        said = self.window()
        self.assertIn('set_app_id("limpid")', said)

    def test_two_pixels_for_a_unit_are_drawn(self) -> None:
        self.weston(scale=2)
        said = self.window()
        self.assertRegex(said, r"set_buffer_scale\(2\)|wp_viewport")


if __name__ == "__main__":
    unittest.main()
