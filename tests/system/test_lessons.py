"""The lessons run without a window, and their statements are true."""

from __future__ import annotations

import os
import re
import subprocess
import sys
import unittest
import xml.etree.ElementTree
from pathlib import Path

from support import ASSETS, LIMPID, ROOT, SystemTest

LESSONS = ASSETS / "python" / "lessons"
NUMBER = r"-?\d+\.?\d*(?:e-?\d+)?"


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
            self.assert_looks_like(svg, LESSONS / "figures" / f"{figure}.svg")
        text = re.sub(r"kg cm\^2", "", done.stdout)
        return [[float(number) for number in re.findall(NUMBER, line)] for line in text.splitlines()]

    def assert_looks_like(self, svg: str, shown: Path) -> None:
        """Asserts that a figure of the page has the same words, and everything at the same place but for
        a pixel."""
        old = shown.read_text()
        again = f"{shown} is not what the program gives: run the lesson with LESSONS={shown.parent}"
        self.assertTrue(re.sub(NUMBER, "", svg) == re.sub(NUMBER, "", old), again)
        pairs = zip(re.findall(NUMBER, svg), re.findall(NUMBER, old))
        self.assertLess(max(abs(float(a) - float(b)) for a, b in pairs), 1, again)

    def quantities(self, lesson: str) -> list[str]:
        """Numbers with a unit in what the page says of a lesson."""
        (section,) = [each for each in (LESSONS / "README.md").read_text().split("\n## ") if f"`{lesson}.py`\n" in each]
        return re.findall(rf"{NUMBER} (?:mm|N/m|J|g|kg|m|s|N)\b", section)

    def test_only_the_standard_coupling_drifts(self) -> None:
        """The drift is force over stiffness: the part of 10 mm that the hand's spring of 300 N/m
        leaves."""
        standard, proposed, predictive = self.lesson("drift", "drift")
        self.assertGreater(standard[0], 3)
        self.assertLess(max(proposed[0], predictive[0]), 0.01)
        self.assertEqual(self.quantities("drift"), [f"{standard[0]:.1f} mm"])

    def test_eta_scales_damping_or_inertia(self) -> None:
        for numbers, scaled in zip(self.lesson("inertia", "inertia", "damping"), (2, 1)):
            etas, inertias, dampings = numbers[0::3], numbers[1::3], numbers[2::3]
            values = dampings if scaled == 2 else inertias
            self.assertEqual(etas, [0.5, 0.6, 0.7, 1, 1.5])
            self.assertEqual(values, sorted(values))
            ratio = values[4] / values[0]
            self.assertAlmostEqual(ratio, 3, delta=0.4 if scaled == 2 else 1)
        self.assertEqual(self.quantities("inertia"), [])

    def test_above_the_limit_no_energy_is_given_and_far_below_it_is(self) -> None:
        limit, *energies = self.lesson("passivity", "passivity")
        self.assertAlmostEqual(limit[0], 0.593, places=2)
        for eta, energy in energies:
            if eta > limit[0]:
                self.assertEqual(energy, 0)
            else:
                self.assertGreater(energy, 0.5)
        self.assertEqual(len(energies), 3)
        self.assertEqual(energies[2][0], 0.3)
        self.assertEqual(self.quantities("passivity"), [f"{energies[2][1]:.1f} J"])

    def test_the_standard_coupling_is_in_series_with_walls(self) -> None:
        """1 / felt less 1 / wall is the same for all walls."""
        standard, proposed, predictive = self.lesson("walls", "walls")
        walls = (100, 200, 400, 800)
        springs = [1 / (1 / felt - 1 / wall) for felt, wall in zip(standard, walls)]
        self.assertLess(max(springs) / min(springs), 1.1)
        for exact in (proposed, predictive):
            self.assertEqual(tuple(exact), walls)
        self.assertEqual(self.quantities("walls"), ["800 N/m", f"{standard[3]:.0f} N/m"])
        self.assertIn(f"it has 800 N/m, and feels like one of {standard[3]:.0f}.", (LESSONS / "walls.py").read_text())

    def test_what_moves_has_what_it_was_given(self) -> None:
        for speed, moving, given, gained in self.lesson("objects", "objects"):
            self.assertGreater(speed, 0.1)
            self.assertLess(abs(given - moving), 0.02 * given)
            self.assertLess(gained, 1e-3)
        mass = re.search(r"^mass = (.*)", (LESSONS / "objects.py").read_text(), re.M)
        self.assertEqual(self.quantities("objects"), [f"{1000 * float(mass[1]):g} g"])

    def test_the_page_shows_figures_that_are_there(self) -> None:
        page = (LESSONS / "README.md").read_text()
        shown = re.findall(r"\]\((figures/[^)]*)\)", page)
        self.assertEqual(len(shown), 6)
        for figure in shown:
            self.assertTrue((LESSONS / figure).exists(), figure)
        for command in re.findall(r"^    python3 (\S+)", page, re.M):
            self.assertTrue((ROOT / command).exists(), command)
        for lesson in re.findall(r"`(\w+)\.py`", page):
            self.assertTrue((LESSONS / f"{lesson}.py").exists(), lesson)


if __name__ == "__main__":
    unittest.main()
