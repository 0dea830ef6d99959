"""Keys, dialogs and possible faults of the window, under Xvfb with xdotool."""

import shutil
import signal
import subprocess
import time
import tomllib
import unittest

from support import ASSETS
from window import WindowTest

LETTERS = "rcfpgxle1 2[]?d"
# State that typing must leave alone.
LASTING = ("force", "recording", "playing", "kind", "eta", "alpha", "objects", "selected", "dirty")


def lasting(state: dict) -> dict:
    return {key: state[key] for key in LASTING}


def make_a_change(test: WindowTest) -> None:
    test.key("Tab")
    test.wait("an object", lambda s: s["selected"] is not None)
    test.key("ctrl+d")
    test.wait("a second one", lambda s: s["objects"] == 2 and s["dirty"])


class Keys(WindowTest):
    LAW = "proposed"  # which uses eta

    def escape_from(self, dialog: str) -> None:
        """On the virtual arm Escape closes the dialog, and no more."""
        self.key("Escape")
        self.wait(f"{dialog} to close", lambda s: s["dialog"] == "")
        self.assertTrue(self.settled()["force"], dialog)

    def test_what_is_typed_into_a_field_does_nothing_else(self) -> None:
        before = lasting(self.state())
        for keys, dialog in (("ctrl+o", "open session"), ("ctrl+m", "add model"),
                             ("ctrl+shift+s", "save scene")):
            with self.subTest(dialog):
                self.key(keys)
                self.wait(dialog, lambda s: s["dialog"] == dialog and s["typing"])
                self.type(LETTERS)
                self.key("F2")
                self.key("ctrl+g")
                self.key("ctrl+m")
                state = self.settled()
                self.assertEqual(lasting(state), before)
                self.assertEqual(state["dialog"], dialog)
                self.escape_from(dialog)

    def test_what_is_typed_over_a_slider_does_nothing_else(self) -> None:
        before = lasting(self.state())
        self.click_on("coupling", "coupling.eta", times=2)
        self.wait("typing", lambda s: s["typing"])
        self.assertEqual(lasting(self.settled()), before, "a double click moves nothing")
        self.type("rcfpx")
        self.assertEqual(lasting(self.settled()), before)
        self.key("ctrl+a")
        self.type("0.5")
        self.key("Return")
        self.wait("the typed value", lambda s: s["eta"] == 0.5 and not s["typing"])
        self.key("ctrl+z")
        self.wait("one step back", lambda s: s["eta"] == before["eta"])
        self.key("ctrl+z")
        self.wait_for_notice("Nothing to undo")

        # Escape ends typing; pressed once more, it cuts the force.
        self.click_on("coupling", "coupling.eta", times=2)
        self.wait("typing", lambda s: s["typing"])
        self.type("7")
        self.key("Escape")
        self.wait("no typing", lambda s: not s["typing"])
        state = self.settled()
        self.assertEqual(state["eta"], before["eta"])
        self.assertTrue(state["force"])
        self.key("Escape")
        self.wait("force off", lambda s: not s["force"])

    def test_what_is_typed_into_an_objects_name_does_nothing_else(self) -> None:
        self.key("Tab")
        self.wait("an object", lambda s: s["selected"] == "table top")
        before = self.state()
        self.click_on("side", "name")
        self.wait("typing", lambda s: s["typing"])
        # Ctrl is released in the frame of the A, as on a computer that draws slowly.
        self.xdotool("keydown", "ctrl")
        self.settled()
        self.app.send_signal(signal.SIGSTOP)
        self.xdotool("key", "a")
        self.xdotool("keyup", "ctrl")
        self.app.send_signal(signal.SIGCONT)
        self.settled()
        self.type("crisp fog")
        self.key("Return")
        after = self.wait("its new name", lambda s: s["selected"] == "crisp fog")
        for key in ("force", "recording", "playing", "kind", "eta", "alpha", "objects"):
            self.assertEqual(after[key], before[key], key)

    def test_lists_are_chosen_from_by_arrows_and_enter(self) -> None:
        before = self.settled()["file"]
        self.key("ctrl+g")
        self.wait("the gallery", lambda s: s["dialog"] == "gallery")
        for key in ("Right", "Right", "Right", "Left", "Return"):
            self.key(key)
        state = self.wait("another scene", lambda s: s["dialog"] == "" and s["file"] != before)
        self.assertIn("scenes/", state["file"])
        self.key("ctrl+o")
        self.wait("the field", lambda s: s["dialog"] == "open session" and s["typing"])
        self.key("Down")
        self.key("Down")
        self.key("Return")
        self.wait("a recording", lambda s: s["playing"] and s["dialog"] == "")

    def test_enter_and_escape_belong_to_the_dialog(self) -> None:
        self.key("F1")
        self.wait("the help", lambda s: s["dialog"] == "help")
        self.key("Return")
        self.wait("no help", lambda s: s["dialog"] == "")
        self.key("F1")
        self.wait("the help", lambda s: s["dialog"] == "help")
        self.escape_from("help")
        for keys, dialog in (("F5", "experiments"), ("ctrl+g", "gallery")):
            self.key(keys)
            self.wait(dialog, lambda s: s["dialog"] == dialog)
            self.escape_from(dialog)

        self.key("ctrl+o")
        self.wait("the field", lambda s: s["dialog"] == "open session" and s["typing"])
        self.key("Return")
        self.assertEqual(self.settled()["dialog"], "open session", "there is nothing to accept")
        self.escape_from("open session")
        self.key("ctrl+o")
        self.wait("the field", lambda s: s["typing"])
        self.type("/no/such/file.h5")
        self.key("Return")
        self.assertEqual(self.settled()["dialog"], "open session", "and says that it is not there")
        self.escape_from("open session")
        session = sorted((ASSETS / "sessions").glob("*.h5"))[0]
        self.key("ctrl+o")
        self.wait("the field", lambda s: s["typing"])
        self.type(str(session))
        self.key("Return")
        self.wait("playback", lambda s: s["playing"] and s["dialog"] == "")

    def test_the_question_lets_no_shortcut_through(self) -> None:
        make_a_change(self)
        self.key("ctrl+q")
        self.wait("the question", lambda s: s["dialog"] == "question")
        before = self.state()
        for key in ("r", "c", "p", "F1", "F2", "F5", "ctrl+o", "ctrl+z", "ctrl+s", "ctrl+g",
                    "Delete", "bracketleft"):
            self.key(key)
        after = self.settled()
        self.assertEqual(lasting(after), lasting(before))
        self.assertEqual(after["dialog"], "question")
        self.key("space")
        self.wait("force off", lambda s: not s["force"])
        self.assertEqual(self.settled()["dialog"], "question")
        self.key("Escape")
        self.wait("the window to stay", lambda s: s["dialog"] == "" and s["dirty"])


