#!/usr/bin/python3
"""All experiments, carried out; their promises are pinned here."""

from __future__ import annotations

import json
import math
import operator
import shutil
import subprocess
import sys
import unittest
from pathlib import Path

from support import LIMPID, ROOT, SystemTest, limpid

HOLDS = {"at most": operator.le, "at least": operator.ge}

# What each experiment checks, in order: words, relation and bound of each check.
PROMISES = json.loads((ROOT / "tests/support/promises.json").read_text())
# Promise of every experiment.
for promises in PROMISES.values():
    promises.append(("number of diverged trials, among the trials that must not diverge", "at most", 0))


class AllExperiments(SystemTest):
    @classmethod
    def setUpClass(cls) -> None:
        super().setUpClass()
        cls.out = cls.directory / "all"
        cls.result = limpid("experiment", "all", "--out", cls.out, timeout=900)

    def verdict(self, name: str) -> dict:
        return json.loads((self.out / f"{name}.json").read_text())

    def test_all_of_them_pass(self) -> None:
        self.assertEqual((self.result.status, self.result.err), (0, ""), self.result.out)
        for name in PROMISES:
            self.assertIn(f"{name}: passed\n", self.result.out)
            self.assertIs(self.verdict(name)["passed"], True)

    def test_each_promises_what_is_written_here_and_nothing_less(self) -> None:
        self.assertEqual({path.stem for path in self.out.glob("*.json")}, set(PROMISES))
        for name, promised in PROMISES.items():
            with self.subTest(name):
                checks = self.verdict(name)["checks"]
                self.assertEqual([c["what"] for c in checks], [what for what, *_ in promised])
                for check, (what, relation, bound) in zip(checks, promised):
                    self.assertEqual(check["relation"], relation, what)
                    self.assertAlmostEqual(check["bound"], bound, delta=1e-12, msg=what)

    def test_every_caption_says_the_motors_limit_and_all_other_conditions(self) -> None:
        for name in PROMISES:
            caption = self.verdict(name)["caption"]
            for words in ("Conditions: arm ", "limit of every motor: ", "grip ", "in the hand",
                          "encoders", "delay", "tick "):  # fmt: skip
                self.assertIn(words, caption, name)

    def test_every_verdict_is_that_of_value_and_bound(self) -> None:
        for name, promised in PROMISES.items():
            for check, (what, relation, bound) in zip(self.verdict(name)["checks"], promised):
                with self.subTest(what):
                    self.assertTrue(math.isfinite(check["value"]))
                    if relation == "measured":  # a known fault spoils the row, or no theory judges it
                        self.assertIsNone(check["passed"])
                        self.assertTrue(check["unjudged"])
                    else:
                        self.assertIs(check["passed"], HOLDS[relation](check["value"], bound))

    def test_each_leaves_its_files_and_a_report_of_all(self) -> None:
        for name in PROMISES:
            for end in ("csv", "png", "svg"):
                self.assertGreater((self.out / f"{name}.{end}").stat().st_size, 0)
        self.assertIn(f"{len(PROMISES)} of {len(PROMISES)} experiments passed", (self.out / "report.html").read_text())
        self.assertEqual([*self.out.rglob("*.part"), *self.out.rglob("*.gnuplot")], [])


class ThePapersTable(SystemTest):
    def test_of_an_ideal_arm_and_a_touch_is_the_one_that_is_printed(self) -> None:
        script = ROOT / "assets/python/paper_table.py"
        done = subprocess.run([sys.executable, script, LIMPID, self.directory], capture_output=True, text=True, timeout=900)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertGreater(len(done.stdout.splitlines()), 10)
        page = (ROOT / "app/experiments/README.md").read_text()
        self.assertIn(done.stdout, page)


class AFailingCheck(SystemTest):
    """The program with other assets: the arm's joints have friction, so the human torque is not
    proportional to eta."""

    def installed(self) -> Path:
        program = self.directory / "bin/limpid"
        program.parent.mkdir()
        shutil.copy(LIMPID, program)
        data = self.directory / "share/limpid"
        shutil.copytree(ROOT / "assets", data / "assets", ignore=shutil.ignore_patterns("*.h5"))
        shutil.copytree(ROOT / "shaders", data / "shaders")
        arm = data / "assets/devices/omni.urdf"
        text = arm.read_text()
        self.assertIn('friction="0"', text)
        arm.write_text(text.replace('friction="0"', 'friction="0.05"'))
        return program

    def test_gives_status_one_and_is_named(self) -> None:
        out = self.directory / "out"
        done = subprocess.run([self.installed(), "experiment", "inertia", "--out", out],
                              capture_output=True, text=True, timeout=300)  # fmt: skip
        self.assertEqual(done.returncode, 1, done.stderr)
        verdict = json.loads((out / "inertia.json").read_text())
        self.assertIs(verdict["passed"], False)
        failed = [check for check in verdict["checks"] if not check["passed"]]
        self.assertTrue(failed)
        for check in failed:
            self.assertGreater(check["value"], check["bound"])
            self.assertIn(f"FAIL  {check['what']}", done.stdout)
            self.assertIn(f"inertia: {check['what']}", done.stderr)
        self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
        self.assertIn("inertia: FAILED\n", done.stdout)
        self.assertIn("0 of 1 experiments passed", (out / "report.html").read_text())


if __name__ == "__main__":
    unittest.main()
