"""A device on a socket that is moved as a recorded one was, whatever its motors do.

usage: replaying_device.py NAME SESSION.h5 [LATE]
LATE: a file that gets a line for each reading that came late: when, and how long after the one
before it [s, of the monotonic clock].
"""
import sys
import time
from pathlib import Path

import h5py

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "assets" / "python"))
from limpid_device import LimpidDevice  # noqa: E402


STALE = 0.005  # age at which a reading takes the force away [s]


def main(name: str, session: str, late: str = "/dev/null") -> None:
    with h5py.File(session) as file:
        path = file["device/position"][...].tolist()
    path += path[::-1]  # back and forth for ever, without a jump
    n = len(path[0])  # the first joints of the built-in arm
    device = LimpidDevice(name, [-1, -1.735, 0.15][:n], [1, 0.165, 2.9916][:n], [0.64, 0.64, 0.45][:n])
    begun = before = time.monotonic()
    with open(late, "a") as file:
        while True:
            now = time.monotonic()
            if now - before > STALE:
                file.write(f"{now} {now - before}\n")
                file.flush()
            before = now
            k = int(1e3 * (now - begun))
            device.exchange(path[k % len(path)])
            time.sleep(max(0.0, begun + 1e-3 * (k + 1) - time.monotonic()))


if __name__ == "__main__":
    main(*sys.argv[1:])
