#!/usr/bin/python3
"""Bad input is refused before anything is written, in one line that names the fault."""

from __future__ import annotations

import os
import resource
import signal
import subprocess
import unittest
from pathlib import Path

import arms
from bad_input import TABLES, Good
from limpid_check.session import read_session
from support import LIMPID, Result, SystemTest, limpid

# Texts that a person should never see.
_MACHINE_TALK = (
    "terminate called", "what():", "Traceback", "HDF5-DIAG", "std::", "assert", "core dumped",
)  # fmt: skip


def _contents(directory: Path) -> dict[str, bytes]:
    return {str(p): p.read_bytes() for p in directory.rglob("*") if p.is_file()}


class Refusals(SystemTest):
    good: Good

    @classmethod
    def setUpClass(cls) -> None:
        super().setUpClass()
        inputs = cls.directory / "good"
        inputs.mkdir()
        arm = arms.write_arm(inputs, 3)
        session = inputs / "good.h5"
        cls.good = Good(cls.directory, arm, session)
        made = limpid(*cls.good.run("--record", session))
        assert made.status == 0, f"input in order is refused: {made.err}"

    def assert_refused(self, result: Result, names: list[str], status: int = 2) -> None:
        self.assertEqual(result.status, status, f"status {result.status}: {result.err}")
        self.assertEqual(len(result.error_lines), 1, f"not one line: {result.err}")
        self.assertLess(len(result.err), 400, result.err)
        for words in _MACHINE_TALK:
            self.assertNotIn(words, result.err)
        for name in names:
            self.assertIn(name, result.err)
        self.assertEqual(result.out, "")

    def test_every_case_of_every_table(self) -> None:
        seen = set()
        for table, cases in TABLES.items():
            for case in cases:
                self.assertNotIn(case.name, seen, "two cases of one name")
                seen.add(case.name)
                with self.subTest(case.name, table=table):
                    words = case.words(self.good)
                    before = _contents(self.directory)
                    self.assert_refused(limpid(*words, timeout=20), case.names)
                    after = _contents(self.directory)
                    self.assertEqual(set(after) - set(before), set(), "something was written")
                    self.assertEqual(after, before, "something was changed")
        self.assertGreater(len(seen), 70)

    def test_a_leftover_part_is_not_overwritten(self) -> None:
        part = self.directory / "refused.h5.part"
        part.write_bytes(self.good.session.read_bytes())
        self.addCleanup(part.unlink)
        before = _contents(self.directory)
        self.assert_refused(limpid(*self.good.run()), ["refused.h5.part"])
        self.assertEqual(_contents(self.directory), before)

    def test_a_folder_without_permission_is_refused(self) -> None:
        if os.geteuid() == 0:
            self.skipTest("root may write anywhere")
        closed = self.directory / "closed"
        closed.mkdir(mode=0o555)
        self.assert_refused(limpid(*self.good.run("--record", closed / "out.h5")), ["closed"])


class FullDisk(SystemTest):
    """The run fails with one line; the part that fitted on the disk is kept and readable."""

    SIZE = 512 * 1024

    def mounted(self) -> Path | None:
        """A new file system of SIZE bytes; None if mounting is not allowed."""
        place = self.directory / "small"
        place.mkdir()
        mount = ["mount", "-t", "tmpfs", "-o", f"size={self.SIZE}", "limpid-test", str(place)]
        try:
            if subprocess.run(mount, capture_output=True).returncode != 0:
                return None
        except FileNotFoundError:
            return None
        self.addCleanup(subprocess.run, ["umount", str(place)], check=True)
        return place

    def limited(self) -> None:
        """In the child: no file may grow beyond SIZE, and trying is an error, not a signal."""
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        resource.setrlimit(resource.RLIMIT_FSIZE, (self.SIZE, self.SIZE))

    def test_a_full_disk_ends_the_run_and_keeps_what_was_recorded(self) -> None:
        files = arms.write_arm(self.directory, 3)
        place = self.mounted()
        out = (place or self.directory) / "out.h5"
        done = subprocess.run(
            [str(LIMPID), "run", "--device", files.urdf, "--scene", files.scene,
             "--hand", files.hand, "--record", out],
            capture_output=True, text=True, timeout=60,
            preexec_fn=None if place else self.limited,
        )  # fmt: skip
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertEqual(len(done.stderr.strip().splitlines()), 1, done.stderr)
        self.assertIn("out.h5", done.stderr)
        self.assertFalse(out.exists())
        part = out.with_name("out.h5.part")
        self.assertEqual(limpid("info", part).status, 0, "the rest is not readable")
        kept = self.directory / "kept.h5.part"
        kept.write_bytes(part.read_bytes())
        recovered = limpid("recover", kept)
        self.assertEqual(recovered.status, 0, recovered.err)
        session = read_session(self.directory / "kept.h5")
        self.assertGreater(len(session), 100)
        self.assert_verified(session)


if __name__ == "__main__":
    unittest.main()
