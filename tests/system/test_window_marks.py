"""Marks, stretches of time, exports and tasks for new users, in the window."""

from __future__ import annotations

import os
import struct
import sys
import time
import unittest
from pathlib import Path

import h5py

from support import ASSETS, limpid
from window import WindowTest

sys.path.insert(0, str(ASSETS / "python"))
import limpid as client  # noqa: E402


class Recorded(WindowTest):
    LAW = "predictive"

    def sessions(self) -> Path:
        return self.home / "data/limpid/sessions"

    def record(self, seconds: float = 2) -> None:
        self.key("r")
        self.wait("recording", lambda s: s["recording"])
        self.go_on(seconds)

    def stop_and_play(self) -> Path:
        self.key("r")
        self.wait_for_notice("Recorded")
        self.key("p")
        self.wait("playback", lambda s: s["playing"])
        self.key("p")  # p stops the playback
        return next(self.sessions().glob("session-*.h5"))

    def mark(self, text: str | None) -> None:
        """Sets a mark with this text, or with the offered one."""
        self.key("t")
        self.wait("the dialog", lambda s: s["dialog"] == "mark" and s["typing"])
        if text is not None:
            self.type(text)
        self.key("Return")
        self.wait("its end", lambda s: s["dialog"] == "")

    def texts(self, state: dict) -> list[str]:
        return [mark["text"] for mark in state["recorded"]["marks"]]


class Marks(Recorded):
    def test_are_kept_with_the_recording_and_found_by_every_reader(self) -> None:
        self.record(1)
        self.mark("first touch")
        self.go_on(0.5)
        self.mark(None)
        file = self.stop_and_play()
        shown = self.wait("both marks", lambda s: len(s["recorded"]["marks"]) == 2)
        self.assertEqual(self.texts(shown), ["first touch", "mark 2"])
        first, second = (mark["time"] for mark in shown["recorded"]["marks"])
        self.assertGreater(first, 0.9)
        self.assertGreater(second, first + 0.4)

        session = client.session(file)
        self.assertEqual([text for _, text in session.marks], ["first touch", "mark 2"])
        self.assertAlmostEqual(session.marks[0][0], first, delta=1e-9)
        self.assertGreater(len(session.time), 1000, "its channels are whole")
        said = limpid("info", file).out
        self.assertRegex(said, r"mark +%.3f s +first touch" % first)

    def test_are_added_renamed_removed_and_undone_in_playback(self) -> None:
        self.record(2)
        file = self.stop_and_play()
        before = client.session(file).time
        self.key("Home")
        for _ in range(5):
            self.key("shift+Right")
        at = self.settled()["recorded"]["at"]
        self.assertAlmostEqual(at, 0.5, delta=0.001)
        self.mark("here")
        self.wait_until("it in the file", lambda: self.kept(file) == ["here"])
        self.assertAlmostEqual(client.session(file).marks[0][0], at, delta=0.002)
        self.assertEqual(list(client.session(file).time), list(before), "the rows are the same")

        self.key("Home")
        self.key("ctrl+Right")  # to the mark
        self.wait("the mark", lambda s: abs(s["recorded"]["at"] - at) < 0.002)
        self.key("ctrl+Right")
        self.wait_for_notice("no mark after")

        # A second mark, renamed by a right click on the time line.
        self.key("Home")
        self.mark("start")
        self.wait_until("both", lambda: self.kept(file) == ["start", "here"])
        self.rename_the_first("begin")
        self.wait_until("its new name", lambda: self.kept(file) == ["begin", "here"])
        self.key("ctrl+z")
        self.wait_until("the old one", lambda: self.kept(file) == ["start", "here"])
        self.key("ctrl+z")
        self.wait_until("one mark", lambda: self.kept(file) == ["here"])
        self.key("ctrl+y")
        self.wait_until("both again", lambda: self.kept(file) == ["start", "here"])
        self.assertEqual([p.name for p in self.sessions().iterdir() if "marks" in p.name], [],
                         "no half of a copy is left")

    def kept(self, file: Path) -> list[str]:
        try:
            with h5py.File(file) as opened:
                return [bytes(t).decode() for t in opened["marks/text"]]
        except OSError:
            return []  # the file is being replaced

    def rename_the_first(self, name: str) -> None:
        """Renames the first mark by a right click on the time line."""
        self.click(*self.settled()["recorded"]["marks"][0]["place"], button=3)
        self.wait("the dialog", lambda s: s["dialog"] == "mark" and s["typing"])
        self.key("ctrl+a")
        self.type(name)
        self.key("Return")
        self.wait("its end", lambda s: s["dialog"] == "")

    def test_at_the_mouse_where_that_is_in_a_plot(self) -> None:
        self.go_on(3)
        self.key("x")  # the plots stand still
        left, top, right, bottom = self.state()["plots"][0]["area"]
        for beside in (1, 0):  # the frame that takes the key may take the first move, too
            self.move(left + 0.25 * (right - left) + beside, 0.5 * (top + bottom))
            self.settled()
        start, stop = self.state()["shown"]
        self.mark("in a quarter")
        notes = self.wait("a note", lambda s: s["notes"])["notes"]
        self.assertEqual(notes[0][1], "in a quarter")
        self.assertAlmostEqual(notes[0][0], start + 0.25 * (stop - start), delta=0.02 * (stop - start))


