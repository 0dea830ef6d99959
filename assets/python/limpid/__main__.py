"""python3 -m limpid demo: leads a loop for five seconds. python3 -m limpid stream: sends its rows."""

from __future__ import annotations

import argparse
import json
import socket
import sys
import tempfile
from pathlib import Path
from typing import List

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


def stream(name: str, target: str, channels: List[str], rate: float) -> None:
    """Sends rows of a running program as JSON over UDP, one object a datagram, as PlotJuggler's UDP
    server reads them: {"time": 1.25, "hand/torque": [...]}. Ends with Ctrl-C, or with the program."""
    host, _, port = target.rpartition(":")
    if not port.isdigit() or not 0 < int(port) < 65536:
        raise limpid.ArgumentError(f"{target} is no place to send to; needed: HOST:PORT, as localhost:9870")
    try:
        family, _, _, _, address = socket.getaddrinfo(host.strip("[]") or "localhost", int(port), type=socket.SOCK_DGRAM)[0]
    except OSError as error:
        raise limpid.LimpidError(f"{target}: no such host: {error.strerror}") from error
    with limpid.connect(name) as loop, socket.socket(family, socket.SOCK_DGRAM) as out:
        names = channels or CHANNELS
        tick = float(loop.get("loop.tick")["loop.tick"])
        loop.follow(names, rate=rate)
        dropped = 0
        while True:
            rows = loop.rows(seconds=0.1)
            for at, values in zip(rows.ticks, rows.values):
                out.sendto(json.dumps({"time": at * tick, **dict(zip(names, values))}).encode(), address)
            if rows.dropped > dropped:
                print(f"limpid: {rows.dropped} rows found no room", file=sys.stderr)
                dropped = rows.dropped


def main() -> int:
    parser = argparse.ArgumentParser(prog="python3 -m limpid", description="Limpid from Python.")
    verbs = parser.add_subparsers(dest="verb", required=True)
    shown = verbs.add_parser("demo", help="lead a loop for five seconds and say what happens")
    shown.add_argument("--window", action="store_true", help="in a window")
    sent = verbs.add_parser("stream", help="send rows of a running program over UDP, for PlotJuggler; the field "
                           "of the time is `time`")
    sent.add_argument("target", metavar="HOST:PORT", help="PlotJuggler's UDP server has port 9870")
    sent.add_argument("channels", nargs="*", metavar="CHANNEL", help=f"default: {', '.join(CHANNELS)}")
    sent.add_argument("--name", default="control", help="of the program, as limpid --listen NAME; default: control")
    sent.add_argument("--rate", type=float, default=100, help="rows a second; default: 100")
    given = parser.parse_args()
    try:
        if given.verb == "demo":
            demo(window=given.window)
        else:
            stream(given.name, given.target, given.channels, given.rate)
    except KeyboardInterrupt:
        return 0
    except limpid.LimpidError as error:
        print(f"limpid: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
