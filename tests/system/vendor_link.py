"""limpid-vendor beside stand-ins for the makers' libraries, and Limpid's end of its connection.

The reports are those of devices/hid/raw_protocol.h, version 2, written down here once more.
"""

from __future__ import annotations

import contextlib
import os
import socket
import struct
import subprocess
import tempfile
import time
import zlib
from dataclasses import dataclass
from pathlib import Path

from support import LIMPID

VENDOR = LIMPID.with_name("limpid-vendor")
STAND_INS = Path(os.environ.get("LIMPID_STAND_INS", LIMPID.parents[1] / "tests" / "vendor"))


def sealed(body: bytes) -> bytes:
    return body + struct.pack("<I", zlib.crc32(body))


def environment(folder: str, faults: str = "", libraries: Path | None = STAND_INS) -> dict:
    changed = {**os.environ, "HOME": folder, "LIMPID_STAND_IN": faults,
               "LIMPID_STAND_IN_RECORD": str(Path(folder, "motors")),
               "LD_LIBRARY_PATH": str(libraries or folder)}
    for name in ("GTDD_HOME", "FORCEDIM_SDK"):
        changed.pop(name, None)
    return changed


@dataclass
class Reading:
    status: int
    x: tuple
    answered: int
    buttons: int
    no_force: int
    warmth: float
    orientation: tuple = (0.0, 0.0, 0.0, 0.0)
    taken: float = 0.0  # of the monotonic clock [s]

    hand = property(lambda self: bool(self.status & 2))
    calibrated = property(lambda self: bool(self.status & 4))
    fault = property(lambda self: bool(self.status & 8))
    cut = property(lambda self: bool(self.status & 16))


@dataclass
class Description:
    joints: int
    motors: bool
    watchdog: int
    kinds: tuple
    lower: tuple
    upper: tuple
    effort: tuple
    name: str
    made_by: str


@dataclass
class Held:
    """A change of what the stand-in's motors hold, in the library's own axes."""
    time: float
    force: tuple
    on: bool


class Link:
    """Limpid's end of the connection; `force` is what is asked for from now on."""

    def __init__(self, path: Path):
        self.socket = socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        self.socket.settimeout(10)
        try:
            self.socket.connect(str(path))
            self.description = self._described(self.socket.recv(4096))
        except BaseException:
            self.socket.close()
            raise
        self.socket.setblocking(False)
        self.sequence, self.newest, self.readings, self.gone = 0, None, [], False

    @staticmethod
    def _described(packet: bytes) -> Description:
        assert len(packet) == 256 and packet == sealed(packet[:252]) and packet[:2] == b"L\2", packet
        joints, motors, _, watchdog = struct.unpack_from("<BBHH", packet, 2)
        floats = [struct.unpack_from("<8f", packet, at)[:joints] for at in (16, 48, 112)]
        return Description(joints, motors == 1, watchdog, struct.unpack_from("<8B", packet, 8)[:joints],
                           *floats, packet[176:224].rstrip(b"\0").decode(),
                           packet[224:252].rstrip(b"\0").decode())

    def send(self, force: tuple | None) -> float:
        self.sequence += 1
        packet = sealed(struct.pack("<4BIQ8fI8x", 0x4C, 2, 3, force is not None, self.sequence, 0,
                                    *(force or (0.0,) * 3), *[0.0] * 5, 0))
        assert len(packet) == 64
        at = time.monotonic()
        try:
            self.socket.send(packet)
        except OSError:
            self.gone = True
        return at

    def listen(self) -> None:
        while not self.gone:
            try:
                packet = self.socket.recv(4096)
            except BlockingIOError:
                return
            except OSError:
                packet = b""
            if not packet:
                self.gone = True
                return
            assert len(packet) == 128 and packet == sealed(packet[:124])
            status, stamp = struct.unpack_from("<B4xQ", packet, 3)
            x = struct.unpack_from("<3f", packet, 16)
            answered, buttons, no_force, warmth, *orientation = struct.unpack_from("<IIB3xf4f", packet, 48)
            self.newest = Reading(status, x, answered, buttons, no_force, warmth, tuple(orientation),
                                  1e-6 * stamp)
            self.readings.append(self.newest)

    def go_on(self, seconds: float, force: tuple | None = None, until=lambda reading: False,
              begin: bool = True) -> bool:
        """Asks for a force every millisecond. After a pause begins with no force, as Limpid does."""
        end = time.monotonic() + seconds
        while time.monotonic() < end and not self.gone:
            self.listen()
            if self.newest is not None and until(self.newest):
                return True
            self.send(None if force is None or (begin and self.newest and self.newest.cut) else force)
            time.sleep(1e-3)
        return False

    def push_variously(self, until) -> None:
        """Pushes until the end of the connection, 20 s at most, each time a little differently, so
        that the record has the time of the last force."""
        for i in range(20000):
            self.go_on(1e-3, (1.0 + 0.01 * (i % 2), 0.0, 0.0))
            if self.gone or until():
                return

    def close(self) -> None:
        self.socket.close()


