"""The window leads through the identification of a device."""

from __future__ import annotations

import json
import math
import os
import re
import subprocess
import sys
import time
from pathlib import Path

from support import ASSETS, limpid
from window import WindowTest

PADDLE = Path(__file__).with_name("simulated_paddle.py")
WITH_LOAD, LOAD = "identify again with a load at the tip", "load"
COOLING = 600  # [s]
GO_ON, AGAIN = "Go on (Enter)", "Again"


class Identify(WindowTest):
    def reports(self) -> list[Path]:
        return sorted((self.home / "data/limpid/identified").glob("*/report.html"))

    def found(self, seconds: float) -> dict:
        """Contents of a new report."""
        before = len(self.reports())
        for _ in range(int(10 * seconds)):
            if len(self.reports()) > before:
                return json.loads(self.reports()[-1].with_name("identified.json").read_text())
            time.sleep(0.1)
        return {}

    def test_is_tried_on_a_simulated_device(self) -> None:
        self.key("F7")
        self.wait("the dialog", lambda s: s["dialog"] == "identify")
        self.key("Return")
        found = self.found(60)
        self.assertEqual([joint["name"] for joint in found["joints"]],
                         ["turret", "shoulder", "elbow"])
        for name in ("identified.urdf", "identified.svg", "motion.csv"):
            self.assertTrue(self.reports()[0].with_name(name).exists(), name)
        self.assertFalse((self.home / "data/limpid/devices").exists(), "nothing is remembered of it")
        self.wait("the findings", lambda s: s["identify"]["phase"] == "found")
        self.key("space")  # there is no force; the cut loses nothing
        self.settled()
        self.assertEqual(self.state()["identify"]["phase"], "found")
        for way in ("Escape", "cross", "button"):
            with self.subTest(way):
                places = self.wait("a dialog that can be closed", lambda s: s["closing"])["closing"]
                self.key("Escape") if way == "Escape" else self.click(*places[way])
                self.wait("no dialog", lambda s: s["dialog"] == "" and s["closing"] is None)
                self.assertEqual(self.settled()["identify"]["phase"], "found", "it is kept")
                self.key("F7")
                self.wait("the findings again", lambda s: s["dialog"] == "identify")


class IdentifyWithLoad(WindowTest):
    GRAMS = 80  # differs from the preset load

    def reports(self) -> list[Path]:
        return sorted((self.home / "data/limpid/identified").glob("*/identified.json"))

    def place(self, label: str) -> list[float]:
        """Place of a label in the dialog, once the dialog has its size."""
        self.wait(label, lambda s: label in s["identify"]["places"])
        return self.settled()["identify"]["places"][label]

    def wait_for(self, phase: str) -> dict:
        return self.wait(phase, lambda s: s["identify"]["phase"] == phase, 120)

    def order_a_load(self) -> None:
        self.key("F7")
        self.click(*self.place(WITH_LOAD))
        place = self.place(LOAD)
        self.move(*place)
        self.settled()
        self.xdotool("keydown", "ctrl")
        self.click(*place)
        self.xdotool("keyup", "ctrl")
        self.wait("typing", lambda s: s["typing"])
        self.type(str(self.GRAMS))
        self.key("Return")
        self.wait("a load", lambda s: not s["typing"])
        self.assertEqual(self.settled()["identify"]["phase"], "asking", "that Enter was the field's")

    def drawn_scale(self) -> float:
        """Scale of the simulated device's motor torques, as the command reports it."""
        done = limpid("identify", "simulated", "--load", "0.05", "--out", self.home / "out")
        return float(re.search(r"([\d.]+) is the true value", done.out)[1])

    def begin(self) -> None:
        self.key("Return")
        self.wait_for("load")
        self.assertEqual(self.settled()["identify"]["phase"], "load", "until it is told")

    def check_found(self, report: Path) -> None:
        found = json.loads(report.read_text())
        self.assertAlmostEqual(found["load"], 1e-3 * self.GRAMS)
        drawn, scale = self.drawn_scale(), found["torque_scale"]
        self.assertGreater(abs(drawn - 1), 0.05, "or a load tells nothing")
        self.assertAlmostEqual(scale["value"], drawn, delta=0.02 * drawn)
        self.assertLess(scale["deviation"], 0.02 * drawn)
        bare, loaded = (report.with_name(name).read_bytes()
                        for name in ("motion.csv", "motion-with-load.csv"))
        self.assertNotEqual(bare, loaded)

    def test_it_waits_for_the_load_and_finds_what_the_motors_give(self) -> None:
        self.order_a_load()
        self.begin()
        self.key("Escape")
        self.assertEqual(self.wait_for("asking")["identify"]["wrong"], "stopped")
        self.assertEqual(self.reports(), [])

        self.begin()
        self.key("Return")
        self.wait_for("found")
        first, = self.reports()
        self.check_found(first)

        self.click(*self.place(AGAIN))
        self.wait_for("asking")
        self.begin()
        self.click(*self.place(GO_ON))
        self.wait_for("found")
        self.assertEqual(len(self.reports()), 2)


class PaddleWindow(WindowTest):
    BOOK = ""  # entry of the device

    def prepare(self) -> None:
        runtime = self.home / "runtime"
        (runtime / "limpid").mkdir(mode=0o700, parents=True)
        runtime.chmod(0o700)
        self.environment["XDG_RUNTIME_DIR"] = str(runtime)
        device = subprocess.Popen([sys.executable, PADDLE, "paddle"], env=self.environment)
        self.addCleanup(device.wait)
        self.addCleanup(device.kill)
        while not (runtime / "limpid/paddle.device").exists():
            time.sleep(0.05)
        self.book = self.home / "config/limpid/devices.toml"
        self.book.write_text(f'in_use = "socket:paddle"\n[device."socket:paddle"]\n{self.BOOK}')
        self.words = ["--device", str(ASSETS / "devices/paddle.urdf")]
        if hasattr(os, "sched_setscheduler") and os.geteuid() == 0:
            os.sched_setscheduler(device.pid, os.SCHED_FIFO, os.sched_param(50))


