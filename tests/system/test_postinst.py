#!/usr/bin/python3
"""Actions of the package on installation, with stand-ins for programs that change the computer."""

from __future__ import annotations

import subprocess
import unittest

from support import ROOT, SystemTest

POSTINST = ROOT / "assets/package/postinst"


class Postinst(SystemTest):
    """A computer with or without the group; its programs note their arguments."""

    def setUp(self) -> None:
        self.place = self.out("")
        self.place.mkdir()
        self.log = self.place / "log"
        self.log.write_text("")

    def program(self, name: str, script: str) -> None:
        path = self.place / name
        path.write_text(f'#!/bin/sh\necho "{name} $*" >>"{self.log}"\n{script}\n')
        path.chmod(0o755)

    def install(self, group: str) -> tuple[int, list[str]]:
        """Installs; `group` is none, system or ordinary."""
        self.program("getent", f'[ "{group}" != none ] || exit 2; echo realtime:x:1234:somebody')
        # adduser 3.134 of Debian 12 accepts an existing system group, and refuses another one.
        self.program("addgroup", f'[ "{group}" != ordinary ] || exit 1')
        self.program("udevadm", "exit 0")
        done = subprocess.run(["/bin/sh", POSTINST, "configure", ""], capture_output=True, text=True,
                              env={"PATH": f"{self.place}:/usr/bin:/bin"}, timeout=60)  # fmt: skip
        return done.returncode, self.log.read_text().splitlines()

    def test_it_makes_the_group_where_there_is_none(self) -> None:
        status, asked = self.install("none")
        self.assertEqual(status, 0)
        self.assertIn("addgroup --quiet --system realtime", asked)

    def test_it_leaves_a_group_alone_that_is_there(self) -> None:
        for group in ("system", "ordinary"):
            with self.subTest(group=group):
                self.log.write_text("")
                status, asked = self.install(group)
                self.assertEqual(status, 0)
                self.assertEqual([line for line in asked if line.startswith("addgroup")], [])

    def test_it_fails_where_the_group_cannot_be_made(self) -> None:
        self.program("getent", "exit 2")
        self.program("addgroup", "exit 1")
        done = subprocess.run(["/bin/sh", POSTINST, "configure", ""], capture_output=True, timeout=60,
                              env={"PATH": f"{self.place}:/usr/bin:/bin"})  # fmt: skip
        self.assertNotEqual(done.returncode, 0)

    def test_it_does_nothing_when_it_is_not_to_configure(self) -> None:
        self.program("addgroup", "exit 1")
        done = subprocess.run(["/bin/sh", POSTINST, "abort-upgrade", "1"], timeout=60,
                              env={"PATH": f"{self.place}:/usr/bin:/bin"})  # fmt: skip
        self.assertEqual(done.returncode, 0)
        self.assertEqual(self.log.read_text(), "")


if __name__ == "__main__":
    unittest.main()
