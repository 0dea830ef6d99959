"""Statements of the window about energy: its cause, and how to provoke and repair it."""

import time
import unittest

from window import WindowTest

FAULT = 1e-3  # energy from which the panel reports it [J]


class Energy(WindowTest):
    def hold(self) -> None:
        """Takes the tip and holds it, a little aside."""
        x, y = self.hold_tip()
        for step in range(10):
            self.move(x - step, y + step)
            time.sleep(0.03)

    def test_passivity_is_broken_by_a_button_and_repaired_by_it_or_by_undo(self) -> None:
        before = self.state()
        for end in ("Repair", "undo", "C", "Repair (C)"):
            with self.subTest(end):
                self.click_on("coupling", "Break passivity")
                self.wait("a banner", lambda s: any("Repair (C)" in b["buttons"]
                                                    for b in s["banners"]))
                broken = self.wait("a small eta", lambda s: s["eta"] < 0.6 and s["kind"] == 1)
                self.hold()
                self.wait("energy that grows",
                          lambda s: s["energy_total"] > broken["energy_total"] + 0.02)
                self.xdotool("mouseup", "1")
                self.wait("the hand to let go", lambda s: s["grip"] == 0)
                if end == "undo":
                    self.key("ctrl+z")
                elif end == "C":
                    self.key("c")
                elif end == "Repair":
                    self.click_on("coupling", "Repair")
                else:
                    self.click(*next(b["buttons"][end] for b in self.state()["banners"]
                                     if end in b["buttons"]))
                self.wait("what was before",
                          lambda s: s["eta"] == before["eta"] and s["kind"] == before["kind"]
                          and s["hand_settings"] == before["hand_settings"])
                self.key("BackSpace")
                self.wait("a new start", lambda s: s["energy_total"] == 0)

    def test_what_is_left_broken_is_whole_at_the_next_start(self) -> None:
        before = self.state()
        self.click_on("coupling", "Break passivity")
        self.wait("a stiff grip", lambda s: s["hand_settings"] == {"stiffness": 3000, "damping": 0})
        self.key("ctrl+q", closes=True)
        self.assertEqual(self.app.wait(30), 0)
        self.start()
        after = self.wait("a frame", lambda s: s["frames"] > 0)
        for key in ("hand", "kind", "eta"):
            self.assertEqual(after[key], before[key], key)

    def test_switching_while_pressing_is_no_fault_of_a_coupling(self) -> None:
        self.press_onto_table()
        self.wait("contact", lambda s: s["contact"] > 0.2)
        for kind in (1, 2, 0, 1):
            self.key("c")
            self.wait("the next law", lambda s: s["kind"] == kind)
            after = self.go_on(1)
            if kind != 2:  # the predictive law's promise is about its ledger
                self.assertLess(after["energy_own"], FAULT, f"law {kind}")
        self.xdotool("mouseup", "1")

    def test_a_key_goes_round_the_laws_and_to_tanks_where_there_is_a_link(self) -> None:
        first = self.state()["kind"]
        for kind in [(first + i) % 3 for i in range(1, 4)]:
            self.key("c")
            self.wait("the next law", lambda s: s["kind"] == kind)
        self.stop(self.app)
        self.words = [*self.words, "--set", "link.delay=5"]
        self.start()
        first = self.state()["kind"]
        for kind in [(first + i) % 4 for i in range(1, 5)]:
            self.key("c")
            self.wait("the next law", lambda s: s["kind"] == kind)


if __name__ == "__main__":
    unittest.main()
