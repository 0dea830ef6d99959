#!/usr/bin/python3
"""`limpid experiment`: what it leaves, how it goes on, what it refuses."""

from __future__ import annotations

import csv
import json
import signal
import time
import unittest
from pathlib import Path

from limpid_check.session import read_session
from support import Started, SystemTest, limpid


class Inertia(SystemTest):
    """One experiment, run once for all the tests of this class."""

    out_dir: Path

    @classmethod
    def setUpClass(cls) -> None:
        super().setUpClass()
        cls.out_dir = cls.directory / "experiments"
        cls.result = limpid("experiment", "inertia", "--out", cls.out_dir, timeout=300)

    def test_it_succeeds_and_says_so_check_by_check(self) -> None:
        self.assertEqual((self.result.status, self.result.err), (0, ""), self.result.out)
        verdict = json.loads((self.out_dir / "inertia.json").read_text())
        for check in verdict["checks"]:
            self.assertIn(check["what"], self.result.out)

    def test_it_leaves_the_files_of_the_contract(self) -> None:
        for name in ("inertia.csv", "inertia.png", "inertia.svg", "inertia.json", "report.html"):
            self.assertGreater((self.out_dir / name).stat().st_size, 0, name)
        self.assertEqual((self.out_dir / "inertia.png").read_bytes()[:8], b"\x89PNG\r\n\x1a\n")
        self.assertEqual(list(self.out_dir.rglob("*.part")), [])
        self.assertEqual(list(self.out_dir.glob("*.gnuplot")), [])

    def test_the_verdict_has_the_keys_of_the_contract(self) -> None:
        verdict = json.loads((self.out_dir / "inertia.json").read_text())
        self.assertEqual(verdict["name"], "inertia")
        self.assertIs(verdict["passed"], True)
        self.assertTrue(verdict["checks"])
        for check in verdict["checks"]:
            self.assertLessEqual({"what", "value", "bound", "passed"}, set(check))

    def test_the_table_holds_what_is_plotted(self) -> None:
        with (self.out_dir / "inertia.csv").open() as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(set(rows[0]), {"panel", "series", "x", "y", "low", "high"})
        self.assertLessEqual({"eta = 0.6", "eta = 1", "eta = 5"}, {row["series"] for row in rows})
        for row in rows:
            float(row["x"]), float(row["y"])

    def test_its_sessions_are_verified_recordings(self) -> None:
        sessions = sorted((self.out_dir / "inertia").glob("*.h5"))
        self.assertEqual(len(sessions), 3)
        self.assert_verified(read_session(sessions[0]))

    def test_a_second_call_reads_what_is_there(self) -> None:
        sessions = sorted((self.out_dir / "inertia").glob("*.h5"))
        before = [path.stat().st_mtime_ns for path in sessions]
        table = (self.out_dir / "inertia.csv").read_bytes()
        result = limpid("experiment", "inertia", "--out", self.out_dir, timeout=300)
        self.assertEqual(result.status, 0, result.err)
        self.assertEqual([path.stat().st_mtime_ns for path in sessions], before)
        self.assertEqual((self.out_dir / "inertia.csv").read_bytes(), table)

    def test_the_number_of_threads_does_not_matter(self) -> None:
        other = self.directory / "threads"
        result = limpid("experiment", "inertia", "--out", other, "--threads", "3", timeout=300)
        self.assertEqual(result.status, 0, result.err)
        for name in ("inertia.csv", "inertia.json"):
            self.assertEqual((other / name).read_bytes(), (self.out_dir / name).read_bytes(), name)


class Stopping(SystemTest):
    def test_ctrl_c_ends_it_cleanly_and_the_next_call_goes_on(self) -> None:
        out = self.directory / "stopped"
        with Started("experiment", "passivity", "--out", out) as started:
            deadline = time.monotonic() + 60
            while not list((out / "passivity").glob("*.h5")) and time.monotonic() < deadline:
                time.sleep(0.01)
            self.assertEqual(started.stop(signal.SIGINT), 1)
        done = {path: path.stat().st_mtime_ns for path in (out / "passivity").glob("*.h5")}
        self.assertTrue(done)
        self.assertFalse((out / "passivity.json").exists())
        result = limpid("experiment", "passivity", "--out", out, timeout=300)
        self.assertEqual(result.status, 0, result.err + result.out)
        for path, written in done.items():
            self.assertEqual(path.stat().st_mtime_ns, written, path)


class Refusals(SystemTest):
    def refused(self, *words: str | Path) -> str:
        result = limpid("experiment", *words)
        self.assertEqual(result.status, 2, result.out + result.err)
        self.assertEqual(len(result.error_lines), 1, result.err)
        return result.err

    def test_an_unknown_name_lists_the_names_and_writes_nothing(self) -> None:
        out = self.directory / "none"
        error = self.refused("intertia", "--out", out)
        for word in ("intertia", "all", "coordination", "inertia", "passivity", "spectrum"):
            self.assertIn(word, error)
        self.assertFalse(out.exists())

    def test_a_folder_is_needed(self) -> None:
        self.assertIn("--out", self.refused("inertia"))

    def test_a_file_is_no_folder(self) -> None:
        file = self.directory / "file"
        file.write_text("something of the user's")
        self.assertIn(str(file), self.refused("inertia", "--out", file))
        self.assertEqual(file.read_text(), "something of the user's")
        self.refused("inertia", "--out", file / "below")

    def test_numbers_are_whole_and_not_negative(self) -> None:
        out = self.directory / "numbers"
        for option in ("--seed", "--threads"):
            for value in ("-1", "1.5", "many", ""):
                with self.subTest(option=option, value=value):
                    self.refused("inertia", "--out", out, option, value)
        self.refused("inertia", "--out", out, "--threads", "0")
        self.assertFalse(out.exists())


if __name__ == "__main__":
    unittest.main()
