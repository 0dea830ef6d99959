"""Every dialog closes by its cross, by Esc and by its button, and stays closed."""

import re
import shutil
import unittest
from pathlib import Path

from support import ASSETS, ROOT
from test_drop import two_arms
from test_window_keys import make_a_change
from window import WindowTest

FOCUS = ROOT / "app/desktop/shell/focus.cpp"
SESSION = sorted((ASSETS / "sessions").glob("*.h5"))[0]
MENUS = {"Help": (352, 12), "Device": (303, 12)}  # in the menu bar
ITEMS = {"about": ("Help", 3), "open arm": ("Device", 2)}  # which one in it


def dialogs() -> set[str]:
    """All there are, by the program's own list."""
    return set(re.findall(r'case Dialog::\w+: return "([^"]+)"', FOCUS.read_text()))


class EachDialog(WindowTest):
    """One window for all of them; what some need is there from the start."""

    def prepare(self) -> None:
        from test_sweep_window import PLAN, LIMPID
        import subprocess

        plan = self.home / "plan.toml"
        plan.write_text(PLAN % 0.01)
        subprocess.run([LIMPID, "sweep", plan, "--out", self.home / "sweep"], check=True,
                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.arms = self.home / "arms.urdf"
        self.arms.write_text(two_arms())
        self.words = [str(self.home / "sweep")]

    def menu(self, dialog: str) -> None:
        menu, place = ITEMS[dialog]
        x, y = MENUS[menu]
        self.click(x, y)
        self.settled()
        self.click(x + 30, y + 22 * place)

    def open_video(self) -> None:
        if not self.state()["playing"]:
            self.key("ctrl+o")
            self.wait("the field", lambda s: s["dialog"] == "open session" and s["typing"])
            self.type(str(SESSION))
            self.key("Return")
            self.wait("playback", lambda s: s["playing"] and s["dialog"] == "")
        self.key("v")

    def open_arm_tip(self) -> None:
        self.menu("open arm")
        self.wait("the field", lambda s: s["dialog"] == "open arm" and s["typing"])
        self.key("ctrl+a")
        self.type(str(self.arms))
        self.key("Return")

    def open(self, dialog: str) -> None:
        keys = {"help": "F1", "experiments": "F5", "sweep": "F6", "plot": "n", "gallery": "ctrl+g",
                "open session": "ctrl+o", "add model": "ctrl+m", "save scene": "ctrl+shift+s",
                "layouts": "ctrl+l", "presets": "ctrl+p", "identify": "F7", "question": "ctrl+q"}
        ways = {"about": lambda: self.menu("about"), "open arm": lambda: self.menu("open arm"),
                "arm tip": self.open_arm_tip, "video": self.open_video}
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
        all_of_them = sorted(dialogs() | {"question"}, key=lambda d: (d == "video", d))
        self.assertGreaterEqual(len(all_of_them), 16)
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