class Held(WindowTest):
    REPEATS = True

    def test_a_key_held_while_a_dialog_opens_is_not_typed_into_it(self) -> None:
        session = sorted((ASSETS / "sessions").glob("*.h5"))[0]
        self.xdotool("keydown", "ctrl", "keydown", "o")
        self.wait("the field", lambda s: s["dialog"] == "open session" and s["typing"])
        self.xdotool("keyup", "ctrl")
        time.sleep(1.5)  # the o repeats
        self.xdotool("keyup", "o")
        self.type(str(session))
        self.key("Return")
        self.wait("playback, of a path without o before it", lambda s: s["playing"])

    def test_enter_that_asks_for_a_name_does_not_accept_the_one_that_stands_there(self) -> None:
        make_a_change(self)
        self.key("ctrl+q")
        self.wait("the question", lambda s: s["dialog"] == "question")
        self.xdotool("keydown", "Return")
        self.wait("the dialog", lambda s: s["dialog"] == "save scene" and s["typing"])
        time.sleep(1.5)
        self.xdotool("keyup", "Return")
        state = self.settled()
        self.assertTrue(state["dirty"])
        self.assertEqual(state["dialog"], "save scene")
        self.key("Return")
        self.wait("the scene to be saved", lambda s: not s["dirty"] and s["dialog"] == "")
        self.assertTrue((self.home / "data/limpid/scenes/table.toml").exists())


