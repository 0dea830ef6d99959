"""The window, led by a program: questions to a person, and things hidden from one."""

from __future__ import annotations

import os
import subprocess
import sys
import threading
import time
import tomllib
import unittest
from pathlib import Path
from unittest import mock

from support import ASSETS, LIMPID
from window import WindowTest

sys.path.insert(0, str(ASSETS / "python"))
os.environ["LIMPID"] = str(LIMPID)

import limpid  # noqa: E402


class TestRemoteWindow(WindowTest):
    def prepare(self) -> None:
        self.words = ["--listen", "test"]
        self.path = self.home / "run/limpid/test.control"

    def start(self) -> None:
        super().start()
        self.loop = limpid.Client(self.path)
        self.addCleanup(self.loop.close)

    def beside(self, work):
        """Runs work on a thread; the returned list gets its result or its error."""
        result: list = []

        def carry_out() -> None:
            try:
                result.append(work())
            except limpid.LimpidError as error:
                result.append(error)

        thread = threading.Thread(target=carry_out, daemon=True)  # it may wait for an answer
        thread.start()
        return result, thread

    def asked(self, *choices: str):
        result, thread = self.beside(lambda: self.loop.ask("Which one is stiffer?", choices))
        self.wait("the question", lambda s: s["dialog"] == "ask" and s["question"])
        self.settled()
        return result, thread

    def keep_picture(self, name: str) -> None:
        """Keeps a picture for people in the folder LIMPID_PICTURES, if that is set."""
        folder = os.environ.get("LIMPID_PICTURES")
        if folder:  # beside the client that may wait for an answer
            with limpid.Client(self.path) as other:
                other.picture(Path(folder, f"{name}.png"), replace=True)

    def test_says_that_it_has_a_window_and_ends_with_it(self) -> None:
        self.assertEqual(self.loop.about["kind"], "window")
        self.assertIn("ask", self.loop.about["verbs"])
        self.stop(self.app)
        with self.assertRaises(limpid.ProgramError):
            self.loop.state()
        self.assertFalse(self.path.exists())

    def test_settings_move_the_sliders_and_the_loop(self) -> None:
        self.loop.set({"coupling.kind": "predictive", "coupling.eta": 0.5})
        self.wait("the setting", lambda s: s["kind"] == 2 and s["eta"] == 0.5)
        self.key("ctrl+z")  # undone like a slider's change
        self.wait("undone", lambda s: s["kind"] == 0)
        self.key("c")
        self.wait("the next law", lambda s: s["kind"] == 1)
        self.assertEqual(self.loop.get("coupling.kind"), {"coupling.kind": "proposed"})

    def test_prints_the_state_that_it_sends(self) -> None:
        sent, printed = self.loop.state(), self.settled()
        self.assertLessEqual(set(sent), set(printed))
        for key in ("arm", "joints", "device", "scene", "file", "objects", "recording", "trouble", "playing",
                    "twin", "blind", "hand"):
            self.assertEqual(printed[key], sent[key], key)

    def test_a_person_answers_with_a_key(self) -> None:
        result, thread = self.asked("the first", "the second")
        self.keep_picture("ask")
        time.sleep(1)
        self.key("2")
        thread.join(20)
        [answer] = result
        self.assertEqual((answer.answer, answer.index), ("the second", 1))
        self.assertGreater(answer.seconds, 0.5)
        self.wait("the question to go", lambda s: not s["asking"])

    def test_a_person_answers_with_the_mouse_and_esc_is_no_answer(self) -> None:
        result, thread = self.asked("the first", "the second")
        self.key("Escape")
        self.key("9")
        state = self.settled()
        self.assertEqual(state["dialog"], "ask")
        self.assertEqual(result, [])
        self.click(*state["question"]["the first"])
        thread.join(20)
        self.assertEqual(result[0].index, 0)

    def test_enter_goes_on_where_there_is_one_answer(self) -> None:
        result, thread = self.asked()
        self.key("Return")
        thread.join(20)
        self.assertEqual(result[0].answer, "Go on")

    def test_space_cuts_the_force_during_a_question(self) -> None:
        result, thread = self.asked("yes", "no")
        self.key("space")
        self.wait("no force", lambda s: not s["force"])
        self.assertEqual(result, [])
        self.key("1")
        thread.join(20)

    def test_a_question_goes_with_whoever_asked(self) -> None:
        other = limpid.Client(self.path)
        result, thread = self.beside(lambda: other.ask("Who?", ["I"], timeout=1))
        self.wait("the question", lambda s: s["dialog"] == "ask")
        thread.join(20)
        self.assertIsInstance(result[0], limpid.ProgramError)
        other.close()
        self.wait("the question to go", lambda s: s["dialog"] == "")

    def test_blind_hides_the_law_and_all_that_changes_it(self) -> None:
        self.loop.set({"coupling.kind": "predictive"})
        self.loop.blind()
        self.wait("blind", lambda s: s["blind"])
        self.settled()
        self.keep_picture("blind")
        for key in ("c", "bracketright", "F2", "n", "ctrl+g", "b", "p", "question", "BackSpace"):
            self.key(key)
        state = self.settled()
        self.assertEqual((state["kind"], state["eta"], state["dialog"], state["twin"]),
                         (2, 1, "", False))
        self.key("space")  # the force is still the person's
        self.wait("no force", lambda s: not s["force"])
        self.keep_picture("blind_force_off")
        self.key("f")
        self.wait("force", lambda s: s["force"])
        self.loop.set({"coupling.kind": "standard"})  # what hides it may change it
        self.wait("the law", lambda s: s["kind"] == 0)
        self.loop.blind(False)
        self.wait("seen", lambda s: not s["blind"])
        self.key("c")
        self.wait("the next law", lambda s: s["kind"] == 1)

    def test_blind_ends_with_the_client(self) -> None:
        other = limpid.Client(self.path)
        other.blind()
        with self.assertRaisesRegex(limpid.RequestError, "another program"):
            self.loop.blind(False)
        other.close()
        self.wait("seen", lambda s: not s["blind"])

    def test_a_question_is_asked_of_a_person_who_sees_nothing_else(self) -> None:
        self.loop.blind()
        result, thread = self.asked("the first", "the second")
        self.keep_picture("ask_blind")
        self.key("1")
        thread.join(20)
        self.assertEqual(result[0].index, 0)

    def test_twin_and_start_over_are_those_of_their_keys(self) -> None:
        self.loop.twin({"coupling.kind": "predictive"})
        self.wait("the twin", lambda s: s["shown_lanes"] == 2)
        self.assertEqual(self.loop.row(["twin/coupling/kind"])["twin/coupling/kind"], 2)
        self.key("b")
        self.wait("no twin", lambda s: s["shown_lanes"] == 1)
        self.loop.start_over()
        self.wait_for_notice("The simulation has started over")

    def test_recordings_have_the_name_that_is_asked_for(self) -> None:
        file = self.loop.record(self.home / "a.h5")
        self.wait("recording", lambda s: s["recording"])
        self.loop.mark("here")
        self.go_on(0.5)
        with self.assertRaisesRegex(limpid.RequestError, "stop the recording first"):
            self.loop.open(scene="spheres.toml")
        done = self.loop.stop()
        self.assertEqual((done["file"], done["dropped"]), (file, 0))
        self.assertEqual(len(limpid.session(file)), done["rows"])
        self.check_rerun_is_the_same(Path(file))
        # A recording begun by a person is ended by the program, and the other way round.
        self.key("r")
        self.wait("recording", lambda s: s["recording"])
        self.assertIn("sessions/session-", self.loop.stop()["file"])
        self.loop.record(self.home / "b.h5")
        self.key("r")
        self.wait("no recording", lambda s: not s["recording"])
        self.assertTrue((self.home / "b.h5").exists())

    def test_a_person_takes_part_in_a_study(self) -> None:
        """A trial of two intervals, each a session; the answer is a row."""
        from limpid import study

        who = study.Person(self.loop, seconds=0.3)
        run = study.Study("window", self.home / "answers", 0, who)
        result, thread = self.beside(lambda: run.two_intervals(
            study.ConstantStimuli([0.2], 1, "a"), "standard", 0.5,
            lambda eta: study.Stimulus(eta, {"coupling.eta": eta}), "Which one is heavier?"))
        for key in ("Return", "Return", "2"):
            self.wait("the question", lambda s: s["dialog"] == "ask" and s["question"])
            self.settled()
            self.keep_picture(f"study_{key}")
            self.key(key)
            self.wait("an answer", lambda s: not s["question"])
        thread.join(20)
        [[(level, right)]] = result
        [row] = run.rows
        self.assertEqual((level, row["answer"], right), (0.2, "the second", row["order"] == "2"))
        etas = [limpid.session(self.home / "answers" / name)["coupling/eta"][0]
                for name in row["sessions"].split()]
        self.assertEqual(etas, [0.5, 0.7] if row["order"] == "2" else [0.7, 0.5])
        self.assertGreater(float(row["seconds"]), 0)

    def test_a_question_beside_the_picture_leaves_the_arm_to_the_hand(self) -> None:
        result, thread = self.beside(lambda: self.loop.ask("Make it as heavy.", ("lighter", "heavier", "the same"),
                                                           beside=True))
        self.wait("the question", lambda s: s["dialog"] == "ask" and s["question"])
        self.hold_tip()
        self.keep_picture("ask_beside")
        self.key("9")  # 9 is no answer
        self.key("Escape")
        self.assertEqual(self.settled()["dialog"], "ask")
        self.assertEqual((result, self.state()["grip"], self.state()["force"]), ([], 1, True))
        self.key("2")
        thread.join(20)
        self.assertEqual((result[0].answer, result[0].index), ("heavier", 1))
        self.assertEqual(self.settled()["grip"], 1)
        self.wait("the question to go", lambda s: not s["asking"])

    def test_what_is_said_for_a_time_goes_by_itself(self) -> None:
        result, thread = self.beside(lambda: self.loop.ask("Feel it now.", beside=True, seconds=2))
        self.wait("the text", lambda s: s["dialog"] == "ask")
        self.key("1")
        self.key("Return")
        self.keep_picture("said_for_a_time")
        thread.join(30)
        self.assertEqual((result[0].answer, result[0].index), ("", -1))
        self.assertGreaterEqual(result[0].seconds, 2)
        self.wait("it to go", lambda s: not s["asking"])
        with self.assertRaisesRegex(limpid.RequestError, "ask: seconds: 0 is not allowed"):
            self.loop.ask("?", seconds=0)
        # An earlier, answered question leaves the arm to the mouse.
        result, thread = self.asked()
        self.key("Return")
        thread.join(20)
        self.beside(lambda: self.loop.ask("Feel it now.", beside=True, seconds=60))
        self.wait("the text", lambda s: s["dialog"] == "ask")
        self.hold_tip()

    def answer(self, key: str) -> None:
        """Answers the present question, or the next one."""
        self.wait("the question", lambda s: s["dialog"] == "ask" and s["question"])
        self.settled()
        asked = self.state()["question"]
        self.key(key)
        self.wait("an answer", lambda s: s["question"] != asked or not s["question"])

    def test_a_person_adjusts_until_it_feels_like_the_reference(self) -> None:
        """A person adjusts by keys, wrong ones among them; each is a row, the trial a session with
        all values."""
        from limpid import study

        run = study.Study("adjust", self.home / "answers", 0, study.Person(self.loop))

        def etas(value: float) -> study.Stimulus:
            return study.Stimulus(value, {"coupling.kind": "predictive", "coupling.eta": value})

        result, thread = self.beside(lambda: run.adjustments(
            "a", etas(0.5), etas, "Make the arm as heavy.", ("lighter", "heavier"), trials=2))
        for key in 2 * ("Return", "2", "3", "Return", "1", "4"):
            for wrong in ("9", "c", "bracketright"):
                self.key(wrong)
            self.keep_picture(f"adjust_{len(run.rows):02d}")
            before = len(run.rows)
            self.wait("the question", lambda s: s["dialog"] == "ask" and s["question"])
            self.settled()
            self.key(key)
            self.wait_until("the key's row", lambda before=before: len(run.rows) > before)
        thread.join(20)
        [[(a, b)]] = result
        self.assertEqual([row["answer"] for row in run.rows], 2 * ["on", "more", "reference", "on", "less", "same"])
        self.assertEqual([row["value"] for row in run.rows if row["value"]], [repr(a), repr(b)])
        for k in range(2):
            rows = run.rows[6 * k : 6 * k + 6]
            [name] = {row["sessions"] for row in rows}
            session = limpid.session(self.home / "answers" / name)
            eta = session["coupling/eta"][:]
            changes = [float(eta[0]), *(float(y) for x, y in zip(eta, eta[1:]) if x != y)]
            self.assertEqual(changes, [float(row["level"]) for row in rows])
            self.assertEqual([text for _, text in session.marks][::3], ["reference"] * 2)
        self.assertTrue(all(float(row["seconds"]) > 0 for row in run.rows))

    def compares(self, run):
        from limpid import study

        return run.two_intervals(study.ConstantStimuli([0.2], 2, "a"), "standard", 0.5,
                                 lambda eta: study.Stimulus(eta, {"coupling.eta": eta}), "Which one is heavier?")

    def check_goes_on(self, cut_off) -> None:
        """Checks that a study cut off in the second trial's recording goes on with that trial."""
        from limpid import study

        answers = self.home / "answers"
        run = study.Study("cut", answers, 0, study.Person(self.loop, seconds=3))
        result, thread = self.beside(lambda: self.compares(run))
        for key in ("Return", "Return", "2", "Return"):
            self.answer(key)
        self.wait("recording", lambda s: s["recording"])
        cut_off()
        thread.join(60)
        [error] = result
        self.assertIsInstance(error, study.StudyError)
        self.assertIn(f"Every answer up to then is in {run.file}", str(error))
        self.assertIn("goes on behind the 1 answers", str(error))
        self.start()
        again = study.Study("cut", answers, 0, study.Person(self.loop, seconds=0.3))
        result, thread = self.beside(lambda: self.compares(again))
        for key in ("Return", "Return", "1"):
            self.answer(key)
        thread.join(20)
        self.assertEqual(len(result[0]), 2)
        self.assertEqual(again.rows[0], run.rows[0])
        for row in again.rows:
            for name in row["sessions"].split():
                self.assertGreater(len(limpid.session(answers / name)), 100)
        self.assertEqual(list(answers.glob("*.part")), [])

    def test_goes_on_after_the_window_was_closed_in_a_trial(self) -> None:
        def close() -> None:
            self.close_by_cross()
            self.wait("the question", lambda s: s["dialog"] == "quit")
            self.settled()
            self.key("Return", closes=True)
            self.app.wait(30)

        self.check_goes_on(close)

    def test_goes_on_after_the_program_was_killed_in_a_trial(self) -> None:
        def kill() -> None:
            self.app.kill()
            self.app.wait(30)

        self.check_goes_on(kill)

    def test_a_disk_that_is_full_is_named_and_the_study_goes_on_where_there_is_room(self) -> None:
        from limpid import study

        answers = self.home / "answers"
        answers.mkdir()

        def mount(*words: str) -> bool:
            return subprocess.run(["mount", "-t", "tmpfs", *words, "tmpfs", answers],
                                  capture_output=True).returncode == 0

        if not mount("-o", "size=900k"):
            self.skipTest("needs to be allowed to mount a small disk")
        self.addCleanup(subprocess.run, ["umount", "-l", answers])
        run = study.Study("full", answers, 0, study.Person(self.loop, seconds=6))
        result, thread = self.beside(lambda: self.compares(run))
        self.answer("Return")
        thread.join(60)
        self.assertIsInstance(result[0], study.StudyError)
        self.assertIn("No space left on device", str(result[0]))
        self.assertIn(f"Every answer up to then is in {run.file}", str(result[0]))
        self.assertTrue(mount("-o", "remount,size=50m"))
        again = study.Study("full", answers, 0, study.Person(self.loop, seconds=0.3))
        result, thread = self.beside(lambda: self.compares(again))
        for key in 2 * ("Return", "Return", "1"):
            self.answer(key)
        thread.join(20)
        self.assertEqual(len(result[0]), 2)
        self.assertEqual(list(answers.glob("*.part")), [])

    def test_a_study_that_was_killed_in_a_trial_goes_on_at_the_same_window(self) -> None:
        """The next study ends the killed one's recording."""
        from limpid import study

        answers = self.home / "answers"
        run = study.Study("cut", answers, 0, study.Person(self.loop, seconds=60))
        self.beside(lambda: self.compares(run))
        self.answer("Return")
        self.wait("recording", lambda s: s["recording"])
        self.loop._socket.shutdown(2)  # as the kernel does for a process that is killed
        self.wait("nothing hidden any more", lambda s: not s["blind"] and not s["asking"])
        self.loop = limpid.Client(self.path)
        self.addCleanup(self.loop.close)
        again = study.Study("cut", answers, 0, study.Person(self.loop, seconds=0.3))
        result, thread = self.beside(lambda: self.compares(again))
        for key in 2 * ("Return", "Return", "1"):
            self.answer(key)
        thread.join(20)
        self.assertEqual(len(result[0]), 2)

    # A program's settings are not kept.

    def kept(self) -> dict:
        """Settings on the disk for the next start."""
        return tomllib.loads((self.home / "config/limpid/settings.toml").read_text())

    def another_leads(self) -> limpid.Client:
        """Another program leads, with settings, a scene and a twin of its own."""
        other = limpid.Client(self.path)
        self.addCleanup(other.close)
        other.open(scene="spheres.toml")
        other.set({"coupling.kind": "predictive", "coupling.eta": 0.5, "device.torque_limit": 0.1, "link.delay": 20})
        other.twin({"coupling.kind": "proposed"})
        self.wait("the program's settings", lambda s: s["led"] and s["kind"] == 2 and s["shown_lanes"] == 2)
        return other

    def check_is_back(self, scene: str) -> None:
        self.wait_for_notice("Your settings are back.")
        self.wait("the person's settings", lambda s: not s["led"] and s["kind"] == 0 and s["eta"] == 1
                  and s["shown_lanes"] == 1 and s["file"] == scene)
        values = self.loop.get()
        self.assertEqual((values["device.torque_limit"], values["link.delay"]), (self.limit, 0))
        self.assertEqual(self.loop.state()["file"], scene)

    def start_of_a_person(self) -> str:
        self.limit = self.loop.get("device.torque_limit")["device.torque_limit"]
        self.assertFalse(self.state()["led"])
        return self.state()["file"]

    def test_settings_and_scene_come_back_when_the_program_ends(self) -> None:
        scene = self.start_of_a_person()
        other = self.another_leads()
        self.assertIn("spheres.toml", self.state()["file"])
        other.close()
        self.check_is_back(scene)
        self.assertIn("The program that controlled this window has ended. Your settings are back.", self.notices())
        self.stop(self.app)
        kept = self.kept()
        self.assertEqual((kept["parameters"]["coupling"]["kind"], kept["window"]["scene"]), ("standard", ""))
        self.assertNotIn("spheres.toml", str(kept["window"]["recent"]))

    def test_settings_come_back_when_a_study_is_killed_that_records(self) -> None:
        scene = self.start_of_a_person()
        other = self.another_leads()
        other.blind()
        file = other.record(self.home / "cut.h5")
        self.go_on(0.3)
        other._socket.shutdown(2)  # as the kernel does for a process that is killed
        self.check_is_back(scene)
        self.assertIn("The study has ended. Your settings are back.", self.notices())
        session = limpid.session(file)  # which is complete
        self.assertEqual(set(session["coupling/kind"]), {2})
        self.assertEqual(session.changes, [])

    def test_nothing_that_a_program_set_is_kept_where_the_window_ends_first(self) -> None:
        for end in (self.app.terminate, self.app.kill):
            with self.subTest(end=end.__name__):
                self.key("bracketright")  # the person's eta
                eta = self.wait("another eta", lambda s: s["eta"] != 1)["eta"]
                self.wait_until("it to be kept", lambda eta=eta: abs(
                    self.kept().get("parameters", {}).get("coupling", {}).get("eta", 1) - eta) < 1e-9)
                self.another_leads()
                self.go_on(5)
                end = self.app.kill if end.__name__ == "kill" else self.app.terminate
                end()
                self.app.wait(30)
                kept = self.kept()
                self.assertEqual((kept["parameters"]["coupling"]["kind"], kept["parameters"]["link"]["delay"],
                                  kept["window"]["scene"]), ("standard", 0, ""))
                self.assertAlmostEqual(kept["parameters"]["coupling"]["eta"], eta)
                settings = self.home / "config/limpid/settings.toml"
                settings.write_text('[parameters]\ncoupling.kind = "standard"\n')
                self.start()

    def test_what_a_person_changes_meanwhile_stays(self) -> None:
        other = limpid.Client(self.path)
        other.set({"coupling.eta": 0.5})
        self.wait("the setting", lambda s: s["eta"] == 0.5)
        self.key("c")
        self.wait("the next law", lambda s: s["kind"] == 1)
        other.close()
        self.wait_for_notice("Your settings are back.")
        self.wait("both", lambda s: s["kind"] == 1 and s["eta"] == 1)

    def test_a_study_begins_from_usual_settings_whatever_was_there(self) -> None:
        from limpid import study

        self.key("b")  # a twin, of the person
        self.wait("the twin", lambda s: s["shown_lanes"] == 2)
        other = limpid.Client(self.path)  # somebody else who leads
        self.addCleanup(other.close)
        other.set({"hand.stiffness": 900, "link.delay": 20, "coupling.eta": 0.6})
        run = study.Study("known", self.home / "answers", 0, study.Person(self.loop, seconds=0.3),
                          {"coupling.kind": "predictive"})
        values = self.loop.get()
        self.assertEqual((values["hand.stiffness"], values["link.delay"], values["coupling.eta"],
                          values["coupling.kind"]), (300, 0, 1, "predictive"))
        self.assertFalse(self.loop.state()["twin"])
        self.assertEqual(run.sheet.has["settings"], values)
        # Each interval begins again from these settings.
        run.who.use({"coupling.eta": 0.7})
        run.who.use({"hand.damping": 3})
        values = self.loop.get()
        self.assertEqual((values["coupling.eta"], values["hand.damping"]), (1, 3))
        with self.assertRaises(study.StimulusError):
            run.who.use({"coupling.eta": -1})

    def test_a_window_that_a_program_has_started_ends_with_it_and_keeps_nothing(self) -> None:
        self.stop(self.app)
        before = self.kept()
        with mock.patch.dict(os.environ, self.environment):
            loop = limpid.serve(window=True, settings={"coupling.eta": 0.6}, hand__stiffness=900)
            self.addCleanup(loop.close)
            self.assertEqual(loop.get("coupling.eta", "hand.stiffness"), {"coupling.eta": 0.6, "hand.stiffness": 900})
            loop.set({"link.delay": 20})
            loop._process.stdin.close()  # as that of a Python that is killed
            loop._process.stdin = None
            loop._process.wait(30)
        after = self.kept()
        self.assertEqual((after.get("twin"), after["window"].get("scene", "")), (before.get("twin"), before["window"].get("scene", "")))
        self.assertEqual(after["parameters"], before["parameters"])

    def test_a_recording_is_replaced_only_when_that_is_said(self) -> None:
        file = self.loop.record(self.home / "a.h5")
        self.loop.stop()
        with self.assertRaisesRegex(limpid.RequestError, "exists already; with force it is replaced"):
            self.loop.record(file)
        first = Path(file).read_bytes()
        self.loop.record(file, force=True)
        self.assertEqual(Path(file).read_bytes(), first, "it stays until the new one is complete")
        self.loop.stop()
        self.assertNotEqual(Path(file).read_bytes(), first)

    def test_scenes_and_sessions_are_opened(self) -> None:
        self.assertEqual(self.loop.open(scene="spheres.toml")["scene"], "Soft and hard")
        self.assertTrue(self.loop.open(session="table.h5")["playing"])
        self.loop.start_over()
        self.wait("live", lambda s: not s["playing"])
        broken = self.home / "broken.toml"
        broken.write_text("[[sphere]]\nradius = -1\n")
        with self.assertRaisesRegex(limpid.RequestError, "broken.toml:1: sphere.center: missing"):
            self.loop.open(scene=broken)

    def test_rows_are_followed_and_pictures_saved(self) -> None:
        self.loop.follow(["coupling/eta"], rate=1000)
        rows = self.loop.rows(seconds=1)
        self.assertEqual({b - a for a, b in zip(rows.ticks, rows.ticks[1:])}, {1})
        self.loop.follow([])
        file = Path(self.loop.picture(self.home / "a.png"))
        self.assertEqual(file.read_bytes()[:4], b"\x89PNG")
        with self.assertRaisesRegex(limpid.RequestError, "exists already"):
            self.loop.picture(file)
        self.loop.picture(file, replace=True)


if __name__ == "__main__":
    unittest.main()
