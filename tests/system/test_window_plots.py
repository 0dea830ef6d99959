"""Plots, layouts and presets in the window, under Xvfb with xdotool."""

import tomllib
import unittest

from window import HEIGHT, WIDTH, WindowTest

FOUR = ["coordination error", "controller energy", "human and contact torque",
        "error against torque"]
PLOTS = HEIGHT - 130  # a height within the plots
SAVE_CSV = (1060, 499)  # place in the menu of the last plot


def titles(state: dict) -> list[str]:
    return [plot["title"] for plot in state["plots"]]


class Plots(WindowTest):
    def type_and_enter(self, text: str) -> None:
        self.type(text)
        self.key("Return")

    def filter(self, words: str) -> None:
        self.key("ctrl+a")
        self.type_and_enter(words)

    def open(self, key: str, dialog: str) -> None:
        self.key(key)
        self.wait(dialog, lambda s: s["dialog"] == dialog and s["typing"])

    def wait_for_layout(self, name: str) -> dict:
        file = self.home / "config/limpid/layouts.toml"

        def is_there() -> bool:
            try:
                return file.exists() and name in self.kept("layouts.toml")
            except tomllib.TOMLDecodeError:  # the former, broken file is still there
                return False

        self.wait_until(name, is_there)
        return self.kept("layouts.toml")

    def use(self, key: str, dialog: str, name: str) -> None:
        """Uses an entry kept by name, by the keyboard."""
        self.open(key, dialog)
        self.type_and_enter(name)
        self.wait("it to be used", lambda s: s["dialog"] == "")

    def close(self) -> None:
        self.key("Escape")
        self.wait("the dialog to close", lambda s: s["dialog"] == "")

    def restart(self) -> None:
        self.key("ctrl+q", closes=True)
        self.assertEqual(self.app.wait(30), 0)
        self.start()

    def kept(self, file: str) -> dict:
        return tomllib.loads((self.home / "config/limpid" / file).read_text())

    def test_channels_are_chosen_by_filter_and_stay_over_a_restart(self) -> None:
        self.assertEqual(titles(self.state()), FOUR)
        self.open("n", "plot")
        self.filter("device velocity joint 2")
        self.wait("a fifth plot", lambda s: titles(s)[4:] == ["device velocity 2"])
        self.filter("proxy velocity joint 2")
        self.wait("two channels", lambda s: len(s["plots"][4]["curves"]) == 2)
        self.filter("no such channel")
        self.filter("proxy velocity joint 2")
        five = self.wait("one again", lambda s: len(s["plots"][4]["curves"]) == 1)
        self.close()
        self.assertEqual(five["plots"][4]["kind"], "time")

        self.open("n", "plot")  # nothing is chosen, so nothing is deleted
        self.close()
        self.assertEqual(len(self.settled()["plots"]), 5)

        self.key("b")
        twin = self.wait("the twin", lambda s: s["shown_lanes"] == 2 and len(s["plots"][4]["curves"]) == 2)
        self.assertEqual(len(twin["plots"][3]["curves"]), 2, "two lines of error over torque")
        self.key("b")
        self.restart()
        self.assertEqual(titles(self.state()), [*FOUR, "device velocity 2"])

    def test_a_channel_is_dragged_into_another_plot(self) -> None:
        before = self.settled()["plots"][0]["curves"]
        self.open("n", "plot")
        self.type("device tip speed")
        self.settled()
        place = self.wait("the channel", lambda s: any("device/tip_speed" in places for places in s["noted"].values()))
        at = next(places["device/tip_speed"] for places in place["noted"].values() if "device/tip_speed" in places)
        self.move(*at)
        self.settled()
        self.xdotool("mousedown", "1")
        self.taken()
        for part in (0.3, 0.6, 1):
            self.move(at[0] + part * (150 - at[0]), at[1] + part * (PLOTS - at[1]))
            self.settled()
        self.xdotool("mouseup", "1")
        plots = self.wait("one curve more", lambda s: len(s["plots"][0]["curves"]) == len(before) + 1)["plots"]
        self.assertIn("device tip speed [m/s]", plots[0]["curves"])
        self.assertEqual(len(plots[4]["curves"]), 0, "the plot of the chooser keeps what it had")

    def test_layouts_are_saved_used_renamed_and_removed(self) -> None:
        self.open("ctrl+l", "layouts")
        self.type_and_enter("mine")
        self.wait_for_layout("mine")
        self.close()
        self.key("F2")
        self.open("n", "plot")
        self.filter("energy ledger")
        self.wait("a fifth plot", lambda s: len(s["plots"]) == 5)
        self.close()
        self.open("ctrl+l", "layouts")
        self.type_and_enter("with ledger")
        layouts = self.wait_for_layout("with ledger")
        self.assertEqual(len(layouts["with ledger"]["plot"]), 5)
        self.assertFalse(layouts["with ledger"]["show_left"])
        self.assertTrue(layouts["mine"]["show_left"])
        self.close()
        self.use("ctrl+l", "layouts", "mine")
        self.wait("the layout of before", lambda s: titles(s) == FOUR)
        self.use("ctrl+l", "layouts", "with ledger")
        self.wait("the other one", lambda s: len(s["plots"]) == 5)
        self.open("ctrl+l", "layouts")
        self.type("mine")
        self.settled()  # a frame with the entry, which chooses it
        self.key("ctrl+a")
        self.type("yours")
        self.click_on("Layouts", "Rename")
        self.assertNotIn("mine", self.wait_for_layout("yours"))
        self.click_on("Layouts", "Remove")
        self.settled()
        self.assertIn("yours", self.kept("layouts.toml"), "it asks once more")
        self.click_on("Layouts", "Remove it")
        self.wait_until("the layout to go", lambda: "yours" not in self.kept("layouts.toml"))
        self.assertIn("with ledger", self.kept("layouts.toml"))

    def test_presets_set_the_running_loop_and_can_be_undone(self) -> None:
        before = self.state()
        self.assertEqual((before["kind"], before["eta"]), (0, 1))
        self.use("ctrl+p", "presets", "Light hand")
        self.wait("the preset in the loop", lambda s: (s["kind"], s["eta"]) == (2, 0.3))
        self.key("ctrl+z")
        self.wait("what was before", lambda s: (s["kind"], s["eta"]) == (0, 1))
        self.key("ctrl+y")
        self.wait("the preset again", lambda s: (s["kind"], s["eta"]) == (2, 0.3))
        self.key("bracketleft")
        smaller = self.wait("a smaller eta", lambda s: s["eta"] < 0.3)["eta"]
        self.open("ctrl+p", "presets")
        self.type_and_enter("mine")
        presets = self.home / "config/limpid/presets.toml"
        self.wait_until("the preset's file",
                        lambda: presets.exists() and "mine" in self.kept("presets.toml"))
        self.assertEqual(self.kept("presets.toml")["mine"]["coupling"]["eta"], smaller)
        self.close()
        self.restart()
        self.use("ctrl+p", "presets", "Light hand")
        self.wait("the preset", lambda s: s["eta"] == 0.3)
        self.use("ctrl+p", "presets", "mine")
        self.wait("one's own", lambda s: s["eta"] == smaller)

    def test_a_plot_against_a_channel_is_saved_by_its_menu(self) -> None:
        self.click(WIDTH - 100, PLOTS, button=3)  # the plot of error over torque
        sessions = self.home / "data/limpid/sessions"
        self.click(*SAVE_CSV)
        self.wait_for_notice("error-against-torque")
        header = next(sessions.glob("error-against-torque-*.csv")).read_text().splitlines()[0]
        self.assertEqual(header, "time [s],|f2| [N m],|x_E| [mrad]")

    def test_files_that_cannot_be_read_are_told_and_kept(self) -> None:
        self.key("ctrl+q", closes=True)
        self.assertEqual(self.app.wait(30), 0)
        broken = "[mine\nleft = 3"
        (self.home / "config/limpid/layouts.toml").write_text(broken)
        self.start()
        self.wait_for_notice("layouts.toml:1")
        self.open("ctrl+l", "layouts")
        self.type_and_enter("new")
        self.wait_for_layout("new")
        self.assertEqual((self.home / "config/limpid/layouts.toml.unread").read_text(), broken)


if __name__ == "__main__":
    unittest.main()
