#!/usr/bin/python3
"""A delay between device and proxy: recorded, run again bit for bit, and recomputed; energy tanks."""

from __future__ import annotations

import json
import time
import unittest
from pathlib import Path

import numpy as np

import limpid_check.link as link
from limpid_check.checks import verify
from limpid_check.report import table
from limpid_check.session import read_session
from remote import RemoteTest
from support import ASSETS, SystemTest, limpid

_BAD = ["--set", "link.delay=20", "--set", "link.jitter=8", "--set", "link.loss=0.3", "--set", "link.seed=7"]
_TAPS = ["--hand", ASSETS / "hands/touch.csv", "--scene", ASSETS / "scenes/table.toml", "--duration", "2"]
_LINKED = ("standard", "proposed", "tank")


class ThroughALink(SystemTest):
    def assert_recomputed(self, file: Path, *names: str) -> None:
        checks = verify(read_session(file))
        self.assertTrue(all(check.passed for check in checks), "\n" + table(checks))
        applying = {check.name for check in checks if check.applies}
        self.assertLessEqual(set(names), applying)

    def test_runs_are_recomputed_and_run_again_bit_for_bit(self) -> None:
        for law in _LINKED:
            # a soft spring, with which the proposed law does not diverge
            for name, words in (("late", ["--set", "link.delay=20"]), ("bad", _BAD), ("none", [])):
                with self.subTest(law, link=name):
                    options = ["--coupling", law, "--set", "coupling.k_vc=2", *_TAPS, *words]
                    first = self.record(*options, out=self.directory / f"{law}_{name}.h5")
                    self.assertTrue(np.any(read_session(first)["/proxy/contact_torque"]), "nothing was touched")
                    names = ["tank tau1", "tank tau2", "tank reserve"] if law == "tank" else ["tau1 (1)/(14)", "tau2 (2)/(15)"]
                    self.assert_recomputed(first, *names)
                    self.assert_same_rows(first, self.record("--hand", first, out=self.directory / f"{law}_{name}_again.h5"))

    def test_arms_of_other_sizes_are_recomputed(self) -> None:
        import arms

        files = arms.write_arm(self.directory, 5)
        for law in _LINKED:
            with self.subTest(law):
                file = self.record("--device", files.urdf, "--scene", files.scene, "--hand", files.hand, "--duration",
                                   "1", "--coupling", law, "--set", "coupling.k_vc=1", *_BAD,
                                   out=self.directory / f"five_{law}.h5")  # fmt: skip
                self.assert_recomputed(file)

    def test_a_link_without_delay_is_none(self) -> None:
        for law in _LINKED:
            with self.subTest(law):
                options = ["--coupling", law, *_TAPS]
                none = self.record(*options, out=self.directory / f"{law}_unlinked.h5")
                seeded = self.record(*options, "--set", "link.seed=99", out=self.directory / f"{law}_seeded.h5")
                self.assert_same_rows(none, seeded)

    def test_another_seed_loses_other_packets(self) -> None:
        options = ["--coupling", "standard", "--set", "coupling.k_vc=2", *_TAPS, *_BAD]
        one = read_session(self.record(*options, out=self.directory / "one.h5"))
        two = read_session(self.record(*options, "--set", "link.seed=8", out=self.directory / "two.h5"))
        self.assertFalse(np.array_equal(one["/proxy/position"], two["/proxy/position"]))
        ages = np.arange(len(one)) - link.known(one, link.TO_PROXY).row
        self.assertGreaterEqual(ages[100:].min(), 20)
        self.assertGreater(ages[100:].max(), 28)

    def test_the_predictive_law_knows_none_and_says_so(self) -> None:
        options = ["--coupling", "predictive", *_TAPS]
        none, linked = self.directory / "without.h5", self.directory / "with.h5"
        self.record(*options, out=none)
        done = limpid("run", *options, "--set", "link.delay=50", "--record", linked)
        self.assertIn("link.* does nothing here", done.err)
        self.assert_same_rows(none, linked)

    def test_tanks_bound_what_is_given_where_the_standard_law_diverges(self) -> None:
        worst = {}
        for law in ("standard", "tank"):
            words = ["--coupling", law, *_TAPS[:-2], "--set", "link.delay=10", "--set", "coupling.k_vc=20",
                     "--duration", "4"]  # fmt: skip
            out = self.directory / f"{law}_diverges.h5"
            limpid("run", *words, "--record", out)
            worst[law] = read_session(out)["/energy/controller_total"].max()
        self.assertLessEqual(worst["tank"], 0.005)
        self.assertGreater(worst["standard"], 0.05)

    def test_settings_out_of_range_are_refused_by_name(self) -> None:
        for setting, said in (("link.delay=201", "from 0 to 200 ticks"), ("link.jitter=1.5", "a whole number from 0 to 50"),
                              ("link.loss=1", "from 0 to 0.9"), ("tank.share=0", "from 1e-04 to 1")):
            with self.subTest(setting):
                done = limpid("run", *_TAPS, "--set", setting)
                self.assertEqual(done.status, 2)
                self.assertIn(setting.split("=")[0], done.err)
                self.assertIn(said, done.err)

    def test_analyze_counts_the_link_in_condition_3(self) -> None:
        def found(*words: str) -> dict:
            return json.loads(limpid("analyze", "--json", *words).out)

        bare, late = found(), found("--set", "link.delay=4", "--set", "link.jitter=2")
        k_vc, b_vc, T = 10, 0.001, 0.001
        for side, more in (("device", k_vc * 6 * T + b_vc), ("proxy", k_vc * 6 * T + b_vc)):
            margin = f"{side}_margin"
            self.assertAlmostEqual(bare["condition3"][margin] - late["condition3"][margin], more, places=12)
        self.assertEqual((late["link"], late["condition3"]["holds"], late["condition3"]["known"]), (0.006, False, True))
        self.assertFalse(found("--set", "link.loss=0.1")["condition3"]["known"])
        said = limpid("analyze", "--set", "link.delay=4", "--coupling", "tank").out
        self.assertIn("passive at any delay, jitter and loss", said)


class LiveThroughALink(RemoteTest):
    """A loop that runs by the clock, whose link changes while it is recorded."""

    def test_is_run_again_bit_for_bit(self) -> None:
        loop = self.connect()
        loop.set({"coupling.kind": "standard", "coupling.k_vc": 2, "link.delay": 15, "link.jitter": 5, "link.loss": 0.2})
        time.sleep(0.3)
        file = Path(loop.record(self.home / "live.h5"))
        for values in ({"link.delay": 40}, {"coupling.kind": "tank"}, {"link.delay": 0, "link.jitter": 0, "link.loss": 0},
                       {"link.loss": 0.5, "link.seed": 3}, {"coupling.kind": "proposed"}):
            time.sleep(0.2)
            loop.set(values)
        time.sleep(0.2)
        loop.stop()
        again = self.home / "again.h5"
        done = limpid("run", "--hand", file, "--record", again)
        self.assertEqual(done.status, 0, done.err)
        SystemTest.assert_same_rows(self, file, again)
        s = read_session(file)
        self.assertEqual(set(s["/coupling/kind"]), {0, 1, 3})
        checks = verify(s, ["torques", "energy", "proxy"])
        self.assertTrue(all(check.passed for check in checks), "\n" + table(checks))


if __name__ == "__main__":
    unittest.main()
