"""The grip, measured by a button of the window."""

import unittest

from window import WindowTest

HAND = {"stiffness": 520, "damping": 3}


class Grip(WindowTest):
    def prepare(self) -> None:
        self.words = [word for key, value in (*HAND.items(), ("mass", 0.1))
                      for word in ("--set", f"hand.{key}={value}")]  # fmt: skip

    def test_is_measured_on_request_and_taken_as_the_hand(self) -> None:
        self.go_on(0.5)
        self.click_on("side", "Measure the grip")
        self.noted("side", "Stop measuring")
        self.wait("what was found", lambda s: "Take as the hand" in s["noted"].get("side", {}), 60)
        self.assertEqual(self.state()["hand_settings"], HAND, "nothing is taken unasked")
        self.click_on("side", "Take as the hand")
        taken = self.wait("the hand's values", lambda s: s["hand_settings"] != HAND)["hand_settings"]
        for key, value in HAND.items():
            self.assertAlmostEqual(taken[key], value, delta=0.05 * value)

    def test_ends_by_a_button_and_with_the_force(self) -> None:
        self.click_on("side", "Measure the grip")
        self.click_on("side", "Stop measuring")
        self.click_on("side", "Measure the grip")
        self.noted("side", "Stop measuring")
        self.key("f")
        self.noted("side", "Measure the grip")


if __name__ == "__main__":
    unittest.main()
