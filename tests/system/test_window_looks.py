"""Theme and size of the window's text: chosen by mouse and keys, kept for the next start."""

import unittest

from window import WindowTest

DARK, LIGHT, CONTRAST = 0, 1, 2


class Looks(WindowTest):
    SIZE = (900, 560)

    def choose(self, *items: str) -> None:
        """Chooses an item of the menu View, or of a menu inside of it."""
        self.settled()
        bar = self.wait("the menu bar", lambda s: "View" in s["noted"].get("##MainMenuBar", {}))
        self.click(*bar["noted"]["##MainMenuBar"]["View"])
        for item in items:
            self.click_on("##Menu_00", item)

    def start_again(self) -> None:
        self.key("ctrl+q", closes=True)
        self.app.wait(30)
        self.start()

    def test_themes_are_chosen_in_a_menu_and_kept(self) -> None:
        self.assertEqual(self.settled()["theme"], DARK)
        for item, theme in (("light", LIGHT), ("high contrast", CONTRAST)):
            self.choose("Theme", item)
            self.wait(item, lambda s: s["theme"] == theme and not s["popup"])
        self.assertTrue(self.settled()["force"], "force is not touched")
        self.start_again()
        self.assertEqual(self.settled()["theme"], CONTRAST)

    def test_text_grows_and_shrinks_by_keys_and_the_window_with_it(self) -> None:
        first = self.settled()
        plot = first["plots"][0]["area"]
        for key, size in (("plus", 1.25), ("plus", 1.5), ("equal", 2), ("plus", 2), ("minus", 1.5)):
            self.key(f"ctrl+{key}")
            self.wait(f"text at {size}", lambda s: s["text_size"] == size)
        self.settled()
        self.start_again()
        self.assertEqual(self.settled()["text_size"], 1.5)
        self.key("ctrl+0")
        self.wait("the usual size", lambda s: s["text_size"] == 1)
        self.assertEqual(self.settled()["plots"][0]["area"], plot)

    def test_they_are_left_alone_while_somebody_types(self) -> None:
        self.key("ctrl+p")
        self.wait("a field", lambda s: s["dialog"] == "presets" and s["typing"])
        self.key("ctrl+plus")
        self.assertEqual(self.settled()["text_size"], 1)


if __name__ == "__main__":
    unittest.main()
