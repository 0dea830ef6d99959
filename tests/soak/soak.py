#!/usr/bin/python3
"""Uses the window at random for as long as told, and watches that nothing grows and nothing is lost.

usage: soak.py LIMPID [--minutes M] [--seed S] [--memory MB]

LIMPID: the program, of any build. M: 10. S: of what is done; the same does the same as far as the
machine lets it. MB: what the second half may take more than the first, 40. Prints a line whenever
it has done something new and a table at the end. Exit status: 0 all is well, 1 something grew, was
lost or ended.

Needs Xvfb, xdotool, h5py and numpy.
"""
from __future__ import annotations

import argparse
import collections
import itertools
import os
import random
import re
import shutil
import statistics
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

HERE = Path(__file__).resolve().parent
CLIENT = HERE.parents[1] / "assets" / "python" / "limpid_device.py"
DEVICE = "soak"


def options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n", maxsplit=1)[0])
    parser.add_argument("limpid", type=Path)
    parser.add_argument("--minutes", type=float, default=10)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--memory", type=float, default=40)
    return parser.parse_args()


ASKED = options()
os.environ["LIMPID"] = str(ASKED.limpid.absolute())
sys.path.insert(0, str(HERE.parent / "system"))
import h5py  # noqa: E402
import numpy  # noqa: E402
from window import WindowTest  # noqa: E402


