"""The Python package without a loop: its use of callers' values, and its reading."""

from __future__ import annotations

import csv
import json
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import tracemalloc
import unittest
import warnings
import xml.etree.ElementTree
from pathlib import Path
from unittest import mock

import h5py
import numpy

from support import ASSETS, LIMPID

PACKAGE = ASSETS / "python"
sys.path.insert(0, str(PACKAGE))
os.environ["LIMPID"] = str(LIMPID)

import limpid  # noqa: E402
from limpid import runs, study  # noqa: E402
from limpid.study import report  # noqa: E402
from limpid.values import hand_rows, settings_of  # noqa: E402

ROWS = 500
PATH = [(0, 0.19, 0, 0), (1, 0.19, 0, -0.05)]


class OfNumpy2(float):
    """A number that prints as numpy's do from version 2 on."""

    def __repr__(self) -> str:
        return f"np.float64({float(self)!r})"


class InAFolder(unittest.TestCase):
    def setUp(self) -> None:
        self.folder = Path(tempfile.mkdtemp(prefix="limpid-python-"))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)


def write_lane(group: h5py.Group, law: int, eta: float, rows: int, changes: list[tuple[int, str]]) -> None:
    group.attrs["config"] = f"coupling.eta = {eta}\n"
    columns = {"time": numpy.arange(rows) / 1000, "coupling/kind": numpy.full(rows, law, "uint8"),
               "coupling/eta": numpy.full(rows, eta),
               "device/position": numpy.arange(3.0 * rows).reshape(rows, 3) + law}
    for name, values in columns.items():
        group[name] = values
        group[name].attrs["unit"] = "s" if name == "time" else "-"
        group[name].attrs["what"] = name
    group["objects/state"] = numpy.zeros((1, 40))
    group["objects/state"].attrs["unit"] = "-"
    group["events/row"] = [row for row, _ in changes]
    group["events/row"].attrs["unit"] = "-"
    group["events/setting"] = numpy.array([text.encode() for _, text in changes])


def write_session(file: Path, rows: int = ROWS, twin: bool = True) -> Path:
    """Writes a session in the format of devices/files/README.md."""
    with h5py.File(file, "w") as out:
        out.attrs.update({"format": "limpid-session", "tick": 0.001, "source": "mouse"})
        write_lane(out, 2, 1.0, rows, [(3, "coupling.eta = 0.5")])
        out["marks/tick"] = [7]
        out["marks/text"] = numpy.array([b"here"])
        out["check/sums"] = numpy.zeros(5)
        if twin:
            write_lane(out.create_group("twin"), 0, 0.7, rows, [(1, "coupling.eta = 0.8"), (2, "coupling.eta = 0.7")])
    return file