class Ranges(Recorded):
    def select(self, begin: float, end: float) -> dict:
        """Selects a stretch, given in parts of the first plot's width."""
        left, top, right, bottom = self.state()["plots"][0]["area"]
        y = 0.5 * (top + bottom)
        self.move(left + begin * (right - left), y)
        self.settled()
        self.xdotool("keydown", "shift")
        self.xdotool("mousedown", "1")
        for step in range(1, 11):
            part = begin + (end - begin) * step / 10
            self.move(left + part * (right - left), y)
            time.sleep(0.03)
        self.settled()
        self.xdotool("mouseup", "1")
        self.xdotool("keyup", "shift")
        return self.wait("a stretch", lambda s: s["range"] and len(s["range"]["buttons"]) > 1)

    def test_are_measured_exported_played_and_cleared(self) -> None:
        self.record(3)
        self.stop_and_play()
        start, stop = self.settled()["shown"]
        chosen = self.select(0.25, 0.5)["range"]
        length = stop - start
        self.assertAlmostEqual(chosen["start"], start + 0.25 * length, delta=0.02 * length)
        self.assertAlmostEqual(chosen["stop"], start + 0.5 * length, delta=0.02 * length)
        self.assertEqual(chosen["plot"], 0)

        self.click(*self.state()["range"]["buttons"]["Export range as CSV"])
        self.wait_until("a table", lambda: list(self.sessions().glob("*.csv")))
        self.wait_for_notice("Saved")
        lines = next(self.sessions().glob("*.csv")).read_text().splitlines()
        self.assertTrue(lines[0].startswith("time [s],"))
        times = [float(line.split(",")[0]) for line in lines[1:]]
        self.assertAlmostEqual(times[0], chosen["start"], delta=0.0011)
        self.assertAlmostEqual(times[-1], chosen["stop"], delta=0.0011)

        self.click(*self.state()["range"]["buttons"]["Play this"])
        self.wait("its end", lambda s: abs(s["recorded"]["at"] - chosen["stop"]) < 0.002, 30)
        time.sleep(0.5)
        self.assertAlmostEqual(self.state()["recorded"]["at"], chosen["stop"], delta=0.002)
        self.key("Escape")
        self.wait("nothing selected", lambda s: s["range"] is None)
        self.assertTrue(self.state()["playing"], "Esc closed the selection and nothing else")


