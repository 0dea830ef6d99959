"""Every dialog closes by its cross, by Esc and by its button, and stays closed."""

import re
import subprocess
import unittest
from pathlib import Path

import test_sweep_window
from support import ASSETS, LIMPID, ROOT
from test_drop import drop, two_arms
from test_window_keys import make_a_change
from window import WindowTest

TABLE = ROOT / "app/desktop/shell/dialogs.cpp"
SESSION = sorted((ASSETS / "sessions").glob("*.h5"))[0]
# Dialogs that no key opens; their frames are those of the others. "ask" is a program's, and stays
# open until it is answered; "quit" asks about a recording, which test_window_keys makes.
WITHOUT_KEY = {"about", "messages", "open arm", "device arm", "find session", "ask", "quit"}


def dialogs() -> set[str]:
    """Names of all dialogs, from the program's own list."""
    return set(re.findall(r'DialogKind{"([^"]+)"', TABLE.read_text()))


@unittest.skipUnless(drop, "needs python3-xlib")
class EachDialog(WindowTest):
    """One window for all dialogs; the files that some need exist from the start."""

    def prepare(self) -> None:
        plan = self.home / "plan.toml"
        plan.write_text(test_sweep_window.PLAN % 0.01)
        subprocess.run([LIMPID, "sweep", plan, "--out", self.home / "sweep"], check=True,
                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.arms = self.home / "arms.urdf"
        self.arms.write_text(two_arms())
        self.xacro = self.home / "arm.xacro"
        self.xacro.write_text("<robot name='arm'/>")
        self.words = [str(self.home / "sweep")]

    def open_video(self) -> None:
        if not self.state()["playing"]:
            self.key("ctrl+o")
            self.wait("the field", lambda s: s["dialog"] == "open session" and s["typing"])
            self.type(str(SESSION))
            self.key("Return")
            self.wait("playback", lambda s: s["playing"] and s["dialog"] == "")
        self.key("v")

    def open_new_sweep(self) -> None:
        self.key("F6")
        self.wait("the map", lambda s: s["dialog"] == "sweep" and s["sweep"]["drawn"])
        window = next(name for name in self.settled()["noted"] if name.startswith("Sweep"))
        self.click_on(window, "New sweep...")

    def drop(self, file: Path) -> None:
        drop(self.environment["DISPLAY"], int(self.window), [file])

    def open(self, dialog: str) -> None:
        keys = {"help": "F1", "experiments": "F5", "sweep": "F6", "plot": "n", "gallery": "ctrl+g",
                "open session": "ctrl+o", "open scene": "ctrl+shift+o", "add model": "ctrl+m", "save scene": "ctrl+shift+s",
                "layouts": "ctrl+l", "mark": "t", "export": "ctrl+e", "presets": "ctrl+p", "identify": "F7", "question": "ctrl+q"}
        ways = {"arm tip": lambda: self.drop(self.arms), "video": self.open_video,
                "expand xacro": lambda: self.drop(self.xacro), "new sweep": self.open_new_sweep}
        ways[dialog]() if dialog in ways else self.key(keys[dialog])
        self.wait(dialog, lambda s: s["dialog"] == dialog and s["closing"])
        self.settled()

    def close(self, way: str) -> None:
        places = self.state()["closing"]
        if way == "Escape":
            self.key("Escape")
        else:
            self.assertIsNotNone(places[way], way)
            self.click(*places[way])

    def test_closes_by_its_cross_by_escape_and_by_its_button(self) -> None:
        self.wait("the sweep", lambda s: s.get("sweep") and s["dialog"] == "sweep")
        self.key("Escape")
        self.wait("no dialog", lambda s: s["dialog"] == "")
        make_a_change(self)
        all_of_them = sorted((dialogs() | {"question"}) - WITHOUT_KEY, key=lambda d: (d == "video", d))
        self.assertGreaterEqual(len(all_of_them), 14)
        for dialog in all_of_them:
            for way in ("cross", "Escape", "button"):
                with self.subTest(f"{dialog}, {way}"):
                    self.open(dialog)
                    self.close(way)
                    self.wait("no dialog", lambda s: s["dialog"] == "" and s["closing"] is None, 10)
                    state = self.settled()
                    self.assertEqual(state["dialog"], "", "it stays closed")
                    self.assertIsNone(state["closing"])
                    self.assertTrue(state["force"], "and the virtual arm keeps its force")


if __name__ == "__main__":
    unittest.main()
