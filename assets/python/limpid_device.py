"""A haptic device that is a program: Limpid finds it by its socket and drives it as one on USB.

Standard library only. The reports are those of devices/hid/raw_protocol.h, without an id, in
version 1, or in version 2 for joints that slide or have no motor, buttons, warmth and the
orientation of the tool.
A hand may be on what your program moves, so exchange() gives no torque once the connection has
ended or no command came for 10 ms. Call it about every millisecond and apply what it returns, also
while nobody is connected. Run as a program, it plays joints that springs hold:

    python3 limpid_device.py [NAME [JOINTS [VERSION]]]
"""

import argparse
import math
import os
import pathlib
import socket
import struct
import sys
import time
import zlib

WATCHDOG = 0.010  # [s]


def sealed(body: bytes) -> bytes:
    return body + struct.pack("<I", zlib.crc32(body))


def padded(values: list, size: int) -> list:
    return [*values, *[0] * (size - len(values))]


def feature_1(name: str, lower: list, upper: list, effort: list, rate: int) -> bytes:
    milli = [round(1e3 * end) for pair in zip(lower, upper) for end in pair]
    return sealed(
        struct.pack("<4B2H12hf6H12s", 0x4C, 1, len(effort), 1, rate, round(1e3 * WATCHDOG),
                    *padded(milli, 12), 1e-4, *padded([round(1e3 * e) for e in effort], 6),
                    name.encode("ascii", "replace")[:12]))


def feature_2(name: str, lower: list, upper: list, effort: list, rate: int, slides: list) -> bytes:
    joints = len(effort)
    return sealed(
        struct.pack("<4B2H8B8f8f8f8f8f48s28s", 0x4C, 2, joints, any(effort), rate,
                    round(1e3 * WATCHDOG), *padded([int(s) for s in slides], 8),
                    *padded(lower, 8), *padded(upper, 8), *padded([1e-4] * joints, 8),
                    *padded(effort, 8), *[0.0] * 8, name.encode("ascii", "replace")[:48],
                    b"limpid_device.py"))


