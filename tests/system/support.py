"""Finds and runs the program from outside, as a user would.

Environment: LIMPID the program (default build/app/limpid of this tree), LIMPID_SHARED the folder
with recorded hands (default ../shared beside this tree).
"""

from __future__ import annotations

import os
import re
import shutil
import signal
import subprocess
import tempfile
import unittest
from dataclasses import dataclass
from pathlib import Path

import h5py
import numpy as np

import arms
from limpid_check.checks import verify
from limpid_check.report import table
from limpid_check.session import Session, read_session

ROOT = Path(__file__).resolve().parents[2]
LIMPID = Path(os.environ.get("LIMPID", ROOT / "build/app/limpid")).absolute()
SHARED = Path(os.environ.get("LIMPID_SHARED", ROOT.parent / "shared"))
ASSETS = ROOT / "assets"

Words = list[str | Path]

# A shell starts programs in the background with Ctrl-C ignored, and those that they start as well.
signal.signal(signal.SIGINT, signal.default_int_handler)


@dataclass(frozen=True)
class Result:
    status: int  # negative: the signal that ended it
    out: str
    err: str

    @property
    def error_lines(self) -> list[str]:
        return [line for line in self.err.splitlines() if line.strip()]


def datasets(file: h5py.File) -> list[str]:
    names: list[str] = []
    file.visititems(lambda name, item: names.append(name) if hasattr(item, "shape") else None)
    return names


def limpid(*words: str | Path, timeout: float = 120, cwd: Path | None = None) -> Result:
    """Runs the program to its end; stdout and stderr are pipes."""
    done = subprocess.run(
        [str(LIMPID), *map(str, words)],
        capture_output=True,
        text=True,
        errors="replace",
        timeout=timeout,
        cwd=cwd,
        stdin=subprocess.DEVNULL,
    )
    return Result(done.returncode, done.stdout, done.stderr)


def shared_hand(name: str) -> Path:
    """A recorded hand of the shared folder; skips the test if the folder is absent."""
    path = SHARED / "data" / "hand" / name
    if not path.exists():
        raise unittest.SkipTest(f"{path} is not there; set LIMPID_SHARED to the folder with data/")
    return path


class Started:
    """The program running in the background."""

    def __init__(self, *words: str | Path, stderr: int = subprocess.PIPE) -> None:
        self.process = subprocess.Popen(
            [str(LIMPID), *map(str, words)],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=stderr,
        )

    def __enter__(self) -> Started:
        return self

    def __exit__(self, *_: object) -> None:
        if self.process.poll() is None:
            self.process.kill()
        self.process.communicate()

    def stop(self, how: signal.Signals) -> int:
        self.process.send_signal(how)
        return self.process.wait(timeout=20)


def is_of_rows(name: str) -> bool:
    """Whether a dataset has rows. Marks and notes belong to the whole recording, and scales at the
    root name joints and axes."""
    return name == "time" or ("/" in name and not name.startswith("marks/"))


class SystemTest(unittest.TestCase):
    """A test that runs the program in a folder of its own."""

    directory: Path

    @classmethod
    def setUpClass(cls) -> None:
        if not LIMPID.exists():
            raise AssertionError(f"{LIMPID} is not there; build it or set LIMPID")
        cls.directory = Path(tempfile.mkdtemp(prefix="limpid-"))
        cls.addClassCleanup(shutil.rmtree, cls.directory, ignore_errors=True)

    def out(self, end: str = ".h5") -> Path:
        """A path in this test's own folder."""
        name = re.sub(r"\W+", "_", self.id().split(".")[-1])
        count = sum(1 for _ in self.directory.glob(f"{name}-*"))
        return self.directory / f"{name}-{count}{end}"

    def record(self, *options: str | Path, out: Path | None = None) -> Path:
        """`limpid run OPTIONS --record OUT`, which must succeed."""
        out = out or self.out()
        result = limpid("run", *options, "--record", out)
        self.assertEqual(result.status, 0, result.err)
        self.assertTrue(out.exists(), f"{out} was not written")
        self.assertFalse(out.with_name(out.name + ".part").exists(), "the .part is still there")
        return out

    def run_and_read(self, *options: str | Path) -> Session:
        return read_session(self.record(*options))

    def assert_same_rows(self, first: Path, second: Path, older: bool = False) -> None:
        """Asserts that all datasets agree to the last bit, except durations and starts of ticks. An older
        program may have recorded fewer columns; sums over the columns are then others."""
        with h5py.File(first, "r") as a, h5py.File(second, "r") as b:
            names, others = ([name for name in datasets(file) if is_of_rows(name)] for file in (a, b))
            if older:
                names = [name for name in names if not name.startswith("check/")]
                others = [name for name in others if name in names]
            self.assertEqual(names, others)
            for name in names:
                if name.startswith("timing/"):
                    continue
                x, y = a[name][()], b[name][()]
                self.assertEqual(x.shape, y.shape, name)
                if x.tobytes() != y.tobytes():
                    rows = np.flatnonzero((x != y).reshape(len(x), -1).any(axis=1))
                    self.fail(f"{first.name}: {name} differs in {len(rows)} of {len(x)} rows, "
                              f"first in row {rows[0] if len(rows) else 'of another 0 or nan'}")

    def assert_verified(self, session: Session) -> None:
        """Asserts that every recomputation of the session agrees."""
        checks = verify(session)
        self.assertTrue(all(check.passed for check in checks), "\n" + table(checks))


class WithAnArm(SystemTest):
    """Tests that run a generated arm of three joints."""

    arm: Words
    files: arms.ArmFiles

    @classmethod
    def setUpClass(cls) -> None:
        super().setUpClass()
        cls.files = arms.write_arm(cls.directory, 3)
        cls.arm = ["--device", cls.files.urdf, "--scene", cls.files.scene, "--hand", cls.files.hand]

    def part(self, out: Path) -> Path:
        return out.with_name(out.name + ".part")