class Exports(Recorded):
    SAVE_PNG = (250, 650)  # place in the menu of the first plot, opened at (200, 560)

    def prepare(self) -> None:
        """Installs stand-ins for the desktop's programs, which note their arguments."""
        tools = self.home / "bin"
        tools.mkdir()
        self.opened = self.home / "opened"
        tool = tools / "xdg-open"
        tool.write_text(f'#!/bin/sh\necho "$1" >> {self.opened}\n')
        tool.chmod(0o755)
        self.environment["PATH"] = f"{tools}:{os.environ['PATH']}"

    def press(self, banner: str, button: str) -> None:
        self.wait("the banner", lambda s: any(
            button in b["buttons"] for b in s["banners"] if banner in b["text"]))
        state = self.settled()  # the first frame does not know its width yet
        self.click(*next(b["buttons"][button] for b in state["banners"] if button in b["buttons"]))

    def test_a_plot_is_a_picture_of_the_size_and_density_that_were_asked_for(self) -> None:
        self.go_on(2)
        self.key("ctrl+e")
        self.wait("the dialog", lambda s: s["dialog"] == "export")
        self.key("Return")
        self.wait("it to be said", lambda s: any("coordination-error-001.png" in b["text"]
                                                 for b in s["banners"]))
        file = next(self.sessions().glob("coordination-error-*.png"))
        data = file.read_bytes()
        self.assertEqual(data[:8], b"\x89PNG\r\n\x1a\n")
        width, height = struct.unpack(">II", data[16:24])
        self.assertAlmostEqual(width, 160 / 25.4 * 300, delta=3)
        self.assertAlmostEqual(height, 80 / 25.4 * 300, delta=3)
        at = data.index(b"pHYs")
        across, down, unit = struct.unpack(">IIB", data[at + 4:at + 13])
        self.assertEqual((across, down, unit), (11811, 11811, 1), "300 dpi")

        self.press(file.name, "Open")
        self.wait_until("it to be opened", self.opened.exists)
        self.assertEqual(self.opened.read_text().split("\n")[0], str(file))
        self.key("ctrl+e")
        self.wait("the dialog", lambda s: s["dialog"] == "export")
        self.key("Return")
        self.press("coordination-error-002.png", "Show in folder")
        self.wait_until("the folder", lambda: str(self.sessions()) in self.opened.read_text().split("\n"))


    def test_the_manual_is_opened_by_the_menu_help(self) -> None:
        self.click_on("##MainMenuBar", "Help")
        self.click_on("##Menu_00", "Manual")
        self.wait_for_notice("Opening the manual")
        self.wait_until("it to be opened", lambda: self.opened.exists() and self.opened.read_text())
        self.assertEqual(self.opened.read_text().strip(), limpid("manual", "--path").out.strip())

    def test_the_plot_under_the_mouse_is_offered_as_it_was_seen(self) -> None:
        self.go_on(2)
        left, top, right, bottom = self.state()["plots"][1]["area"]
        self.move(0.5 * (left + right), 0.5 * (top + bottom))
        self.settled()
        self.key("ctrl+e")
        self.wait("the dialog", lambda s: s["dialog"] == "export")
        shown = self.settled()["shown"]
        self.go_on(0.5)
        self.assertEqual(self.state()["shown"], shown, "the plots stand still")
        self.key("Return")
        self.wait("it to be said", lambda s: any("controller-energy-001.png" in b["text"] for b in s["banners"]))
        self.wait("the plots to go on", lambda s: s["shown"][1] > shown[1] + 0.5)

    def test_the_menu_of_a_plot_saves_the_same_picture(self) -> None:
        self.go_on(2)
        left, _, right, _ = self.state()["plots"][0]["area"]
        self.move(200, 560)
        self.settled()
        self.xdotool("click", "3")
        self.click(*self.SAVE_PNG)
        self.wait("it to be said", lambda s: any("coordination-error-001.png" in b["text"]
                                                 for b in s["banners"]))
        data = next(self.sessions().glob("coordination-error-*.png")).read_bytes()
        width, _ = struct.unpack(">II", data[16:24])
        self.assertGreater(width, 3 * (right - left), "more than what is on the screen")
        self.assertAlmostEqual(width, 160 / 25.4 * 300, delta=3)


