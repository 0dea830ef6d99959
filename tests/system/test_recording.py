#!/usr/bin/python3
"""Remains of a recording, however it ends, and its visible part before."""

from __future__ import annotations

import math
import os
import re
import signal
import subprocess
import time
import unittest
from pathlib import Path

import h5py
import numpy as np

from limpid_check.session import DATASETS, read_session
from support import ASSETS, LIMPID, Started, SystemTest, WithAnArm, limpid


def live_rows(part: Path) -> int:
    """Number of rows of an unfinished recording, as h5py sees it; 0 while there are none."""
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
    """Remains of a recording, however it ends."""

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
                    self.assertEqual(started.stop(how), 1)
                self.assertFalse(self.part(out).exists())
                session = read_session(out)
                self.assertGreaterEqual(len(session), seen)
                self.assert_verified(session)

    def test_ctrl_c_ends_a_run_that_no_clock_paces(self) -> None:
        for how in (signal.SIGINT, signal.SIGTERM):
            with self.subTest(how):
                out = self.out()
                words = ["run", *self.arm, "--duration", "80000", "--record", out]
                with Started(*words) as started:
                    seen = wait_for_rows(started, self.part(out), 300)
                    self.assertEqual(started.stop(how), 1)
                    said = started.process.communicate()
                self.assertFalse(self.part(out).exists())
                with h5py.File(out, "r") as file:
                    lengths = {len(file[name]) for name in DATASETS}
                    self.assertEqual(len(lengths), 1, "not every column is complete")
                    (rows,) = lengths
                self.assertGreaterEqual(rows, seen)
                self.assertIn(f"recorded {rows} ticks in {out}", said[0].decode())
                self.assertIn(f"stopped at {(rows - 1) * 1e-3:.3f} s", said[1].decode())

    def test_a_loop_that_flies_apart_says_since_when_and_why(self) -> None:
        ways = {
            "stiff": ["coupling.k_vc=10000", "coupling.b_vc=1", "coupling.eta=0.01",
                      "observer.alpha=100", "device.torque_limit=10000"],
            "wound up": ["coupling.eta=0.05", "observer.anti_windup=false", "hand.stiffness=3000"],
            "strong": ["coupling.eta=0.05", "device.torque_limit=1000", "hand.stiffness=3000"],
        }  # fmt: skip
        for name, settings in ways.items():
            with self.subTest(name):
                out = self.out()
                options = [word for setting in settings for word in ("--set", setting)]
                result = limpid("run", *options, "--record", out)
                self.assertEqual(result.status, 1, result.err + result.out)
                self.assertEqual(len(result.error_lines), 1, result.err)
                said = re.search(
                    r"unstable since t = (\d+\.\d{3}) s: "
                    r"the (torque|speed|distance) .* joint [123] (became larger than|is not finite)",
                    result.err,
                )
                self.assertIsNotNone(said, result.err)
                self.assertFalse(self.part(out).exists())
                # the summary covers the rows before, in credible numbers
                self.assertNotRegex(result.out, r"(?i)nan|inf\b|e\+")
                for number in re.findall(r"\d+\.\d+", result.out):
                    self.assertLess(float(number), 1e6, result.out)
                self.assertIn(said.group(0), re.sub(" +", " ", limpid("info", out).out))
                session = read_session(out)
                self.assertGreater(len(session), 10)
                before = session["/time"] < float(said.group(1)) - 1e-9
                self.assertTrue(before.any())
                for path in ("/device/velocity", "/proxy/velocity"):
                    self.assertLess(np.abs(session[path][before]).max(), 1e3)
                self.assertLess(np.abs(session["/device/commanded_torque"][before]).max(), 1e4)
                again = limpid("run", "--hand", out)
                self.assertEqual(again.status, 1)
                self.assertIn(said.group(0), again.err)

    def test_a_loop_that_saturates_into_a_limit_cycle_is_no_failed_run(self) -> None:
        result = limpid("run", "--eta", "0.05", "--set", "hand.stiffness=3000", "--duration", "2")
        self.assertEqual((result.status, len(result.error_lines)), (0, 1), result.err)
        self.assertRegex(result.err, "warning: E_c rose to .* J.*: this run is not passive")

    def test_a_change_comes_at_its_time_whatever_the_tick(self) -> None:
        """Recorded changes belong to rows; with another tick other rows have the same time."""
        first = self.record("--hand", ASSETS / "hands/touch.csv", "--duration", "0.6")
        with h5py.File(first, "r+") as file:
            for name, value in (("row", 300), ("setting", b"coupling.eta = 0.7")):
                events = file[f"/events/{name}"]
                events.resize((1,))
                events[0] = value
        for tick in (0.001, 0.002, 0.0005):
            with self.subTest(tick):
                again = self.record("--hand", first, "--set", f"loop.tick={tick}")
                with h5py.File(again) as file:
                    time, eta = file["/time"][:], file["/coupling/eta"][:]
                self.assertAlmostEqual(time[1], tick, delta=1e-12)
                self.assertAlmostEqual(time[np.flatnonzero(eta == 0.7)[0]], 0.3, delta=1e-9)
                self.assertAlmostEqual(time[-1] + tick, 0.6, delta=2 * tick)

    def test_a_killed_run_loses_at_most_its_last_second(self) -> None:
        out = self.out()
        words = ["run", *self.arm, "--realtime", "--duration", "60", "--record", out]
        with Started(*words) as started:
            began = math.inf  # latest possible time of the first row
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