class Watch:
    """What the process has: its memory, threads and open files, now and again."""

    def __init__(self, pid: int) -> None:
        self.pid, self.seen = pid, []

    def look(self) -> None:
        status = dict(line.split(":", 1)
                      for line in Path(f"/proc/{self.pid}/status").read_text().splitlines())
        self.seen.append((time.monotonic(), int(status["VmRSS"].split()[0]) / 1024,
                          int(status["Threads"]), len(os.listdir(f"/proc/{self.pid}/fd"))))

    def halves(self, what: int) -> tuple[float, float]:
        """Medians over the second and the last quarter: the first is for warming up."""
        values = [each[what] for each in self.seen]
        quarter = max(1, len(values) // 4)
        return (statistics.median(values[quarter:2 * quarter] or values),
                statistics.median(values[-quarter:]))


class Ticks:
    """Every period of the clock is a tick that ran or one that the schedule slipped by."""

    def __init__(self) -> None:
        self.last, self.stretches = None, []

    def look(self, state: dict) -> None:
        now = (time.monotonic(), state["ticks"] + state["slipped"], state["ticks"])
        # A new arm or scene begins a loop of its own.
        if self.last is None or now[1] < self.last[-1][1]:
            self.last = [now]
            self.stretches.append(self.last)
        self.last.append(now)

    def lost(self) -> float:
        """The most that one loop ran short of its clock [s]; a state is up to 0.5 s old."""
        return max(((s[-1][0] - s[0][0]) - (s[-1][1] - s[0][1]) / 1000 for s in self.stretches),
                   default=0)


class Soak(WindowTest):
    def prepare(self) -> None:
        book = self.home / "config/limpid/devices.toml"
        book.write_text(f'in_use = "socket:{DEVICE}"\n[device."socket:{DEVICE}"]\nchecked = true\n')
        runtime = self.home / "runtime"
        (runtime / "limpid").mkdir(parents=True, mode=0o700)
        self.environment["XDG_RUNTIME_DIR"] = str(runtime)
        self.client: subprocess.Popen | None = None
        self.random = random.Random(ASKED.seed)
        self.done = collections.Counter()
        self.trail: list[str] = []
        self.checked = self.again = 0

    def runTest(self) -> None:
        self.addCleanup(self.unplug)
        watch, ticks = Watch(self.app.pid), Ticks()
        first = self.at_rest()
        watch.look()
        begun = watch.seen[0]
        actions = [self.drag, self.drag, self.law, self.turn_knobs, self.twin, self.record,
                   self.record, self.play, self.edit_scene, self.dialogs, self.resize,
                   self.start_over, self.replug, self.camera, self.plots, self.picture]
        end = time.monotonic() + 60 * ASKED.minutes
        while time.monotonic() < end:
            action = self.random.choice(actions)
            if not self.done[action.__name__]:
                print(f"{time.strftime('%H:%M:%S')} {action.__name__}", flush=True)
            self.trail.append(action.__name__)
            action()
            self.done[action.__name__] += 1
            self.assertIsNone(self.app.poll(), f"limpid ended after {action.__name__}")
            watch.look()
            ticks.look(self.state())
        self.unplug()
        last = self.at_rest()
        time.sleep(3)
        watch.look()
        self.report(watch, ticks, last)
        ended = watch.seen[-1]
        self.assertLess(watch.halves(1)[1] - watch.halves(1)[0], ASKED.memory, "memory grew [MB]")
        self.assertLessEqual(ended[2], begun[2] + 2, "threads are left")
        self.assertLessEqual(ended[3], begun[3] + 4, "files are left open")
        self.assertEqual(last["dropped"], first["dropped"], "rows were dropped")
        self.assertLess(ticks.lost(), 1.0, "ticks are unaccounted for [s]")
        self.app.terminate()
        self.assertEqual(self.app.wait(60), 0, "it did not end well")
        self.assertEqual(list(self.home.rglob("*.part")), [], "a recording was not finished")

    def report(self, watch: Watch, ticks: Ticks, last: dict) -> None:
        print("\n" + ", ".join(f"{name} {count}" for name, count in self.done.most_common()))
        for what, name in ((1, "memory [MB]"), (2, "threads"), (3, "open files")):
            early, late = watch.halves(what)
            print(f"{name:<14} {early:>8.1f} in the second quarter, {late:>8.1f} in the last, "
                  f"{watch.seen[-1][what]:>8.1f} at the end")
        print(f"ticks: {sum(s[-1][2] for s in ticks.stretches)} in {len(ticks.stretches)} loops, "
              f"{last['slipped']} slipped, {last['missed']} missed in the last one; "
              f"{1000 * ticks.lost():.0f} ms not accounted for; {last['dropped']} rows dropped")
        print(f"recordings checked: {self.checked}", flush=True)

    # What it does.

    def at_rest(self) -> dict:
        """Live, nothing open, one coupling, the mouse up."""
        self.xdotool("mouseup", "1")
        for _ in range(4):
            self.key("Escape")
        if self.settled()["playing"]:
            self.key("BackSpace")
            self.wait("being live", lambda s: not s["playing"])
        if self.state()["twin"]:
            self.key("b")
            self.wait("one coupling", lambda s: s["shown_lanes"] == 1)
        return self.settled()

    def live(self) -> None:
        if self.state()["playing"]:
            self.key("BackSpace")
            self.wait("being live", lambda s: not s["playing"])

    def point(self) -> tuple[float, float]:
        width, height = self.state()["size"]
        return (width * self.random.uniform(0.4, 0.62), height * self.random.uniform(0.25, 0.5))

    def drag(self) -> None:
        self.live()
        self.move(*self.point())
        self.xdotool("mousedown", "1")
        for _ in range(self.random.randint(3, 25)):
            self.move(*self.point())
            time.sleep(0.05)
        self.xdotool("mouseup", "1")

    def law(self) -> None:
        self.key("c")

    def turn_knobs(self) -> None:
        for _ in range(self.random.randint(1, 6)):
            self.key(self.random.choice(["", "shift+", "ctrl+", "alt+"])
                     + self.random.choice(["bracketleft", "bracketright"]))

    def twin(self) -> None:
        self.key(self.random.choice(["b", "b", "shift+b"]))

    def record(self) -> None:
        self.live()
        self.settled()
        said = (self.home / "states").stat().st_size
        self.key("r")
        self.wait("the recording", lambda s: s["recording"])
        for _ in range(self.random.randint(1, 3)):
            self.random.choice([self.drag, self.law, self.turn_knobs, self.go_on_a_little])()
        self.key("r")
        self.wait("its end", lambda s: not s["recording"])
        self.settled()
        self.check_newest(self.slipped_since(said))

    def slipped_since(self, said: int) -> int:
        """Periods that were given up since the states' file was so long; a new loop counts anew."""
        with (self.home / "states").open("rb") as states:
            states.seek(max(0, said - 2000))
            counts = [int(count) for count in re.findall(rb'"slipped": (\d+)', states.read())]
        return sum(b - a if b >= a else b for a, b in itertools.pairwise(counts))

    def go_on_a_little(self) -> None:
        self.go_on(self.random.uniform(0.2, 2))

    def check_newest(self, slipped: int) -> None:
        """All ticks are there, one after the other, but for those that a loop with a device gave
        up; now and then: run again, the same bits."""
        sessions = sorted(self.home.rglob("*.h5"), key=lambda path: path.stat().st_mtime)
        self.assertTrue(sessions, "nothing was recorded")
        with h5py.File(sessions[-1]) as session:
            steps = numpy.diff(session["time"][...])
            simulated = session.attrs["source"] != "device"  # else nobody knows what moved it
        self.again += simulated
        periods = numpy.round(1e3 * steps).astype(int)
        self.assertLess(numpy.abs(1e3 * steps - periods).max(initial=0), 1e-6, "no whole ticks")
        self.assertGreaterEqual(periods.min(initial=1), 1, "time stands still")
        self.assertLessEqual(sum(periods - 1), slipped, "a gap")
        if self.again % 10 == 0 and simulated and len(steps) > 500:
            self.check_again(sessions[-1])
            (self.home / "again.h5").unlink(missing_ok=True)
        self.checked += 1
        for old in sessions[:-5]:
            old.unlink()

    def check_again(self, session: Path) -> None:
        try:
            self.check_rerun_is_the_same(session)
        except AssertionError:
            kept = Path(tempfile.gettempdir(), "soak-" + session.name)
            shutil.copy(session, kept)
            print(f"kept {kept}, done so far: {self.trail[-20:]}", flush=True)
            raise

    def play(self) -> None:
        self.live()
        self.key("p")
        self.go_on_a_little()
        if self.state()["asking"]:  # nothing was recorded yet: which one?
            self.close()
        if self.state()["playing"]:
            for _ in range(self.random.randint(0, 6)):
                self.key(self.random.choice(["e", "Left", "Right", "shift+Right", "Home", "l", "p"]))
            self.wait("what it loads", lambda s: s["loading_part"] >= 1, 120)
            self.key("BackSpace")
            self.wait("being live", lambda s: not s["playing"])

    def edit_scene(self) -> None:
        self.live()
        for key in self.random.choices(["Tab", "ctrl+d", "Delete", "ctrl+z", "ctrl+y"], k=4):
            if key == "ctrl+d" and self.state()["objects"] > 6:
                key = "Delete"
            self.key(key)

    def dialogs(self) -> None:
        self.key(self.random.choice(["F1", "F5", "F6", "n", "ctrl+l", "ctrl+p", "ctrl+g", "ctrl+o"]))
        self.settled()
        self.close()

    def close(self) -> None:
        """Whatever is open; Esc takes the force away as well."""
        for _ in range(3):
            self.key("Escape")
        if not self.settled()["force"]:
            self.key("f")

    def resize(self) -> None:
        self.xdotool("windowsize", self.window, str(self.random.randint(900, 1600)),
                     str(self.random.randint(560, 900)))

    def start_over(self) -> None:
        self.live()
        self.key("BackSpace")

    def replug(self) -> None:
        if self.client is None:
            self.client = subprocess.Popen([sys.executable, str(CLIENT), DEVICE, "3"],
                                           env=self.environment)
            time.sleep(self.random.uniform(0, 3))
        else:
            self.unplug()

    def unplug(self) -> None:
        if self.client is not None:
            self.client.kill()
            self.client.wait()
            self.client = None

    def camera(self) -> None:
        self.key(self.random.choice(["0", "1", "2", "3"]))
        self.move(*self.point())
        self.xdotool("click", "--repeat", "3", self.random.choice(["4", "5"]))

    def plots(self) -> None:
        self.key(self.random.choice(["x", "F2", "F3", "F4", "g", "m"]))

    def picture(self) -> None:
        self.key("F12")


if __name__ == "__main__":
    result = unittest.TextTestRunner(verbosity=0).run(Soak())
    sys.exit(not result.wasSuccessful())
