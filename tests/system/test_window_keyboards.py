"""Keys by their labels on other keyboards, menus by keys, and leaving during a recording."""

import os
import shutil
import subprocess
import sys
import threading
import unittest

from support import ASSETS, LIMPID
from window import WindowTest

sys.path.insert(0, str(ASSETS / "python"))
os.environ["LIMPID"] = str(LIMPID)

import limpid  # noqa: E402

# Key codes of the letters' places, from Q, A and Z on, as X has them for every keyboard.
PLACES = {letter: str(code) for row, first in (("qwertyuiop", 24), ("asdfghjkl", 38), ("zxcvbnm", 52))
          for code, letter in enumerate(row, first)}


@unittest.skipUnless(shutil.which("setxkbmap"), "needs setxkbmap")
class OtherKeyboard(WindowTest):
    LAW = "proposed"  # which uses eta

    def choose(self, *layout: str) -> None:
        subprocess.run(["setxkbmap", *layout], env=self.environment, check=True,
                       stderr=subprocess.DEVNULL)
        self.layout = layout

    def label(self, keys: str) -> str:
        """Presses a key by its label. On a Russian keyboard Latin letters are beside the Cyrillic
        ones, and X has no names for them."""
        *modifiers, key = keys.split("+")
        return "+".join([*modifiers, PLACES.get(key, key) if "ru" in self.layout else key])

    def press(self, keys: str) -> dict:
        self.key(self.label(keys))
        return self.settled()


class Labels(OtherKeyboard):
    def check_keys(self) -> None:
        self.assertTrue(self.press("u")["force"], "U is no F")
        self.assertFalse(self.press("f")["force"])
        self.press("f")
        self.wait("force", lambda s: s["force"])
        self.assertEqual(self.press("c")["kind"], 2)
        self.assertEqual(self.press("ctrl+z")["kind"], 1)
        self.assertEqual(self.press("question")["dialog"], "help")
        self.assertEqual(self.press("Escape")["dialog"], "")
        self.assertEqual(self.press("F1")["dialog"], "help")
        self.press("Escape")

    def check_brackets(self, smaller: str, larger: str) -> None:
        before = self.state()["eta"]
        self.key(smaller)
        less = self.wait("a smaller eta", lambda s: s["eta"] < before)["eta"]
        self.key(larger)
        self.wait("a larger eta", lambda s: s["eta"] > less)

    def check_all_is_selected(self) -> None:
        """Checks that Ctrl+A selects all in a text field and quits nothing."""
        self.click_on("coupling", "coupling.eta", times=2)
        self.wait("typing", lambda s: s["typing"])
        self.type("9")
        self.press("ctrl+a")
        self.type("0.5")
        self.key("Return")
        self.wait("the typed value", lambda s: s["eta"] == 0.5 and not s["typing"])
        self.key(self.label("ctrl+z"))
        self.wait("the value of before", lambda s: s["eta"] > 0.5)

    def test_keys_are_what_stands_on_them(self) -> None:
        # Keys at the brackets' place, right of P, on keyboards without them.
        for layout, brackets in ((("us",), ("bracketleft", "bracketright")),
                                 (("fr",), ("34", "35")),
                                 (("de",), ("udiaeresis", "plus")),
                                 (("es",), ("34", "35")),
                                 (("ru",), ("34", "35")),
                                 (("us", "-variant", "dvorak"), ("bracketleft", "bracketright"))):
            with self.subTest(layout=layout):
                self.choose(*layout)
                self.check_keys()
                self.check_brackets(*brackets)
                self.check_all_is_selected()

    def test_signs_act_wherever_they_are_written(self) -> None:
        self.choose("fr")
        self.key("bracketleft")  # with AltGr
        self.wait("a smaller eta", lambda s: s["eta"] < 1)


class Answers(OtherKeyboard):
    def prepare(self) -> None:
        self.words = ["--listen", "test"]

    def test_a_row_of_digits_answers_without_shift_and_so_does_a_keypad(self) -> None:
        self.choose("fr")
        with limpid.Client(self.home / "run/limpid/test.control") as client:
            for key, index in (("eacute", 1), ("2", 1), ("ampersand", 0), ("KP_2", 1), ("KP_End", 0)):
                with self.subTest(key):
                    answers = []
                    thread = threading.Thread(daemon=True, target=lambda: answers.append(
                        client.ask("Which one is stiffer?", ["the first", "the second"])))
                    thread.start()
                    self.wait("the question", lambda s: s["dialog"] == "ask" and s["question"])
                    self.settled()
                    self.key(key)
                    thread.join(20)
                    self.assertEqual([answer.index for answer in answers], [index])
                    self.wait("the question to go", lambda s: not s["asking"])


