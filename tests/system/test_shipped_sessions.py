#!/usr/bin/python3
"""The recordings that are shipped, run again."""

from __future__ import annotations

import unittest

import h5py

from limpid_check.checks import verify
from limpid_check.session import read_session
from support import ASSETS, SystemTest, limpid


class ShippedSessions(SystemTest):
    """The shipped recordings; of a rounded one the re-run is verified."""

    def test_they_verify_and_can_be_run_again(self) -> None:
        sessions = sorted((ASSETS / "sessions").glob("*.h5"))
        self.assertGreaterEqual(len(sessions), 2)
        for path in sessions:
            with self.subTest(path.name):
                again = self.out()
                done = limpid("run", "--hand", path, "--record", again, "--force")
                self.assertEqual(done.status, 0, done.err)
                with h5py.File(path) as file:
                    rounded = "rounded" in file.attrs
                checks = verify(read_session(again if rounded else path))
                self.assertEqual([c for c in checks if not c.passed], [])


if __name__ == "__main__":
    unittest.main()
