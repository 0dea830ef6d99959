#!/usr/bin/python3
"""`limpid analyze` against the closed forms of the paper's section 4.2."""

from __future__ import annotations

import json
import math
import unittest
from pathlib import Path
from typing import Any

import numpy as np

import arms
from support import SystemTest, limpid


class Analyze(SystemTest):
    """Closed forms of section 4.2, for a scalar inertia and per mode of an arm."""

    def analyze(self, *options: str | Path) -> dict[str, Any]:
        result = limpid("analyze", *options, "--json")
        self.assertEqual(result.status, 0, result.err)
        return json.loads(result.out)

    def scalar(self, **given: float) -> dict[str, Any]:
        """`analyze` for one inertia; keys of the command line with '_' for '.' or as options."""
        keys = {
            "alpha": "observer.alpha", "b_d": "device.damping", "b_v": "coupling.b_v",
            "eta": "coupling.eta", "k_h": "hand.stiffness", "b_h": "hand.damping",
            "k_vc": "coupling.k_vc", "b_vc": "coupling.b_vc", "tick": "loop.tick",
        }  # fmt: skip
        words: list[str] = []
        for name, value in given.items():
            if name in keys:
                words += ["--set", f"{keys[name]}={value!r}"]
            else:
                words += [f"--{name}", repr(value)]
        return self.analyze(*words)

    def test_bandwidths_and_eta_min_of_a_scalar_inertia(self) -> None:
        for mass, alpha, b_d, b_v in ((1.75e-4, 0.035, 0.012, 0.012), (2e-3, 0.02, 0.03, 0.01)):
            with self.subTest(mass=mass):
                found = self.scalar(mass=mass, alpha=alpha, b_d=b_d, b_v=b_v)
                # the locked inertia counts the proxy's 1e-4, so a little more than round-off
                self.assert_list(found["w_f"], [alpha / mass])
                self.assert_list(found["w_c"], [(b_d + b_v) / mass])
                self.assertAlmostEqual(np.atleast_1d(found["b"])[0], b_d + b_v, delta=1e-12)
                self.assert_close(found["eta_min"], alpha / (alpha + b_d + b_v))
                self.assertNotIn("eta_min_band", {k for k, v in found.items() if v is not None})

    def assert_close(self, value: float, expected: float) -> None:
        self.assertAlmostEqual(value, expected, delta=3e-4 * abs(expected) + 1e-12)

    def assert_list(self, values: list[float], expected: list[float]) -> None:
        self.assertEqual(len(values), len(expected))
        for value, wanted in zip(sorted(values), sorted(expected)):
            self.assert_close(value, wanted)

    def test_eta_min_of_a_hand_of_limited_bandwidth(self) -> None:
        mass, alpha, b = 1.75e-4, 0.035, 0.024
        w_f, w_c = alpha / mass, b / mass
        for band in (5.0, 20.0, 30.0, 100.0, 1e4):
            with self.subTest(band=band):
                w_b = 2 * math.pi * band
                wanted = max(0.0, (w_f - w_c * w_f**2 / w_b**2) / (w_c + w_f))
                found = self.scalar(mass=mass, alpha=alpha, b_d=0.012, b_v=0.012, band=band)
                self.assertAlmostEqual(found["eta_min_band"], wanted, delta=2e-3)

    def test_eta_min_in_a_grip_is_where_the_cubic_gets_a_root_on_the_axis(self) -> None:
        """Routh-Hurwitz of (m s^2 + b s)(s + w_f) + (k_h + b_h s)(s + w_f / eta), by its roots."""
        mass, alpha, b = 1.75e-4, 0.035, 0.024
        w_f = alpha / mass

        def stable(eta: float, k_h: float, b_h: float) -> bool:
            cubic = np.polyadd(
                np.polymul([mass, b, 0], [1, w_f]), np.polymul([b_h, k_h], [1, w_f / eta])
            )
            return bool(np.max(np.roots(cubic).real) < 0)

        for k_h, b_h in ((300.0, 0.0), (3000.0, 0.0), (5.0, 0.0), (50.0, 0.001), (500.0, 0.01)):
            with self.subTest(k_h=k_h, b_h=b_h):
                found = self.scalar(mass=mass, alpha=alpha, b_d=0.012, b_v=0.012, k_h=k_h, b_h=b_h)
                limit = found["eta_min_grip"]
                if b_h == 0:
                    eta_min = alpha / (alpha + b)
                    self.assert_close(limit, eta_min * k_h / (k_h + b * w_f))
                self.assertTrue(stable(limit * 1.002 + 1e-6, k_h, b_h))
                if limit > 1e-3:
                    self.assertFalse(stable(limit * 0.998, k_h, b_h))

    def test_condition_three_and_the_verdict(self) -> None:
        cases = [  # b_d, b_v, k_vc, b_vc, tick
            (0.012, 0.012, 10.0, 0.001, 0.001),
            (0.0119, 0.012, 10.0, 0.001, 0.001),
            (0.02, 0.004, 10.0, 0.002, 0.001),
            (0.02, 0.012, 12.0, 0.001, 0.002),
        ]
        for b_d, b_v, k_vc, b_vc, tick in cases:
            with self.subTest(b_d=b_d, b_v=b_v, k_vc=k_vc):
                given = {"b_d": b_d, "b_v": b_v, "k_vc": k_vc, "b_vc": b_vc, "tick": tick}
                found = self.scalar(mass=1.75e-4, **given)["condition3"]
                device, proxy = b_d - 2 * b_vc - k_vc * tick, b_v - k_vc * tick / 2
                self.assertAlmostEqual(found["device_margin"], device, delta=1e-12)
                self.assertAlmostEqual(found["proxy_margin"], proxy, delta=1e-12)
                if abs(device) > 1e-12 and abs(proxy) > 1e-12:
                    self.assertEqual(found["holds"], device >= 0 and proxy >= 0)

    def test_condition_three_counts_a_delay(self) -> None:
        for ticks, known in ((2, True), (2, False), (5, True)):
            with self.subTest(ticks=ticks, known=known):
                options = ["--set", f"device.delay={ticks}"]
                if known:
                    options += ["--set", f"model.delay={ticks}"]
                found = self.analyze(*options)
                delay = ticks * 1e-3
                self.assertEqual(found["delay"], delay)
                self.assertFalse(found["measured"])
                margins = found["condition3"]
                device = 0.012 - 0.002 - 10 * (1e-3 + 1.5 * delay)
                self.assertAlmostEqual(margins["device_margin"], device, delta=1e-12)
                self.assertAlmostEqual(
                    margins["proxy_margin"], 0.012 - 10 * (1e-3 + delay) / 2, delta=1e-12
                )
                tip = found["tip"]
                self.assert_close(tip["every_hand"], tip["damping"] / (5e-4 + delay))

    def test_passive_means_at_or_above_eta_min(self) -> None:
        for eta in (0.5, 0.58, 0.6, 1.0):
            with self.subTest(eta=eta):
                found = self.scalar(mass=1.75e-4, alpha=0.035, b_d=0.012, b_v=0.012, eta=eta)
                self.assertEqual(found["passive"], eta >= 0.035 / 0.059)

    def test_passive_is_about_the_law_that_is_chosen(self) -> None:
        cases = [
            (["--coupling", "predictive", "--eta", "0.2"], True),
            (["--coupling", "standard", "--eta", "0.01"], True),
            (["--coupling", "proposed", "--eta", "0.5"], False),
            (["--set", "loop.tick=0.1"], False),  # b_d >= 2 b_vc + k_vc T is broken
            (["--coupling", "tank", "--eta", "0.1", "--set", "link.delay=20"], True),
            (["--coupling", "standard", "--set", "link.loss=0.1"], None),
            (["--coupling", "eba"], True),
            (["--coupling", "direct"], None),
            (["--coupling", "popc"], None),
            (["--coupling", "sfa"], None),
            (["--coupling", "wave", "--set", "link.delay=20"], None),  # b = b_v = b_d
            (["--coupling", "wave", "--set", "link.delay=20", "--set", "wave.b=0.004"], True),  # b_d/3
            (["--coupling", "wave", "--set", "wave.b=0.006", "--set", "wave.matched=false"], True),  # b_d/2
            (["--coupling", "tdpn", "--set", "link.delay=20"], None),
            (["--set", "link.delay=1", "--set", "coupling.k_vc=1"], None),
        ]
        for options, passive in cases:
            with self.subTest(options=options):
                found = self.analyze(*options)
                self.assertIs(found["passive"], passive)
                self.assertTrue(found["passive_by"])
                text = limpid("analyze", *options).out
                self.assertEqual("NOT passive" in text, passive is False, text)

    def test_json_says_units_and_where_it_is_from(self) -> None:
        found = self.analyze()
        self.assertRegex(found["provenance"], r"^limpid \S+, settings [0-9a-f]{8}, \d{4}-\d\d-\d\d$")
        self.assertEqual(found["units"]["w_f"], "rad/s")
        for path in found["units"]:
            value: Any = found
            for key in path.replace("LAW", "proposed").split("."):
                value = value[key]

    def test_a_tip_that_no_joint_moves_is_said(self) -> None:
        arm = self.out(".urdf")
        arm.write_text("""<robot name="shaft"><link name="base"/><link name="tip"><inertial>
            <mass value="0.1"/><inertia ixx="1e-4" iyy="1e-4" izz="1e-4" ixy="0" ixz="0" iyz="0"/>
            </inertial></link><joint name="turn" type="revolute"><parent link="base"/><child link="tip"/>
            <axis xyz="0 0 1"/><limit lower="-1" upper="1" effort="1" velocity="9"/>
            <dynamics damping="0.01"/></joint></robot>""")
        said = limpid("analyze", "--device", arm)
        self.assertEqual(said.status, 0, said.err)
        self.assertIn("no joint moves the tip 'tip'", said.out)
        for wrong in ("nan", "inf"):
            self.assertNotIn(wrong, said.out)
        self.assertIsNone(self.analyze("--device", arm)["tip"])

    def test_every_mode_of_an_arm_has_the_same_eta_min(self) -> None:
        files = arms.write_arm(self.directory, 6)
        found = self.analyze("--device", files.urdf)
        b = 0.015 + 0.012
        self.assertEqual((len(found["w_f"]), len(found["w_c"])), (6, 6))
        for w_f, w_c in zip(sorted(found["w_f"]), sorted(found["w_c"])):
            self.assert_close(w_f / w_c, 0.035 / b)
        self.assert_close(found["eta_min"], 0.035 / (0.035 + b))

    def test_the_tip_has_the_walls_and_the_weight_that_theory_gives_it(self) -> None:
        for eta, tick in ((1.0, 1e-3), (0.4, 5e-4)):
            with self.subTest(eta=eta, tick=tick):
                tip = self.analyze("--set", f"coupling.eta={eta}", "--set", f"loop.tick={tick}")["tip"]
                damping, mass = tip["damping"], tip["led_mass"]  # what is felt is led by a hand
                self.assert_close(tip["every_hand"], 2 * damping / tick)
                lever2 = 0.012 / damping  # every joint of the built-in arm has 0.012 N m s/rad
                b = (0.012 + 0.012 + 10 * tick / 2) / lever2 + 2
                self.assert_close(tip["proposed"]["wall"], eta * b / (tick / 2 + 0.012 / 10))
                self.assert_close(tip["standard"]["wall"], 10 / lever2)
                self.assertGreater(tip["predictive"]["wall"], 10000)
                felt = dict(zip(tip["frequency"], tip["predictive"]["felt_mass"]))
                self.assertAlmostEqual(felt[2], eta * mass, delta=0.03 * mass)
                least = max(0, 1 - eta) * mass * 2 * math.pi * 5.3
                self.assert_close(tip["least_damping"], least)
                self.assertGreaterEqual(min(tip["predictive"]["felt_damping"][:3]), least)

    def test_a_range_of_hands_beside_every_hand(self) -> None:
        """An arm of one joint: poles of the sampled loop by numpy, and the literature's bounds."""
        arm = ["--device", arms.write_arm(self.directory, 1).urdf]
        tip = self.analyze(*arm)["tip"]
        m, b_d, T = tip["mass"], tip["damping"], 1e-3

        def stable(K: float, k_h: float, b_h: float, m_h: float) -> bool:
            A = np.array([[0, 1, 0], [-k_h / (m + m_h), -(b_d + b_h) / (m + m_h), 1 / (m + m_h)], [0, 0, 0]])
            step, term = np.eye(3), np.eye(3)
            for k in range(1, 40):
                term = term @ A * T / k
                step = step + term
            loop = step[:2, :2] - np.outer(step[:2, 2], [K, 0])
            return bool(np.max(np.abs(np.linalg.eigvals(loop))) < 1)

        for b_h, m_h in ((2.0, 0.0), (0.5, 0.1)):
            with self.subTest(b_h=b_h):
                hand = ["--set", f"hand.damping={b_h}", "--set", f"hand.mass={m_h}"]
                grip = self.analyze(*arm, "--grip", "200", "4000", *hand)["grip"]
                self.assertEqual((grip["damping"], grip["mass"]), (b_h, m_h))
                wall, worst = grip["direct"]["stable"]["wall"], grip["direct"]["stable"]["hand"]
                self.assertTrue(stable(wall * 0.999, worst, b_h, m_h))
                self.assertFalse(stable(wall * 1.001, worst, b_h, m_h))
                for other in (200, 700, 4000):
                    self.assertTrue(stable(wall * 0.999, other, b_h, m_h))
        words = ["--set", "device.encoder_step=4e-4", "--set", "device.friction=1e-3"]
        grip = self.analyze(*arm, "--grip", "200", "4000", *words)["grip"]
        self.assert_close(grip["colgate_schenkel"]["wall"], 2 * b_d / T)
        self.assertLess(grip["abbott_okamura"]["wall"], grip["colgate_schenkel"]["wall"])
        self.assertEqual(grip["direct"]["passive"]["wall"], grip["abbott_okamura"]["wall"])

    def test_readings_are_exact_and_prompt_unless_the_arms_file_is_asked(self) -> None:
        touch = ["--device", "touch.urdf"]
        exact, real = self.analyze(*touch)["tip"], self.analyze(*touch, "--readings")["tip"]
        self.assert_close(real["eba"]["wall"], exact["eba"]["wall"] / 2)  # 2 b_d/(T + delay)
        self.assertAlmostEqual(real["standard"]["wall"], exact["standard"]["wall"] * 4 / 10, delta=2)  # k_vc by (3)
        self.assertLess(real["predictive"]["wall"], exact["predictive"]["wall"] / 2)
        fine = self.analyze(*touch, "--readings", "--set", "device.encoder_step=1e-6")["tip"]
        self.assertGreater(fine["predictive"]["wall"], real["predictive"]["wall"], "what is set wins")
        half = [self.analyze(*touch, "--set", "loop.tick=5e-4", *words)["tip"]["eba"]["wall"]
                for words in ((), ("--readings",))]
        self.assert_close(half[1], half[0] / 3)  # a delay of two such ticks
        self.assertIn("encoder steps of 0.419 mrad and a delay of 1 ms", limpid("analyze", *touch).out)
        self.assertNotIn("readings", limpid("analyze", *touch, "--readings").out)
        self.assertNotIn("readings", limpid("analyze").out, "the built-in arm's file says nothing")

    def test_llewellyns_criterion_is_the_closed_form(self) -> None:
        for k_vc, b_v in ((10.0, 0.012), (14.0, 0.006), (20.0, 0.012)):
            with self.subTest(k_vc=k_vc):
                words = ["--set", f"coupling.k_vc={k_vc}", "--set", f"coupling.b_v={b_v}", "--set", "coupling.b_vc=0"]
                found = self.analyze("--grip", "300", "3000", *words)["grip"]["standard"]["llewellyn"]
                half = k_vc * 1e-3 / 2
                c = (0.012 - half) * b_v / half**2
                self.assertEqual(found["fails_from"] is None, c >= 1)
                self.assertAlmostEqual(found["least"], min(1, 2 * c - 1), delta=1e-6)

    def test_the_grip_of_a_recording_is_that_of_its_hand_with_its_walls(self) -> None:
        out = self.out()
        hand = {"stiffness": 700.0, "damping": 2.5, "mass": 0.1}
        words = [word for key, value in hand.items() for word in ("--set", f"hand.{key}={value}")]
        run = limpid("run", "--measure-grip", *words, "--record", out, "--json")
        self.assertEqual(run.status, 0, run.err)
        found = self.analyze("--grip-of", out)
        measured = found["measured_grip"]
        self.assertEqual(measured, json.loads(run.out)["measured_grip"])
        self.assertTrue(measured["known"])
        for key, value in hand.items():
            self.assertLess(abs(measured[key]["value"] - value), measured[key]["bound"], key)
            self.assertLess(measured[key]["bound"], 0.15 * value, key)
            self.assertIn(f"measured_grip.{key}.bound", found["units"])
        k, b = measured["stiffness"], measured["damping"]
        self.assertAlmostEqual(found["grip"]["from"], k["value"] - k["bound"])
        self.assertAlmostEqual(found["grip"]["to"], k["value"] + k["bound"])
        self.assertAlmostEqual(found["grip"]["damping"], b["value"] - b["bound"])
        eta = measured["eta_min"]
        self.assertTrue(eta["least"] <= eta["value"] <= eta["most"])
        self.assertAlmostEqual(found["eta_min_compliant"], eta["value"])
        self.assertIn("known", limpid("analyze", "--grip-of", out).out)

    def test_without_a_measurement_the_grip_is_not_known(self) -> None:
        out = self.out()
        self.assertEqual(limpid("run", "--duration", "0.5", "--record", out).status, 0)
        found = limpid("analyze", "--grip-of", out)
        self.assertEqual(found.status, 2)
        self.assertIn("the grip was not measured", found.err)
        short = limpid("run", "--measure-grip", "--duration", "5")
        self.assertEqual(short.status, 2)
        self.assertIn("--duration", short.err)

    def test_without_json_it_speaks_to_people(self) -> None:
        result = limpid("analyze")
        self.assertEqual(result.status, 0, result.err)
        self.assertIn("eta", result.out)


if __name__ == "__main__":
    unittest.main()
