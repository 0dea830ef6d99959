"""A sweep's table in the window: its map, its points in playback, tables that cannot be opened."""

import shutil
import subprocess
import unittest
from pathlib import Path

import h5py
import numpy as np

from support import LIMPID
from window import WindowTest

WALLS, ETAS = [500, 1000, 1500, 2000], [0.4, 0.6, 0.8, 1.0]
PLAN = """title = "Pressed"
hand = { at = [0.19, 0, -0.035], jump = [0, 0, -0.015] }
seconds = %s
measure = ["energy_highest", "chatter", "diverged"]
axis = [
  { key = "coupling.kind", values = ["proposed", "predictive"] },
  { key = "scene.stiffness", values = [500, 1000, 1500, 2000] },
  { key = "coupling.eta", values = [0.4, 0.6, 0.8, 1.0] },
]
[figure]
x = "wall"
y = "eta"
theory = ["pr", "routh"]
"""


def point(kind: int, wall: int, eta: int) -> int:
    """Number of the point at these places."""
    return (kind * len(WALLS) + wall) * len(ETAS) + eta


class SweepWindow(WindowTest):
    SECONDS = 0.3

    def prepare(self) -> None:
        self.sweep = self.home / "sweep"
        self.plan = self.home / "plan.toml"
        self.plan.write_text(PLAN % self.SECONDS)
        self.run_sweep()
        self.words = [str(self.sweep)]

    def run_sweep(self, *words: str) -> None:
        subprocess.run([LIMPID, "sweep", self.plan, "--out", self.sweep, *words],
                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    def table(self) -> Path:
        return self.sweep / "table.h5"

    def wait_for_map(self) -> dict:
        return self.wait("the map", lambda s: s.get("sweep") and s["sweep"]["drawn"]
                         and "map" in s["sweep"] and s["dialog"] == "sweep")

    def point_at(self, wall: int, eta: int) -> tuple[float, float]:
        """Middle of a cell of the map on the screen; all cells have one size."""
        left, top, right, bottom = self.state()["sweep"]["map"]
        return (left + (right - left) * (wall + 0.5) / len(WALLS),
                bottom - (bottom - top) * (eta + 0.5) / len(ETAS))

    def play_point(self, wall: int, eta: int) -> None:
        self.wait_for_map()
        self.move(*self.point_at(wall, eta))
        number = point(0, wall, eta)
        self.wait("the mouse on it", lambda s: s["sweep"].get("pointed_at") == number)
        self.xdotool("click", "1")
        self.wait_for_notice(f"Point {number}: kind proposed, wall {WALLS[wall]} N/m, "
                             f"eta {ETAS[eta]:g}. The result is exactly the same as in the table.")
        self.wait("playback", lambda s: s["playing"] and s["dialog"] == "")


class Points(SweepWindow):
    def test_they_are_played_and_one_key_comes_back_to_the_map(self) -> None:
        for wall, eta in ((0, 3), (2, 1)):
            self.play_point(wall, eta)
            self.key("F6")
        # The line over the picture names the point and its measures, and leads back.
        self.play_point(3, 0)
        back = "Back to map (F6)"
        self.wait("the way back", lambda s: any(back in b["buttons"] for b in s["banners"]))
        banner = next(b for b in self.settled()["banners"] if back in b["buttons"])
        self.assertIn(f"wall {WALLS[3]} N/m, eta {ETAS[0]:g}: ", banner["text"])
        self.assertRegex(banner["text"], r": \w+ \S+.*\.$")
        self.click(*banner["buttons"][back])
        self.wait_for_map()
        # The run is the command's: the same rows.
        number = point(0, 2, 1)
        other = self.home / "other"
        environment = {k: v for k, v in self.environment.items() if "DISPLAY" not in k}
        subprocess.run([LIMPID, "sweep", self.plan, "--out", other, "--open", str(number)],
                       env=environment, stdout=subprocess.DEVNULL, check=True)
        with h5py.File(self.sweep / f"points/{number}.h5") as a, \
                h5py.File(other / f"points/{number}.h5") as b:
            self.assertEqual(len(a["time"]), 300)
            for name in ("device/position", "proxy/torque", "hand/torque"):
                self.assertTrue(np.array_equal(a[name][...], b[name][...]), name)
        self.key("BackSpace")  # playback is left, the map stays
        self.wait("the loop", lambda s: not s["playing"] and s["dialog"] == "sweep")
        self.key("ctrl+q", closes=True)
        self.app.wait(30)
        settings = (self.home / "config/limpid/settings.toml").read_text()
        self.assertIn(str(self.table()), settings)
        self.assertNotIn(f"{number}.h5", settings)


class LongPoints(SweepWindow):
    SECONDS = 0.02

    def prepare(self) -> None:
        super().prepare()
        # The table is as if its runs were an hour long, from a program that knew no keys.
        with h5py.File(self.table(), "a") as table:
            table.attrs["plan"] = PLAN % 3600
            del table.attrs["key"]

    def test_one_that_takes_long_shows_how_far_it_is_and_can_be_cancelled(self) -> None:
        self.wait_for_map()
        for wall in (0, 1):
            self.move(*self.point_at(wall, 1))
            number = point(0, wall, 1)
            self.wait("the mouse on it", lambda s: s["sweep"].get("pointed_at") == number)
            self.xdotool("click", "1")
            self.wait("a run", lambda s: 0 < s["loading_part"] < 1)
            ticks = self.state()["ticks"]
            self.wait("the loop to go on meanwhile", lambda s: s["ticks"] > ticks + 300)
            self.key("Escape")
            self.wait("its end", lambda s: s["loading_part"] == 1)
            state = self.wait_for_map()
            self.assertFalse(state["playing"])
        self.assertEqual(list((self.sweep / "points").glob("*")), [])


class Tables(SweepWindow):
    def prepare(self) -> None:
        super().prepare()
        self.words = []

    def open(self, path: Path) -> None:
        self.key("ctrl+o")
        self.wait("the dialog", lambda s: s["dialog"] == "open session" and s["typing"])
        self.type(str(path))
        self.key("Return")

    def test_one_that_fills_is_followed(self) -> None:
        shutil.rmtree(self.sweep)
        self.run_sweep("--shard", "1/2")
        self.run_sweep("--gather")
        self.open(self.sweep)
        self.wait_for_map()
        self.assertEqual(self.state()["sweep"]["done"], 16)
        self.run_sweep("--shard", "2/2")
        self.run_sweep("--gather")
        self.wait("all of it", lambda s: s["sweep"]["done"] == 32)
        self.play_point(1, 1)

    def test_what_cannot_be_opened_says_why(self) -> None:
        damaged = self.home / "damaged/table.h5"
        without = self.home / "without/table.h5"
        for path in (damaged, without):
            path.parent.mkdir()
            shutil.copy(self.table(), path)
        with h5py.File(without, "a") as table:
            del table.attrs["plan"]
        with damaged.open("r+b") as file:
            file.truncate(damaged.stat().st_size // 2)
        self.open(damaged.parent)
        self.wait_for_notice("damaged")
        self.open(without)
        self.wait_for_notice("contains no plan")
        self.assertIsNone(self.state()["sweep"])
        self.key("Escape")
        self.wait("no dialog", lambda s: s["dialog"] == "")
        self.key("F6")
        self.wait("the dialog for a new one", lambda s: s["dialog"] == "new sweep")

    def test_of_another_build_points_are_compared(self) -> None:
        with h5py.File(self.table(), "a") as table:
            table.attrs["build"] = "0123456789abcdef"
            table["/measure/chatter"][point(0, 1, 1)] *= 1.0001
        self.open(self.table())
        self.play_point(2, 1)
        self.key("F6")
        self.wait_for_map()
        self.move(*self.point_at(1, 1))
        self.wait("the mouse on it", lambda s: s["sweep"].get("pointed_at") == point(0, 1, 1))
        self.xdotool("click", "1")
        self.wait_for_notice("which another build of limpid (0123456789abcdef) made: chatter is")

    def test_with_other_files_it_is_only_looked_at(self) -> None:
        with h5py.File(self.table(), "a") as table:
            table.attrs["key"] = "0123456789abcdef"
        self.open(self.table())
        self.wait_for_map()
        self.move(*self.point_at(1, 1))
        self.wait("the mouse on it", lambda s: s["sweep"].get("pointed_at") == point(0, 1, 1))
        self.xdotool("click", "1")
        self.wait_for_notice("cannot be run again: files that the plan names have changed since")
        self.assertFalse(self.state()["playing"])


class NewSweep(WindowTest):
    """A sweep from the first click to its map, without a file or a command."""

    def folder(self) -> Path:
        folders = list((self.home / "data/limpid/sweeps").iterdir())
        self.assertEqual(len(folders), 1)
        return folders[0]

    def replace(self, label: str, text: str) -> None:
        """Types into a field in place of what it holds."""
        self.click_on("New sweep", label, times=2)
        self.wait(f"typing in {label}", lambda s: s["typing"])
        self.key("ctrl+a")
        self.type(text)
        self.key("Tab")

    def open(self) -> None:
        self.key("F6")
        self.wait("the dialog", lambda s: s["dialog"] == "new sweep")

    def on_the_map(self, label: str) -> None:
        """Clicks a button below the map."""
        name = next(name for name in self.settled()["noted"] if name.startswith("Sweep"))
        self.click_on(name, label)

    def test_it_is_started_watched_stopped_and_gone_on_with(self) -> None:
        self.open()
        self.replace("first from", "0.2")
        self.replace("first to", "2")
        self.replace("first count", "200")
        self.click_on("New sweep", "Start (Enter)")
        state = self.wait("its map", lambda s: s["dialog"] == "sweep" and s["sweeping"]
                          and s["sweep"] and s["sweep"]["drawn"], 60)
        self.assertEqual((state["sweep"]["points"], state["sweep"]["x"]), (200, "eta"))
        self.wait("some points", lambda s: s["sweeping"] and s["sweeping"]["done"] > 2, 120)
        ticks = self.state()["ticks"]
        self.wait("the loop to go on meanwhile", lambda s: s["ticks"] > ticks + 300)
        self.key("Escape")
        self.wait("a banner", lambda s: any("The sweep is running: " in b["text"] for b in s["banners"]))
        self.key("F6")
        self.wait("the map", lambda s: s["dialog"] == "sweep" and "map" in s["sweep"])
        self.on_the_map("Stop")
        self.wait_for_notice("The sweep was stopped at ")
        before = {block.name: block.read_bytes() for block in (self.folder() / "blocks").iterdir()}
        self.assertTrue(2 < len(before) < 200)
        self.wait("all of them in the table", lambda s: s["sweep"]["done"] == len(before))
        self.on_the_map("Go on")
        self.wait("all of it", lambda s: s["sweep"]["done"] == 200 and not s["sweeping"], 300)
        self.wait_for_notice("The sweep is complete: 200 points in ")
        for name, block in before.items():
            self.assertEqual((self.folder() / "blocks" / name).read_bytes(), block, "nothing is made twice")
        # The command makes the same table of the same plan.
        other = self.home / "other"
        subprocess.run([LIMPID, "sweep", self.folder() / "plan.toml", "--out", other], check=True,
                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        with h5py.File(self.folder() / "table.h5") as a, h5py.File(other / "table.h5") as b:
            eta = a["axis/eta"][...]
            np.testing.assert_allclose(eta, np.geomspace(0.2, 2, 200), rtol=1e-12)
            for name in ("measure/energy_highest", "measure/diverged", "done"):
                self.assertTrue(np.array_equal(a[name][...], b[name][...]), name)

    def test_what_cannot_be_swept_says_why_and_starts_nothing(self) -> None:
        self.open()
        self.replace("first to", "0.01")  # less than where it begins
        self.click_on("New sweep", "Start (Enter)")
        self.assertEqual(self.settled()["dialog"], "new sweep")
        self.assertEqual(list((self.home / "data/limpid/sweeps").glob("*")), [])
        self.key("Escape")
        self.wait("no dialog", lambda s: s["dialog"] == "")


if __name__ == "__main__":
    unittest.main()
