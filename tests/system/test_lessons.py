"""The lessons run without a window, and their statements are true."""

from __future__ import annotations

import os
import re
import subprocess
import sys
import unittest
import xml.etree.ElementTree
from pathlib import Path

from support import ASSETS, LIMPID, SystemTest

LESSONS = ASSETS / "python" / "lessons"


class TestLessons(SystemTest):
    def lesson(self, name: str, *figures: str) -> list[list[float]]:
        """Numbers in the lesson's output, without those in its sentences."""
        environment = {**os.environ, "LIMPID": str(LIMPID), "LESSONS": str(self.directory)}
        done = subprocess.run([sys.executable, LESSONS / f"{name}.py"], env=environment, text=True,
                              capture_output=True, timeout=250)
        self.assertEqual(done.returncode, 0, done.stderr)
        for figure in figures:
            svg = (self.directory / f"{figure}.svg").read_text()
            xml.etree.ElementTree.fromstring(svg)
            self.assertNotIn("nan", svg)
            self.assertIn("<polyline", svg)
        text = re.sub(r"kg cm\^2", "", done.stdout)
        return [[float(number) for number in re.findall(r"-?\d+\.?\d*(?:e-?\d+)?", line)]
                for line in text.splitlines()]

    def test_only_the_standard_coupling_drifts(self) -> None:
        """The drift is force over stiffness: the part of 10 mm that the hand's spring of 300 N/m
        leaves."""
        standard, proposed, predictive = self.lesson("drift", "drift")
        self.assertGreater(standard[0], 3)
        self.assertLess(max(proposed[0], predictive[0]), 0.01)

    def test_eta_scales_damping_or_inertia(self) -> None:
        for numbers, scaled in zip(self.lesson("inertia", "inertia", "damping"), (2, 1)):
            etas, inertias, dampings = numbers[0::3], numbers[1::3], numbers[2::3]
            values = dampings if scaled == 2 else inertias
            self.assertEqual(etas, [0.5, 0.6, 0.7, 1, 1.5])
            self.assertEqual(values, sorted(values))
            ratio = values[4] / values[0]
            self.assertAlmostEqual(ratio, 3, delta=0.4 if scaled == 2 else 1)

    def test_above_the_limit_no_energy_is_given_and_far_below_it_is(self) -> None:
        limit, *energies = self.lesson("passivity", "passivity")
        self.assertAlmostEqual(limit[0], 0.593, places=2)
        for eta, energy in energies:
            if eta > limit[0]:
                self.assertEqual(energy, 0)
            else:
                self.assertGreater(energy, 0.5)
        self.assertEqual(len(energies), 3)

    def test_the_standard_coupling_is_in_series_with_walls(self) -> None:
        """1 / felt less 1 / wall is the same for all walls."""
        standard, proposed, predictive = self.lesson("walls", "walls")
        walls = (100, 200, 400, 800)
        springs = [1 / (1 / felt - 1 / wall) for felt, wall in zip(standard, walls)]
        self.assertLess(max(springs) / min(springs), 1.1)
        for exact in (proposed, predictive):
            self.assertEqual(tuple(exact), walls)

    def test_what_moves_has_what_it_was_given(self) -> None:
        for speed, moving, given, gained in self.lesson("objects", "objects"):
            self.assertGreater(speed, 0.1)
            self.assertLess(abs(given - moving), 0.02 * given)
            self.assertLess(gained, 1e-3)

    def test_the_page_shows_figures_that_are_there(self) -> None:
        page = (LESSONS / "README.md").read_text()
        shown = re.findall(r"\]\((figures/[^)]*)\)", page)
        self.assertEqual(len(shown), 6)
        for figure in shown:
            self.assertTrue((LESSONS / figure).exists(), figure)
        for lesson in re.findall(r"`(\w+)\.py`", page):
            self.assertTrue((LESSONS / f"{lesson}.py").exists(), lesson)


if __name__ == "__main__":
    unittest.main()
