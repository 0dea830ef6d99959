"""Studies in Python: methods, orders, trials that survive a crash, fits, and the three that come
along, all with simulated participants."""

from __future__ import annotations

import ast
import csv
import math
import os
import random
import shutil
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree
from pathlib import Path

from support import ASSETS, LIMPID

PACKAGE = ASSETS / "python"
sys.path.insert(0, str(PACKAGE))
os.environ["LIMPID"] = str(LIMPID)

import limpid  # noqa: E402
from limpid import study  # noqa: E402
from limpid.study import fits  # noqa: E402
from limpid.study.report import binned, nice_ticks  # noqa: E402


def answers_of(method, who: study.Simulated, chance: random.Random) -> list[tuple[float, bool]]:
    """Answers of a participant with normal errors, drawn independently of the package's own one."""
    found = []
    while not method.done:
        level = method.level
        if chance.random() < who.lapse:
            right = chance.random() < 0.5
        else:
            right = chance.gauss(level, 0) + chance.gauss(0, who.sigma) > chance.gauss(0, who.sigma)
        method.answer(right)
        found.append((level, right))
    return found


def binomial_ends(count: int, chance: float, part: float) -> tuple[int, int]:
    """Numbers of successes with less than this probability beyond them, on either side."""
    mass = [math.comb(count, k) * chance**k * (1 - chance) ** (count - k) for k in range(count + 1)]
    low = next(k for k in range(count + 1) if sum(mass[: k + 1]) > part)
    high = next(k for k in range(count, -1, -1) if sum(mass[k:]) > part)
    return low, high


