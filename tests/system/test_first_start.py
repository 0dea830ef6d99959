#!/usr/bin/python3
"""Messages of ./run before the program is built, with stand-ins for the tools that it calls."""

from __future__ import annotations

import os
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]

# Packages named in the file `installed` are installed.
DPKG_QUERY = """
while read -r name; do echo; echo "$name installed"; done < "$HERE/installed"
exit 1
"""
# Builds three files of a hundred; if `broken` exists beside it, the third fails.
CMAKE = """
[ "$1" = --build ] || exit 0
echo '[0/100] Re-running CMake'
echo '-- Found everything'
echo '[1/100] Building CXX object a.o'
echo 'b.cpp:1:2: warning: odd'
echo '[2/100] Building CXX object b.o'
[ -e "$HERE/broken" ] || exit 0
printf 'FAILED: c.o\\nc++ -c c.cpp\\nc.cpp:3:4: error: wrong\\n'
exit 1
"""


class FirstStart(unittest.TestCase):
    def setUp(self) -> None:
        self.bin = Path(tempfile.mkdtemp(prefix="limpid-start-"))
        self.addCleanup(shutil.rmtree, self.bin)
        for tool in ("bash", "cat", "dirname", "env", "grep"):
            (self.bin / tool).symlink_to(shutil.which(tool))
        (self.bin / "installed").touch()

    def tool(self, name: str, script: str) -> None:
        (self.bin / name).write_text(f"#!/bin/bash\n{script}\n")
        (self.bin / name).chmod(0o755)

    def run_script(self, *words: str) -> subprocess.CompletedProcess:
        return subprocess.run([ROOT / words[0], *words[1:]], capture_output=True, text=True, timeout=60,
                              stdin=subprocess.DEVNULL,
                              env=os.environ | {"PATH": str(self.bin), "HERE": str(self.bin)})  # fmt: skip

    def on_debian(self, uid: int, sudo: str = "exit 1") -> None:
        self.tool("dpkg-query", DPKG_QUERY)
        self.tool("apt-get", 'echo "apt-get $*" >> "$HERE/done"')
        self.tool("id", f"echo {uid}")
        self.tool("sudo", sudo)

    def asked_of_apt(self) -> str:
        done = self.bin / "done"
        return done.read_text() if done.exists() else ""

    def install_all_but(self, *words: str) -> None:
        """Installs all packages but one, by the names that ./run itself gives."""
        self.run_script(".ci/install")
        names = self.asked_of_apt().splitlines()[-1].split("--no-install-recommends ")[1].split()
        (self.bin / "installed").write_text("".join(f"{n}\n" for n in names if n not in words))
        (self.bin / "done").unlink()

    def test_elsewhere_it_names_libraries_and_the_way_without_it(self) -> None:
        done = self.run_script(".ci/install")
        self.assertEqual(done.returncode, 1)
        for part in ("Embree 3.13 or 4", "GLFW 3.3", "cmake --preset release && cmake --build --preset release"):
            self.assertIn(part, done.stderr)
        self.assertNotIn("apt", done.stderr)

    def test_root_gets_what_is_missing_installed(self) -> None:
        self.on_debian(uid=0)
        self.assertEqual(self.run_script(".ci/install").returncode, 0)
        self.assertRegex(self.asked_of_apt(), "install .*libembree-dev .*fonts-inter")

    def test_whoever_cannot_install_is_told_the_command(self) -> None:
        self.on_debian(uid=1000)
        done = self.run_script(".ci/install")
        self.assertEqual(done.returncode, 1)
        self.assertRegex(done.stderr, "sudo apt-get install --no-install-recommends build-essential .*libwebp-dev")
        self.assertEqual(self.asked_of_apt(), "")

    def test_comfort_stops_nobody(self) -> None:
        self.on_debian(uid=0)
        self.install_all_but("ccache", "gnuplot-nox")
        self.tool("id", "echo 1000")
        done = self.run_script(".ci/install")
        self.assertEqual(done.returncode, 0)
        self.assertIn("ccache gnuplot-nox", done.stderr)
        self.tool("id", "echo 0")
        self.tool("apt-get", "exit 100")
        self.assertEqual(self.run_script(".ci/install").returncode, 0)

    def test_with_everything_there_nothing_is_said(self) -> None:
        self.on_debian(uid=0)
        self.install_all_but()
        self.tool("id", "echo 1000")
        done = self.run_script(".ci/install")
        self.assertEqual((done.returncode, done.stdout, done.stderr), (0, "", ""))

    def test_a_build_tells_how_far_it_is_and_not_what_the_compiler_is_told(self) -> None:
        self.tool("cmake", CMAKE)
        done = self.run_script(".ci/build", "limpid")
        self.assertEqual(done.returncode, 0)
        self.assertIn("1 of 100 files done", done.stderr)
        self.assertIn("b.cpp:1:2: warning: odd", done.stderr)
        self.assertNotRegex(done.stderr, "Building CXX|Found everything")

    def test_a_build_that_fails_shows_all_of_it(self) -> None:
        self.tool("cmake", CMAKE)
        (self.bin / "broken").touch()
        done = self.run_script(".ci/build", "limpid")
        self.assertEqual(done.returncode, 1)
        self.assertIn("FAILED: c.o\nc++ -c c.cpp\nc.cpp:3:4: error: wrong\n", done.stderr)


if __name__ == "__main__":
    unittest.main()