class AxesOfADevice(PaddleWindow):
    SIZE = (1600, 880)  # all of the panel fits

    def begin_check(self) -> None:
        self.wait("the check's button", lambda s: s["device_panel"]["check"])
        place = self.settled()["device_panel"]["check"]
        if place:  # the device has left the loop
            self.click(*place)

    def test_are_checked_before_it_may_push_and_again_after_a_check_that_was_stopped(self) -> None:
        self.begin_check()
        self.wait("the check", lambda s: s["device_panel"]["checking"])
        self.key("Escape")
        state = self.wait("its end", lambda s: not s["device_panel"]["checking"])
        self.assertIn("interrupted", state["device_panel"]["problem"])
        self.assertFalse(state["identify"]["plugged"])
        end = time.monotonic() + 60  # a stall of 5 ms ends it
        while "checked = true" not in self.book.read_text() and time.monotonic() < end:
            self.begin_check()
            self.wait("its end", lambda s: not s["device_panel"]["checking"]
                      and (s["device_panel"]["check"] or s["identify"]["plugged"]))
        self.wait_for_notice("The device's axes move in the direction in which the motors push.")
        self.wait("the device in the loop", lambda s: s["identify"]["plugged"])
        self.assertFalse(self.state()["force"])
        self.wait("why it has none", lambda s: s["device_panel"]["explains_force"])


class WarmthOfADevice(AxesOfADevice):
    test_are_checked_before_it_may_push_and_again_after_a_check_that_was_stopped = None

    def prepare(self) -> None:
        # A motor that bears next to nothing for hours, and is slow to get warm.
        arm = self.home / "paddle.urdf"
        model = '<limpid><warmth joint="paddle" continuous="0.005" time="%g"/></limpid></robot>' % COOLING
        arm.write_text((ASSETS / "devices/paddle.urdf").read_text().replace("</robot>", model))
        self.BOOK = f'taken_for = "{arm}"\n'
        super().prepare()

    def test_begins_with_what_the_check_and_an_identification_have_warmed_up(self) -> None:
        end = time.monotonic() + 60  # a stall of 5 ms ends it
        while "checked = true" not in self.book.read_text() and time.monotonic() < end:
            self.begin_check()
            self.wait("its end", lambda s: not s["device_panel"]["checking"]
                      and (s["device_panel"]["check"] or s["identify"]["plugged"]))
        self.wait("the device in the loop", lambda s: s["identify"]["plugged"] and s["device"])
        by_check = self.wait("warmth", lambda s: s["warmth"] > 1e-9)["warmth"]
        began = time.monotonic()

        def warmed() -> bool:
            """By more than it was after the check and would have kept: the age of a state is at most 1 s."""
            kept = by_check * math.exp(-(time.monotonic() - began - 2) / COOLING)
            return self.state()["warmth"] > 1.01 * kept

        self.key("F7")
        self.wait("the dialog", lambda s: s["dialog"] == "identify")
        while not warmed() and time.monotonic() < began + 180:  # a stall of 5 ms ends each try
            self.key("Return")
            self.go_on(4)  # until it sweeps
            if self.state()["identify"]["phase"] == "moving":
                self.key("Escape")
            self.wait("its end", lambda s: s["identify"]["wrong"] != "")
            self.wait("the device back", lambda s: s["identify"]["plugged"])
            self.go_on(1.5)
        self.assertTrue(warmed(), self.state()["warmth"])


class ArmOfADevice(PaddleWindow):
    BOOK = "checked = true\n"
    SIZE = (1600, 880)

    def test_is_asked_about_once(self) -> None:
        self.wait("the device in the loop", lambda s: s["identify"]["plugged"])
        self.wait("the question", lambda s: s["device_panel"]["arm"])
        place = self.settled()["device_panel"]["arm"]
        self.assertLess(place[1], 400, "the card stands first: nothing of it is below the fold")
        self.click(*place)
        self.wait("no question", lambda s: s["device_panel"]["arm"] is None)
        self.wait("the device back in the loop", lambda s: s["identify"]["plugged"])
        book = self.book.read_text()
        self.assertRegex(book, "taken_for = .built-in.")
        self.assertRegex(book, "taken_as = .paddle, 1 joint.")
        self.assertIn("checked = true", book)
        self.assertFalse(self.state()["force"])


class IdentifyDevice(PaddleWindow):
    BOOK = "checked = true\n"

    def test_leaves_the_loop_and_comes_back(self) -> None:
        """Leaves the loop and comes back. A device that is a program seldom reaches the end: a
        stall of 5 ms ends it."""
        self.wait("the device", lambda s: s["identify"]["plugged"])
        self.key("F7")
        self.wait("the dialog", lambda s: s["dialog"] == "identify")
        self.key("Return")
        self.wait("the motion", lambda s: not s["identify"]["plugged"])
        if self.state()["identify"]["phase"] == "moving":
            self.key("Escape")
        state = self.wait("its end", lambda s: s["identify"]["wrong"] != "")
        self.assertEqual(state["identify"]["phase"], "asking")
        self.wait("the device back", lambda s: s["identify"]["plugged"])
        self.assertFalse(self.state()["force"])