class TestThresholds(unittest.TestCase):
    """Thresholds of 300 simulated participants with a threshold of 1: the interval contains it for
    95 %. If the true share differed, such a number of hits would come in less than one of a
    thousand tries."""

    RUNS = 300

    def check(self, name: str, make, find) -> None:
        hits, middle = 0, []
        for k in range(self.RUNS):
            who = study.Simulated(1.0, seed=k)
            method = make(k)
            answers = answers_of(method, who, random.Random(f"{name} {k}"))
            found = find(method, answers)
            hits += found.low <= 1 <= found.high
            middle.append(found.threshold)
            self.assertLessEqual(found.low, found.threshold)
            self.assertLessEqual(found.threshold, found.high)
        low, high = binomial_ends(self.RUNS, 0.95, 0.001)
        self.assertTrue(low <= hits <= high, f"{name}: {hits} of {self.RUNS}; allowed: {low} to {high}")
        self.assertAlmostEqual(sorted(middle)[self.RUNS // 2], 1, delta=0.12, msg=name)

    def test_of_staircases(self) -> None:
        self.check("staircase", lambda k: study.Staircase(3.0, trials=80),
                   lambda method, answers: study.fit(answers))

    def test_of_constant_stimuli(self) -> None:
        levels = [0.25, 0.5, 0.75, 1, 1.5, 2, 3]
        self.check("constant", lambda k: study.ConstantStimuli(levels, 12, str(k)),
                   lambda method, answers: study.fit(answers))

    def test_of_quest(self) -> None:
        self.check("quest", lambda k: study.Quest(1.6, trials=60), lambda method, answers: method.found())

    def test_an_interval_has_no_end_where_the_answers_give_none(self) -> None:
        self.assertEqual(study.fit([(1.0, True)] * 20).low, 0)
        self.assertEqual(study.fit([(1.0, False), (1.0, True)] * 10).high, math.inf)
        with self.assertRaisesRegex(ValueError, "at least 5 answers; found: 2"):
            study.fit([(1.0, True)] * 2)
        with self.assertRaisesRegex(ValueError, "above 0"):
            study.fit([(0.0, True)] * 9)

    def test_the_simulated_participant_is_right_as_often_as_it_should(self) -> None:
        who = study.Simulated(2.0, lapse=0.1, seed=1)
        for level in (1.0, 2.0, 4.0):
            right = sum(who.compare([study.Stimulus(5), study.Stimulus(5 + level)], "?", ("1", "2"),
                                    Path(), f"{level} {k}")[0].index for k in range(2000))
            expected = fits.chance_of(level, 2.0, 0.1)
            low, high = study.proportion_interval(right, 2000, 0.999)
            self.assertTrue(low <= expected <= high, f"{level}: {right} of 2000, {expected:.3f}")

    def test_three_quarters_are_right_at_the_threshold(self) -> None:
        self.assertAlmostEqual(fits.chance_of(2.0, 2.0, 0), 0.75)
        self.assertAlmostEqual(fits.chance_of(1e-9, 2.0, 0.1), 0.5)
        self.assertAlmostEqual(fits.chance_of(1e9, 2.0, 0.1), 0.95)


class TestAdjustments(unittest.TestCase):
    """Adjustments of participants for whom a quantity feels like the reference at a known value."""

    def setUp(self) -> None:
        self.folder = Path(tempfile.mkdtemp(prefix="limpid-study-"))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)

    Kind = study.Study

    def pairs(self, who, participant: int, name: str = "t", **more) -> list[tuple[float, float]]:
        run = self.Kind(name, self.folder, participant, who)
        return run.adjustments("a", study.Stimulus(300.0), lambda x: study.Stimulus(x, {"own": 1}), "?", **more)

    @staticmethod
    def who(equal: float, seed: int, threshold: float = 45.0, **more) -> study.Simulated:
        """A participant for whom `equal` feels like the reference of 300."""
        return study.Simulated(threshold, seed=seed, percept=lambda s: s.level * (
            300 / equal if s.settings else 1), **more)

    def test_the_interval_has_the_point_of_equality(self) -> None:
        """The interval contains the point of equality in 95 of 100 studies. If the true share
        differed, such a number of hits would come in less than one of a thousand tries."""

        class Unwritten(study.Study):
            def _append(self, cells):
                """Does nothing: thousands of rows are not wanted."""

        self.Kind = Unwritten
        for equal, trials in ((300.0, 10), (430.0, 10), (200.0, 12)):
            found = [study.equality(self.pairs(self.who(equal, k), k, f"t{equal:g}", trials=trials))
                     for k in range(100)]
            hits = sum(f.low <= equal <= f.high for f in found)
            low, high = binomial_ends(100, 0.95, 0.001)
            self.assertTrue(low <= hits <= high, f"{equal}: {hits} of 100; allowed: {low} to {high}")
            middle = sorted(f.threshold for f in found)[50]
            self.assertAlmostEqual(middle / equal, 1, delta=0.05)
            self.assertEqual({f.trials for f in found}, {trials})

    def test_equality_is_the_mean_of_pairs_with_students_interval(self) -> None:
        """By hand: the logarithms' means are 0, 2 and 4, so 2 with 4.303 * 2 / sqrt(3) on either side."""
        e = math.e
        found = study.equality([(1 / e, e), (e, e**3), (e**4, e**4)])
        half = 4.303 * 2 / math.sqrt(3)
        for value, wanted in ((found.threshold, 2), (found.low, 2 - half), (found.high, 2 + half)):
            self.assertAlmostEqual(math.log(value), wanted, delta=0.06)
        for wrong, why in (([(1.0, 1.0)], "at least 2 pairs"), ([(0.0, 1.0)] * 3, "above 0")):
            with self.assertRaisesRegex(ValueError, why):
                study.equality(wrong)

    def test_each_pair_starts_once_above_and_once_below(self) -> None:
        self.pairs(self.who(300, 1), 1, trials=12, practice=1, around=200.0, spread=3.0)
        starts: dict[str, dict] = {}
        for row in self.rows(1):
            if row["kind"] == "adjust":
                starts.setdefault(row["trial"], row)
        above = [float(row["level"]) > 200 for trial, row in starts.items() if trial != "0"]
        self.assertEqual(len(above), 12)
        self.assertTrue(all(a != b for a, b in zip(above[::2], above[1::2])), above)
        self.assertEqual(len(set(above[::2])), 2)  # either may come first
        for row in starts.values():
            factor = max(float(row["level"]) / 200, 200 / float(row["level"]))
            self.assertTrue(3**0.5 <= factor <= 3, row)
            self.assertEqual(row["order"], "2" if float(row["level"]) > 200 else "1")
        self.assertEqual({row["practice"] for row in self.rows(1) if row["trial"] == "0"}, {"1"})

    def test_each_key_is_a_row_and_trials_begin_with_the_reference(self) -> None:
        keys = ["Go on", "more", "feel the reference again", "Go on", "less", "it feels the same"]
        shown = []

        class Pressing(study.Simulated):
            def adjust(self, what, folder, name):
                shown.append((what.stimulus.level, tuple(what.choices)))
                key = keys[(len(shown) - 1) % len(keys)]
                return super().adjust(what, folder, name)[0]._replace(
                    index=what.choices.index(key), answer=key), [f"{name}.h5"]

        [(a, b)] = self.pairs(Pressing(1.0), 0, trials=2)
        rows = self.rows(0)
        self.assertEqual([row["answer"] for row in rows], 2 * ["on", "more", "reference", "on", "less", "same"])
        self.assertEqual([row["kind"] for row in rows], 2 * ["reference", "adjust", "adjust",
                                                             "reference", "adjust", "adjust"])
        self.assertEqual([float(row["level"]) for row in rows], [level for level, _ in shown])
        self.assertEqual([row["value"] for row in rows if row["value"]], [repr(a), repr(b)])
        first = shown[1][0]
        self.assertEqual([level for level, _ in shown[:6]],
                         [300, first, first * 1.5, 300, first * 1.5, first * 1.5 / math.sqrt(1.5)])
        self.assertEqual({row["sessions"] for row in rows}, {"t-000-a-000.h5", "t-000-a-001.h5"})

    def test_goes_on_within_a_trial_after_a_crash(self) -> None:
        """A study cut off once behind every key asks for each once; all is as without a crash."""
        asked: list[tuple] = []

        class Failing(study.Simulated):
            most = 0

            def adjust(self, shown, folder, name):
                if len(asked) >= self.most:
                    raise Crash
                asked.append((name, shown.step))
                return super().adjust(shown, folder, name)

        who = Failing(45.0)
        for who.most in range(1, 400):
            try:
                crashed = self.pairs(who, 2, trials=4, practice=1)
                break
            except Crash:
                continue
        self.assertEqual(len(asked), len(set(asked)))
        rows = self.rows(2)
        shutil.rmtree(self.folder)
        self.assertEqual(crashed, self.pairs(study.Simulated(45.0), 2, trials=4, practice=1))
        self.assertEqual(rows, self.rows(2))
        self.assertEqual(len(rows), len(asked))

    def test_levels_stay_within_their_limits_and_the_question_says_so(self) -> None:
        texts = []

        class Always(study.Simulated):
            def adjust(self, shown, folder, name):
                texts.append(shown.text)
                self.last = shown.stimulus.level
                return super().adjust(shown, folder, name)[0]._replace(
                    index=0 if len(shown.choices) == 1 or len(texts) % 20 else 3), []

        self.pairs(Always(1.0), 0, trials=2, low=250.0, high=320.0)
        levels = {float(row["level"]) for row in self.rows(0)}
        self.assertEqual((min(levels), max(levels)), (250, 320))
        self.assertIn("? It goes no further.", texts)

    def test_a_trial_without_an_end_is_left_and_its_pair_with_it(self) -> None:
        class Undecided(study.Simulated):
            def adjust(self, shown, folder, name):
                said, sessions = super().adjust(shown, folder, name)
                return (said if "-002" not in name else said._replace(index=0)), sessions

        pairs = self.pairs(Undecided(45.0), 0, trials=6)
        self.assertEqual(len(pairs), 2)
        self.assertEqual(sum(row["trial"] == "2" and row["kind"] == "adjust" for row in self.rows(0)), 100)
        with self.assertRaisesRegex(ValueError, "in pairs"):
            self.pairs(study.Simulated(1.0), 1, trials=3)

    def rows(self, participant: int) -> list[dict]:
        with open(self.folder / f"t-{participant:03d}.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        for row in rows:
            del row["time"]
        return rows


class TestMethods(unittest.TestCase):
    def test_a_staircase_goes_down_after_three_and_up_after_one(self) -> None:
        stairs = study.Staircase(8.0, steps=(2.0,), reversals=3)
        for right, level in ((True, 8), (True, 8), (True, 4), (True, 4), (False, 8), (True, 8), (True, 8),
                             (True, 4), (False, 8)):
            self.assertFalse(stairs.done)
            stairs.answer(right)
            self.assertEqual(stairs.level, level)
        self.assertTrue(stairs.done)
        self.assertEqual(stairs.turned, [4, 8, 4])

    def test_a_staircase_rests_where_it_should(self) -> None:
        """The staircase's reversals are about where 79.4 % are right (Levitt 1971)."""
        found = []
        for k in range(60):
            who = study.Simulated(1.0, lapse=0, seed=k)
            stairs = study.Staircase(3.0, steps=(2.0, 1.4, 1.1), reversals=24, trials=400)
            answers_of(stairs, who, random.Random(k))
            found.append(math.log(stairs.threshold()))
        level = math.exp(sum(found) / len(found))
        self.assertAlmostEqual(fits.chance_of(level, 1.0, 0), 0.5 ** (1 / 3), delta=0.03)

    def test_levels_stay_within_their_limits(self) -> None:
        stairs = study.Staircase(1.0, low=0.5, high=1.5)
        for _ in range(9):
            stairs.answer(False)
        self.assertEqual(stairs.level, 1.5)

    def test_constant_stimuli_are_each_equally_often_and_the_same_for_a_seed(self) -> None:
        def levels(seed: str) -> list[float]:
            plan, found = study.ConstantStimuli([1, 2, 3], 4, seed), []
            while not plan.done:
                found.append(plan.level)
                plan.answer(True)
            return found

        self.assertEqual(sorted(levels("a")), [1] * 4 + [2] * 4 + [3] * 4)
        self.assertEqual(levels("a"), levels("a"))
        self.assertNotEqual(levels("a"), levels("b"))

    def test_what_cannot_be_is_named_with_what_is_allowed(self) -> None:
        for name, allowed, ask in (
            ("guess", "a finite number above 0", lambda: study.Quest("a")),
            ("lapse", "a number from 0 to below 1", lambda: study.Quest(1.0, lapse=1)),
            ("start", "a number above 0, between the limits 2 and 3", lambda: study.Staircase(1.0, low=2, high=3)),
            ("start", "a number above 0", lambda: study.Staircase(None)),
            ("steps", "a list of at least 1 number above 1", lambda: study.Staircase(1.0, steps="ab")),
            ("low", "a finite number from 0 on", lambda: study.Adjustment(1.0, low="a")),
            ("levels", "a list of at least 1 number", lambda: study.ConstantStimuli(3, 1, 1)),
            ("levels", "a list of at least 1 number", lambda: study.ConstantStimuli("abc", 1, 1)),
            ("levels", "a finite number", lambda: study.ConstantStimuli([[1, 2], [3, 4]], 1, 1)),
            ("repeats", "a whole number from 1 on", lambda: study.ConstantStimuli([1], "a", 1)),
            ("answers", "a list of pairs", lambda: study.fit(3)),
            ("answers, pair 1", "a level and", lambda: study.fit("abc".split())),
            ("level", "a finite number above 0", lambda: study.equality([(1, 0), (1, 2)])),
            ("count", "a whole number from 1 on", lambda: study.latin_square("a")),
            ("conditions", "a list", lambda: study.order_for(0, 3)),
            ("right", "a whole number from 0 on", lambda: study.proportion_interval("a", 2)),
            ("values", "a list of at least 2 numbers", lambda: study.mean_interval("abc")),
        ):
            with self.subTest(name=name), self.assertRaisesRegex(
                    limpid.LimpidError, f"^{name}: .* is not allowed; allowed: {allowed}"):
                ask()

    def test_a_threshold_is_found_of_one_who_never_slips(self) -> None:
        answers = [(level, right) for level in (0.1, 1.0, 100.0) for right in (True, True, level > 1)]
        self.assertLess(study.fit(answers, lapse=0).threshold, 10)
        quest = study.Quest(1.0, lapse=0, low=100.0)
        quest.answer(False)
        self.assertEqual(quest.level, 100)

    def test_an_adjustment_comes_near_and_ends_when_it_is_the_same(self) -> None:
        adjusted = study.Adjustment(4.0)
        while not adjusted.done:
            off = math.log(adjusted.level)
            adjusted.answer("same" if abs(off) < 0.03 else "more" if off < 0 else "less")
        self.assertAlmostEqual(adjusted.level, 1, delta=0.04)
        with self.assertRaisesRegex(ValueError, "allowed: more, less, same"):
            study.Adjustment(1.0).answer("perhaps")

    def test_orders_are_balanced_for_what_comes_before(self) -> None:
        for count in range(1, 9):
            orders = study.latin_square(count)
            self.assertEqual(len(orders), count if count % 2 == 0 else 2 * count)
            places = [[order.index(c) for order in orders] for c in range(count)]
            self.assertTrue(all(sorted(place) == sorted(places[0]) for place in places), count)
            pairs = [pair for order in orders for pair in zip(order, order[1:])]
            self.assertEqual(len({pairs.count(pair) for pair in pairs}), 1 if count > 1 else 0)
            self.assertEqual(len(set(pairs)), count * (count - 1))

    def test_intervals_of_a_mean_are_students(self) -> None:
        """Values of tables: 97.5 % at 4, 9 and 30 degrees of freedom."""
        for freedom, table in ((1, 12.706), (2, 4.303), (4, 2.776), (9, 2.262), (30, 2.042)):
            self.assertAlmostEqual(fits._student(freedom), table, delta=0.01 * table)
        self.assertEqual(study.mean_interval([1.0, 1.0, 1.0]), (1, 1, 1))

    def test_intervals_of_a_proportion_are_wilsons(self) -> None:
        """Values of Newcombe (1998), table I: 81 of 263 and 0 of 20."""
        for right, of, low, high in ((81, 263, 0.2553, 0.3662), (0, 20, 0, 0.1611)):
            found = study.proportion_interval(right, of)
            self.assertAlmostEqual(found[0], low, places=4)
            self.assertAlmostEqual(found[1], high, places=4)


class Crash(Exception):
    """A crash of the program that runs the study."""


class TestTrials(unittest.TestCase):
    def setUp(self) -> None:
        self.folder = Path(tempfile.mkdtemp(prefix="limpid-study-"))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)

    def carry_out(self, who, participant: int = 3) -> study.Study:
        run = study.Study("test", self.folder, participant, who)
        for condition in run.blocks(["a", "b"]):
            run.two_intervals(study.Staircase(2.0, trials=12), condition, 5.0,
                              lambda value: study.Stimulus(value), "?", practice=2, pause_every=5)
            run.question("How was it?", ["good", "bad"], condition)
        return run

    def test_goes_on_after_a_crash_without_losing_an_answer(self) -> None:
        """A study cut off once behind every answer asks for each of them once, and all is as
        without a crash."""
        asked: list[str] = []

        class Failing(study.Simulated):
            def compare(self, stimuli, question, choices, folder, name):
                if len(asked) >= self.most:
                    raise Crash
                asked.append(name)
                return super().compare(stimuli, question, choices, folder, name)

        who = Failing(1.0)
        for who.most in range(1, 40):
            try:
                self.carry_out(who)
                break
            except Crash:
                continue
        self.assertEqual(len(asked), len(set(asked)))
        rows = self.rows(3)
        shutil.rmtree(self.folder)
        self.carry_out(study.Simulated(1.0))
        self.assertEqual(rows, self.rows(3))
        self.assertEqual(len(rows), 2 * (12 + 2 + 1))

    def rows(self, participant: int) -> list[dict]:
        with open(self.folder / f"test-{participant:03d}.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        for row in rows:
            del row["time"]
        return rows

    def test_half_a_row_is_no_answer(self) -> None:
        self.carry_out(study.Simulated(1.0))
        file = self.folder / "test-003.csv"
        whole, rows = file.read_bytes(), self.rows(3)
        for cut in (1, 10, 40):
            file.write_bytes(whole[:-cut])
            self.carry_out(study.Simulated(1.0))
            self.assertEqual(self.rows(3), rows)
        file.write_bytes(b"study,parti")
        self.carry_out(study.Simulated(1.0))
        self.assertEqual(self.rows(3), rows)

    def test_a_study_that_is_another_one_by_now_says_so(self) -> None:
        self.carry_out(study.Simulated(1.0))
        run = study.Study("test", self.folder, 3, study.Simulated(1.0))
        with self.assertRaisesRegex(study.StudyError, "test-003.csv: row 1: .* needed: "):
            run.two_intervals(study.Staircase(7.0), "a", 5.0, study.Stimulus, "?")
        (self.folder / "test-004.csv").write_text("a,b\n1,2\n")
        with self.assertRaisesRegex(study.StudyError, "other columns"):
            study.Study("test", self.folder, 4, study.Simulated(1.0))

    def test_both_orders_come_and_practice_does_not_count(self) -> None:
        self.carry_out(study.Simulated(1.0))
        rows = [row for row in self.rows(3) if row["kind"] == "2ifc"]
        self.assertEqual({row["order"] for row in rows}, {"1", "2"})
        self.assertEqual([row["practice"] for row in rows[:3]], ["1", "1", "0"])
        self.assertEqual({row["level"] for row in rows if row["practice"] == "1"}, {"2.0"})

    def test_one_who_perceives_everything_is_always_right_in_either_order(self) -> None:
        self.carry_out(study.Simulated(1e-9, lapse=0))
        rows = [row for row in self.rows(3) if row["kind"] == "2ifc"]
        self.assertEqual({row["correct"] for row in rows}, {"1"})
        self.assertEqual({(row["order"], row["answer"]) for row in rows},
                         {("1", "the first"), ("2", "the second")})

    def test_participants_meet_conditions_in_balanced_orders(self) -> None:
        orders = []
        for participant in range(2):
            self.carry_out(study.Simulated(1.0), participant)
            orders.append(list(dict.fromkeys(row["condition"] for row in self.rows(participant))))
        self.assertEqual(sorted(orders), [["a", "b"], ["b", "a"]])


class TestStudies(unittest.TestCase):
    def setUp(self) -> None:
        self.folder = Path(tempfile.mkdtemp(prefix="limpid-study-"))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)

    def run_study(self, name: str, *words: str) -> str:
        environment = {**os.environ, "PYTHONPATH": str(PACKAGE)}
        done = subprocess.run([sys.executable, "-m", f"limpid.studies.{name}", "--out", self.folder,
                               "--simulate", *words], text=True, capture_output=True,
                              env=environment, timeout=280)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout

    def check_report(self, name: str) -> None:
        page = (self.folder / f"{name}.html").read_text()
        self.assertIn("<table>", page)
        for figure in self.folder.glob("*.svg"):
            xml.etree.ElementTree.parse(figure)
            self.assertNotIn("nan", figure.read_text())

    def test_stiffness_is_told_apart_worse_under_the_standard_coupling(self) -> None:
        """The coupling's spring is in series with the wall: a wall of 300 N/m feels like one of
        132."""
        printed = self.run_study("stiffness", "--trials", "40")
        found = {line.split(":")[0].strip(): float(line.split(":")[1].split()[0])
                 for line in printed.splitlines()}
        self.assertGreater(found["standard"], 2 * found["predictive"])
        self.assertGreater(found["standard"], 2 * found["proposed"])
        self.check_report("stiffness")
        self.assertEqual(self.run_study("stiffness", "--trials", "40"), printed)  # the same answers

    def test_a_difference_of_inertia_is_found(self) -> None:
        self.assertIn("eta: 0.", self.run_study("inertia", "--trials", "20"))
        self.check_report("inertia")

    def test_placing_takes_longer_with_the_standard_coupling(self) -> None:
        printed = self.run_study("placing", "--repeats", "6")
        rate = {line.split(":")[0].strip(): float(line.split(":")[1].split()[0])
                for line in printed.splitlines()}
        self.assertLess(rate["standard"], rate["proposed"])
        self.assertLess(rate["standard"], rate["predictive"])
        self.check_report("placing")
        self.assertEqual(len(list(self.folder.glob("*.h5"))), 36)

    def test_an_arm_as_heavy_as_under_another_law_is_found(self) -> None:
        """The found eta is that of runs of the loop with the same inertia."""
        from limpid.studies.inertia import felt

        printed = self.run_study("weight", "--pairs", "6")
        scene = (self.folder / "nothing.toml").resolve()
        for line in printed.splitlines():
            law, words = line.split(":")
            low, high = (float(x) for x in words.split("(")[1].split(",")[0].split(" to "))
            wanted = felt(law.strip(), 1.0, scene)
            self.assertLess(felt("predictive", low, scene), wanted, line)
            self.assertGreater(felt("predictive", high, scene), wanted, line)
        self.check_report("weight")
        self.assertEqual(self.run_study("weight", "--pairs", "6"), printed)  # the same answers

    def test_a_person_places_from_the_first_ball_to_the_place_or_once_more(self) -> None:
        """A person places again; the test plays the window's part. Each recording is a run, of
        which only the last one counts."""
        import limpid
        from limpid.studies import placing

        scene, out = placing.scene_in(self.folder), self.folder / "a.h5"
        first, place, press = placing.START, placing.START + 0.02, placing.PRESSED
        ways = [((place, 0.0), (place, 0.0)), ((first, press), (first, press)), ((first, press), (place, press))]

        class Loop:
            texts: list[str] = []

            def ask(self, text, **how):
                self.texts.append(text)
                return limpid.client.Answer("Go on", 0, 1.5, 0)

            def record(self, file):
                (x, z), (to_x, to_z) = ways.pop(0)
                # A hand that begins inside of the table would not feel it.
                limpid.run(scene=scene, coupling="predictive", record=file, hand=[
                    (0, x, 0, max(z, -0.039)), (0.2, x, 0, z), (1, x, 0, z), (2, to_x, 0, to_z), (3, to_x, 0, to_z)])

            def stop(self):
                """Ends the run, which is complete."""

        self.assertEqual(placing.person(Loop(), 0.02, out), 1.5)
        wrong = [text for text in Loop.texts if "Once more" in text]
        self.assertEqual(len(wrong), 2, Loop.texts)
        self.assertIn("It began 20.0 mm off the ball, 40.0 mm above the table; allowed: 4 and 2 mm", wrong[0])
        self.assertIn("It ended 20.0 mm off the place; allowed: 1 mm", wrong[1])
        self.assertEqual(ways, [])

    def test_studies_are_short(self) -> None:
        for script in (PACKAGE / "limpid/studies").glob("[a-z]*.py"):
            self.assertLess(len(script.read_text().splitlines()), 120, script.name)


class TestTrouble(unittest.TestCase):
    """Faults are reported in a sentence that names the file, and no answer is lost."""

    def setUp(self) -> None:
        self.folder = Path(tempfile.mkdtemp(prefix="limpid-study-"))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)
        self.environment = {**os.environ, "PYTHONPATH": str(PACKAGE), "XDG_RUNTIME_DIR": str(self.folder)}

    def run_code(self, code: str) -> subprocess.CompletedProcess:
        return subprocess.run([sys.executable, "-c", code, self.folder], text=True, capture_output=True,
                              env=self.environment, timeout=120)

    def start(self, *words: str) -> str:
        """Output of a study that ends at once."""
        done = subprocess.run([sys.executable, "-m", "limpid.studies.stiffness", *words], text=True,
                              capture_output=True, env=self.environment, timeout=120)
        self.assertNotEqual(done.returncode, 0)
        self.assertNotIn("Traceback", done.stderr)
        return done.stderr

    STUDY = ("import resource, sys\n"
             "from limpid import study\n"
             "def main():\n"
             "    {before}\n"
             "    run = study.Study('full', sys.argv[1], 0, study.Simulated(1.0))\n"
             "    print(len(run.two_intervals(study.Staircase(2.0, trials=30, reversals=99), 'a', 5.0,\n"
             "                                study.Stimulus, '?')))\n"
             "study.carry_out(main)\n")

    def test_a_disk_that_is_full_loses_no_answer(self) -> None:
        """A limit of file size stands for a full disk: only a row's beginning is written."""
        full = self.run_code(self.STUDY.format(before="resource.setrlimit(resource.RLIMIT_FSIZE, (900, 900))"))
        self.assertEqual(full.returncode, 1)
        self.assertNotIn("Traceback", full.stderr)
        file = self.folder / "full-000.csv"
        self.assertIn(f"{file}: ", full.stderr)
        kept = file.read_bytes()
        self.assertTrue(kept.endswith(b"\n"))
        answers = kept.count(b"\n") - 1
        self.assertIn(f"goes on behind the {answers} answers", full.stderr)
        again = self.run_code(self.STUDY.format(before="pass"))
        self.assertEqual(again.stdout.strip(), "30", again.stderr)
        self.assertTrue(file.read_bytes().startswith(kept))

    def test_what_cannot_be_written_beside_the_answers_is_said_in_a_sentence(self) -> None:
        full = self.run_code("from pathlib import Path\nfrom limpid import study\n"
                             "study.carry_out(lambda: Path('/dev/full').write_text('a'))")
        self.assertEqual(full.returncode, 1)
        self.assertIn("a file in the folder of --out: No space left on device. Every answer", full.stderr)
        self.assertNotIn("Traceback", full.stderr)

    def test_a_folder_that_cannot_be_written_is_named(self) -> None:
        file = self.folder / "file"
        file.write_text("")
        for folder in (file, file / "below", Path("/proc/limpid")):
            said = self.start("--out", str(folder), "--simulate")
            self.assertIn(f"{folder}: answers cannot be written there: ", said)
            self.assertIn("choose another folder", said)

    def test_a_program_that_does_not_listen_is_named(self) -> None:
        said = self.start("--out", str(self.folder), "--connect", "nobody")
        self.assertIn("limpid/nobody.control: ", said)
        self.assertIn("start `limpid --listen`", said)

    def test_numbers_that_cannot_be_are_refused(self) -> None:
        self.assertIn("--participant: -1 is not allowed", self.start("--out", str(self.folder),
                                                                     "--participant", "-1"))
        self.assertIn("--trials: 4 is not allowed; allowed: a number from 5 on",
                      self.start("--out", str(self.folder), "--trials", "4"))


