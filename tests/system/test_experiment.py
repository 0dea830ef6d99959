#!/usr/bin/python3
"""`limpid experiment`: files it leaves, continuing, refusals."""

from __future__ import annotations

import csv
import json
import shutil
import signal
import subprocess
import time
import unittest
from pathlib import Path

import h5py

from limpid_check.session import read_session
from support import Started, SystemTest, limpid


class Inertia(SystemTest):
    """One experiment, run once for all tests of this class."""

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
            self.assertLessEqual({"what", "value", "relation", "bound", "passed"}, set(check))

    def test_figure_verdict_and_page_say_where_they_are_from(self) -> None:
        line = json.loads((self.out_dir / "inertia.json").read_text())["provenance"]
        self.assertRegex(line, r"^limpid \S+, settings [0-9a-f]{8}, seed 0, \d{4}-\d\d-\d\d$")
        self.assertIn(f"<metadata>{line}</metadata>", (self.out_dir / "inertia.svg").read_text())
        self.assertIn(line, (self.out_dir / "report.html").read_text())

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

    def test_a_changed_recording_is_run_again(self) -> None:
        out = self.directory / "changed"
        shutil.copytree(self.out_dir, out)
        session = sorted((out / "inertia").glob("*.h5"))[0]
        with h5py.File(session, "r+") as file:
            wanted = file["/device/position"][500, 1]
            file["/device/position"][500, 1] = wanted + 1e-9
        kept = sorted((out / "inertia").glob("*.h5"))[1].stat().st_mtime_ns
        result = limpid("experiment", "inertia", "--out", out, timeout=300)
        self.assertEqual(result.status, 0, result.err)
        with h5py.File(session, "r") as file:
            self.assertEqual(file["/device/position"][500, 1], wanted)
        self.assertEqual(sorted((out / "inertia").glob("*.h5"))[1].stat().st_mtime_ns, kept)

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


class OnAnotherArm(SystemTest):
    def test_numbers_are_that_arms_and_every_page_names_it(self) -> None:
        out = self.directory / "touch"
        result = limpid("experiment", "inertia", "--device", "touch.urdf", "--readings",
                        "--out", out, timeout=300)  # fmt: skip
        self.assertEqual((result.status, result.err), (0, ""), result.out)
        self.assertIn("inertia, on touch with its readings: measured\n", result.out)
        verdict = json.loads((out / "inertia.json").read_text())
        self.assertEqual(verdict["arm"], "touch with its readings")
        for words in ("arm touch of 3 joints", "0.000419 rad per encoder step", "1 ms of delay"):
            self.assertIn(words, verdict["caption"])
        for check in verdict["checks"][:-1]:
            self.assertEqual((check["relation"], check["passed"]), ("measured", None))
            self.assertIn("Promised only for the built-in arm", check["unjudged"])
        self.assertGreater(verdict["checks"][0]["value"], 0.2, "friction does not scale with eta")
        page = (out / "report.html").read_text()
        self.assertIn("Without a verdict, because no bound is promised for the arm: 1.", page)
        for text in (page, (out / "inertia.svg").read_text()):
            self.assertIn("on touch with its readings", text)
        session = read_session(out / "inertia/eta-1.h5")
        self.assert_verified(session)

    def test_the_built_in_arm_by_its_file_gives_the_same_files(self) -> None:
        for name, words in (("default", ()), ("named", ("--device", "omni.urdf"))):
            result = limpid("experiment", "inertia", *words, "--out", self.directory / name, timeout=300)
            self.assertEqual(result.status, 0, result.err)
        for end in ("csv", "json", "svg"):
            one, other = ((self.directory / name / f"inertia.{end}").read_bytes() for name in ("default", "named"))
            self.assertEqual(one, other, end)


class Stopping(SystemTest):
    def stopped(self, out: Path, how: signal.Signals) -> dict[Path, int]:
        """Recordings that an experiment leaves when stopped, with their times."""
        keys = (out / "passivity").glob
        before = len(list(keys("*.key")))
        with Started("experiment", "passivity", "--out", out) as started:
            deadline = time.monotonic() + 60
            while len(list(keys("*.key"))) <= before and time.monotonic() < deadline:
                time.sleep(0.01)
            self.assertEqual(started.stop(how), 1)
            said = started.process.communicate()[1].decode()
        self.assertEqual(said, "limpid: stopped; the same command continues from here\n")
        self.assertFalse((out / "passivity.json").exists())
        return {key: key.with_suffix(".h5").stat().st_mtime_ns
                for key in (out / "passivity").glob("*.key")}  # fmt: skip

    def test_ctrl_c_ends_it_cleanly_and_the_next_call_goes_on(self) -> None:
        out = self.directory / "stopped"
        self.assertTrue(self.stopped(out, signal.SIGTERM))
        done = self.stopped(out, signal.SIGINT)
        self.assertTrue(done)
        for key in done:
            self.assertGreater(len(read_session(key.with_suffix(".h5"))), 1000)
        result = limpid("experiment", "passivity", "--out", out, timeout=300)
        self.assertEqual(result.status, 0, result.err + result.out)
        self.assertEqual(list(out.rglob("*.part")), [])
        for key, written in done.items():
            self.assertEqual(key.with_suffix(".h5").stat().st_mtime_ns, written, key)


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

    def test_a_place_that_cannot_be_written_is_refused_with_the_reason(self) -> None:
        self.assertIn("/proc/limpid: No such file or directory",
                      self.refused("inertia", "--out", "/proc/limpid"))  # fmt: skip
        below = self.directory / "plain"
        below.write_text("")
        self.assertIn(f"{below}/x: Not a directory", self.refused("inertia", "--out", below / "x"))

    def test_a_full_disk_is_refused_with_the_reason_and_left_as_it_was(self) -> None:
        place = self.directory / "full"
        place.mkdir()
        mount = ["mount", "-t", "tmpfs", "-o", "size=64k", "limpid-test", str(place)]
        if subprocess.run(mount, capture_output=True).returncode != 0:
            self.skipTest("may not mount a file system")
        self.addCleanup(subprocess.run, ["umount", str(place)], check=True)
        (place / "fill").write_bytes(bytes(65536))
        for out in (place / "new", place):
            error = self.refused("inertia", "--out", out)
            self.assertIn(f"{out}: No space left on device", error)
            self.assertEqual([path.name for path in place.iterdir()], ["fill"])
        record = limpid("run", "--duration", "1", "--record", place / "a.h5")
        self.assertEqual(record.status, 2, record.err)
        self.assertRegex(record.err, r"full/a\.h5.*: No space left on device")
        self.assertEqual([path.name for path in place.iterdir()], ["fill"])

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
