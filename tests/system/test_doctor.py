#!/usr/bin/python3
"""`limpid doctor` on computers with something missing."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import unittest
from pathlib import Path

from support import LIMPID, ROOT, SystemTest

STATES = ("ok", "better", "broken")


class Doctor(SystemTest):
    def setUp(self) -> None:
        self.home = self.out("")
        self.home.mkdir()
        self.environment = {
            "PATH": os.environ["PATH"],
            "HOME": str(self.home),
            "XDG_CONFIG_HOME": str(self.home / "config"),
            "XDG_DATA_HOME": str(self.home / "data"),
            "XDG_CACHE_HOME": str(self.home / "cache"),
        }

    def run_it(self, *words: str, program: Path = LIMPID, before: tuple[str, ...] = ()):
        return subprocess.run([*before, program, "doctor", *words], env=self.environment,
                              capture_output=True, text=True, timeout=120,
                              stdin=subprocess.DEVNULL)  # fmt: skip

    def examine(self, **how) -> dict[tuple[str, str], dict[str, str]]:
        done = self.run_it("--json", **how)
        self.assertEqual(done.stderr, "")
        said = json.loads(done.stdout)
        self.assertEqual(done.returncode, STATES.index(said["state"]), done.stdout)
        states = [STATES.index(finding["state"]) for finding in said["findings"]]
        self.assertEqual(done.returncode, max(states))
        return {(f["area"], f["what"]): f for f in said["findings"]}

    def test_each_line_says_what_it_costs_and_what_mends_it(self) -> None:
        findings = self.examine()
        areas = list(dict.fromkeys(area for area, _ in findings))
        self.assertEqual(areas, ["real time", "devices", "picture", "files"])
        for finding in findings.values():
            with self.subTest(finding["what"]):
                self.assertTrue(finding["found"])
                fine = finding["state"] == "ok"
                self.assertEqual((not finding["cost"], not finding["mend"]), (fine, fine))
        text = self.run_it().stdout
        for finding in findings.values():
            self.assertIn(finding["what"], text)
            self.assertIn(finding["mend"], text)

    def test_it_changes_nothing(self) -> None:
        self.examine()
        self.assertEqual(list(self.home.iterdir()), [])

    def test_without_a_display_the_window_alone_is_missing(self) -> None:
        findings = self.examine()
        self.assertEqual(findings["picture", "window"]["state"], "better")
        self.assertIn("DISPLAY", findings["picture", "window"]["found"])
        self.assertEqual(findings["picture", "without display"]["state"], "ok")

    def test_a_display_that_nobody_serves(self) -> None:
        self.environment["DISPLAY"] = ":987"
        self.assertEqual(self.examine()["picture", "window"]["state"], "broken")

    def test_a_folder_that_cannot_be_written(self) -> None:
        file = self.home / "file"
        file.write_text("no folder")
        self.environment["XDG_CONFIG_HOME"] = str(file)
        findings = self.examine()
        self.assertEqual(findings["files", "settings"]["state"], "broken")
        self.assertIn(str(file), findings["files", "settings"]["mend"])
        self.assertEqual(findings["files", "data"]["state"], "ok")

    def test_a_program_that_is_missing(self) -> None:
        program = self.home / "app/limpid"
        program.parent.mkdir()
        shutil.copy(LIMPID, program)
        shutil.copy(LIMPID.with_name("limpid-model"), program.with_name("limpid-model"))
        (self.home / "share").mkdir()
        (self.home / "share/limpid").symlink_to(ROOT)
        findings = self.examine(program=program)
        self.assertEqual(findings["files", "limpid-model"]["state"], "ok")
        self.assertEqual(findings["files", "limpid-video"]["state"], "broken")
        self.assertIn("install", findings["files", "limpid-video"]["mend"])

    def test_without_assets(self) -> None:
        program = self.home / "limpid"
        shutil.copy(LIMPID, program)
        self.assertEqual(self.examine(program=program)["files", "assets"]["state"], "broken")

    def test_a_tool_that_is_missing(self) -> None:
        self.environment["PATH"] = str(self.home)
        gnuplot = self.examine()["files", "gnuplot"]
        self.assertEqual((gnuplot["state"], gnuplot["mend"]), ("better", "sudo apt install gnuplot-nox"))

    def limited(self, priority: int) -> tuple[str, ...]:
        """Words before a command that limit its real-time priority to this one."""
        words = ["prlimit", f"--rtprio={priority}:{priority}", "--memlock=65536:65536"]
        if os.geteuid() == 0:
            words += ["setpriv", "--bounding-set=-sys_nice,-ipc_lock", "--inh-caps=-all"]
        if subprocess.run([*words, "true"], capture_output=True).returncode != 0:
            self.skipTest("prlimit or setpriv does not work here")
        return tuple(words)

    def test_the_limit_of_priorities_and_of_memory(self) -> None:
        findings = self.examine(before=self.limited(50))
        self.assertEqual(findings["real time", "priority"]["state"], "ok")
        self.assertIn("SCHED_FIFO 50", findings["real time", "priority"]["found"])
        self.assertEqual(findings["real time", "memory"]["state"], "better")
        self.assertIn("64 KiB", findings["real time", "memory"]["found"])

    def test_no_priority_at_all(self) -> None:
        self.environment["DBUS_SYSTEM_BUS_ADDRESS"] = f"unix:path={self.home}/none"  # no rtkit
        findings = self.examine(before=self.limited(0))
        self.assertEqual(findings["real time", "priority"]["state"], "better")
        self.assertRegex(findings["real time", "priority"]["mend"], r"rtprio 80|usermod -aG realtime")
        self.assertIn("RLIMIT_RTPRIO 0", findings["real time", "priority"]["found"])

    def test_the_command_that_mends_names_a_rule_that_is_there(self) -> None:
        rule = self.examine()["devices", "udev rule"]
        named = re.search(r"/\S*70-limpid.rules", rule["mend"] or rule["found"])
        self.assertIsNotNone(named)
        self.assertTrue(Path(named[0]).is_file(), named[0])


if __name__ == "__main__":
    unittest.main()