class TestPackage(unittest.TestCase):
    def test_is_written_in_the_python_that_it_promises(self) -> None:
        for file in (PACKAGE / "limpid").rglob("*.py"):
            ast.parse(file.read_text(), str(file), feature_version=(3, 9))

    def test_leads_a_program_with_the_standard_library_alone(self) -> None:
        """Without numpy, h5py and scipy the package is imported, and names what reading a session
        needs."""
        code = ("import sys\n"
                "for name in ('numpy', 'h5py', 'scipy'): sys.modules[name] = None\n"
                "import limpid, limpid.study\n"
                "try: limpid.session('a.h5')\n"
                "except limpid.LimpidError as error: print(error)\n")
        said = subprocess.run([sys.executable, "-c", code], check=True, text=True, capture_output=True,
                              env={**os.environ, "PYTHONPATH": str(PACKAGE)}).stdout
        self.assertIn("sessions are read with h5py and numpy; h5py is missing", said)


class TestFigures(unittest.TestCase):
    def test_ticks_are_round_numbers_within_the_axis(self) -> None:
        self.assertEqual(nice_ticks(0, 1, 5), [0, 0.2, 0.4, 0.6, 0.8, 1.0])
        self.assertEqual(nice_ticks(0.3, 1.0, 6), [0.4, 0.6, 0.8, 1.0])
        self.assertTrue(all(-3 <= tick <= 47 for tick in nice_ticks(-3, 47)))

    def test_groups_of_levels_have_all_answers(self) -> None:
        answers = [(random.Random(k).random(), k % 3 > 0) for k in range(50)]
        groups = binned(answers)
        self.assertEqual(sum(of for _, _, of in groups), 50)
        self.assertEqual(sum(right for _, right, _ in groups), sum(right for _, right in answers))
        self.assertLessEqual(len(groups), 7)


if __name__ == "__main__":
    unittest.main()