class YourTurn(WindowTest):
    LAW = None  # a first start's law

    def test_what_is_tried_is_ticked_off_and_stays_so(self) -> None:
        self.assertEqual(self.state()["tried"], "")
        self.hold_tip()
        self.wait("the first tick", lambda s: "d" in s["tried"])
        self.xdotool("click", "4")  # the wheel
        self.wait("the second one", lambda s: "w" in s["tried"])
        self.xdotool("mouseup", "1")
        self.key("c")
        self.wait("the law", lambda s: "c" in s["tried"])
        self.key("bracketright")
        self.wait("eta", lambda s: "e" in s["tried"])
        self.key("b")
        self.wait("the twin", lambda s: "t" in s["tried"])
        self.key("ctrl+q", closes=True)
        self.assertEqual(self.app.wait(30), 0)
        self.start()
        self.assertEqual(set(self.state()["tried"]), set("dwcet"))


class BrokenPassivity(WindowTest):
    def test_a_hand_is_put_where_energy_climbs_and_goes_with_it(self) -> None:
        before = self.state()
        self.click_on("coupling", "Break passivity")
        self.wait("a hand", lambda s: s["grip"] == 1 and s["banners"])
        self.wait("energy that grows",
                  lambda s: s["energy_total"] > before["energy_total"] + 0.02, 60)
        self.key("c")
        after = self.wait("the hand to let go",
                          lambda s: s["grip"] == 0 and s["kind"] == before["kind"])
        self.assertEqual(after["tried"], "", "nobody chose a law, or eta, or pressed anything")


class Places(WindowTest):
    def prepare(self) -> None:
        self.environment["HOME"] = str(self.home)

    def test_a_scene_is_saved_in_a_new_folder_of_a_place(self) -> None:
        self.key("ctrl+shift+s")
        self.wait("the dialog", lambda s: s["dialog"] == "save scene" and s["typing"])
        self.click_on("Save scene as", "Home")
        self.click_on("Save scene as", "New folder")
        self.wait("its name to be asked for", lambda s: s["typing"])
        self.type("mine")
        self.key("Return")
        self.wait_until("the folder", (self.home / "mine").is_dir)
        self.settled()
        self.key("Return")
        self.wait("the dialog to close", lambda s: s["dialog"] == "")
        self.assertTrue((self.home / "mine/table.toml").is_file())


class Experiments(WindowTest):
    def test_they_go_on_beside_the_window_which_says_so_and_are_stopped(self) -> None:
        self.key("F5")
        self.wait("the dialog", lambda s: s["dialog"] == "experiments")
        self.click_on("Experiments", "Run all")
        self.wait("a result", lambda s: any("coordination: passed" in n for n in s["notices"]), 240)
        self.click_on("Experiments", "the figure")
        self.wait("the figure alone", lambda s: s["popup"])
        self.key("Escape")
        state = self.wait("it to close", lambda s: not s["popup"])
        self.assertEqual(state["dialog"], "experiments", "and no more")
        self.click_on("Experiments", "the figure")
        self.wait("the figure alone", lambda s: s["popup"])
        name = next(name for name in self.settled()["noted"] if "Close (Esc)" in self.state()["noted"][name])
        self.click_on(name, "Close (Esc)")
        self.wait("it to close", lambda s: not s["popup"] and s["dialog"] == "experiments")
        self.key("Escape")
        self.wait("a banner", lambda s: any("Experiments are running: " in b["text"]
                                            for b in s["banners"]))
        kind = self.state()["kind"]
        self.key("c")  # the window is free
        self.wait("the next law", lambda s: s["kind"] == kind + 1)
        show = "Show (F5)"
        self.click(*next(b["buttons"][show] for b in self.settled()["banners"]
                         if show in b["buttons"]))
        self.wait("the dialog", lambda s: s["dialog"] == "experiments")
        self.click_on("Experiments", "Stop")
        self.wait_for_notice("The experiments have stopped.")
        self.key("Escape")
        self.wait("nothing under way", lambda s: s["dialog"] == "" and not s["banners"])


if __name__ == "__main__":
    unittest.main()
