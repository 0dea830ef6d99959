#!/usr/bin/python3
"""What is left of a recording, however it ends, and what can be seen of it before."""

from __future__ import annotations

import math
import signal
import time
import unittest
from pathlib import Path

import h5py
import numpy as np

from limpid_check.checks import verify
from limpid_check.session import DATASETS, read_session
from support import ASSETS, Started, WithAnArm, limpid


def live_rows(part: Path) -> int:
    """Rows of a recording that is being written, as h5py sees them; 0 while there are none."""
    try:
        with h5py.File(part, "r", libver="latest", swmr=True) as file:
            return len(file["/time"])
    except (OSError, KeyError):
        return 0


def wait_for_rows(started: Started, part: Path, rows: int) -> int:
    deadline = time.monotonic() + 30
    while time.monotonic() < deadline and started.process.poll() is None:
        if (seen := live_rows(part)) >= rows:
            return seen
        time.sleep(0.05)
    raise AssertionError(f"{rows} rows never appeared in {part}")


class Recording(WithAnArm):
    """What is left of a recording, however it ends."""

    def test_it_can_be_read_while_it_is_written(self) -> None:
        out = self.out()
        words = ["run", *self.arm, "--realtime", "--duration", "4", "--record", out]
        with Started(*words) as started:
            first = wait_for_rows(started, self.part(out), 1)
            with h5py.File(self.part(out), "r", libver="latest", swmr=True) as file:
                self.assertEqual(file.attrs["format"], "limpid-session")
                rows = min(len(file[name]) for name in DATASETS)
                ticks = np.diff(file["/time"][:rows])
            self.assertGreaterEqual(rows, 1)
            np.testing.assert_allclose(ticks, 1e-3, rtol=1e-9)
            self.assertGreater(wait_for_rows(started, self.part(out), first + 1), first)
            self.assertEqual(started.process.wait(timeout=20), 0)
        self.assertFalse(self.part(out).exists())
        self.assertEqual(len(read_session(out)), 4000)

    def test_ctrl_c_closes_a_complete_file(self) -> None:
        for how in (signal.SIGINT, signal.SIGTERM):
            with self.subTest(how):
                out = self.out()
                words = ["run", *self.arm, "--realtime", "--duration", "60", "--record", out]
                with Started(*words) as started:
                    seen = wait_for_rows(started, self.part(out), 300)
                    self.assertEqual(started.stop(how), 0)
                self.assertFalse(self.part(out).exists())
                session = read_session(out)
                self.assertGreaterEqual(len(session), seen)
                self.assert_verified(session)

    def test_ctrl_c_ends_a_run_that_no_clock_paces(self) -> None:
        out = self.out()
        words = ["run", *self.arm, "--duration", "80000", "--record", out]
        with Started(*words) as started:
            seen = wait_for_rows(started, self.part(out), 300)
            self.assertEqual(started.stop(signal.SIGINT), 0)
        self.assertFalse(self.part(out).exists())
        with h5py.File(out, "r") as file:
            self.assertGreaterEqual(min(len(file[name]) for name in DATASETS), seen)

    def test_a_loop_that_flies_apart_fails_and_keeps_its_rows(self) -> None:
        out = self.out()
        absurd = [
            "coupling.k_vc=10000", "coupling.b_vc=1", "coupling.eta=0.01", "observer.alpha=100",
            "device.torque_limit=10000",
        ]  # fmt: skip
        options = [word for setting in absurd for word in ("--set", setting)]
        result = limpid("run", *self.arm, *options, "--record", out)
        self.assertEqual(result.status, 1)
        self.assertEqual(len(result.error_lines), 1, result.err)
        self.assertIn("unstable", result.err)
        self.assertFalse(self.part(out).exists())
        self.assertGreater(len(read_session(out)), 10)

    def test_a_killed_run_loses_at_most_its_last_second(self) -> None:
        out = self.out()
        words = ["run", *self.arm, "--realtime", "--duration", "60", "--record", out]
        with Started(*words) as started:
            began = math.inf  # latest time the first row can have been written at
            for rows in (1, 1000, 2000, 2400):
                seen = wait_for_rows(started, self.part(out), rows)
                began = min(began, time.monotonic() - seen * 1e-3)
            ran = time.monotonic() - began
            started.stop(signal.SIGKILL)
        self.assertFalse(out.exists())
        with_part = limpid("info", self.part(out))
        self.assertEqual(with_part.status, 0, with_part.err)

        recovered = limpid("recover", self.part(out))
        self.assertEqual(recovered.status, 0, recovered.err)
        self.assertFalse(self.part(out).exists())
        session = read_session(out)
        # a machine that stalls loses ticks of the clock, too: a fifth of a second for that
        self.assertGreaterEqual(len(session) * 1e-3, ran - 1.2)
        self.assert_verified(session)

    def test_recover_keeps_an_existing_session_unless_forced(self) -> None:
        out = self.out()
        words = ["run", *self.arm, "--realtime", "--duration", "60", "--record", out]
        with Started(*words) as started:
            wait_for_rows(started, self.part(out), 100)
            started.stop(signal.SIGKILL)
        out.write_text("something else")
        refused = limpid("recover", self.part(out))
        self.assertEqual(refused.status, 2)
        self.assertEqual(out.read_text(), "something else")
        self.assertTrue(self.part(out).exists())
        self.assertEqual(limpid("recover", "--force", self.part(out)).status, 0)
        self.assertGreaterEqual(len(read_session(out)), 100)


class ShippedSessions(unittest.TestCase):
    """The recordings that come with the program, made in its window."""

    def test_they_verify_and_can_be_run_again(self) -> None:
        sessions = sorted((ASSETS / "sessions").glob("*.h5"))
        self.assertGreaterEqual(len(sessions), 2)
        for path in sessions:
            with self.subTest(path.name):
                checks = verify(read_session(path))
                self.assertEqual([c for c in checks if not c.passed], [])
                done = limpid("run", "--hand", path)
                self.assertEqual(done.status, 0, done.err)


if __name__ == "__main__":
    unittest.main()