class LimpidDevice:
    def __init__(self, name: str, lower: list, upper: list, effort: list, rate: int = 1000,
                 version: int = 1, slides: list = ()):
        """One to six joints: their ranges [rad] and torque limits [N m].

        Version 2: up to eight; `slides` says which slide [m, N], and an effort of 0 that a joint
        has no motor.
        """
        self.effort, self.joints, self.version = effort, len(effort), version
        self._room = 6 if version == 1 else 8
        self._feature = (feature_1(name, lower, upper, effort, rate) if version == 1 else
                         feature_2(name, lower, upper, effort, rate, slides))
        runtime = os.environ.get("XDG_RUNTIME_DIR")
        if not runtime:
            raise OSError("XDG_RUNTIME_DIR is not set; Limpid looks for devices in that folder")
        folder = pathlib.Path(runtime, "limpid")
        folder.mkdir(mode=0o700, exist_ok=True)
        unready = folder / f"{name}.new"
        unready.unlink(missing_ok=True)
        self._listener = socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        self._listener.setblocking(False)
        self._listener.bind(str(unready))
        self._listener.listen()
        # Found from now on; takes the place of one that was killed.
        unready.replace(folder / f"{name}.device")
        self._connection, self._sequence = None, 0
        self._hang_up()

    def exchange(self, x: list, hand: bool = True, fault: bool = False, calibrated: bool = True,
                 buttons: int = 0, no_force: int = 0, warmth: float = 0.0,
                 orientation: tuple = (0.0, 0.0, 0.0, 0.0)) -> list:
        """Says where the joints are [rad]; returns the torques to be held until the next call.

        Buttons (a bit each), the reason for no force, warmth (0 to 1) and the tool's orientation
        (a quaternion w x y z, 1 0 0 0 if it points forward; zeros: not known) need version 2.
        """
        try:
            self._accept()
            if self._connection:
                self._take_commands()
                self._send_reading(x, (hand, calibrated, fault),
                                   (buttons, no_force, warmth, *orientation))
        except BlockingIOError:
            pass  # it does not listen at present
        except OSError:
            self._hang_up()
        return self._torque if self._on_time() else [0.0] * self.joints

    def _on_time(self) -> bool:
        return time.monotonic() - self._heard <= WATCHDOG

    def _hang_up(self):
        if self._connection:
            self._connection.close()
        self._connection, self._command = None, 0
        self._heard, self._torque = -math.inf, [0.0] * self.joints

    def _accept(self):
        try:
            connection, _ = self._listener.accept()
        except BlockingIOError:
            return
        if self._connection:
            return connection.close()  # one at a time
        connection.setblocking(False)
        connection.send(self._feature)
        self._connection = connection

    def _send_reading(self, x, state, more):
        self._sequence += 1
        hand, calibrated, fault = state
        status = 1 | 2 * hand | 4 * calibrated | 8 * fault | 16 * (not self._on_time())
        report = struct.pack(f"<4BIQ{self._room}fI", 0x4C, self.version, self.joints, status,
                             self._sequence & 0xFFFFFFFF, round(1e6 * time.monotonic()),
                             *padded(x, self._room), self._command)
        self._connection.send(sealed(
            report + (bytes(16) if self.version == 1 else struct.pack("<IB3xf4f44x", *more))))

    def _take_commands(self):
        """All that wait: after a pause only the newest counts."""
        while True:
            try:
                packet = self._connection.recv(128)
            except BlockingIOError:
                return
            if not packet:
                raise ConnectionResetError
            if len(packet) == 64 and packet == sealed(packet[:60]):
                self._obey(struct.unpack_from(f"<4BIQ{self._room}f", packet))

    def _obey(self, command):
        magic, version, joints, mode, sequence, _, *torque = command
        if (magic, version, joints) != (0x4C, self.version, self.joints) or mode > 1:
            return
        torque = torque[:self.joints]
        newer = 0 < (sequence - self._command) % 2**32 < 2**31
        if mode == 1 and not (newer and all(map(math.isfinite, torque))):
            return
        within = [max(-e, min(e, t)) for t, e in zip(torque, self.effort)]
        self._torque = within if mode == 1 else [0.0] * self.joints
        self._command, self._heard = sequence, time.monotonic()


def play(name: str, joints: int, version: int = 1):
    """Each joint is held in its middle by a spring, critically damped."""
    stiffness, inertia, end = 0.5, 1e-3, 0.349  # [N m/rad], [kg m^2], [rad]
    damping = 2 * math.sqrt(stiffness * inertia)
    device = LimpidDevice(name, [-end] * joints, [end] * joints, [0.2] * joints, version=version)
    x, v = [0.0] * joints, [0.0] * joints
    before = time.monotonic()
    while True:
        torque = device.exchange(x)
        time.sleep(1e-3)
        now = time.monotonic()
        dt, before = min(now - before, 2e-3), now
        for i in range(joints):
            v[i] += dt * (torque[i] - stiffness * x[i] - damping * v[i]) / inertia
            x[i] = max(-end, min(end, x[i] + dt * v[i]))


def main():
    parser = argparse.ArgumentParser(
        description="A simulated haptic device: joints that springs hold. Limpid finds it while it runs.")
    parser.add_argument("name", nargs="?", default="springs", metavar="NAME")
    parser.add_argument("joints", nargs="?", default=2, type=int, metavar="JOINTS",
                        help="1 to 6, with version 2 to 8; default 2")
    parser.add_argument("version", nargs="?", default=1, type=int, choices=(1, 2),
                        metavar="VERSION", help="of the reports, 1 or 2; default 1")
    given = parser.parse_args()
    most = 6 if given.version == 1 else 8
    if not 1 <= given.joints <= most:
        parser.error(f"JOINTS: {given.joints} is not allowed; allowed: 1 to {most}")
    if not given.name or "/" in given.name:
        parser.error(f"NAME: '{given.name}' is not allowed; needed: letters that a file's name may have")
    try:
        play(given.name, given.joints, given.version)
    except OSError as error:
        sys.exit(f"limpid_device.py: {error}")
    except KeyboardInterrupt:
        sys.exit(130)


if __name__ == "__main__":
    main()