class Vendor:
    """The program, serving a device of the stand-ins on a socket."""

    def __init__(self, back_end: str, name: str, faults: str = "", options: tuple = ()):
        self.folder = tempfile.TemporaryDirectory()
        self.links, self.faults = [], faults
        self.path = Path(self.folder.name, "socket")
        self.process = subprocess.Popen(
            [VENDOR, back_end, name, "--socket", self.path, *options], text=True,
            stdout=subprocess.PIPE, stderr=subprocess.PIPE,
            env=environment(self.folder.name, faults))

    def __enter__(self) -> Vendor:
        return self

    def __exit__(self, *_) -> None:
        for link in self.links:
            link.close()
        self.process.kill()
        self.process.communicate()
        self.folder.cleanup()

    def link(self) -> Link:
        end = time.monotonic() + 20
        while not self.path.exists():
            if self.process.poll() is not None or time.monotonic() > end:
                raise AssertionError(self.process.communicate())
            time.sleep(1e-3)
        self.links.append(Link(self.path))
        return self.links[-1]

    def pushed(self, force: tuple = (1.0, 0.0, 0.0)) -> Link:
        """A connection whose force the motors hold."""
        link = self.link()
        link.go_on(0.02)
        for _ in range(200):
            link.go_on(0.05, force)
            if self.motors() and any(self.motors()[-1].force):
                return link
        raise AssertionError("the force does not arrive")

    def motors(self) -> list[Held]:
        return motors_in(self.folder.name)

    def zero_after(self, moment: float) -> float | None:
        return zero_after(self.folder.name, moment)


def motors_in(folder: str) -> list[Held]:
    """Changes of what the motors hold, in a folder's record; none before a library was loaded."""
    with contextlib.suppress(FileNotFoundError), open(Path(folder, "motors"), "rb") as file:
        count, = struct.unpack("<q", file.read(8) or bytes(8))
        entries = struct.iter_unpack("<q3dq", file.read(40 * count))
        return [Held(1e-9 * at, tuple(force), bool(on)) for at, *force, on in entries]
    return []


def zero_after_the_last_force(every: list[Held]) -> float:
    """Time from the last force of a record to the first zero behind it [s]."""
    last = max(i for i, held in enumerate(every) if any(held.force))
    return every[last + 1].time - every[last].time


def zero_after(folder: str, moment: float, longest: float = 5) -> float | None:
    """Time from a moment until the motors hold nothing [s]; none if they held nothing then."""
    end = time.monotonic() + longest
    while time.monotonic() < end:
        every = motors_in(folder)
        if not any(every[-1].force):
            zero = next(held.time for held, before in zip(every[::-1], every[-2::-1])
                        if any(before.force))
            return zero - moment if zero > moment else None
        time.sleep(5e-3)
    raise AssertionError(f"the motors still hold {motors_in(folder)[-1]}")
