#!/usr/bin/python3
"""Recordings are read by a program of their own: whatever happens to it, limpid reports it and goes
on."""

from __future__ import annotations

import shutil
import subprocess
import unittest
from pathlib import Path

from support import LIMPID, ROOT, SystemTest

SESSION = ROOT / "assets/sessions/free.h5"


class ReaderProgramTest(SystemTest):
    def setUp(self) -> None:
        super().setUp()
        root = self.out().with_suffix("")
        self.program = root / "app/limpid"
        self.program.parent.mkdir(parents=True)
        shutil.copy(LIMPID, self.program)
        (root / "share").mkdir()
        (root / "share/limpid").symlink_to(ROOT)

    def read_with(self, script: str | None) -> str:
        reader = self.program.with_name("limpid-session")
        if script is not None:
            reader.write_text(f"#!/bin/sh\n{script}\n")
            reader.chmod(0o755)
        done = subprocess.run([self.program, "info", SESSION], capture_output=True, text=True, timeout=60)
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
        self.assertIn(str(SESSION), done.stderr)
        return done.stderr

    def test_one_that_crashes(self) -> None:
        self.assertIn("crashed (SIGSEGV)", self.read_with("kill -SEGV $$"))

    def test_one_that_takes_for_ever(self) -> None:
        self.assertIn("much longer", self.read_with("kill -XCPU $$"))

    def test_one_that_says_nothing(self) -> None:
        self.assertIn("cut off", self.read_with("exit 0"))
        self.assertIn("status 3", self.read_with("exit 3"))

    def test_one_that_says_anything(self) -> None:
        self.assertIn("sent wrong data", self.read_with("cat /proc/self/exe | tail -c +100; exit 0"))

    def test_one_that_never_ends_what_nobody_reads(self) -> None:
        self.assertIn("sent wrong data", self.read_with(r"printf '\1\0\0\0\0\0\0\0'; exec cat /dev/zero"))

    def test_one_that_is_missing(self) -> None:
        self.assertRegex(self.read_with(None), r"its reader \S*limpid-session cannot be started")

    def test_files_that_crash_hdf5_crash_nothing_else(self) -> None:
        """A recording of HDF5's first edition, which has no checksums, is changed byte by byte."""
        if not Path("/usr/bin/h5repack").exists():
            raise unittest.SkipTest("h5repack is missing")
        old = self.directory / "old.h5"
        small = self.directory / "small.h5"
        subprocess.run([LIMPID, "run", "--duration", "0.02", "--record", small], check=True,
                       capture_output=True)
        subprocess.run(["h5repack", small, old], check=True, capture_output=True)
        whole = old.read_bytes()
        for place in range(600, min(len(whole), 60_000), 997):
            for value in (0x00, 0xFF):
                broken = bytearray(whole)
                broken[place] = value
                old.write_bytes(broken)
                done = subprocess.run([LIMPID, "info", old], capture_output=True, text=True)
                self.assertIn(done.returncode, (0, 2), f"byte {place}: {done.stderr}")
                self.assertLessEqual(len(done.stderr.splitlines()), 1, f"byte {place}: {done.stderr}")


if __name__ == "__main__":
    unittest.main()
