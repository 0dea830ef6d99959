"""limpid_bench and the script that compares what it printed.

Environment: LIMPID_BENCH the program (default build/release/tests/bench/limpid_bench of this tree).
"""
import copy
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

HERE = pathlib.Path(__file__).resolve().parent
COMPARE = HERE / "compare.py"
BENCH = os.environ.get("LIMPID_BENCH", HERE.parents[1] / "build/release/tests/bench/limpid_bench")


def bench(*arguments, **environment):
    return subprocess.run([BENCH, "--ticks", "1000", *arguments], capture_output=True, text=True,
                          env=os.environ | environment, timeout=120, check=False)


class BenchTest(unittest.TestCase):
    def test_prints_a_table_of_what_was_asked_for(self):
        ran = bench("--only", "tick/3")
        self.assertEqual(ran.returncode, 0, ran.stderr)
        for law in ("standard", "proposed", "predictive"):
            self.assertIn(f"tick in contact, n = 3, {law}", ran.stdout)
        self.assertNotIn("n = 7", ran.stdout)

    def test_json_has_ordered_figures_and_the_machine(self):
        report = json.loads(bench("--json", "--only", "tick/3").stdout)
        self.assertGreater(report["machine"]["processors"], 0)
        lines = {line["id"]: line for line in report["lines"]}
        self.assertEqual(set(lines), {"yardstick", "tick/3/standard", "tick/3/proposed",
                                      "tick/3/predictive"})
        for line in lines.values():
            self.assertLess(0, line["median"])
            self.assertLessEqual(line["median"], line["p99"])
            self.assertLessEqual(line["p99"], line["p99.9"])
            self.assertLessEqual(line["p99.9"], line["max"])
        tick = lines["tick/3/proposed"]
        self.assertAlmostEqual(tick["ratio"], tick["median"] / lines["yardstick"]["median"])

    def test_runs_are_recorded_and_leave_nothing_behind(self):
        with tempfile.TemporaryDirectory() as folder:
            ran = bench("--only", "run", "--json", TMPDIR=folder)
            self.assertEqual(ran.returncode, 0, ran.stderr)
            self.assertEqual(list(pathlib.Path(folder).iterdir()), [])
        lines = {line["id"]: line for line in json.loads(ran.stdout)["lines"]}
        self.assertGreater(lines["run/alone"]["real_time"], 1)

    def test_refuses_what_it_does_not_have(self):
        for arguments in (("--only", "teapot"), ("--ticks", "0"), ("--ticks", "many")):
            ran = bench(*arguments)
            self.assertEqual(ran.returncode, 2, arguments)
            self.assertIn(arguments[1], ran.stderr)


class CompareTest(unittest.TestCase):
    def compare(self, before, after, *arguments):
        with tempfile.TemporaryDirectory() as folder:
            paths = []
            for name, report in (("before", before), ("after", after)):
                path = pathlib.Path(folder, name + ".json")
                path.write_text(report if isinstance(report, str) else json.dumps(report))
                paths.append(str(path))
            return subprocess.run([sys.executable, str(COMPARE), *paths, *arguments],
                                  capture_output=True, text=True, check=False)

    def setUp(self):
        self.before = {"limpid": "1", "machine": {"processor": "x"}, "lines": [
            {"id": "yardstick", "median": 2.0},
            {"id": "tick", "median": 1.0, "of": "yardstick", "ratio": 0.5, "instructions": 9000},
            {"id": "mesh", "median": 5.0, "of": "query", "ratio": 4.0}]}
        self.after = copy.deepcopy(self.before)

    def test_the_same_has_not_grown(self):
        ran = self.compare(self.before, self.after)
        self.assertEqual((ran.returncode, ran.stderr), (0, ""))
        self.assertIn("nothing grew", ran.stdout)

    def test_instructions_may_grow_by_three_percent(self):
        self.after["lines"][1]["instructions"] = 9250
        self.assertEqual(self.compare(self.before, self.after).returncode, 0)
        self.after["lines"][1]["instructions"] = 9300
        ran = self.compare(self.before, self.after)
        self.assertEqual(ran.returncode, 1)
        self.assertRegex(ran.stdout, r"tick +instructions .*<-")

    def test_a_ratio_says_more_than_a_median(self):
        self.after["lines"][2].update(median=50.0)
        self.assertEqual(self.compare(self.before, self.after).returncode, 0)
        self.after["lines"][2].update(ratio=4.4)
        self.assertEqual(self.compare(self.before, self.after).returncode, 0)
        self.assertEqual(self.compare(self.before, self.after, "--within", "5").returncode, 1)

    def test_says_which_file_is_no_table(self):
        ran = self.compare(self.before, "{}")
        self.assertEqual(ran.returncode, 2)
        self.assertIn("after.json", ran.stderr)


if __name__ == "__main__":
    unittest.main()
