"""Actions of mouse and keys in the picture: select, move, turn, scale, pull, look."""

from __future__ import annotations

import time
import unittest

from window import WindowTest

SCENE = """title = "three things"
tip_radius = 0.004
gravity = [0, 0, 0]
[[sphere]]
name = "ball"
center = [0.12, 0.12, -0.05]
radius = 0.02
stiffness = 600
[[box]]
name = "block"
center = [0.17, -0.07, -0.05]
size = [0.03, 0.03, 0.03]
stiffness = 600
[[body]]
name = "die"
box = [0.03, 0.03, 0.03]
mass = 0.05
position = [0.14, 0, -0.07]
magnet = true
"""


class Picture(WindowTest):
    LAW = "predictive"

    def prepare(self) -> None:
        self.scene = self.home / "three.toml"
        self.scene.write_text(SCENE)
        self.words = [str(self.scene)]

    def setUp(self) -> None:
        super().setUp()
        self.hold_tip()  # ends the hint that covers things
        self.xdotool("mouseup", "1")
        self.wait("the hand to let go", lambda s: s["grip"] == 0)

    def place(self, name: str) -> tuple[float, float]:
        return self.state()["places"]["objects"][name]

    def drag(self, begin: tuple[float, float], way: tuple[float, float]) -> None:
        self.move(*begin)
        self.settled()
        self.xdotool("mousedown", "1")
        for step in range(1, 11):
            self.move(begin[0] + way[0] * step / 10, begin[1] + way[1] * step / 10)
            time.sleep(0.03)
        self.settled()
        self.xdotool("mouseup", "1")

    def text(self) -> str:
        """Text of the scene as saved."""
        self.key("ctrl+s")
        self.wait("the scene to be saved", lambda s: not s["dirty"])
        return self.scene.read_text()

    def test_a_click_selects_and_handles_and_keys_change_what_is_selected(self) -> None:
        for name in ("ball", "die", "block"):
            self.click(*self.place(name))
            self.wait(f"{name} to be selected", lambda s: s["selected"] == name)
        x, y = self.place("block")
        self.drag((x, y), (40, -30))  # by the handle in the middle
        self.wait("a change", lambda s: s["dirty"])
        there = self.place("block")
        self.assertLess(abs(there[0] - x - 40), 3)
        self.assertLess(abs(there[1] - y + 30), 3)
        self.key("ctrl+z")  # the whole drag is one step
        self.wait("it to be back", lambda s: not s["dirty"])

        self.move(*self.place("block"))
        self.settled()
        self.key("g")
        self.key("z")
        self.settled()  # the motion begins at the mouse
        self.move(x, y - 60)
        self.settled()
        self.key("Return")
        changed = self.text()
        block = changed[changed.index('"block"'):]
        self.assertRegex(block, r"center = \[0\.17, -0\.07, -?0\.\d+\]")
        self.assertNotIn("center = [0.17, -0.07, -0.05]", changed)
        self.key("ctrl+z")

        self.key("g")  # by a number: 25 mm to the right, with a slip on the way
        self.key("y")
        for key in ("minus", "2", "4", "BackSpace", "5"):
            self.key(key)
        self.settled()
        self.key("Return")
        changed = self.text()
        self.assertRegex(changed[changed.index('"block"'):], r"center = \[0\.17, -0\.095, -0\.05\]")
        self.key("ctrl+z")

        self.move(x + 60, y)
        self.settled()
        self.key("s")
        self.settled()  # the motion begins at the mouse
        self.move(x + 120, y)
        self.settled()
        self.click(x + 120, y)
        self.assertNotIn("size = [0.03, 0.03, 0.03]", self.text())

        self.key("r")
        self.settled()  # the motion begins at the mouse
        self.move(x + 60, y + 80)
        self.settled()
        self.assertTrue(self.state()["dirty"])
        self.key("Escape")  # gives it up
        self.wait("nothing to have changed", lambda s: not s["dirty"])
        self.assertTrue(self.state()["force"], "it did not cut the force")
        self.assertFalse(self.state()["recording"])

        self.click(640, 150)  # the sky
        self.wait("nothing to be selected", lambda s: s["selected"] is None)

    def test_what_moves_can_be_put_elsewhere_and_a_right_click_says_what_else(self) -> None:
        x, y = self.place("die")
        self.click(x, y)
        self.wait("the die", lambda s: s["selected"] == "die")
        self.drag((x, y), (50, 10))
        there = self.wait("it to stay there",
                          lambda s: abs(s["places"]["objects"]["die"][0] - x - 50) < 3)
        self.assertEqual(there["objects"], 3)
        self.click(*self.place("ball"), button=3)
        self.wait("the ball", lambda s: s["selected"] == "ball")
        self.key("Escape")  # the menu
        self.settled()
        self.assertTrue(self.state()["force"])
        self.key("Delete")
        self.wait("two objects", lambda s: s["objects"] == 2)

    def test_a_drag_pulls_near_the_tip_and_turns_elsewhere(self) -> None:
        x, y = self.state()["places"]["tip"]
        self.drag((640, 150), (120, 0))
        turned = self.wait("the view to turn",
                           lambda s: abs(s["places"]["tip"][0] - x) > 5)
        self.assertEqual(turned["grip"], 0)
        x, y = self.hold_tip()
        self.move(x, y + 40)
        self.go_on(0.5)
        before = self.state()
        self.key("F2")  # hides the panel: the picture is wider
        self.go_on(0.5)
        after = self.state()
        self.assertEqual(after["grip"], 1)
        self.assertLess(after["error"], 0.05)
        self.assertEqual([round(v, 3) for v in before["places"]["target"]],
                         [round(v, 3) for v in after["places"]["target"]], "the hand's target stays")
        self.xdotool("mouseup", "1")


if __name__ == "__main__":
    unittest.main()