class Menus(WindowTest):
    def test_are_led_by_keys(self) -> None:
        before = self.settled()
        self.key("F10")
        self.wait("a menu", lambda s: s["popup"])
        self.key("space")
        self.wait("the space bar to cut the force", lambda s: not s["force"])
        state = self.settled()
        self.assertTrue(state["popup"], "and to take nothing")
        self.assertEqual((state["file"], state["dialog"]), (before["file"], ""))
        self.key("Escape")
        self.wait("no menu", lambda s: not s["popup"])
        self.key("f")
        self.wait("force", lambda s: s["force"])
        self.key("F10")
        self.wait("a menu", lambda s: s["popup"])
        self.key("Escape")
        self.wait("no menu", lambda s: not s["popup"])
        self.assertTrue(self.settled()["force"], "Esc closes the menu, and no more")

        self.key("F10")
        self.wait("the menu File", lambda s: s["popup"])
        self.press_and_settle("Down", "Return")
        self.wait("its second item", lambda s: s["dialog"] == "open scene" and not s["popup"])
        self.key("Escape")
        self.wait("no dialog", lambda s: s["dialog"] == "")
        self.key("F10")
        self.wait("the menu File", lambda s: s["popup"])
        self.press_and_settle("Right", "Right", "Left", "Right", "Right", "Return")
        self.wait("the first item of Session", lambda s: s["recording"] and not s["popup"])

    def press_and_settle(self, *keys: str) -> None:
        for key in keys:
            self.settled()
            self.key(key)


class Panels(WindowTest):
    NONE, LEFT, RIGHT = 0, 1, 2

    def press(self, *keys: str) -> None:
        for key in keys:
            self.settled()
            self.key(key)

    def test_are_led_by_keys_from_one_to_the_next(self) -> None:
        for panel in (self.LEFT, self.RIGHT, self.NONE):
            self.press("ctrl+Tab")
            self.wait(f"panel {panel}", lambda s: s["panel"] == panel)
        self.press("F3", "ctrl+Tab", "ctrl+Tab")
        self.wait("no panel, as the right one is hidden", lambda s: s["panel"] == self.NONE)

    def test_choose_a_law_and_take_a_number(self) -> None:
        self.press("ctrl+Tab", "Right", "Return")
        self.wait("the second law", lambda s: s["edited"]["kind"] == "proposed")
        self.press("c")
        self.assertEqual(self.settled()["edited"]["kind"], "proposed", "no other key acts")
        self.press("Tab", "Tab", "Return")
        self.wait("typing over a slider", lambda s: s["typing"])
        self.type("0.5")
        self.press("Return")
        self.wait("the number", lambda s: s["eta"] == 0.5 and not s["typing"])
        self.assertEqual(self.settled()["panel"], self.LEFT, "it goes on from there")

    def test_leave_the_force_to_its_keys(self) -> None:
        self.press("ctrl+Tab")
        self.wait("the panel", lambda s: s["panel"] == self.LEFT)
        self.assertTrue(self.settled()["force"])
        self.press("space")
        self.wait("the space bar to cut the force", lambda s: not s["force"])
        self.assertEqual(self.settled()["edited"]["kind"], "standard", "and to take nothing")
        self.press("Escape")
        self.wait("the view", lambda s: s["panel"] == self.NONE)
        self.press("f")
        self.wait("force", lambda s: s["force"])
        self.press("ctrl+Tab", "Escape")
        self.wait("the view", lambda s: s["panel"] == self.NONE)
        self.assertTrue(self.settled()["force"], "Esc leaves the panel, and no more")


class Leaving(WindowTest):
    def test_while_something_is_recorded_is_asked_about(self) -> None:
        self.key("r")
        self.wait("recording", lambda s: s["recording"])
        for way in (lambda: self.key("ctrl+q"), self.close_by_cross):
            way()
            self.wait("the question", lambda s: s["dialog"] == "quit")
            self.key("Escape")
            self.wait("no question", lambda s: s["dialog"] == "")
            self.assertTrue(self.settled()["recording"], "it goes on")
        ticks = self.state()["ticks"]
        self.go_on(0.5)
        self.key("ctrl+q")
        self.wait("the question", lambda s: s["dialog"] == "quit")
        self.settled()
        self.key("Return", closes=True)
        self.assertEqual(self.app.wait(30), 0)
        import h5py

        sessions = self.home / "data/limpid/sessions"
        self.assertEqual(list(sessions.glob("*.part")), [])
        with h5py.File(*sessions.glob("*.h5")) as session:
            self.assertGreater(len(session["time"]), 400)
        self.assertGreater(ticks, 0)


if __name__ == "__main__":
    unittest.main()