class Places(WithAnArm):
    """Places of recordings."""

    NO_LOCKS = """#include <errno.h>
        #include <fcntl.h>
        #include <stdarg.h>
        #include <sys/syscall.h>
        #include <unistd.h>
        int flock(int fd, int how) { (void)fd, (void)how; errno = ENOLCK; return -1; }
        static int control(int fd, int what, long given) {
          if (what == 37 || what == 6) { errno = ENOLCK; return -1; }
          return (int)syscall(SYS_fcntl, fd, what, given);
        }
        int fcntl(int fd, int what, ...) {
          va_list all; va_start(all, what); long given = va_arg(all, long); va_end(all);
          return control(fd, what, given);
        }
        int fcntl64(int fd, int what, ...) {
          va_list all; va_start(all, what); long given = va_arg(all, long); va_end(all);
          return control(fd, what, given);
        }"""

    def without_locks(self, *words: str | Path) -> subprocess.Popen[str]:
        source, library = self.out(".c"), self.out(".so")
        source.write_text(self.NO_LOCKS)
        subprocess.run(["gcc", "-shared", "-fPIC", "-o", library, source], check=True)
        here = {name: str(self.directory) for name in ("XDG_CONFIG_HOME", "XDG_RUNTIME_DIR")}
        program = subprocess.Popen([LIMPID, *words], text=True, stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                                   stderr=subprocess.PIPE, env={**os.environ, **here, "LD_PRELOAD": str(library)})
        self.addCleanup(program.communicate)
        self.addCleanup(program.kill)
        return program

    def test_without_locks_it_is_recorded_and_that_is_said(self) -> None:
        out = self.out()
        done = self.without_locks("run", *self.arm, "--duration", "0.2", "--record", out)
        said = done.stderr.read()
        self.assertEqual(done.wait(120), 0, said)
        self.assertIn("has no locks", said)
        self.assertEqual(len(read_session(out)), 200)

    def test_without_locks_settings_are_kept_and_a_socket_is_one_programs(self) -> None:
        kept = self.without_locks("identify", "socket:here", "--forget")
        self.assertEqual((kept.stderr.read(), kept.wait(60)), ("", 0))
        self.assertTrue((self.directory / "limpid/devices.toml").exists())
        first = self.without_locks("serve", "one")
        self.assertIn("listens", first.stdout.readline())
        second = self.without_locks("serve", "one")
        self.assertIn(f"process {first.pid} (limpid serve one) uses this socket", second.stderr.read())
        first.kill()
        first.wait()
        third = self.without_locks("serve", "one")
        self.assertIn("listens", third.stdout.readline(), "the socket of a killed program is taken over")

    def test_a_name_that_is_too_long_is_refused_in_a_line(self) -> None:
        long = self.directory / ("x" * 249 + ".h5")
        done = limpid("run", *self.arm, "--duration", "0.1", "--record", long)
        self.assertEqual((done.status, len(done.error_lines)), (2, 1), done.err)
        self.assertIn("a name of 252 bytes", done.err)
        fits = self.directory / ("x" * 240 + ".h5")
        self.record(*self.arm, "--duration", "0.1", out=fits)

    def test_a_part_that_is_a_link_is_not_followed(self) -> None:
        out, mine = self.out(), self.out(".txt")
        mine.write_text("mine")
        self.part(out).symlink_to(mine)
        done = limpid("run", *self.arm, "--duration", "0.1", "--record", out, "--force")
        self.assertEqual(done.status, 2)
        self.assertIn("is a symbolic link", done.err)
        self.assertEqual(mine.read_text(), "mine")
        mine.unlink()
        done = limpid("run", *self.arm, "--duration", "0.1", "--record", out)
        self.assertEqual(done.status, 2)
        self.assertFalse(mine.exists())

    def test_recover_puts_it_where_it_is_told(self) -> None:
        out, elsewhere = self.out(), self.directory / "elsewhere.h5"
        words = ["run", *self.arm, "--realtime", "--duration", "60", "--record", out]
        with Started(*words) as started:
            wait_for_rows(started, self.part(out), 100)
            started.stop(signal.SIGKILL)
        done = limpid("recover", self.part(out), "--out", elsewhere)
        self.assertEqual(done.status, 0, done.err)
        self.assertGreaterEqual(len(read_session(elsewhere)), 100)
        self.assertFalse(out.exists() or self.part(out).exists())

    def test_it_is_packed_where_a_clock_sets_the_pace_and_nothing_else_is_left(self) -> None:
        quick = self.record(*self.arm, "--duration", "2")
        with h5py.File(quick, "r") as file:
            self.assertIsNone(file["time"].compression)
        out = self.record(*self.arm, "--duration", "2", "--realtime")
        with h5py.File(out, "r") as file:
            time = file["time"]
            self.assertEqual((time.compression, time.shuffle), ("gzip", True))
        self.assertLess(out.stat().st_size, 0.5 * quick.stat().st_size)
        self.assertEqual([p.name for p in self.directory.glob(".limpid-*")], [])


if __name__ == "__main__":
    unittest.main()
