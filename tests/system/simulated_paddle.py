"""A one-joint device on a socket that differs from its file. usage: simulated_paddle.py NAME"""
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "assets" / "python"))
from limpid_device import LimpidDevice  # noqa: E402

INERTIA, VISCOUS, COULOMB = 1.2e-3, 0.012, 0.02  # [kg m^2, N m s/rad, N m]; its file: 7.0e-4, 0.035, 0
END = 0.7


def main(name: str) -> None:
    device = LimpidDevice(name, [-END], [END], [0.8])
    x, v = 0.0, 0.0
    begun, done = time.monotonic(), 0
    torque = 0.0
    while True:
        # Simulates the time that has passed, in steps of 0.1 ms; at rest friction holds.
        due = int(1e4 * (time.monotonic() - begun))
        for _ in range(min(due - done, 200)):
            push = torque - VISCOUS * v
            if v == 0 and abs(push) <= COULOMB:
                continue
            direction = 1 if v > 0 or (v == 0 and push > 0) else -1
            after = v + 1e-4 * (push - COULOMB * direction) / INERTIA
            v = 0.0 if v * after < 0 else after
            x += 1e-4 * v
            if abs(x) > END:
                x, v = (END if x > 0 else -END), 0.0
        done = due
        torque = device.exchange([x])[0]
        time.sleep(max(0.0, 1e-3 - (time.monotonic() - begun) % 1e-3))


if __name__ == "__main__":
    main(*sys.argv[1:])
