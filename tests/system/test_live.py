"""Commands that lead a hand on a real device, played by a program here."""

from __future__ import annotations

import os
import pty
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest
from pathlib import Path
from unittest import mock

from support import ASSETS, LIMPID, Result, limpid

DEVICE = Path(__file__).with_name("replaying_device.py")
COMES_BACK = 5  # longest time until force comes back after a device is on time again [s]


class Lateness:
    """Wakes up every millisecond in a thread of its own, and keeps when it came more than 5 ms late."""

    def __enter__(self) -> Lateness:
        self.when: list[float] = []
        self.over = threading.Event()
        self.thread = threading.Thread(target=self.watch)
        self.thread.start()
        return self

    def watch(self) -> None:
        before = time.monotonic()
        while not self.over.wait(0.001):
            now = time.monotonic()
            if now - before > 0.005:
                self.when.append(now)
            before = now

    def __exit__(self, *_: object) -> None:
        self.over.set()
        self.thread.join()


class Live(unittest.TestCase):
    def setUp(self) -> None:
        self.folder = Path(self.enterContext(tempfile.TemporaryDirectory()))
        (self.folder / "limpid").mkdir(mode=0o700)
        self.enterContext(mock.patch.dict("os.environ", XDG_RUNTIME_DIR=str(self.folder),
                                          XDG_CONFIG_HOME=str(self.folder / "config")))

    def plug(self, *words: str | Path) -> subprocess.Popen:
        """Plugs in a device that moves as in a run with these words; without words, as in one that
        pressed onto the table."""
        book = self.folder / "config/limpid/devices.toml"
        book.parent.mkdir(parents=True, exist_ok=True)
        book.write_text('[device."socket:replay"]\nchecked = true\n')
        session = self.folder / "pressing.h5"
        limpid("run", *(words or ("--hand", ASSETS / "hands/touch.csv")), "--record", session, "--force")
        self.late = self.folder / "late"
        self.late.touch()
        device = subprocess.Popen([sys.executable, DEVICE, "replay", session, self.late])
        self.addCleanup(device.wait)
        self.addCleanup(device.kill)
        for _ in range(600):
            if "replay" in limpid("devices").out:
                return device
            time.sleep(0.1)
        self.fail("the device is not listed")

    def on_time(self, *words: str | Path) -> Result:
        """Runs a command. The device is a Python program, which may be late, as may be the thread that
        reads it: it has no force then, and again when both are on time. The device reports delays, and
        a thread here those of this computer; a loss of force without either is a fault."""
        begun = time.monotonic()
        with Lateness() as lateness:
            result = limpid(*words)
        no_force, too_long = "gets no force" in result.err, "for too long" in result.err
        if not no_force and not too_long:
            return result
        self.assertRegex(result.err, "no reading for 5 ms|loop stood still", "of another kind")
        stalls = sorted([when for line in self.late.read_text().splitlines()
                         if (when := float(line.split()[0])) > begun] + lateness.when)
        self.assertTrue(stalls, "nothing was ever late: " + result.err)
        if no_force:
            times = [begun, *stalls, time.monotonic()]
            on_time = max(after - before for before, after in zip(times, times[1:]))
            self.assertLess(on_time, COMES_BACK, "the device was on time so long: " + result.err)
        self.skipTest(f"the device in Python was late {len(stalls)} times: {result.err.strip()}")

    def test_refuses_what_cannot_be(self) -> None:
        for words, said in (
                (("--yes",), "no device is chosen"),
                (("nothing", "--yes"), "nothing: is not connected"),
                ((), "no device is chosen"),
                (("--yes", "--hand", "x.csv"), "--hand: not together with --live"),
                (("--yes", "--twin"), "--twin: not together with --live")):
            with self.subTest(words=words):
                result = limpid("run", "--live", *words)
                self.assertEqual((result.status, len(result.error_lines)), (2, 1), result.err)
                self.assertIn(said, result.err)
        result = limpid("experiment", "spectrum", "--live", "--yes", "--out", self.folder / "out")
        self.assertEqual(result.status, 2)
        self.assertIn("coordination, inertia, passivity, zwidth", result.err)

    def test_runs_and_records(self) -> None:
        self.plug()
        out = self.folder / "live.h5"
        result = self.on_time("run", "--live", "--yes", "--duration", "2", "--record", out)
        self.assertEqual(result.status, 0, result.err)
        self.assertIn("device", limpid("info", out).out)

    def test_measures_the_grip_once_the_whole_force_is_on(self) -> None:
        import h5py
        import numpy

        self.plug()
        out = self.folder / "grip.h5"
        result = self.on_time("run", "--live", "--yes", "--duration", "10", "--measure-grip", "--record", out)
        self.assertEqual(result.status, 0, result.err)
        self.assertNotIn("was not measured", result.out, "it never began")
        with h5py.File(out) as session:
            pushed = numpy.any(session["device/excitation"][...] != 0, axis=1)
            off = session["device/force_state"][...] != 0
            self.assertLessEqual(numpy.count_nonzero(off & pushed), 1, "the tick in which it goes")
        self.assertNotIn("was not measured", limpid("analyze", "--grip-of", out).err)

    def refused(self, *words: str | Path) -> str:
        """Message of the refused command, which has written nothing."""
        out = self.folder / "refused"
        options = {"identify": ["--out", out, "--yes"],
                   "run": ["--live", "--yes", "--record", out / "live.h5"],
                   "experiment": ["coordination", "--live", "--yes", "--out", out]}
        said = ""
        for command in words or ("identify", "run", "experiment"):
            result = limpid(str(command), *options[str(command)])
            self.assertEqual((result.status, len(result.error_lines)), (2, 1), result.err)
            self.assertFalse((out / "live.h5").exists())
            said = result.err
        return said

    def test_refuses_a_device_whose_axes_nobody_has_checked(self) -> None:
        self.plug()
        (self.folder / "config/limpid/devices.toml").unlink()
        said = self.refused()
        self.assertIn("replay: the axes must be checked before the device may push", said)
        self.assertIn("Device panel", said)

    def test_refuses_a_device_whose_limits_cannot_be_understood_and_keeps_the_file(self) -> None:
        self.plug()
        book = self.folder / "config/limpid/devices.toml"
        entry = '[device."socket:replay"]\nchecked = true\n'
        for text, said in (
                (entry + 'limits = {tip_force = "1"}\n', 'limits.tip_force: "1" is not allowed'),
                (entry + "limits = {tip_force = 100}\n", "allowed: a number from 0.1 up to 10"),
                (entry + "axis = [{inverted = 'yes'}]\n", "allowed: true, false"),
                (entry + "checked = \n", "not TOML")):
            with self.subTest(text=text):
                book.write_text(text)
                answer = self.refused()
                self.assertIn(said, answer)
                self.assertIn(f"{book}:", answer)
                self.assertEqual(book.read_text(), text)
                forget = limpid("identify", "socket:replay", "--forget")
                self.assertEqual(forget.status, 2, forget.err)
                self.assertEqual(book.read_text(), text)

    def test_is_told_once_which_arm_a_device_is_and_says_it_at_each_connection(self) -> None:
        self.plug()
        self.assertIn("until you choose", limpid("devices").out)
        wrong = limpid("devices", "socket:replay", "--arm", ASSETS / "devices/joystick.urdf")
        self.assertEqual(wrong.status, 2)
        self.assertIn("of 2 joints. The device has 3 joints now", wrong.err)
        right = limpid("devices", "socket:replay", "--arm", ASSETS / "devices/omni.urdf")
        self.assertEqual(right.status, 0, right.err)
        self.assertIn("is used as the arm omni: this arm was chosen", right.out)
        self.assertIn("omni.urdf, as chosen", limpid("devices").out)
        self.assertIn("this arm was chosen", limpid("run", "--live", "--yes", "--duration", "0.1").err)
        self.assertEqual(limpid("devices", "socket:replay", "--arm", "unsaid").status, 0)
        book = (self.folder / "config/limpid/devices.toml").read_text()
        self.assertIn("checked = true", book)
        self.assertNotIn("omni", book)
        self.assertIn("until you choose", limpid("run", "--live", "--yes", "--duration", "0.1").err)

    def test_leaves_a_device_alone_that_another_program_has(self) -> None:
        self.plug()
        first = subprocess.Popen([LIMPID, "run", "--live", "--yes", "--duration", "30"],
                                 stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.addCleanup(first.communicate)
        self.addCleanup(first.kill)
        who = f"process {first.pid} (limpid run --live --yes"
        for _ in range(300):
            if who in limpid("devices").out:
                break
            time.sleep(0.1)
        self.assertIn(f"in use by {who}", limpid("devices").out)
        second = limpid("run", "--live", "--yes", "--duration", "1")
        self.assertEqual(second.status, 1, second.err)
        self.assertIn(f"replay: in use by {who}", second.err)
        self.assertIsNone(first.poll(), "the first one goes on")
        first.kill()
        first.wait()
        self.assertNotIn("in use by", limpid("devices").out)

    def test_coordination_has_a_figure_and_a_verdict(self) -> None:
        self.plug()
        out = self.folder / "out"
        result = self.on_time("experiment", "coordination", "--live", "socket:replay", "--yes", "--out", out)
        for name in ("live-coordination.png", "live-coordination.json", "report.html",
                     "live-coordination/standard.h5", "live-coordination/proposed.h5"):
            self.assertTrue((out / name).exists(), name + ": " + result.err)
        self.assertIn("slope of the error", result.out)

    def test_begins_by_no_enter_of_before_and_leaves_the_old_file_then(self) -> None:
        self.plug()
        out = self.folder / "old.h5"
        out.write_text("precious")
        keyboard, terminal = pty.openpty()
        self.addCleanup(os.close, keyboard)
        run = subprocess.Popen([LIMPID, "run", "--live", "--duration", "60", "--record", out,
                                "--force"], stdin=terminal, stdout=subprocess.PIPE,
                               stderr=subprocess.PIPE, text=True)
        os.close(terminal)
        os.write(keyboard, b"\n\n")
        time.sleep(4)
        run.send_signal(signal.SIGINT)
        asked, said = run.communicate(timeout=60)
        self.assertIn("Enter begins", asked)
        self.assertTrue(said.endswith("\nlimpid: stopped\n"), f"it has begun: {said}")
        self.assertEqual(run.returncode, 1)
        self.assertEqual(out.read_text(), "precious")
        self.assertEqual(list(self.folder.glob("*.part")), [])

    def test_moves_by_no_enter_of_before(self) -> None:
        self.plug()
        keyboard, terminal = pty.openpty()
        self.addCleanup(os.close, keyboard)
        run = subprocess.Popen([LIMPID, "identify", "--out", self.folder / "found"], stdin=terminal,
                               stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        os.close(terminal)
        os.write(keyboard, b"\n\n")
        time.sleep(4)
        self.assertIsNone(run.poll(), "it has begun")
        run.send_signal(signal.SIGINT)
        asked, _ = run.communicate(timeout=60)
        self.assertIn("Enter begins", asked)
        self.assertFalse((self.folder / "found/motion.csv").exists(), "it has moved")

    def test_ends_when_the_device_is_pulled_out_or_on_ctrl_c(self) -> None:
        for what in ("pulled out", "Ctrl-C"):
            device = self.plug()
            run = subprocess.Popen([LIMPID, "run", "--live", "--yes", "--duration", "60"],
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
            time.sleep(3)
            if what == "Ctrl-C":
                run.send_signal(signal.SIGINT)
            else:
                device.kill()
            _, said = run.communicate(timeout=60)
            self.assertIn(run.returncode, (0, 1), said)
            self.assertRegex(said, "is disconnected|" + ("stopped" if what == "Ctrl-C" else "no reading"))

    def test_nobody_arms_a_device_through_the_socket(self) -> None:
        sys.path.insert(0, str(ASSETS / "python"))
        import limpid as package

        self.plug()
        with mock.patch.dict("os.environ", LIMPID=str(LIMPID)), package.serve(live="socket:replay") as loop:
            self.assertTrue(loop.state()["device"])
            for step in (lambda: loop.set({"coupling.eta": 0.8, "coupling.kind": "predictive"}),
                         loop.start_over, lambda: loop.open(scene="table.toml")):
                step()
                time.sleep(0.2)  # ticks of the loop
                self.assertFalse(loop.state()["force"])
            file = loop.record(self.folder / "served.h5")
            loop.mark("here")
            time.sleep(0.5)
            loop.stop()
            for verb, keys, said in (
                    ("twin", {}, "virtual arm"), ("open", {"hand": "touch.csv"}, "a person's hand moves a real device"),
                    ("open", {"arm": "omni.urdf"}, "real device"),
                    ("set", {"values": {"device.torque_limit": 100}}, "Only a person raises a limit"),
                    ("arm", {}, "is not known")):
                with self.subTest(verb=verb), self.assertRaisesRegex(package.RequestError, said):
                    loop.request(verb, **keys)
            self.assertFalse(loop.state()["force"])
            loop.cut()
        session = package.session(file)
        self.assertGreater(len(session), 100)
        self.assertEqual(set(session["device/force_wanted"]), {0})
        self.assertEqual(abs(session["device/motor_torque"]).max(), 0)

    def test_serve_reads_scenes_for_the_device_that_is_there(self) -> None:
        sys.path.insert(0, str(ASSETS / "python"))
        import limpid as package

        self.plug("--device", ASSETS / "devices/joystick.urdf")
        with mock.patch.dict("os.environ", LIMPID=str(LIMPID)), package.serve(live="socket:replay") as loop:
            # The stop is at the shoulder of the built-in arm; a joystick has none, but a second
            # joint.
            with self.assertRaisesRegex(package.RequestError, "proximal.toml:.*shoulder"):
                loop.open(scene="proximal.toml")
            loop.open(scene="free.toml")

    def test_refuses_a_device_without_motors(self) -> None:
        program = ("import sys, time; sys.path.insert(0, sys.argv[1]); from limpid_device import LimpidDevice\n"
                   "device = LimpidDevice('still', [-1] * 3, [1] * 3, [0.0] * 3, version=2, slides=[False] * 3)\n"
                   "while True:\n"
                   "    device.exchange([0.0, 0.0, 1.0])\n"
                   "    time.sleep(1e-3)\n")
        device = subprocess.Popen([sys.executable, "-c", program, ASSETS / "python"])
        self.addCleanup(device.wait)
        self.addCleanup(device.kill)
        for _ in range(600):
            if "socket:still" in limpid("devices").out:
                break
            time.sleep(0.1)
        for words in (("run", "--yes"), ("serve", "x")):
            with self.subTest(words=words):
                result = limpid(*words, "--live", "socket:still", "--device", ASSETS / "devices/omni.urdf",
                                timeout=30)
                self.assertEqual((result.status, len(result.error_lines)), (2, 1), result.err)
                self.assertIn("still: has no motors", result.err)

    def test_serve_leaves_the_hand_to_a_person(self) -> None:
        result = limpid("serve", "x", "--live", "socket:replay", "--hand", ASSETS / "hands/touch.csv")
        self.assertEqual(result.status, 2)
        self.assertIn("--hand: not together with --live", result.err)


if __name__ == "__main__":
    unittest.main()
