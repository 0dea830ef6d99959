"""limpid-vendor drives stand-ins for makers' libraries: each fault, and what the motors then hold.

The stand-ins record what their motors hold, also when the program is killed. Nothing here says what
a real device does.
"""

from __future__ import annotations

import contextlib
import json
import math
import os
import re
import select
import shutil
import signal
import subprocess
import tempfile
import time
import unittest
from pathlib import Path

import h5py
import numpy as np

from support import LIMPID, ROOT
from vendor_link import (STAND_INS, VENDOR, Held, Link, Vendor, environment, motors_in, zero_after,
                         zero_after_the_last_force)

TOUCH = ("openhaptics", "Default Device")
OMEGA = ("forcedimension", "0")
BOTH = (TOUCH, OMEGA)
# The safety table's times, and what a busy computer adds to those of a process that is no real-time
# one [s].
SILENCE, AT_ONCE = 0.005, 0.0
BUSY = 0.02


def own_axes(device: tuple, force: tuple) -> tuple:
    """A force in the axes of the device's library: Limpid's are forward, left, up."""
    x, y, z = force
    # Touch: right, up, towards the person. omega: towards the person, right, up.
    return (-y, z, -x) if device == TOUCH else (-x, -y, z)


def listed(faults: str = "", libraries: Path | None = STAND_INS, config: str = "") -> list[dict]:
    with tempfile.TemporaryDirectory() as folder:
        if config:
            Path(folder, ".3dsystems/config").mkdir(parents=True)
            Path(folder, ".3dsystems/config", f"{config}.config").touch()
        done = subprocess.run([VENDOR, "list"], capture_output=True, text=True, timeout=60,
                              env=environment(folder, faults, libraries))
        assert done.returncode == 0, done.stderr
        return [json.loads(line) for line in done.stdout.splitlines()]


