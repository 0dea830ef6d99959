"""A first start shows what a first hour needs; F8 shows everything, and that is remembered."""

from __future__ import annotations

import unittest

from window import WindowTest


class Simple(WindowTest):
    SIZE = (1440, 900)  # a first start's

    def prepare(self) -> None:
        (self.home / "config/limpid/settings.toml").unlink()

    def begin_again(self) -> dict:
        self.key("ctrl+q", closes=True)
        self.app.wait(20)
        self.start()
        return self.settled()

    def test_a_first_start_is_simple_until_everything_is_asked_for(self) -> None:
        first = self.settled()
        self.assertFalse(first["everything"])
        self.assertEqual(len(first["plots"]), 3)
        self.assertIn("Show all", first["noted"]["coupling"])
        again = self.begin_again()
        self.assertFalse(again["everything"])
        self.assertEqual(len(again["plots"]), 3)
        self.click_on("coupling", "Show all")
        whole = self.wait("the whole bench", lambda s: s["everything"] and len(s["plots"]) == 4)
        self.assertEqual(whole["kind"], first["kind"])
        self.assertTrue(self.begin_again()["everything"])
        self.key("F8")
        self.wait("the simple window", lambda s: not s["everything"] and len(s["plots"]) == 3)


if __name__ == "__main__":
    unittest.main()
