"""The story in the window: it plays, a person takes over, gives back, and ends it."""

import unittest

from window import WindowTest

IN_VIEW = (500, 200)
NEAR_THE_END = (1030, 698)  # place on the time line


class Story(WindowTest):
    LAW = None  # a first start's law

    def play(self) -> dict:
        self.click_on("story", "Show me (47 s)")
        self.wait("the story", lambda s: s["playing"] and s["told"], 120)
        return self.first_sentence()

    def first_sentence(self) -> dict:
        """Shows the story's first sentence again, on slow computers, too."""
        self.key("p")
        self.key("Home")
        state = self.wait("the first sentence", lambda s: "One hand" in s["told"])
        self.key("p")
        return state

    def test_it_plays_is_taken_over_given_back_and_ended(self) -> None:
        first = self.play()
        self.assertEqual(first["shown_lanes"], 2, "two runs beside each other")
        self.wait("its next sentence", lambda s: s["told"] != first["told"], 60)

        taken = self.state()
        self.move(*IN_VIEW)
        self.xdotool("mousedown", "1")
        self.wait("the arm to be the user's", lambda s: not s["playing"])
        self.xdotool("mouseup", "1")
        self.wait_for_notice("P continues the story")
        self.hold_tip()
        self.xdotool("mouseup", "1")

        self.key("p")
        again = self.wait("the story again", lambda s: s["playing"] and s["told"])
        self.assertGreaterEqual(again["time"], taken["time"] - 0.2, "where it was left")
        self.assertNotEqual(again["told"], first["told"])

        self.key("BackSpace")
        self.wait("the end", lambda s: not s["playing"])
        self.assertFalse(self.settled()["playing"])

    def test_its_end_hands_the_arm_over_with_things_to_try(self) -> None:
        self.play()
        self.key("p")
        self.click(*NEAR_THE_END)
        self.wait("its last sentence", lambda s: s["recorded"]["at"] > 40)
        self.assertFalse(self.state()["your_turn"])
        self.key("p")
        state = self.wait("its end", lambda s: not s["playing"], 60)
        self.assertTrue(state["your_turn"])
        self.assertEqual(state["tried"], "", "who has watched has tried nothing yet")

    def test_its_session_has_its_captions_when_it_is_opened_again(self) -> None:
        self.play()
        self.key("ctrl+q", closes=True)
        self.assertEqual(self.app.wait(30), 0)
        self.start()
        self.assertFalse(self.state()["told"])
        self.key("ctrl+o")
        self.wait("the dialog", lambda s: s["typing"])
        self.type(str(self.home / "data/limpid/story/story.h5"))
        self.key("Return")
        self.wait("a sentence", lambda s: s["playing"] and s["told"])
        self.first_sentence()
        cache = self.home / "cache/limpid/thumbnails"
        self.wait_until("a small picture", lambda: any(cache.glob("*.png")))
        self.assertEqual(len(list(cache.glob("*.png"))), 1, "one small picture of one session")


class Overlay(WindowTest):
    LAW = "predictive"

    def test_both_runs_in_one_picture_and_remembered(self) -> None:
        self.key("b")
        self.wait("the twin", lambda s: s["shown_lanes"] == 2 and not s["overlaid"])
        self.key("shift+b")
        self.wait("one picture", lambda s: s["overlaid"])
        self.press_onto_table()
        self.wait("standard to drift", lambda s: s["twin_error"] > 0.01 and s["error"] < 1e-3)
        self.xdotool("mouseup", "1")
        self.key("ctrl+q", closes=True)
        self.assertEqual(self.app.wait(30), 0)
        self.start()
        self.assertTrue(self.state()["overlaid"])


class Video(WindowTest):
    def test_a_video_is_ordered_in_a_dialog_and_can_be_cancelled(self) -> None:
        self.key("r")
        self.wait("recording", lambda s: s["recording"])
        self.go_on(3)
        self.key("r")
        self.wait_for_notice("Recorded")
        self.key("p")
        self.wait("playback", lambda s: s["playing"])
        sessions = self.home / "data/limpid/sessions"

        self.key("v")
        self.wait("the dialog", lambda s: s["dialog"] == "video")
        self.key("Escape")
        self.wait("none", lambda s: s["dialog"] == "")
        self.assertEqual(list(sessions.glob("*.mp4*")), [])

        self.key("v")
        self.wait("the dialog", lambda s: s["dialog"] == "video")
        self.key("Return")
        self.wait("the work", lambda s: s["filming"] and s["dialog"] == "")
        self.wait("its end", lambda s: not s["filming"], 240)
        self.wait_for_notice("Wrote")
        self.assertEqual(len(list(sessions.glob("*.mp4"))), 1)


if __name__ == "__main__":
    unittest.main()
