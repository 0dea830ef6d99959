"""python3 -m limpid demo: leads a loop for five seconds and says what happens."""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

import limpid

CHANNELS = ["coordination/error", "hand/torque_norm", "proxy/contact_torque_norm"]


def demo(window: bool) -> None:
    """Starts a loop, switches its coupling and records it."""
    with limpid.serve(window=window) as loop:
        print(f"limpid {loop.about['version']}, {loop.about['kind']}: {loop.state()['scene']}")
        if not window:
            loop.open(hand="touch.csv", wait=True)
        with tempfile.TemporaryDirectory(prefix="limpid-") as folder:
            file = loop.record(Path(folder, "demo.h5"))
            units = loop.follow(CHANNELS, rate=20)
            for law in ("standard", "proposed", "predictive"):
                loop.set({"coupling.kind": law})
                loop.mark(law)
                rows = loop.rows(seconds=1.5)
                for i, (name, unit) in enumerate(zip(CHANNELS, units)):
                    largest = max((row[i] or 0.0 for row in rows.values), default=0.0)
                    print(f"{law:>10}  {name:<26} up to {largest:.4f} {unit}")
            loop.follow([])
            done = loop.stop()
            print(f"recorded {done['rows']} ticks in {file}, {done['dropped']} missing")
            try:
                print(limpid.session(file))
            except limpid.LimpidError as error:
                print(error)


def main() -> int:
    if sys.argv[1:] not in (["demo"], ["demo", "--window"]):
        print("usage: python3 -m limpid demo [--window]", file=sys.stderr)
        return 2
    try:
        demo(window="--window" in sys.argv)
    except limpid.LimpidError as error:
        print(f"limpid: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