class WhatGoesWrong(WindowTest):
    def test_a_picture_that_cannot_be_written_is_told_of_and_nothing_ends(self) -> None:
        sessions = self.home / "data/limpid/sessions"
        self.wait("the folder", lambda s: sessions.exists())
        shutil.rmtree(sessions)
        sessions.write_text("in the way")
        self.key("F12")
        self.wait_for_notice("cannot be written: Not a directory")
        self.assertNotIn("Saved", self.notices())
        sessions.unlink()
        sessions.mkdir()
        self.key("F12")
        self.wait("a banner", lambda s: any(".png is in " in b["text"] for b in s["banners"]))
        self.assertEqual(self.notices().count(".png"), 1, "the failure's alone")
        self.assertEqual(len(list(sessions.glob("*.png"))), 1)

    def test_termination_keeps_the_recording_and_unsaved_changes(self) -> None:
        import h5py
        import numpy

        make_a_change(self)
        self.key("ctrl+r")  # R turns the selected object
        self.wait("recording", lambda s: s["recording"])
        self.go_on(2)
        self.app.send_signal(signal.SIGTERM)
        self.assertEqual(self.app.wait(30), 0)
        sessions = self.home / "data/limpid/sessions"
        self.assertEqual(list(sessions.glob("*.part")), [])
        with h5py.File(*sessions.glob("*.h5")) as session:
            ticks = session["time"][...]
            self.assertGreater(len(ticks), 1000)
            self.assertTrue(numpy.allclose(numpy.diff(ticks), 0.001), "every tick is there")
        kept = self.home / "data/limpid/scenes/table-unsaved.toml"
        self.assertEqual(kept.read_text().count("[[plane]]"), 2)

        self.start()
        self.wait("the offer", lambda s: any("table-recovered.toml" in b["text"]
                                             for b in s["banners"]))
        self.assertFalse(kept.exists())
        self.assertTrue(kept.with_name("table-recovered.toml").exists())
        self.app.send_signal(signal.SIGINT)
        self.assertEqual(self.app.wait(30), 0)
        self.assertFalse(kept.exists(), "nothing was changed this time")

    def test_a_terminal_that_is_closed_keeps_unsaved_changes_and_they_are_offered(self) -> None:
        make_a_change(self)
        self.key("bracketleft")
        eta = self.wait("a smaller eta", lambda s: s["eta"] < 1)["eta"]
        self.app.send_signal(signal.SIGHUP)
        self.assertEqual(self.app.wait(30), 0)
        self.start()
        state = self.wait("the offer", lambda s: any("Open" in b["buttons"] for b in s["banners"]))
        self.assertEqual(state["eta"], eta)
        self.click(*next(b["buttons"]["Open"] for b in state["banners"] if "Open" in b["buttons"]))
        self.wait("the changed scene", lambda s: s["objects"] == 2 and not s["loading"]
                  and s["file"].endswith("table-recovered.toml"))
        self.wait("no banner", lambda s: s["banners"] == [])

    def test_a_display_that_goes_loses_neither_scene_nor_settings_nor_recording(self) -> None:
        import h5py

        make_a_change(self)
        self.key("bracketleft")
        eta = self.wait("a smaller eta", lambda s: s["eta"] < 1)["eta"]
        self.key("ctrl+r")  # R turns the selected object
        self.wait("recording", lambda s: s["recording"])
        self.go_on(1)
        self.xvfb.kill()
        self.assertEqual(self.app.wait(30), 1)
        data = self.home / "data/limpid"
        self.assertEqual(list((data / "sessions").glob("*.part")), [])
        with h5py.File(*(data / "sessions").glob("*.h5")) as session:
            self.assertGreater(len(session["time"]), 500)
        kept = data / "scenes/table-unsaved.toml"
        self.assertEqual(kept.read_text().count("[[plane]]"), 2)
        settings = (self.home / "config/limpid/settings.toml").read_text()
        self.assertEqual(tomllib.loads(settings)["parameters"]["coupling"]["eta"], eta)

    def test_ctrl_c_keeps_unsaved_changes_even_while_they_are_asked_about(self) -> None:
        make_a_change(self)
        self.key("ctrl+q")
        self.wait("the question", lambda s: s["dialog"] == "question")
        self.app.send_signal(signal.SIGINT)
        self.assertEqual(self.app.wait(30), 0)
        self.assertTrue((self.home / "data/limpid/scenes/table-unsaved.toml").exists())


class LargerThanTheScreen(WindowTest):
    SIZE = (5000, 4000)

    def assert_fits(self) -> None:
        words = self.xdotool("getwindowgeometry", "--shell", self.window).split()
        geometry = {name: int(value) for name, value in (word.split("=") for word in words)}
        self.assertGreaterEqual(min(geometry["X"], geometry["Y"]), 0)
        self.assertLessEqual(geometry["X"] + geometry["WIDTH"], 1600)
        self.assertLessEqual(geometry["Y"] + geometry["HEIGHT"], 900)

    def test_the_window_is_made_to_fit_at_every_start(self) -> None:
        self.assert_fits()
        self.key("ctrl+q", closes=True)
        self.assertEqual(self.app.wait(30), 0)
        self.start()
        self.assert_fits()


@unittest.skipUnless(shutil.which("xprop"), "needs xprop")
class OnAScreenOf150Percent(WindowTest):
    SIZE = (1000, 580)

    def prepare(self) -> None:
        subprocess.run(["xprop", "-root", "-format", "RESOURCE_MANAGER", "8s", "-set",
                        "RESOURCE_MANAGER", "Xft.dpi: 144"], env=self.environment, check=True)

    def test_the_window_does_not_grow_from_start_to_start(self) -> None:
        self.assertEqual(self.state()["size"], [1500, 870])
        self.key("ctrl+q", closes=True)
        self.assertEqual(self.app.wait(30), 0)
        self.prepare()
        self.start()
        self.assertEqual(self.state()["size"], [1500, 870])


if __name__ == "__main__":
    unittest.main()
