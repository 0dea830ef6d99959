"""Scenes with moving objects, led by the mouse in the window as a person does: the stack falls, the
dominoes fall one after the other, marbles roll, pucks slide."""

from __future__ import annotations

import time
import tomllib
import unittest

import numpy as np
from support import ASSETS
from window import WindowTest


class Bodies(WindowTest):
    LAW = "predictive"

    def open(self, scene: str) -> None:
        """Opens the scene, takes the tip, and measures how the target follows the mouse."""
        self.app.terminate()
        self.app.wait(20)
        self.words = [str(ASSETS / "scenes" / f"{scene}.toml")]
        self.start()
        self.at = np.array(self.hold_tip())
        self.xdotool("keydown", "shift")  # only the wheel sets the depth
        here = self.target()
        ways = []
        for step in np.eye(2) * 25:
            self.pointer(self.at + step)
            self.settled()
            ways.append((self.target() - here) / 25)
            self.pointer(self.at - step)
            self.settled()
        self.wheel(1)
        ways.append(self.target() - here)
        self.wheel(-1)
        self.ways = np.array(ways).T  # target's way [m] for a pixel right, a pixel down and a notch

    def pointer(self, at: np.ndarray) -> None:
        self.at = np.array(at, dtype=float)
        self.move(*np.round(self.at))

    def wheel(self, notches: int) -> None:
        for _ in range(abs(notches)):
            self.xdotool("click", "5" if notches < 0 else "4")
            time.sleep(0.02)
        self.settled()

    def target(self) -> np.ndarray:
        """Target of the hand [m]."""
        return np.array(self.state()["places"]["target"])

    def lead(self, to: tuple[float, float, float], seconds: float) -> None:
        """Leads the hand to a place by drags and wheel; a second pass corrects for perspective."""
        for took in (seconds, 0.2):
            right, down, notches = np.linalg.solve(self.ways, np.array(to) - self.target())
            begin, steps = self.at.copy(), max(2, round(took / 0.04))
            turned = 0
            for k in range(1, steps + 1):
                self.pointer(begin + np.array([right, down]) * k / steps)
                while turned < round(abs(notches) * k / steps):
                    self.xdotool("click", "4" if notches > 0 else "5")
                    turned += 1
                time.sleep(0.04)
            self.settled()

    def let_go(self) -> None:
        self.xdotool("mouseup", "1")
        self.xdotool("keyup", "shift")

    def places(self) -> dict[str, np.ndarray]:
        """Places of the objects in the window [px]."""
        return {name: np.array(at) for name, at in self.state()["places"]["objects"].items()}

    def moved(self, name: str, before: dict[str, np.ndarray]) -> float:
        return float(np.linalg.norm(self.places()[name] - before[name]))

    def test_the_stack_is_knocked_over(self) -> None:
        self.open("stack")
        before = self.places()
        self.lead((0.199, 0.005, 0.03), 0.5)
        self.assertLess(self.moved("block 5", before), 2, "it stands until it is touched")
        self.lead((0.251, 0.034, 0.03), 0.6)
        for name in ("block 4", "block 5"):
            self.wait(f"{name} to fall", lambda _: self.moved(name, before) > 40)
        self.let_go()

    def test_the_stack_is_hit_by_a_drag_to_the_right(self) -> None:
        self.open("stack")
        before = self.places()
        for _ in range(40):
            self.pointer(self.at + [5, 0])
            time.sleep(0.03)
        self.wait("the tower to fall", lambda _: self.moved("block 5", before) > 40)
        self.let_go()

    def test_a_block_is_pulled_with_ctrl(self) -> None:
        self.open("stack")
        self.let_go()
        self.key("r")
        self.wait("recording", lambda s: s["recording"])
        before = self.places()
        x, y = before["block 5"]
        self.xdotool("keydown", "ctrl")
        self.move(round(x), round(y))
        time.sleep(0.2)
        self.xdotool("mousedown", "1")
        for k in range(1, 21):
            self.move(round(x + 4 * k), round(y - 5 * k))
            time.sleep(0.03)
        self.wait("it to hang where the mouse is", lambda _: np.linalg.norm(
            self.places()["block 5"] - [x + 80, y - 100]) < 60)  # fmt: skip
        self.assertLess(self.moved("block 1", before), 5, "the others stand")
        self.let_go()
        self.xdotool("keyup", "ctrl")
        self.wait("it to fall", lambda _: self.places()["block 5"][1] > y - 60)
        self.key("r")
        folder = self.home / "data/limpid/sessions"
        self.wait("the session", lambda s: not s["recording"] and list(folder.glob("*.h5")))
        self.check_rerun_is_the_same(next(folder.glob("*.h5")))

    def test_dominoes_fall_without_the_hand(self) -> None:
        self.open("dominoes")
        before = self.places()
        names = [name for name in before if name.startswith("domino")]
        self.lead((0.14, -0.04, 0.0), 0.6)
        self.lead((0.14, -0.045, -0.016), 0.4)
        self.assertLess(self.moved("domino 1", before), 2)
        self.lead((0.168, -0.051, -0.016), 0.6)
        self.let_go()
        for name in names:
            self.wait(f"{name} to fall", lambda _: self.moved(name, before) > 5)

    def test_marbles_are_stirred(self) -> None:
        self.open("marbles")
        before = self.places()
        self.lead((0.195, 0.0, -0.015), 0.5)
        for to in ((0.205, 0.01, -0.024), (0.185, 0.01, -0.024), (0.185, -0.01, -0.024),
                   (0.205, -0.01, -0.024)):  # fmt: skip
            self.lead(to, 0.3)
        self.let_go()
        marbles = [name for name in before if name.startswith("marble")]
        self.assertGreaterEqual(sum(self.moved(name, before) > 5 for name in marbles), 3)

    def test_pucks_are_pushed_one_after_the_other(self) -> None:
        self.open("pucks")
        for name in ("5 g", "500 g"):
            before = self.places()
            x, y, z = self.puck(name)
            self.lead((x - 0.035, y, z + 0.03), 0.5)
            self.lead((x - 0.035, y, z), 0.4)
            self.assertLess(self.moved(name, before), 3, "it lies still until it is touched")
            self.lead((x + 0.005, y, z), 0.25)
            self.wait(f"{name} to go on", lambda _: self.moved(name, before) > 30)
        self.let_go()

    def puck(self, name: str) -> tuple[float, float, float]:
        scene = tomllib.loads((ASSETS / "scenes/pucks.toml").read_text())
        return tuple(next(b for b in scene["body"] if b["name"] == name)["position"])


if __name__ == "__main__":
    unittest.main()