class TestSessions(InAFolder):
    def test_a_recording_with_a_twin_has_all_rows_of_both_runs(self) -> None:
        session = limpid.session(write_session(self.folder / "a.h5"))
        self.assertEqual((len(session), len(session.time), session.law), (ROWS, ROWS, "predictive"))
        self.assertEqual(session.changes, [(0.003, "coupling.eta = 0.5")])
        twin = session.twin
        self.assertEqual((len(twin), len(twin.time), twin.law), (ROWS, ROWS, "standard"))
        self.assertEqual((session.config, twin.config), ("coupling.eta = 1.0\n", "coupling.eta = 0.7\n"))
        self.assertEqual(twin.changes, [(0.001, "coupling.eta = 0.8"), (0.002, "coupling.eta = 0.7")])
        self.assertEqual(twin.channels, ["coupling/eta", "coupling/kind", "device/position", "time"])
        self.assertEqual(session.channels, twin.channels + [f"twin/{name}" for name in twin.channels])
        numpy.testing.assert_array_equal(session["device/position"], numpy.arange(3.0 * ROWS).reshape(ROWS, 3) + 2)
        numpy.testing.assert_array_equal(twin["device/position"], numpy.arange(3.0 * ROWS).reshape(ROWS, 3))
        numpy.testing.assert_array_equal(twin["device/position"], session["twin/device/position"])
        self.assertEqual((twin.unit("time"), twin.marks, twin.tick), ("s", [(0.007, "here")], 0.001))
        self.assertIsNone(twin.twin)
        self.assertIsNone(limpid.session(write_session(self.folder / "b.h5", twin=False)).twin)

    def test_memory_is_taken_for_what_is_asked_for(self) -> None:
        rows = 400_000
        file = write_session(self.folder / "long.h5", rows, twin=False)
        tracemalloc.start()
        self.addCleanup(tracemalloc.stop)
        session = limpid.session(file)
        self.assertEqual(len(session), rows)
        self.assertLess(tracemalloc.get_traced_memory()[1], 1e6)
        session.channel("coupling/eta")
        taken = tracemalloc.get_traced_memory()[1]
        self.assertGreater(taken, 8 * rows)
        self.assertLess(taken, 8 * rows + 1e6)

    def test_only_the_channels_that_are_wanted_are_there(self) -> None:
        file = write_session(self.folder / "a.h5")
        session = limpid.session(file, channels=["coupling/eta"])
        self.assertEqual(set(session.channels), {"coupling/eta", "time", "twin/time"})
        self.assertEqual((session.law, len(session["coupling/eta"])), ("predictive", ROWS))
        with self.assertRaisesRegex(limpid.LimpidError, "device/position is no channel"):
            session.channel("device/position")
        self.assertEqual(limpid.session(file, channels="coupling/eta").channels, session.channels)
        for wrong in (["no/such"], [5], 5):
            with self.assertRaises(limpid.LimpidError):
                limpid.session(file, channels=wrong)

    def test_rows_never_come_from_another_file_than_the_one_that_was_opened(self) -> None:
        file = write_session(self.folder / "a.h5")
        session = limpid.session(file)
        session.channel("coupling/eta")
        write_session(self.folder / "b.h5", 9).rename(file)
        with self.assertRaisesRegex(limpid.LimpidError, "open it again"):
            session.channel("device/position")
        self.assertEqual(len(session["coupling/eta"]), ROWS)  # values that were read stay

    def test_a_recording_that_became_complete_meanwhile_is_read_on(self) -> None:
        part = write_session(self.folder / "a.h5.part")
        session = limpid.session(part)
        part.rename(self.folder / "a.h5")
        self.assertEqual(len(session["device/position"]), ROWS)

    def test_a_recording_that_goes_on_has_its_name_already(self) -> None:
        file = self.folder / "a.h5"
        with self.assertRaisesRegex(limpid.LimpidError, r"a\.h5: no such file$"):
            limpid.session(file)
        part = write_session(self.folder / "a.h5.part")
        session = limpid.session(file)
        self.assertEqual(len(session["coupling/eta"]), ROWS)
        part.rename(file)
        self.assertEqual(len(session["device/position"]), ROWS)

    def test_what_is_kept_needs_no_file_any_more(self) -> None:
        file = write_session(self.folder / "a.h5")
        session = limpid.session(file)
        session.keep()
        file.unlink()
        self.assertEqual(len(session.twin["device/position"]), ROWS)


