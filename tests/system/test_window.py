"""Drives the window as a new user would, under Xvfb with xdotool."""

import json
import os
import shutil
import subprocess
import tempfile
import time
import unittest
from pathlib import Path

from support import LIMPID

NEEDED = ("Xvfb", "xdotool")
WIDTH, HEIGHT = 1280, 720


@unittest.skipUnless(all(shutil.which(tool) for tool in NEEDED), f"needs {' and '.join(NEEDED)}")
class Window(unittest.TestCase):
    """One window for all of a test; its state comes as a line of JSON ten times a second."""

    def setUp(self) -> None:
        self.home = Path(tempfile.mkdtemp(prefix="limpid-window-"))
        self.addCleanup(shutil.rmtree, self.home, ignore_errors=True)
        settings = self.home / "config/limpid/settings.toml"
        settings.parent.mkdir(parents=True)
        settings.write_text(f"[window]\nwidth = {WIDTH}\nheight = {HEIGHT}\n")
        read, write = os.pipe()
        self.xvfb = subprocess.Popen(
            ["Xvfb", "-displayfd", str(write), "-screen", "0", "1600x900x24", "-nolisten", "tcp",
             "-ac", "+extension", "GLX"], pass_fds=[write], stderr=subprocess.DEVNULL)
        self.addCleanup(self.stop, self.xvfb)
        os.close(write)
        with os.fdopen(read) as pipe:
            display = f":{pipe.readline().strip()}"
        self.environment = {**os.environ, "DISPLAY": display,
                            "XDG_CONFIG_HOME": str(self.home / "config"),
                            "XDG_DATA_HOME": str(self.home / "data")}
        self.states = (self.home / "states").open("w")
        self.addCleanup(self.states.close)
        self.app = subprocess.Popen([LIMPID, "--print-state"], env=self.environment,
                                    stdout=self.states)
        self.addCleanup(self.stop, self.app)
        self.wait("the first tick", lambda s: s["ticks"] > 200, 60)
        self.window = self.xdotool("search", "--onlyvisible", "--name", "^Limpid").split()[0]
        self.xdotool("windowfocus", self.window)

    def stop(self, process: subprocess.Popen) -> None:
        process.terminate()
        try:
            process.wait(20)
        except subprocess.TimeoutExpired:
            process.kill()

    def xdotool(self, *words: str, check: bool = True) -> str:
        return subprocess.run(["xdotool", *words], env=self.environment, check=check,
                              capture_output=True, text=True).stdout

    def key(self, name: str, closes: bool = False) -> None:
        """A key press; one that closes the window leaves none for its release."""
        self.xdotool("key", "--window", self.window, "--delay", "120", name, check=not closes)

    def move(self, x: float, y: float) -> None:
        self.xdotool("mousemove", "--window", self.window, str(int(x)), str(int(y)))

    def state(self) -> dict:
        lines = (self.home / "states").read_text().splitlines()
        for line in reversed(lines):
            try:
                return json.loads(line)
            except json.JSONDecodeError:
                continue  # half a line
        return {"ticks": 0}

    def wait(self, what: str, holds, seconds: float = 30) -> dict:
        """The first state for which `holds`; slow machines get their time."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            state = self.state()
            if holds(state):
                return state
            self.assertIsNone(self.app.poll(), f"limpid ended while waiting for {what}")
            time.sleep(0.1)
        self.fail(f"waited {seconds} s for {what}; the state is {self.state()}")

    def press_onto_table(self) -> None:
        """Drags the tip, which stands right of the middle of the view, down onto the table."""
        x, y = 800, 315
        self.move(x, y)
        self.xdotool("mousedown", "1")
        for step in range(1, 31):
            self.move(x - step, y + 5 * step)
            time.sleep(0.04)

    def test_a_person_drags_onto_the_table_switches_records_plays_and_reruns(self) -> None:
        self.assertEqual(self.state()["kind"], 0, "a first start shows the standard coupling")
        self.press_onto_table()
        apart = self.wait("contact", lambda s: s["contact"] > 0.2)
        time.sleep(1.5)
        apart = self.state()
        self.assertAlmostEqual(apart["error"], apart["contact"] / 10, delta=0.02 * apart["error"])

        self.key("c")
        self.wait("the proposed coupling", lambda s: s["kind"] == 1)
        together = self.wait("device and proxy together",
                             lambda s: s["error"] < apart["error"] / 20)
        self.assertGreater(together["contact"], 0.2, "and still in contact")
        self.xdotool("mouseup", "1")
        self.wait("the hand to let go", lambda s: s["grip"] == 0)

        self.key("r")
        self.wait("recording", lambda s: s["recording"])
        self.press_onto_table()
        self.wait("contact", lambda s: s["contact"] > 0.2)
        self.key("c")
        time.sleep(1)
        self.xdotool("mouseup", "1")
        self.key("r")
        self.wait("the end of the recording", lambda s: not s["recording"])

        self.key("p")
        playing = self.wait("playback", lambda s: s["playing"])
        self.wait("playback to go on", lambda s: s["time"] > playing["time"])
        self.key("p")
        self.key("Home")
        self.wait("the beginning", lambda s: s["time"] == 0)
        self.key("shift+Right")
        self.wait("a step of 0.1 s", lambda s: abs(s["time"] - 0.1) < 1e-6)
        self.key("e")
        self.wait("the re-run", lambda s: s["rerun"])
        self.key("BackSpace")
        self.wait("the device again", lambda s: not s["playing"])

        recordings = list((self.home / "data/limpid/sessions").glob("*.h5"))
        self.assertEqual(len(recordings), 1)
        self.check_rerun_is_the_same(recordings[0])

    def check_rerun_is_the_same(self, session: Path) -> None:
        """A live recording, run again without a window: the same rows, bit for bit."""
        import h5py
        import numpy

        again = self.home / "again.h5"
        subprocess.run([LIMPID, "run", "--hand", str(session), "--record", str(again)], check=True,
                       stdout=subprocess.DEVNULL)
        with h5py.File(session) as a, h5py.File(again) as b:
            self.assertGreater(len(a["time"]), 500)
            for group in ("device", "proxy", "hand", "coupling", "energy"):
                for name in a[group]:
                    self.assertTrue(numpy.array_equal(a[group][name][...], b[group][name][...]),
                                    f"/{group}/{name}")

    def test_escape_cuts_the_force_at_once_and_f_arms_it_again(self) -> None:
        self.assertTrue(self.state()["force"])
        self.key("Escape")
        self.wait("force off", lambda s: not s["force"])
        self.key("f")
        self.wait("force on", lambda s: s["force"])

    def test_settings_are_remembered_from_one_start_to_the_next(self) -> None:
        self.key("bracketleft")
        eta = self.wait("a smaller eta", lambda s: s["eta"] < 1)["eta"]
        self.key("ctrl+q", closes=True)
        self.assertEqual(self.app.wait(30), 0)
        self.app = subprocess.Popen([LIMPID, "--print-state"], env=self.environment,
                                    stdout=self.states)
        self.addCleanup(self.stop, self.app)
        self.wait("the same eta", lambda s: s.get("eta") == eta and s["ticks"] < 3000)

    def test_a_killed_recording_is_recovered_at_the_next_start(self) -> None:
        self.key("r")
        self.wait("recording", lambda s: s["recording"])
        time.sleep(2)
        self.app.kill()
        self.app.wait()
        sessions = self.home / "data/limpid/sessions"
        self.assertEqual(len(list(sessions.glob("*.part"))), 1)
        self.app = subprocess.Popen([LIMPID, "--print-state"], env=self.environment,
                                    stdout=self.states)
        self.addCleanup(self.stop, self.app)
        self.wait("a new start", lambda s: s["ticks"] < 1500)
        self.assertEqual(len(list(sessions.glob("*.part"))), 0)
        self.assertEqual(len(list(sessions.glob("*.h5"))), 1)


if __name__ == "__main__":
    unittest.main()