class Lists(unittest.TestCase):
    def test_a_line_for_each_library_and_device(self) -> None:
        lines = listed(config="Left Device")
        libraries = {line["backend"]: line for line in lines if "library" in line}
        devices = {(line["backend"], line["device"]) for line in lines if "device" in line}
        self.assertEqual({key: line["missing"] for key, line in libraries.items()},
                         {"openhaptics": "", "forcedimension": ""})
        self.assertEqual(Path(libraries["openhaptics"]["library"]).name, "libHD.so.3.4")
        # OpenHaptics says its version only of an open device.
        self.assertEqual({key: line["version"] for key, line in libraries.items()},
                         {"openhaptics": "", "forcedimension": "3.17.1.20"})
        self.assertEqual(devices, {("openhaptics", "Left Device"), ("forcedimension", "0")})

    def test_the_library_s_own_file_has_its_version(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            shutil.copy(STAND_INS / "libHD.so.3.4", Path(folder, "libHD.so.3.4.0"))
            Path(folder, "libHD.so.3.4").symlink_to("libHD.so.3.4.0")
            line = next(line for line in listed(libraries=Path(folder)) if line["backend"] == "openhaptics")
            self.assertEqual(line["library"], str(Path(folder, "libHD.so.3.4.0").resolve()))

    def test_what_is_missing_and_who_has_it(self) -> None:
        missing = {line["backend"]: line["missing"] for line in listed(libraries=None)
                   if "library" in line}
        self.assertIn("libHD.so.3.4 is not installed", missing["openhaptics"])
        self.assertIn("3D Systems", missing["openhaptics"])
        self.assertIn("libdhd.so.3 is not installed", missing["forcedimension"])
        self.assertIn("Force Dimension", missing["forcedimension"])

    def test_which_library_the_library_needs(self) -> None:
        missing = next(line["missing"] for line in listed(libraries=STAND_INS / "needs_ncurses")
                       if line["backend"] == "openhaptics")
        self.assertIn("needs libncurses.so.5, which is not installed: ", missing)
        # The window copies what stands between the quotes.
        how, command, rest = missing.partition("not installed: ")[2].split("'")
        self.assertEqual(rest, "")
        for package in ("libtinfo5", "libncurses5"):
            self.assertIn(f"ncurses/{package}_6.4-4_amd64.deb ", command + " ")
            self.assertIn(f" ./{package}_6.4-4_amd64.deb", command.partition("apt install")[2])
        told = " ".join((ROOT / "devices/README.md").read_text().split())
        self.assertIn(how + command, told)

    def test_prints_of_a_library_stay_out_of_the_lines(self) -> None:
        for line in listed("prints"):
            self.assertIn("backend", line)

    def test_no_device_is_no_line(self) -> None:
        self.assertFalse([line for line in listed("no_device") if "device" in line])


def on_both(*faults: str):
    """Runs a test with each maker's device, under each of these faults."""
    def of(test):
        def run(self) -> None:
            for device in BOTH:
                for fault in faults or ("",):
                    with self.subTest(device=device[0], fault=fault), Vendor(*device, fault) as vendor:
                        test(self, device, vendor)
        return run
    return of


class Serves(unittest.TestCase):
    def ends(self, vendor: Vendor, status: int) -> str:
        _, said = vendor.process.communicate(timeout=20)
        self.assertEqual(vendor.process.returncode, status, said)
        return said

    @on_both()
    def test_three_slides_within_the_range_and_force_of_the_device(self, device: tuple,
                                                                  vendor: Vendor) -> None:
        expected = {TOUCH: ((-0.07, -0.16, -0.1), 3.3, "Touch S1", "libHD.so.3.4 3.40.0"),
                    OMEGA: ((-0.075,) * 3, 10, "omega.3 12", "libdrd.so.3 3.17.1.20")}
        found = vendor.link().description
        lower, force, name, made_by = expected[device]
        self.assertEqual((found.joints, found.motors, found.watchdog), (3, True, 5))
        self.assertEqual(found.kinds, (1, 1, 1))
        for end, own in zip(found.lower, lower):
            self.assertAlmostEqual(end, own, 6)
        for effort in found.effort:
            self.assertAlmostEqual(effort, force, 5)
        self.assertEqual((found.name, found.made_by), (name, made_by))

    def test_a_library_that_does_not_say_its_version_drives_the_device(self) -> None:
        with Vendor(*TOUCH, "no_version") as vendor:
            link = vendor.link()
            self.assertEqual(link.description.made_by, "libHD.so.3.4")
            link.go_on(0.2)
            self.assertFalse(link.gone)

    def test_joint_angles_are_compared_with_the_position(self) -> None:
        for faults, apart in (("sway:0.6", range(0, 1)), ("sway:0.6,bent", range(1, 100))):
            with Vendor(*TOUCH, faults) as vendor:
                vendor.link().go_on(1)
                vendor.process.terminate()
                said = self.ends(vendor, 0)
                found = re.search(r"its joint angles .* up to ([\d.]+) mm apart while it moved (\d+) mm", said)
                self.assertIsNotNone(found, said)
                self.assertIn(int(float(found[1]) + 0.5), apart)
                self.assertGreater(int(found[2]), 20)

    # The stand-in's spring is 40 N/m.
    @on_both()
    def test_a_force_along_an_axis_moves_the_tip_along_it(self, device: tuple, vendor: Vendor) -> None:
        link = vendor.link()
        for axis in range(3):
            force = tuple(0.8 if i == axis else 0.0 for i in range(3))
            there = tuple(f / 40 for f in force)
            arrives = lambda reading: math.dist(reading.x, there) < 2e-3
            self.assertTrue(link.go_on(20, force, until=arrives), link.newest)
            held = vendor.motors()[-1].force
            self.assertLess(math.dist(held, own_axes(device, force)), 1e-6)

    @on_both()
    def test_motors_are_off_until_a_force_is_asked_for(self, device: tuple, vendor: Vendor) -> None:
        link = vendor.link()
        link.go_on(0.3)
        self.assertTrue(link.readings)
        self.assertFalse([held for held in vendor.motors() if held.on])
        link.go_on(0.3, (0.5, 0.0, 0.0))
        self.assertTrue([held for held in vendor.motors() if held.on])

    @on_both()
    def test_a_force_beyond_the_device_is_cut_to_it(self, device: tuple, vendor: Vendor) -> None:
        link = vendor.pushed((50.0, 0.0, 0.0))
        most = 3.3 if device == TOUCH else 10
        link.go_on(0.1, (50.0, 0.0, 0.0))
        self.assertLessEqual(max(max(map(abs, held.force)) for held in vendor.motors()), most)

    def zero_in_the_next_frame(self, device: tuple, what: str, every: list[Held]) -> None:
        """The force was another one in each frame, so that the last one stands in the record."""
        self.assertFalse(any(every[-1].force))
        zero = zero_after_the_last_force(every)
        print(f"{device[0]}: {what} {1e3 * zero:.1f} ms after the last force")
        self.assertLess(zero, SILENCE + BUSY)

    def zeros(self, device: tuple, vendor: Vendor, what: str, end) -> list[float]:
        """Times from an end of the force until the motors hold nothing, of five [s]."""
        times = []
        for _ in range(50):
            link = vendor.pushed()
            at = end(link)
            zero = vendor.zero_after(at)  # none: a busy computer was silent before
            self.assertFalse(vendor.motors()[-1].on)
            link.close()
            times += [zero] if zero is not None else []
            if len(times) == 5:
                break
        print(f"{device[0]}: {what} {1e3 * min(times):.1f} to {1e3 * max(times):.1f} ms")
        return times

    @on_both()
    def test_what_the_hop_adds(self, device: tuple, vendor: Vendor) -> None:
        """A reading's age when it arrives, and the time from a force's command until the motors hold it."""
        link = vendor.pushed()
        ages, held = [], []
        for i in range(1500):
            select.select([link.socket], [], [], 0.02)
            arrived, before = time.monotonic(), len(link.readings)
            link.listen()
            ages += [arrived - link.newest.taken] if len(link.readings) == before + 1 else []
            force = (1.0 + 1e-3 * (i % 7), 0.0, 0.0)
            at = link.send(None if link.newest.cut else force)
            held.append((at, own_axes(device, force)))
        delays, begun = [], 0
        for entry in vendor.motors():
            for i, (at, force) in enumerate(held[begun:], begun):
                if at < entry.time and math.dist(force, entry.force) < 1e-6:
                    delays.append(entry.time - at)
                    begun = i + 1
                    break
        for what, times in (("a reading is", ages), ("a force acts after", delays)):
            self.assertGreater(len(times), 300)
            middle, late, worst = (1e3 * np.quantile(times, part) for part in (0.5, 0.99, 1))
            print(f"{device[0]}: {what} {middle:.2f} ms, 99 % {late:.2f}, at most {worst:.2f} ms")
            self.assertLess(middle, 1.5, "more than a frame")

    @on_both()
    def test_no_force_5_ms_after_the_last_command(self, device: tuple, vendor: Vendor) -> None:
        times = self.zeros(device, vendor, "silence", lambda link: link.send((1.0, 0.0, 0.0)))
        self.assertLess(min(times), SILENCE + BUSY)
        self.assertGreater(min(times), 0.9 * SILENCE)

    @on_both()
    def test_after_silence_a_command_of_no_force_comes_first(self, device: tuple, vendor: Vendor) -> None:
        link = vendor.pushed()
        time.sleep(0.1)
        before = len(vendor.motors())
        link.go_on(0.1, (1.0, 0.0, 0.0), begin=False)
        self.assertFalse([held for held in vendor.motors()[before:] if any(held.force)])
        link.go_on(0.1, (1.0, 0.0, 0.0))
        self.assertTrue([held for held in vendor.motors()[before:] if any(held.force)])

    @on_both()
    def test_no_force_once_the_connection_ends(self, device: tuple, vendor: Vendor) -> None:
        def close(link: Link) -> float:
            at = link.send((1.0, 0.0, 0.0))
            link.close()
            return at

        # Sooner than by silence.
        self.assertLess(min(self.zeros(device, vendor, "close", close)), 0.8 * SILENCE)

    def test_signals_end_it_without_force(self) -> None:
        for which in (signal.SIGTERM, signal.SIGINT):
            @on_both()
            def ended(_self, device: tuple, vendor: Vendor) -> None:
                for _ in range(50):
                    at = vendor.pushed().send((1.0, 0.0, 0.0))
                    if any(vendor.motors()[-1].force):
                        break
                vendor.process.send_signal(which)
                self.ends(vendor, 0)
                zero = vendor.zero_after(at)
                self.assertLess(zero, AT_ONCE + BUSY)
                print(f"{device[0]}: {which.name} {1e3 * zero:.1f} ms")
                self.assertFalse(vendor.motors()[-1].on)
                self.assertFalse(vendor.path.exists())

            ended(self)

    @on_both()
    def test_one_connection_at_a_time(self, device: tuple, vendor: Vendor) -> None:
        first = vendor.pushed()
        with self.assertRaises((AssertionError, OSError)):
            vendor.link()
        seen = len(first.readings)
        first.go_on(0.1)
        self.assertGreater(len(first.readings), seen)

    @on_both("no_device")
    def test_a_device_that_is_not_there_is_refused(self, device: tuple, vendor: Vendor) -> None:
        self.assertIn("cannot", self.ends(vendor, 1))

    def test_an_unknown_model_is_refused(self) -> None:
        with Vendor(*OMEGA, "unknown_model") as vendor:
            self.assertIn("range and force of the model", self.ends(vendor, 1))

    def test_a_device_that_has_to_move_is_refused_until_somebody_says_so(self) -> None:
        with Vendor(*OMEGA, "calibration") as vendor:
            said = self.ends(vendor, 1)
            self.assertIn("moves by itself", said)
            self.assertIn("--calibrate", said)
            self.assertNotIn("the stand-in moves", said)
        with Vendor(*OMEGA, "calibration", ("--calibrate",)) as vendor:
            self.assertEqual(vendor.link().description.name, "omega.3 12")
            vendor.process.terminate()
            self.assertIn("the stand-in moves", self.ends(vendor, 0))

    def test_no_force_until_a_person_has_calibrated_it(self) -> None:
        with Vendor(*TOUCH, "calibration:1,calibrated@600") as vendor:
            link = vendor.link()
            link.go_on(0.3, (1.0, 0.0, 0.0))
            self.assertFalse(link.newest.calibrated)
            self.assertFalse([held for held in vendor.motors() if held.on])
            self.assertTrue(link.go_on(20, until=lambda reading: reading.calibrated))

    def test_a_calibration_that_is_due_is_updated(self) -> None:
        with Vendor(*TOUCH, "update@200") as vendor:
            link = vendor.link()
            link.go_on(0.4)
            self.assertTrue(link.newest.calibrated)

    def test_a_pen_in_its_inkwell_is_no_hand(self) -> None:
        with Vendor(*TOUCH, "inkwell@300") as vendor:
            link = vendor.pushed()
            self.assertTrue(link.go_on(20, (1.0, 0.0, 0.0), until=lambda r: not r.hand))
            self.assertFalse(any(vendor.motors()[-1].force))

    def test_buttons_arrive(self) -> None:
        with Vendor(*TOUCH, "button@200") as vendor:
            link = vendor.link()
            self.assertTrue(link.go_on(20, until=lambda reading: reading.buttons == 2))

    @on_both("frame_error@400", "unplug@400")
    def test_an_error_in_a_frame_ends_it_without_force(self, device: tuple, vendor: Vendor) -> None:
        link = vendor.pushed()
        link.push_variously(lambda: False)
        self.assertTrue(link.gone)
        self.ends(vendor, 1)
        self.assertFalse(vendor.motors()[-1].on)
        self.zero_in_the_next_frame(device, vendor.faults, vendor.motors())

    def test_warm_motors_are_the_reason_for_less_force(self) -> None:
        with Vendor(*TOUCH, "warm@400") as vendor:
            link = vendor.pushed()
            self.assertAlmostEqual(link.newest.warmth, 0.25, 6)
            self.assertTrue(link.go_on(20, (1.0, 0.0, 0.0), until=lambda r: r.no_force == 7))
            self.assertAlmostEqual(link.newest.warmth, 0.95, 6)

    def test_a_pen_that_points_to_the_right_is_turned_by_a_quarter(self) -> None:
        half = math.sqrt(0.5)
        with Vendor(*TOUCH, "turned") as vendor:
            link = vendor.link()
            link.go_on(0.2)
            for part, wanted in zip(link.newest.orientation, (half, 0, 0, -half)):
                self.assertAlmostEqual(part, wanted, 6)

    def test_a_wrist_that_points_up_is_turned_by_a_quarter(self) -> None:
        half = math.sqrt(0.5)
        with Vendor(*OMEGA, "turned") as vendor:
            link = vendor.link()
            link.go_on(0.2)
            for part, wanted in zip(link.newest.orientation, (half, 0, -half, 0)):
                self.assertAlmostEqual(part, wanted, 6)

    @on_both()
    def test_a_tool_of_which_nothing_is_known_has_no_orientation(self, device: tuple, vendor: Vendor) -> None:
        link = vendor.link()
        link.go_on(0.2)
        self.assertEqual(link.newest.orientation, (0.0, 0.0, 0.0, 0.0))

    def test_a_button_of_the_device_is_the_reason_for_no_force(self) -> None:
        with Vendor(*OMEGA, "button_off@400") as vendor:
            link = vendor.pushed()
            self.assertTrue(link.go_on(20, (1.0, 0.0, 0.0), until=lambda r: r.no_force == 1))
            # Also after silence, in which the program has switched the motors off itself.
            for silence in (0, 0.05):
                time.sleep(silence)
                before = len(vendor.motors())
                link.go_on(0.5, (1.0, 0.0, 0.0))
                self.assertFalse([held for held in vendor.motors()[before:] if held.on], "a person's button")
                self.assertEqual(link.newest.no_force, 1)

    def test_the_device_gives_the_force_back_that_its_button_took(self) -> None:
        with Vendor(*OMEGA, "button_off@400,button_on@900") as vendor:
            link = vendor.pushed()
            self.assertTrue(link.go_on(20, (1.0, 0.0, 0.0), until=lambda r: r.no_force == 1))
            time.sleep(0.05)
            self.assertTrue(link.go_on(20, (1.0, 0.0, 0.0), until=lambda r: r.no_force == 0))
            link.go_on(0.2, (1.0, 0.0, 0.0))
            self.assertTrue(any(any(held.force) for held in vendor.motors()[-50:]))

    @on_both("stop:20@1000")
    def test_after_a_pause_of_the_library_a_command_of_no_force_comes_first(self, device: tuple,
                                                                           vendor: Vendor) -> None:
        link = vendor.pushed()
        link.go_on(2, (1.0, 0.0, 0.0), begin=False)
        self.assertFalse(any(vendor.motors()[-1].force))

    @on_both("stop:20@400")
    def test_a_pause_of_the_library_leaves_no_force(self, device: tuple, vendor: Vendor) -> None:
        link = vendor.pushed()
        link.go_on(0.5)
        self.assertFalse(link.gone, "20 ms are no hang")
        before = len(vendor.motors())
        link.go_on(0.5, (1.0, 0.0, 0.0))
        self.assertTrue([held for held in vendor.motors()[before:] if any(held.force)], "it goes on")

    @on_both("hang@400", "stop:1000@400")
    def test_a_call_that_never_returns_ends_the_program(self, device: tuple, vendor: Vendor) -> None:
        link = vendor.pushed()
        link.push_variously(lambda: False)
        at = time.monotonic()
        self.assertTrue(link.gone)
        self.assertIn("does not return", self.ends(vendor, 3))
        every = vendor.motors()
        last = next(held for held in every[::-1] if any(held.force))
        print(f"{device[0]}: {vendor.faults} ends {1e3 * (at - last.time):.0f} ms after its last force")
        if device == OMEGA:
            self.assertFalse(any(every[-1].force), "its own watchdog has cut it")
            print(f"its watchdog {1e3 * (every[-1].time - last.time):.1f} ms")

    @on_both("crash@400")
    def test_a_crash_in_a_call_ends_the_program(self, device: tuple, vendor: Vendor) -> None:
        link = vendor.pushed()
        link.go_on(20, (1.0, 0.0, 0.0))
        self.assertTrue(link.gone)
        self.ends(vendor, -signal.SIGSEGV)

    @on_both("nan@400")
    def test_a_place_that_is_no_number_is_a_fault_without_force(self, device: tuple, vendor: Vendor) -> None:
        link = vendor.pushed()
        link.push_variously(lambda: link.newest.fault)
        self.assertTrue(link.newest.fault)
        self.assertTrue(all(map(math.isfinite, link.newest.x)))
        self.zero_in_the_next_frame(device, "nan", vendor.motors())

    @on_both("prints")
    def test_prints_of_a_library_do_no_harm(self, device: tuple, vendor: Vendor) -> None:
        vendor.pushed()
        vendor.process.terminate()
        said, _ = vendor.process.communicate(timeout=20)
        self.assertEqual(said, "")


class WithLimpid(unittest.TestCase):
    def setUp(self) -> None:
        self.folder = self.enterContext(tempfile.TemporaryDirectory())
        book = Path(self.folder, "config/limpid/devices.toml")
        book.parent.mkdir(parents=True)
        book.write_text("".join(f'[device."{":".join(device)}"]\nchecked = true\n' for device in BOTH))

    def start(self, faults: str, *words: str | Path) -> subprocess.Popen:
        Path(self.folder, "motors").unlink(missing_ok=True)
        process = subprocess.Popen(
            [LIMPID, *words], text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
            env={**environment(self.folder, faults), "XDG_CONFIG_HOME": f"{self.folder}/config",
                 "XDG_RUNTIME_DIR": self.folder})
        self.addCleanup(process.communicate, timeout=60)  # nothing that it started goes on
        self.addCleanup(process.kill)
        return process

    def done(self, process: subprocess.Popen, status: int = 0) -> tuple[str, str]:
        out, said = process.communicate(timeout=120)
        self.assertEqual(process.returncode, status, said)
        return out, said

    def pushes(self, process: subprocess.Popen) -> None:
        for _ in range(6000):
            if (every := motors_in(self.folder)) and any(every[-1].force):
                return
            self.assertIsNone(process.poll(), process.returncode)
            time.sleep(0.01)
        self.fail("the motors never push")


class InLimpid(WithLimpid):
    """The whole way: listed, opened, armed and driven by Limpid."""

    def test_devices_are_listed(self) -> None:
        Path(self.folder, ".3dsystems/config").mkdir(parents=True)
        Path(self.folder, ".3dsystems/config/Default Device.config").touch()
        listed = json.loads(self.done(self.start("", "devices", "--json"))[0])["devices"]
        missing = {each["id"]: each["missing"] for each in listed}
        for device in BOTH:
            self.assertEqual(missing.get(":".join(device)), "", missing)
        told, _ = self.done(self.start("", "devices"))
        self.assertRegex(told, r"driven by /\S*/libHD.so.3.4\n")
        self.assertRegex(told, r"driven by /\S*/libdrd.so.3, version 3\.17\.1\.20\n")

    def test_the_doctor_knows_the_libraries(self) -> None:
        out, _ = self.start("", "doctor", "--json").communicate(timeout=120)
        found = [each for each in json.loads(out)["findings"] if each["what"].startswith("library for")]
        self.assertEqual(len(found), 2)
        for each in found:
            self.assertEqual(each["state"], "ok")
            self.assertIn("tests/vendor/lib", each["found"])
        self.assertRegex(found[1]["found"], r"libdrd.so.3, version 3\.17\.1\.20$")

    def on_time(self, faults: str, device: tuple, *words: str | Path) -> str:
        """Leads a run; what it said. Again where this computer stood still, which takes the force away."""
        for _ in range(8):
            process = self.start(faults, "run", "--live", ":".join(device), "--yes", *words)
            out, said = process.communicate(timeout=120)
            if not re.search("no reading for 5 ms|loop stood still", out + said):
                return out + said
        self.skipTest(f"this computer stands still too often: {said}")

    def test_a_run_drives_the_device_and_leaves_it_without_force(self) -> None:
        for device in BOTH:
            with self.subTest(device=device[0]):
                record = Path(self.folder, f"{device[0]}.h5")
                said = self.on_time("sway:0.3", device, "--duration", "2", "--record", record, "--force")
                library = {TOUCH: "libHD.so.3.4 3.40.0 (/", OMEGA: "libdrd.so.3 3.17.1.20 (/"}[device]
                self.assertIn(f"is driven by {library}", said)
                with h5py.File(record) as file:
                    source = str(file.attrs["source"])
                self.assertRegex(source, "^device: (Touch S1|omega.3 12), " + ":".join(device))
                self.assertIn(f", by {library}", source)
                every = motors_in(self.folder)
                self.assertTrue([held for held in every if any(held.force)])
                self.assertFalse(any(every[-1].force))
                self.assertFalse(every[-1].on)
                self.assertTrue(record.exists())

    def test_a_device_that_is_not_there_is_said(self) -> None:
        _, said = self.start("no_device", "run", "--live", ":".join(TOUCH), "--yes").communicate(timeout=60)
        self.assertIn("cannot open the device", said)

    def test_no_force_once_limpid_is_killed(self) -> None:
        for device in BOTH:
            with self.subTest(device=device[0]):
                process = self.start("sway:0.3", "run", "--live", ":".join(device), "--yes",
                                     "--duration", "60")
                self.pushes(process)
                at = time.monotonic()
                process.kill()
                zero = zero_after(self.folder, at)
                self.assertFalse(motors_in(self.folder)[-1].on)
                if zero is not None:
                    print(f"{device[0]}: limpid killed {1e3 * zero:.1f} ms")
                    self.assertLess(zero, AT_ONCE + 2 * BUSY)

    def test_the_device_is_gone_once_its_program_is_killed_or_stopped(self) -> None:
        for device, which in ((device, which) for device in BOTH for which in (signal.SIGKILL, signal.SIGSTOP)):
            with self.subTest(device=device[0], which=which.name):
                process = self.start("sway:0.3", "run", "--live", ":".join(device), "--yes",
                                     "--duration", "60")
                self.pushes(process)
                child = next(int(each) for thread in Path(f"/proc/{process.pid}/task").iterdir()
                             for each in (thread / "children").read_text().split()
                             if Path(f"/proc/{each}/comm").read_text().strip() == "limpid-vendor")
                at = time.monotonic()
                os.kill(child, which)
                runs = lambda: Path(f"/proc/{child}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
                with contextlib.suppress(FileNotFoundError):
                    while runs():
                        self.assertLess(time.monotonic() - at, 5, "it still has the device")
                        time.sleep(1e-3)
                took = time.monotonic() - at
                print(f"{device[0]}: {which.name}, has ended after {1e3 * took:.0f} ms")
                if which == signal.SIGSTOP:
                    self.assertGreater(took, 0.15, "killed too soon")
                _, said = process.communicate(timeout=60)
                self.assertNotEqual(process.returncode, 0)
                self.assertIn("the device is disconnected", said)

    def test_no_force_after_a_jump_that_the_device_cannot_make(self) -> None:
        for device in BOTH:
            with self.subTest(device=device[0]):
                said = self.on_time("sway:0.3,jump@2500", device, "--duration", "3")
                self.assertIn("reports a fault", said)
                self.assertFalse(any(motors_in(self.folder)[-1].force))
                zero = zero_after_the_last_force(motors_in(self.folder))
                print(f"{device[0]}: jump {1e3 * zero:.1f} ms after the last force")


class HasOneOwner(WithLimpid):
    """A second program that wants the device is told who has it, and the first one's force goes on."""

    def refused(self, *words: str) -> str:
        with tempfile.TemporaryDirectory() as folder:
            done = subprocess.run([VENDOR, *words], capture_output=True, text=True, timeout=60,
                                  env=environment(folder))
            self.assertEqual(done.returncode, 1, done.stderr)
            self.assertFalse([held for held in motors_in(folder) if held.on])
            return done.stderr

    def test_by_hand_and_by_hand(self) -> None:
        for device in BOTH:
            with self.subTest(device=device[0]), Vendor(*device) as vendor:
                vendor.pushed()
                by = f"in use by process {vendor.process.pid} \\(limpid-vendor {device[0]}"
                for words in (("--socket", f"{self.folder}/another"), ("--calibrate",)):
                    self.assertRegex(self.refused(*device, *words), f"{device[1]}: {by}")

    def test_by_another_name_of_the_same_device(self) -> None:
        with Vendor(*TOUCH) as vendor:
            vendor.pushed()
            by = f"in use by process {vendor.process.pid} \\(limpid-vendor openhaptics"
            self.assertRegex(self.refused(TOUCH[0], "Left Device", "--socket", f"{self.folder}/another"),
                             f"Touch S1: {by}")

    def test_by_hand_and_limpid(self) -> None:
        for device in BOTH:
            with self.subTest(device=device[0]), Vendor(*device) as vendor:
                link = vendor.pushed()
                process = self.start("", "run", "--live", ":".join(device), "--yes", "--duration", "1")
                _, said = process.communicate(timeout=60)
                self.assertNotEqual(process.returncode, 0)
                self.assertRegex(said, f"in use by process {vendor.process.pid} \\(limpid-vendor")
                self.assertFalse([held for held in motors_in(self.folder) if held.on])
                before = len(link.readings)
                link.go_on(0.1)
                self.assertGreater(len(link.readings), before)

    def test_limpid_and_by_hand(self) -> None:
        for device in BOTH:
            with self.subTest(device=device[0]):
                process = self.start("sway:0.3", "run", "--live", ":".join(device), "--yes",
                                     "--duration", "60")
                self.pushes(process)
                said = self.refused(*device, "--socket", f"{self.folder}/another")
                self.assertRegex(said, f"in use by process {process.pid} \\(limpid run --live")
                self.assertIsNone(process.poll())
                # Killed, it has the device until the motors are off; then others get it.
                process.kill()
                for _ in range(100):
                    with Vendor(*device) as vendor:
                        end = time.monotonic() + 10
                        while not vendor.path.exists() and vendor.process.poll() is None:
                            self.assertLess(time.monotonic(), end)
                            time.sleep(1e-3)
                        if vendor.process.poll() is None:
                            break
                else:
                    self.fail("nobody gets the device")
                self.assertFalse(motors_in(self.folder)[-1].on)


class Asks(unittest.TestCase):
    def test_words_that_make_no_sense_are_refused(self) -> None:
        for words in ([], ["list", "more"], ["nobody", "0", "--socket", "x"], ["openhaptics"]):
            done = subprocess.run([VENDOR, *words], capture_output=True, text=True, timeout=60)
            self.assertEqual(done.returncode, 2, words)
            self.assertIn("allowed: limpid-vendor list", done.stderr)


if __name__ == "__main__":
    unittest.main()
