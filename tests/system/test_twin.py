"""Two and three runs on one hand: from the command line, and in the window."""

import json
import unittest

import h5py
import numpy

from support import WithAnArm, limpid
from window import WindowTest


class Headless(WithAnArm):
    def test_standard_drifts_beside_the_chosen_law_on_one_hand(self) -> None:
        out = self.record(*self.arm, "--coupling", "predictive", "--twin")
        with h5py.File(out) as file:
            self.assertEqual(set(file["coupling/kind"][...]), {2})
            self.assertEqual(set(file["twin/coupling/kind"][...]), {0})
            numpy.testing.assert_array_equal(file["hand/target"], file["twin/hand/target"])

            def error(run: h5py.Group) -> float:
                apart = run["device/position"][...] - run["proxy/position"][...]
                return numpy.linalg.norm(apart, axis=1).max()

            self.assertGreater(error(file["twin"]), 20 * error(file))
            self.assertIn("standard", file["twin"].attrs["config"])
        said = limpid("info", out).out
        self.assertIn("two runs with the same hand", said)
        table = self.out(".csv")
        self.assertEqual(limpid("info", out, "--csv", table).status, 0)
        self.assertIn("twin_device_position_1_rad", table.open().readline())

    def test_any_pair_comes_again_bit_for_bit(self) -> None:
        first = self.record(*self.arm, "--coupling", "predictive", "--twin", "coupling.eta=0.3",
                            "coupling.band=4")
        again = self.record("--hand", first)
        with h5py.File(first) as a, h5py.File(again) as b:
            for name in ("device/position", "proxy/contact_torque", "energy/port"):
                for run in ("", "twin/"):
                    numpy.testing.assert_array_equal(a[run + name], b[run + name])
            self.assertEqual(set(b["twin/coupling/eta"][...]), {0.3})

    def test_three_laws_are_led_by_one_hand_and_come_again_bit_for_bit(self) -> None:
        first = self.record(*self.arm, "--coupling", "predictive", "--twin", "--lane3")
        again = self.record("--hand", first)
        with h5py.File(first) as a, h5py.File(again) as b:
            laws = [set(a[run + "coupling/kind"][...]) for run in ("", "twin/", "lane3/")]
            self.assertEqual(laws, [{2}, {0}, {1}])
            for run in ("twin/", "lane3/"):
                numpy.testing.assert_array_equal(a["hand/target"], a[run + "hand/target"])
                for name in ("device/position", "proxy/contact_torque", "energy/port"):
                    numpy.testing.assert_array_equal(a[run + name], b[run + name])
        said = limpid("info", first).out
        self.assertIn("three runs with the same hand", said)
        table = self.out(".csv")
        self.assertEqual(limpid("info", first, "--csv", table).status, 0)
        self.assertIn("lane3_device_position_1_rad", table.open().readline())
        summary = json.loads(limpid("info", first, "--json").out)
        self.assertEqual(len(summary["runs"]), 3, summary)

    def test_a_third_run_needs_a_second_one(self) -> None:
        result = limpid("run", *self.arm, "--lane3")
        self.assertEqual(result.status, 2, result)
        self.assertIn("--lane3: needs --twin as well", result.err)

    def test_the_picture_of_an_unstable_run_is_of_before(self) -> None:
        image = self.out(".png")
        result = limpid("run", *self.arm, "--twin", "--set", "coupling.k_vc=10000",
                        "--set", "loop.tick=0.01",
                        "--picture", image)
        self.assertEqual(result.status, 1, result)
        self.assertTrue(image.exists(), result)

    def test_a_device_has_no_further_runs(self) -> None:
        for option in ("--twin", "--lane3"):
            result = limpid("run", "--live", "--yes", option)
            self.assertEqual(result.status, 2, result)
            self.assertIn(f"{option}: not together with --live", result.err)

    def test_what_is_no_setting_is_refused_before_anything_is_written(self) -> None:
        for wrong in ("coupling.etta=1", "coupling.eta=-1", "loop.tick=0.002"):
            with self.subTest(wrong):
                out = self.out()
                result = limpid("run", *self.arm, "--twin", wrong, "--record", out)
                self.assertEqual(result.status, 2, result)
                self.assertFalse(out.exists() or self.part(out).exists())


class Window(WindowTest):
    LAW = "predictive"

    def test_b_sets_two_couplings_beside_each_other_and_records_both(self) -> None:
        self.assertFalse(self.state()["twin"])
        self.key("b")
        self.wait("the twin", lambda s: s["shown_lanes"] == 2)
        x, y = self.hold_tip()  # in the left half
        self.key("r")
        self.wait("recording", lambda s: s["recording"])
        for step in range(60):
            self.move(x, y + 3 * step)
        pressed = self.wait("standard to drift",
                            lambda s: s["twin_error"] > 0.01 and s["error"] < 1e-3)
        self.assertGreater(pressed["contact"], 0)
        self.key("b")
        self.wait_for_notice("Stop the recording")
        self.go_on(1)  # enough rows to compare, on a fast computer, too
        self.key("r")
        self.wait("the end", lambda s: not s["recording"])
        self.xdotool("mouseup", "1")
        sessions = self.home / "data/limpid/sessions"
        self.wait_until("the session", lambda: list(sessions.glob("*.h5")))
        session = max(sessions.glob("*.h5"))
        with h5py.File(session) as file:
            self.assertEqual(len(file["twin/time"]), len(file["time"]))
        self.check_rerun_is_the_same(session)
        self.key("p")
        self.wait("playback of both", lambda s: s["playing"] and s["shown_lanes"] == 2)

    def test_ctrl_b_adds_a_third_coupling_which_is_recorded_and_played(self) -> None:
        self.key("ctrl+b")
        self.wait("two runs", lambda s: s["shown_lanes"] == 2)
        self.key("ctrl+b")
        self.wait("three runs", lambda s: s["shown_lanes"] == 3)
        self.key("ctrl+b")
        self.wait_for_notice("At most three runs")
        x, y = self.hold_tip()
        self.key("r")
        self.wait("recording", lambda s: s["recording"])
        for step in range(40):
            self.move(x, y + 3 * step)
        self.go_on(1)
        self.key("r")
        self.wait("the end", lambda s: not s["recording"])
        self.xdotool("mouseup", "1")
        sessions = self.home / "data/limpid/sessions"
        self.wait_until("the session", lambda: list(sessions.glob("*.h5")))
        session = max(sessions.glob("*.h5"))
        with h5py.File(session) as file:
            laws = [file[run + "coupling/kind"][0] for run in ("", "twin/", "lane3/")]
            self.assertEqual(len(set(laws)), 3, laws)
            for run in ("twin/", "lane3/"):
                numpy.testing.assert_array_equal(file["hand/target"], file[run + "hand/target"])
        self.check_rerun_is_the_same(session)
        self.key("p")
        self.wait("playback of all", lambda s: s["playing"] and s["shown_lanes"] == 3)
        self.key("shift+b")
        self.wait("one picture", lambda s: s["overlaid"])
        self.key("BackSpace")
        self.wait("live", lambda s: not s["playing"] and s["shown_lanes"] == 3)
        self.key("ctrl+shift+b")
        self.wait("two runs", lambda s: s["shown_lanes"] == 2)
        self.key("b")
        self.wait("one run", lambda s: s["shown_lanes"] == 1)


if __name__ == "__main__":
    unittest.main()