class TestNumbers(InAFolder):
    """Numbers of any package are accepted."""

    def setUp(self) -> None:
        super().setUp()
        program = self.folder / "program"  # notes its words, and records nothing new
        recorded = write_session(self.folder / "recorded.h5")
        program.write_text(f'#!/bin/sh\nfor word in "$@"; do echo "$word"; done >"{self.folder}/words"\n'
                           f'while [ "$1" != --record ]; do shift; done\ncp "{recorded}" "$2"\n')
        program.chmod(0o755)
        patch = mock.patch.dict(os.environ, LIMPID=str(program))
        patch.start()
        self.addCleanup(patch.stop)

    def test_of_a_run_that_gave_energy_come_with_a_warning(self) -> None:
        with h5py.File(self.folder / "recorded.h5", "a") as recorded:
            recorded.attrs["warnings"] = "E_c rose to 15 J\nthe second run: E_c rose to 2 J"
        with self.assertWarnsRegex(limpid.RunWarning, "E_c rose to 15 J"):
            session = limpid.run()
        self.assertEqual(session.warnings, ["E_c rose to 15 J", "the second run: E_c rose to 2 J"])

    def words(self) -> list[str]:
        return (self.folder / "words").read_text().splitlines()

    def test_of_numpy_2_are_numbers_on_the_command_line(self) -> None:
        limpid.run(eta=OfNumpy2(0.5), duration=OfNumpy2(2), coupling__k_vc=OfNumpy2(8), seed=numpy.int64(3),
                   settings={"hand.mass": OfNumpy2(0.1)}, twin={"coupling.eta": OfNumpy2(0.7)})
        self.assertNotIn("np.", " ".join(self.words()))
        for word in ("coupling.eta=0.5", "coupling.k_vc=8.0", "hand.mass=0.1", "coupling.eta=0.7", "2.0", "3"):
            self.assertIn(word, self.words())

    def test_of_numpy_2_are_points_of_a_sweep_and_rows_of_a_hand(self) -> None:
        for point, _ in limpid.sweep({"eta": [OfNumpy2(0.5)]}, hand=[map(OfNumpy2, row) for row in PATH]):
            self.assertIn("coupling.eta=0.5", self.words())
        written = Path(runs.write_hand([map(OfNumpy2, row) for row in PATH], self.folder / "hand.csv"))
        self.assertEqual(written.read_text().splitlines()[1:], ["time_s,x_m,y_m,z_m", "0.0,0.19,0.0,0.0",
                                                                "1.0,0.19,0.0,-0.05"])

    def test_of_numpy_2_are_numbers_in_the_answers_of_a_study(self) -> None:
        run = study.Study("levels", self.folder, numpy.int64(0), study.Simulated(OfNumpy2(45), seed=numpy.int64(3)))
        levels = [OfNumpy2(30), OfNumpy2(60.5)]
        run.two_intervals(study.ConstantStimuli(levels, 2, "a"), "a", OfNumpy2(300), study.Stimulus, "?")
        run.value("a", 0, lambda: (OfNumpy2(1.5), []), OfNumpy2(2.5))
        with open(run.file, newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual({row["level"] for row in rows}, {"30.0", "60.5", "2.5"})
        self.assertEqual((rows[-1]["value"], rows[0]["standard"]), ("1.5", "300.0"))
        self.assertNotIn("np.", run.file.read_text())

    def test_of_every_kind_are_sent_as_json_has_them(self) -> None:
        sent = settings_of({"a": numpy.float32(0.5), "b": numpy.int64(3), "c": numpy.bool_(True), "d": OfNumpy2(2),
                            "e": numpy.array(4), "f": numpy.str_("standard")}, {"coupling__k_vc": 8, "eta": 1})
        self.assertEqual(json.dumps(sent), '{"a": 0.5, "b": 3, "c": true, "d": 2.0, "e": 4, "f": "standard", '
                                           '"coupling.k_vc": 8, "coupling.eta": 1}')

    def test_that_cannot_be_are_refused_in_a_sentence(self) -> None:
        table = mock.Mock(spec=["to_numpy"], to_numpy=lambda: numpy.zeros((2, 3)))
        for hand in (numpy.zeros(4), 5, None, {"a": 1}, table, "text", b"ab", [1, 2], [(0, 0, 0, 0)], [],
                     [(0, 0, 0, 0), (0, 0, 0, 0)], [(0, 0, 0, 0), (1, 0, 0, float("nan"))], numpy.array(3.0)):
            with self.subTest(hand=hand), self.assertRaisesRegex(limpid.ArgumentError, "^hand: "):
                hand_rows(hand)
        for wrong in (lambda: limpid.sweep({"eta": 0.5}), lambda: limpid.sweep({"eta": []}), lambda: limpid.sweep({"eta": "standard"}),
                      lambda: limpid.sweep([1]), lambda: limpid.run(hand=5), lambda: limpid.run(scene=5),
                      lambda: limpid.run(duration="a"), lambda: limpid.run(seed=-1), lambda: limpid.run(seed=1.5),
                      lambda: limpid.run(eta=float("nan")), lambda: limpid.run(eta=[1]), lambda: limpid.run(settings=5),
                      lambda: limpid.run(eta=1, settings={"coupling.eta": 2}), lambda: limpid.run(record=5),
                      lambda: limpid.session(5), lambda: settings_of({3: 4}), lambda: limpid.connect("a\0b"),
                      lambda: study.Study("a", self.folder, "S01", study.Simulated(1.0)),
                      lambda: study.Study("a", self.folder, -1, study.Simulated(1.0)),
                      lambda: study.Study("a/b", self.folder, 0, study.Simulated(1.0)),
                      lambda: study.Study("a", 5, 0, study.Simulated(1.0)),
                      lambda: study.fit([(1.0, True), (1.0, False)] * 9, part=1.5),
                      lambda: study.Staircase(1.0, steps=[]), lambda: study.Staircase(1.0, down=0)):
            with self.assertRaises(limpid.LimpidError):
                wrong()

    def test_of_a_table_go_by_the_names_of_their_columns(self) -> None:
        try:
            import pandas
        except ImportError:
            self.skipTest("needs python3-pandas")
        mixed = pandas.DataFrame({"x_m": [0.19, 0.2], "time_s": [0, 1], "z_m": [0.03, 0.04], "y_m": [0.01, 0.02]})
        self.assertEqual(hand_rows(mixed), [[0, 0.19, 0.01, 0.03], [1, 0.2, 0.02, 0.04]])
        self.assertEqual(hand_rows(pandas.DataFrame([[0, 1, 2, 3], [1, 4, 5, 6]])), [[0, 1, 2, 3], [1, 4, 5, 6]])
        with self.assertRaisesRegex(limpid.ArgumentError, "needed: time_s, x_m, y_m, z_m"):
            hand_rows(mixed.rename(columns={"x_m": "x"}))

    def test_of_an_array_are_levels(self) -> None:
        plan = study.ConstantStimuli(numpy.linspace(1, 2, 2), 1, "a")
        self.assertIn(plan.level, (1.0, 2.0))

    def test_a_hand_that_is_a_generator_leads_all_points_of_a_sweep(self) -> None:
        found = list(limpid.sweep({"eta": (x for x in (0.5, 1))}, hand=(row for row in PATH)))
        self.assertEqual(len(found), 2)
        self.assertEqual([point for point, _ in found], [{"eta": 0.5}, {"eta": 1}])

    def test_any_part_of_the_likelihood_has_an_interval(self) -> None:
        """The interval of 68 % lies within that of 95 %, which follows from chi-square's 3.84."""
        answers = [(1.0, k % 4 > 0) for k in range(40)]
        near, far = study.fit(answers, part=0.68), study.fit(answers)
        self.assertLess(far.low, near.low)
        self.assertLess(near.high, far.high)

    def test_a_threshold_that_the_answers_do_not_bound_is_not_told_as_found(self) -> None:
        found = str(study.fit([(1.0, True)] * 20))
        self.assertIn("not found, below ", found)


HOLDS = ("import sys, time\nfrom limpid import study\n"
         "run = study.Study('held', sys.argv[1], 0, study.Simulated(1.0))\n"
         "run.value('a', 0, lambda: (1.0, []))\nprint('there', flush=True)\ntime.sleep(60)\n")


class TestAnswers(InAFolder):
    """Only one study at a time writes to a participant's answers; these keep their conditions."""

    def study(self, **more) -> study.Study:
        return study.Study("held", self.folder, 0, more.pop("who", study.Simulated(1.0)), **more)

    def held(self) -> subprocess.Popen:
        process = subprocess.Popen([sys.executable, "-c", HOLDS, str(self.folder)], stdout=subprocess.PIPE, text=True,
                                   env={**os.environ, "PYTHONPATH": str(PACKAGE)})
        self.addCleanup(process.communicate)
        self.addCleanup(process.kill)
        self.assertEqual(process.stdout.readline(), "there\n")
        return process

    def test_two_processes_never_share_a_file(self) -> None:
        process = self.held()
        before = (self.folder / "held-000.csv").read_bytes()
        with self.assertRaisesRegex(study.StudyError, f"held-000.csv: process {process.pid} on .*, since 20.* is "
                                                      "writing to it"):
            self.study()
        self.assertEqual((self.folder / "held-000.csv").read_bytes(), before)
        study.Study("held", self.folder, 1, study.Simulated(1.0))  # another participant may be

    def test_what_was_killed_holds_nothing_any_more(self) -> None:
        process = self.held()
        process.send_signal(signal.SIGKILL)
        process.wait()
        self.assertEqual(self.study().value("a", 0, lambda: (9.0, [])), 1.0)

    def test_in_one_process_the_newest_has_the_file(self) -> None:
        first = self.study()
        second = self.study()
        second.value("a", 0, lambda: (1.0, []))
        with self.assertRaisesRegex(study.StudyError, "another study of this program"):
            first.value("a", 0, lambda: (2.0, []))
        self.assertEqual(self.study().value("a", 0, lambda: (9.0, [])), 1.0)

    def test_rows_of_somebody_else_are_noticed_where_there_are_no_locks(self) -> None:
        with mock.patch("fcntl.flock", side_effect=OSError(37, "No locks available")):
            with warnings.catch_warnings(record=True) as said:
                warnings.simplefilter("always")
                run = self.study()
        self.assertIn("knows no locks", str(said[0].message))
        run.value("a", 0, lambda: (1.0, []))
        with open(run.file, "a") as other:
            other.write("of somebody else\n")
        with self.assertRaisesRegex(study.StudyError, "somebody else has written to it"):
            run.value("a", 1, lambda: (2.0, []))

    def test_a_file_that_was_replaced_takes_no_answer_unseen(self) -> None:
        run = self.study()
        copy = self.folder / "copy"
        shutil.copy(run.file, copy)
        copy.rename(run.file)  # as an editor saves it
        with self.assertRaisesRegex(study.StudyError, "removed or replaced"):
            run.value("a", 0, lambda: (1.0, []))

    def test_answers_say_under_what_they_were_given(self) -> None:
        run = self.study(settings={"coupling.eta": OfNumpy2(0.5)}, who=study.Simulated(45.0, lapse=0.1, seed=7))
        run.two_intervals(study.ConstantStimuli([1.0], 1, "a"), "near", 300, study.Stimulus, "Which is stiffer?")
        sheet = json.loads((self.folder / "held-000.json").read_text())
        self.assertEqual((sheet["settings"], sheet["seed"], sheet["questions"]),
                         ({"coupling.eta": 0.5}, 0, {"near": "Which is stiffer?"}))
        self.assertEqual((sheet["truth"]["threshold"], sheet["truth"]["lapse"], sheet["truth"]["seed"]), (45, 0.1, 7))
        self.assertRegex(sheet["provenance"], r"^limpid \S+, settings [0-9a-f]{8}, seed 0, 20\d\d-")
        [sitting] = sheet["sittings"]
        self.assertEqual((sitting["process"], sitting["computer"]), (os.getpid(), os.uname().nodename))
        self.assertEqual(run.rows[0]["block"], "")

    def test_a_study_does_not_go_on_under_other_settings(self) -> None:
        self.study(settings={"coupling.eta": 0.5}).value("a", 0, lambda: (1.0, []))
        with self.assertRaisesRegex(study.StudyError, r"given with coupling.eta = 0.5; now it is 0.7"):
            self.study(settings={"coupling.eta": 0.7})
        with self.assertRaisesRegex(study.StudyError, r"given with coupling.eta = 0.5; now it is not set"):
            self.study()
        with self.assertRaisesRegex(study.StudyError, "truth was "):
            self.study(settings={"coupling.eta": 0.5}, who=study.Simulated(2.0))
        self.study(settings={"coupling.eta": 0.5})
        self.assertEqual(len(json.loads((self.folder / "held-000.json").read_text())["sittings"]), 2)

    def test_another_question_is_another_study(self) -> None:
        self.study().two_intervals(study.ConstantStimuli([1.0], 1, "a"), "a", 3, study.Stimulus, "Stiffer?")
        with self.assertRaisesRegex(study.StudyError, 'the question was "Stiffer\\?"; now it is "Heavier\\?"'):
            self.study().two_intervals(study.ConstantStimuli([1.0], 1, "a"), "a", 3, study.Stimulus, "Heavier?")

    def test_numbers_may_be_written_otherwise_when_it_goes_on(self) -> None:
        for standard in (100, 100.0):
            self.study().two_intervals(study.ConstantStimuli([1], 1, "a"), "a", standard, study.Stimulus, "?")

    def test_blocks_are_numbered(self) -> None:
        run = self.study()
        for condition in run.blocks(["a", "b"]):
            run.value(condition, 0, lambda: (1.0, []))
        self.assertEqual([row["block"] for row in run.rows], ["1", "2"])

    def test_what_a_stimulus_cannot_be_is_the_studys_mistake(self) -> None:
        """The study would end there again, so this is its mistake, unlike the end of a program."""

        def asks_too_much(stimulus: study.Stimulus) -> float:
            raise limpid.ProgramError("friction_static: 1.1 is not allowed; allowed: 0 to 1")

        run = self.study(who=study.Simulated(1.0, lapse=0, percept=asks_too_much))
        with self.assertRaises(study.StudyError) as said:
            run.two_intervals(study.ConstantStimuli([0.8], 1, "a"), "a", 0.3, study.Stimulus, "?")
        self.assertIn("1.1 is not allowed", str(said.exception))
        self.assertIn("change the study", str(said.exception))
        self.assertNotIn("with the same words", str(said.exception))


class TestReports(InAFolder):
    def carry_out(self, participant: int, threshold: float) -> None:
        run = study.Study("wall", self.folder, participant, study.Simulated(threshold, seed=participant))
        answers = {"soft": run.two_intervals(study.ConstantStimuli([0.5, 1.0, 2.0, 4.0], 20, str(participant)), "soft",
                                             10.0, study.Stimulus, "Which one?")}
        report.threshold_report("Walls", self.folder, "N/m", answers, "Two intervals.", "wall", run=run)

    def test_each_participant_has_a_page_and_all_have_one(self) -> None:
        for participant in range(3):
            self.carry_out(participant, 1.0 + participant)
        names = {file.name for file in self.folder.glob("*.html")}
        self.assertEqual(names, {"wall-000.html", "wall-001.html", "wall-002.html", "wall.html"})
        for figure in self.folder.glob("*.svg"):
            about = xml.etree.ElementTree.parse(figure).getroot().find("{http://www.w3.org/2000/svg}desc").text
            self.assertIn("settings ", about)
        found = [report._read_results(self.folder / f"wall-{k:03d}-results.csv")["soft"].threshold for k in range(3)]
        mean, low, high = report.group_report("Walls", self.folder, "threshold [N/m]", "wall")["soft"]
        self.assertAlmostEqual(mean, numpy.exp(numpy.mean(numpy.log(found))), places=9)
        half = 4.303 * numpy.std(numpy.log(found), ddof=1) / numpy.sqrt(3)  # Student's of 2 freedoms
        self.assertAlmostEqual(numpy.log(high / mean), half, delta=0.01 * half)
        self.assertAlmostEqual(numpy.log(mean / low), half, delta=0.01 * half)
        page = (self.folder / "wall.html").read_text()
        for text in ("3 participants: 000, 001, 002", f"{mean:.4g}", "<svg"):
            self.assertIn(text, page)
        self.assertTrue((self.folder / "wall-group.svg").exists())

    def test_a_threshold_that_was_not_found_is_no_part_of_the_mean(self) -> None:
        for participant, value in enumerate(((2.0, 1.0, 4.0), (0.01, 0.0, 0.7), (8.0, 4.0, 16.0))):
            report._write_results(self.folder / f"wall-{participant:03d}-results.csv",
                                  {"soft": study.Fit(*value, 20)})
        mean, _, _ = report.group_report("Walls", self.folder, "threshold [N/m]", "wall")["soft"]
        self.assertAlmostEqual(mean, 4)  # of 2 and 8
        self.assertIn("not found, below 0.7", (self.folder / "wall.html").read_text())

    def test_the_page_of_a_simulated_participant_says_its_truth_and_the_question(self) -> None:
        self.carry_out(1, 3.5)
        page = (self.folder / "wall-001.html").read_text()
        for text in ("The participant was simulated", "differ by 3.5", "Its seed is 1", "Which one?", "limpid ",
                     ", seed 1, "):
            self.assertIn(text, page)


if __name__ == "__main__":
    unittest.main()
