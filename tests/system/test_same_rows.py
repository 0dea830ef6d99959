#!/usr/bin/python3
"""The same input gives the same rows bit for bit, on every processor and for shipped sessions."""

from __future__ import annotations

import os
import subprocess
import sys
import unittest
from pathlib import Path

import h5py

import arms
from support import ASSETS, LIMPID, SystemTest

sys.path.insert(0, str(ASSETS / "sessions"))
import make_sessions  # noqa: E402

SESSIONS = sorted((ASSETS / "sessions").glob("*.h5"))

# glibc 2.36 chooses sine, cosine and others for processors without fused products.
WITHOUT_FUSED = {"GLIBC_TUNABLES": "glibc.cpu.hwcaps=-FMA,-FMA4,-AVX2"}
SINES = (
    "import math, struct, zlib;"
    "print(zlib.crc32(b''.join(struct.pack('d', math.sin(0.0137 * i)) for i in range(20000))))"
)


def digest_of_sines(environment: dict[str, str]) -> str:
    done = subprocess.run([sys.executable, "-c", SINES], env=os.environ | environment, check=True,
                          capture_output=True, text=True)  # fmt: skip
    return done.stdout


class SameRows(SystemTest):
    def record_under(self, environment: dict[str, str], *options: str | Path) -> tuple[Path, str]:
        """Recording and output of a `limpid run`."""
        out = self.out()
        done = subprocess.run([LIMPID, "run", *map(str, options), "--record", out], timeout=240,
                              env=os.environ | environment, capture_output=True, text=True)  # fmt: skip
        self.assertEqual(done.returncode, 0, done.stderr)
        return out, done.stdout + done.stderr


class OnEveryProcessor(SameRows):
    """Runs once as on this processor, and once as on one that can do less."""

    def runs(self) -> list[list[str | Path]]:
        """Meshes under the predictive law; arms of skew axes, of 3, 7 and 15 joints, under all laws;
        a path and gains that the program finds by itself."""
        all_runs: list[list[str | Path]] = [
            ["--hand", ASSETS / f"sessions/{name}.h5"] for name in ("relief", "gears", "leaf")
        ]
        all_runs.append(["--hand", ASSETS / "hands/relief.csv", "--scene", ASSETS / "scenes/relief.toml",
                         "--coupling", "proposed", "--eta", "0.6", "--duration", "3"])  # fmt: skip
        for dof, law in ((3, "predictive"), (3, "proposed"), (7, "standard"), (15, "predictive")):
            files = arms.write_arm(self.directory, dof)
            all_runs.append(["--device", files.urdf, "--scene", files.scene, "--hand", files.hand,
                             "--coupling", law, "--duration", "2"])  # fmt: skip
            all_runs.append(["--device", files.urdf, "--duration", "2"])
        return all_runs

    def assert_same_under(self, environment: dict[str, str], said: str = "") -> None:
        for options in self.runs():
            with self.subTest(options=options):
                here, _ = self.record_under({}, *options)
                there, printed = self.record_under(environment, *options)
                self.assert_same_rows(here, there)
                if "relief" in str(options):
                    self.assertIn(said, printed)

    def test_without_fused_products_in_the_mathematical_library(self) -> None:
        if digest_of_sines({}) == digest_of_sines(WITHOUT_FUSED):
            self.skipTest("the mathematical library is the same with and without them here")
        self.assert_same_under(WITHOUT_FUSED)

    def test_with_embree_for_the_oldest_processors(self) -> None:
        library = os.environ.get("LIMPID_EMBREE_OF_OLD", "")
        if not Path(library).is_file():
            self.skipTest("LIMPID_EMBREE_OF_OLD names no library (target embree_of_old)")
        self.assert_same_under({"LD_PRELOAD": library}, said="ISA     : XMM SSE SSE2 \n")


class Shipped(SameRows):
    """Each shipped session, run again; one with rounded numbers gives numbers that round to these.
    If this fails, the program has changed: run assets/sessions/make_sessions.py."""

    def test_sessions_come_again(self) -> None:
        self.assertTrue(SESSIONS)
        for session in SESSIONS:
            with self.subTest(session=session.name):
                again, _ = self.record_under({}, "--hand", session)
                with h5py.File(session) as file:
                    rounds = "rounded" in file.attrs
                if rounds:
                    whole, again = again, self.out()
                    make_sessions.ship(whole, again, rounds)
                self.assert_same_rows(session, again, older=True)


if __name__ == "__main__":
    unittest.main()
