"""Drives the window as a new user would, under Xvfb with xdotool."""

import unittest

from window import WindowTest


class Window(WindowTest):
    def test_a_person_drags_onto_the_table_switches_records_plays_and_reruns(self) -> None:
        self.assertEqual(self.state()["kind"], 0, "the coupling that was left")
        self.press_onto_table()
        apart = self.wait("contact that the spring of 10 N m/rad carries",
                          lambda s: s["contact"] > 0.2
                          and abs(s["error"] - s["contact"] / 10) < 0.02 * s["error"])

        self.key("c")
        self.wait("the proposed coupling", lambda s: s["kind"] == 1)
        together = self.wait("device and proxy together",
                             lambda s: s["error"] < apart["error"] / 20)
        self.assertGreater(together["contact"], 0.2, "and still in contact")
        self.xdotool("mouseup", "1")
        self.wait("the hand to let go", lambda s: s["grip"] == 0)

        self.key("r")
        self.wait("recording", lambda s: s["recording"])
        self.press_onto_table()
        self.wait("contact", lambda s: s["contact"] > 0.2)
        self.key("c")
        self.wait("the next coupling", lambda s: s["kind"] == 2)
        self.go_on(1)
        self.xdotool("mouseup", "1")
        self.key("r")
        self.wait("the end of the recording", lambda s: not s["recording"])

        self.key("p")
        playing = self.wait("playback", lambda s: s["playing"])
        self.wait("playback to go on", lambda s: s["time"] > playing["time"])
        self.key("p")
        self.key("Home")
        self.wait("the beginning", lambda s: s["time"] == 0)
        self.key("shift+Right")
        self.wait("a step of 0.1 s", lambda s: abs(s["time"] - 0.1) < 1e-6)
        self.key("e")
        self.wait("the re-run", lambda s: s["rerun"])
        self.key("BackSpace")
        self.wait("the device again", lambda s: not s["playing"])

        recordings = list((self.home / "data/limpid/sessions").glob("*.h5"))
        self.assertEqual(len(recordings), 1)
        self.check_rerun_is_the_same(recordings[0])

    def test_escape_cuts_the_force_at_once_and_f_arms_it_again(self) -> None:
        self.assertTrue(self.state()["force"])
        self.key("Escape")
        self.wait("force off", lambda s: not s["force"])
        self.key("f")
        self.wait("force on", lambda s: s["force"])

    def test_settings_are_remembered_from_one_start_to_the_next(self) -> None:
        self.key("bracketleft")
        eta = self.wait("a smaller eta", lambda s: s["eta"] < 1)["eta"]
        self.key("ctrl+q", closes=True)
        self.assertEqual(self.app.wait(30), 0)
        self.start()
        self.wait("the same eta", lambda s: s.get("eta") == eta)

    def test_a_killed_recording_is_recovered_at_the_next_start(self) -> None:
        self.key("r")
        self.wait("recording", lambda s: s["recording"])
        self.go_on(2)
        self.app.kill()
        self.app.wait()
        sessions = self.home / "data/limpid/sessions"
        self.assertEqual(len(list(sessions.glob("*.part"))), 1)
        self.start()
        self.assertEqual(len(list(sessions.glob("*.part"))), 0)
        self.assertEqual(len(list(sessions.glob("*.h5"))), 1)
        self.key("p")  # the law of the last start
        self.wait("its playback", lambda s: s["playing"] and s["time"] > 0)


class FirstStart(WindowTest):
    LAW = None

    def test_has_the_coupling_that_feels_best_and_stays_passive(self) -> None:
        self.assertEqual(self.state()["kind"], 2)


class Playback(WindowTest):
    SIZE = (1600, 880)  # all of the panel fits

    def test_a_recording_has_the_keys_of_a_player_and_is_run_again_as_it_was(self) -> None:
        self.key("bracketleft")
        eta = self.wait("a smaller eta", lambda s: s["eta"] < 1)["eta"]
        self.key("r")
        self.wait("recording", lambda s: s["recording"])
        self.go_on(2)
        self.key("r")
        self.wait("the end of the recording", lambda s: not s["recording"])
        self.key("bracketright")
        self.wait("a larger eta", lambda s: s["eta"] > eta)
        self.key("p")
        state = self.wait("playback", lambda s: s["playing"])
        self.key("l")  # it goes on from its beginning, however long the rest takes
        self.assertEqual(state["edited"]["eta"], eta, "the re-run begins as the recording did")
        self.key("c")
        self.wait("another law for the re-run", lambda s: s["edited"]["kind"] != state["edited"]["kind"])
        self.click_on("coupling", "As recorded")
        self.wait("the recording's", lambda s: s["edited"] == state["edited"])
        self.click_on("coupling", "Take mine")
        self.wait("the loop's", lambda s: s["edited"]["eta"] > eta)

        self.key("space")  # pauses
        at = self.settled()["recorded"]["at"]
        self.assertEqual(self.settled()["recorded"]["at"], at)
        left, top, right, bottom = self.state()["plots"][0]["area"]
        start, stop = self.state()["shown"]
        self.click(left + 0.25 * (right - left), 0.5 * (top + bottom))
        found = self.settled()["recorded"]["at"]
        self.assertAlmostEqual(found, start + 0.25 * (stop - start), delta=0.02 * (stop - start))
        self.key("space")
        self.wait("it to go on", lambda s: abs(s["recorded"]["at"] - found) > 0.1)
        self.assertTrue(self.state()["force"], "the virtual arm's force is as it was")
        self.key("Escape")
        self.wait("the loop", lambda s: not s["playing"])
        self.assertTrue(self.settled()["force"])
        self.key("space")
        self.wait("force off", lambda s: not s["force"])


if __name__ == "__main__":
    unittest.main()
