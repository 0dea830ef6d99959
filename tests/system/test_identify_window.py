"""The window leads through the identification of a device."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import time
from pathlib import Path

from support import ASSETS
from window import WindowTest

PADDLE = Path(__file__).with_name("simulated_paddle.py")


class Identify(WindowTest):
    def reports(self) -> list[Path]:
        return sorted((self.home / "data/limpid/identified").glob("*/report.html"))

    def found(self, seconds: float) -> dict:
        """What a new report says."""
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
        self.key("space")  # no force, and nothing is lost by it
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


class IdentifyDevice(WindowTest):
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
        (self.home / "config/limpid/devices.toml").write_text(
            'in_use = "socket:paddle"\n[device."socket:paddle"]\nchecked = true\n')
        self.words = ["--device", str(ASSETS / "devices/paddle.urdf")]
        if hasattr(os, "sched_setscheduler") and os.geteuid() == 0:
            os.sched_setscheduler(device.pid, os.SCHED_FIFO, os.sched_param(50))

    def test_leaves_the_loop_and_comes_back(self) -> None:
        """To the end a device that is a program seldom comes: a stall of 5 ms ends it."""
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
