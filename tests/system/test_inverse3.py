"""The Inverse3 through a stand-in of its service: listed, named, and pushed in the window."""

from __future__ import annotations

import os
import subprocess
import tempfile
import threading
import time
import unittest
from pathlib import Path

from support import ASSETS, LIMPID, ROOT, limpid
from window import WindowTest

PROGRAM = ROOT / "tests" / "support" / "inverse_service.py"
ON_TABLE = "move 0 -0.12 0.115"  # half a centimetre below the table top of the scene


class Service:
    """The stand-in and its lines."""

    def __init__(self, port: str = "0") -> None:
        self.process = subprocess.Popen(["/usr/bin/python3", PROGRAM, port], text=True, bufsize=1,
                                        stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        self.lines: list[str] = []
        self.listener = threading.Thread(target=self._listen, daemon=True)
        self.listener.start()
        self.port = self.wait(lambda line: line.startswith("port ")).split()[1]
        self.name = f"inverse3@127.0.0.1:{self.port}"

    def _listen(self) -> None:
        assert self.process.stdout is not None
        for line in self.process.stdout:
            self.lines.append(line.strip())

    def tell(self, order: str) -> None:
        assert self.process.stdin is not None
        self.process.stdin.write(order + "\n")

    def wait(self, wanted, seconds: float = 60) -> str:
        """Waits for the first wanted line; forgets all lines before it."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            for i, line in enumerate(list(self.lines)):
                if wanted(line):
                    del self.lines[: i + 1]
                    return line
            time.sleep(0.01)
        raise AssertionError(f"the service has not said it, but {self.lines[-5:]}")

    def wait_for_all_so_far(self) -> None:
        """Forgets all lines up to now."""
        self.tell("count")
        self.wait(lambda line: line.startswith("messages"))

    def pushes(self) -> list[str]:
        lines = list(self.lines)
        return [line for line in lines if line.startswith("force ") and line != "force 0 0 0"]

    def end(self) -> None:
        self.process.kill()
        self.process.communicate()


def lifts(line: str) -> bool:
    """A force upward."""
    words = line.split()
    return words[0] == "force" and float(words[3]) > 0


class Named(unittest.TestCase):
    def test_is_listed_where_the_device_in_use_says_that_its_service_is(self) -> None:
        service = Service()
        with tempfile.TemporaryDirectory() as home:
            book = Path(home, "limpid", "devices.toml")
            book.parent.mkdir()
            book.write_text(f'in_use = "{service.name}"\n')
            environment = {**os.environ, "XDG_CONFIG_HOME": home}
            listed = subprocess.run([str(LIMPID), "devices"], env=environment, text=True,
                                    capture_output=True, timeout=60)
            self.assertIn(f"Haply Inverse3 (127.0.0.1:{service.port})\n"
                          f"  Haply Inverse3, inverse3:049D@127.0.0.1:{service.port}", listed.stdout)
            self.assertIn(", in use", listed.stdout)
            service.end()
            gone = subprocess.run([str(LIMPID), "devices"], env=environment, text=True,
                                  capture_output=True, timeout=60)
            self.assertIn("no Haply Inverse Service at", gone.stdout)
            words = ["identify", service.name, "--out", str(Path(home, "out"))]
            refused = subprocess.run([str(LIMPID), *words], env=environment, text=True,
                                     capture_output=True, timeout=60)
            self.assertNotEqual(refused.returncode, 0)
            self.assertIn("no Haply Inverse Service at", refused.stderr)

    def test_names_an_arm_like_it_where_nothing_is_connected(self) -> None:
        run = limpid("run", "--device", "inverse3", "--duration", "0.1")
        self.assertEqual(run.status, 0, run.err)
        for wrong in ("inverse3:", "inverse3@", "inverse3@desk:0"):
            refused = limpid("run", "--device", wrong)
            self.assertEqual(refused.status, 2, refused.err)
            self.assertIn("inverse3[:ID][@HOST[:PORT]]", refused.err)


class InTheWindow(WindowTest):
    LAW = None

    def prepare(self) -> None:
        self.service = Service()
        self.addCleanup(self.service.end)
        self.service.tell("spring 2000")  # moves as in a hand; constant readings get no force
        book = self.home / "config/limpid/devices.toml"
        book.write_text(f'[device."inverse3:049D@127.0.0.1:{self.service.port}"]\nchecked = true\n')
        self.words = ["--device", self.service.name,
                      "--scene", str(ASSETS / "scenes" / "table.toml")]

    def wait_in_the_loop(self) -> None:
        self.wait("the device in the loop", lambda s: s["arm"] == "inverse3", 60)
        self.service.wait(lambda line: line == "session")

    def arm_until_it_lifts(self) -> None:
        """Arms until a force lifts, repeatedly on a busy machine: 5 ms without a reading take the
        force away."""
        end = time.monotonic() + 60
        while not any(lifts(line) for line in self.service.lines) and time.monotonic() < end:
            if not self.state()["force"]:
                self.key("f")
            time.sleep(1)  # the age of a state is at most this
        self.service.wait(lifts)

    def check_without_force(self, why: str) -> None:
        self.wait("the force to be off", lambda s: not s["force"])
        self.service.wait_for_all_so_far()
        self.go_on(0.3)
        self.assertEqual(self.service.pushes(), [], why)

    def test_pushes_only_while_it_is_armed_and_starts_anew_without_force(self) -> None:
        self.wait_in_the_loop()
        self.wait_for_notice("press F to arm the force")
        self.service.tell(ON_TABLE)
        self.wait("contact", lambda s: s["contact"] > 0)
        self.check_without_force("not armed")
        self.arm_until_it_lifts()
        self.key("Escape")
        self.service.wait(lambda line: line == "force 0 0 0")
        self.check_without_force("cut")
        self.arm_until_it_lifts()
        self.service.tell("drop")
        self.service.wait(lambda line: line == "end")
        self.wait_for_notice("The device is disconnected")
        self.service.wait(lambda line: line == "session")
        self.wait("contact again", lambda s: s["contact"] > 0)
        self.check_without_force("not armed again")
        self.arm_until_it_lifts()
        self.service.tell("silent")
        self.check_without_force("no readings")
        self.service.tell("answer")
        self.check_without_force("not armed since the silence")
        self.arm_until_it_lifts()
        self.app.terminate()
        self.service.wait(lambda line: line == "force 0 0 0")
        self.service.wait(lambda line: line == "end")

    def another_window(self, *words: str) -> dict:
        """Text of a second window about the device once it knows it; the first window's force goes
        on."""
        first, states = self.app, self.states
        try:
            self.states = (self.home / "others").open("w")
            self.addCleanup(self.states.close)
            self.words = list(words)
            self.start()
            self.wait("the second window's device", lambda s: s["device_panel"]["problem"] not in
                      ("", "not connected"), 60)
            self.go_on(4)  # enough time for another try
            return self.state()
        finally:
            second = self.app
            self.stop(second)
            self.app, self.states = first, states

    def test_is_left_alone_by_a_second_window_and_by_one_that_was_started_with_a_file(self) -> None:
        self.wait_in_the_loop()
        self.service.tell(ON_TABLE)
        self.wait("contact", lambda s: s["contact"] > 0)
        self.arm_until_it_lifts()
        self.service.wait_for_all_so_far()
        holder = f"process {self.app.pid} (limpid "
        for words, why in (((), "Another window of Limpid already uses a device"),
                           ((str(ASSETS / "scenes" / "table.toml"),), "was started with a file")):
            with self.subTest(words=words):
                device = self.another_window(*words)["device_panel"]
                self.assertIn(why, device["problem"])
                self.assertIn("in use by " + holder, device["problem"])
                self.assertTrue(device["waits_for_choice"])
        # On a busy machine the first window may lose its stream, which it begins anew then.
        streams = 1
        for line in list(self.service.lines):
            streams += {"session": 1, "end": -1}.get(line, 0)
            self.assertLessEqual(streams, 1, "no second stream of forces")


if __name__ == "__main__":
    unittest.main()
