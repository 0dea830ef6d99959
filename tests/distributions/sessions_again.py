#!/usr/bin/python3
"""Makes the shipped sessions again that have a hand of their own as a path, and compares the rows:
    sessions_again.py [--bodies-may-differ] COMMAND...   such as `qemu-aarch64 build/release/app/limpid`
With --bodies-may-differ it does not fail where bodies meet: Bullet, which finds where, is not the same
on each processor.
Sessions themselves are not read by it: a sandbox lets nothing through that is not its own processor."""

import subprocess
import sys
import tempfile
from pathlib import Path

import h5py
import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "assets/sessions"))
import make_sessions  # noqa: E402


BODIES_MEET = {"dominoes", "marbles", "stack", "cup", "pucks", "cradle"}


def differences(first: h5py.File, second: h5py.File) -> list[str]:
    names: list[str] = []
    first.visititems(lambda name, item: names.append(name) if hasattr(item, "shape") else None)
    found = []
    for name in names:
        if name.startswith(("timing/", "check/")):  # the latter are sums of all others
            continue
        x, y = first[name][()], second[name][()]
        if x.shape != y.shape:
            found.append(f"{name}: {x.shape} and {y.shape}")
        elif x.tobytes() != y.tobytes():
            numbers = x.dtype.kind == "f"
            same = (x == y) | (np.isnan(x) & np.isnan(y)) if numbers else x == y
            rows = np.flatnonzero(~same.reshape(len(x), -1).all(axis=1))
            if not len(rows):
                found.append(f"{name}: signs of zeros, or kinds of what is not a number")
                continue
            most = np.nanmax(np.abs(x - y)) if numbers else "other"
            found.append(f"{name}: {len(rows)} of {len(x)} rows from {rows[0]} on, by {most} at most")
    return found


def main() -> int:
    good, command = True, sys.argv[1:]
    may_differ = BODIES_MEET if command[:1] == ["--bodies-may-differ"] else set()
    if may_differ:
        command = command[1:]
    for scene, (_, seconds) in make_sessions.SCENES.items():
        if not seconds:
            continue
        world, _ = make_sessions.options(scene)
        with tempfile.TemporaryDirectory() as folder:
            again = Path(folder) / "again.h5"
            subprocess.run([*command, "run", *world, "--duration", str(seconds), "--record", again],
                           cwd=ROOT, check=True, stdout=subprocess.DEVNULL)  # fmt: skip
            with h5py.File(ROOT / f"assets/sessions/{scene}.h5") as a:
                rounds = "rounded" in a.attrs
            if rounds:
                whole, again = again, again.with_name("rounded.h5")
                make_sessions.ship(whole, again, rounds)
            with h5py.File(ROOT / f"assets/sessions/{scene}.h5") as a, h5py.File(again) as b:
                found = differences(a, b)
        print(f"{scene}:", "the same bits" if not found else "\n  ".join(["differs", *found]), flush=True)
        good = good and (not found or scene in may_differ)
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
