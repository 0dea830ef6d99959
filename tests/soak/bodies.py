#!/usr/bin/python3
"""Stirs a scene in which things move for long, without a window, and watches that they make no
energy, that every tick is solved and that memory stays as it is.

usage: bodies.py LIMPID SCENE.toml [--minutes M] [--seed S] [--set KEY=VALUE ...]

The hand goes at random through what moves, and presses on it and on what it lies on; where there is
something for the magnet it picks it up now and then. M: of simulated time, 30. S: of where it goes.
Others than the given settings are those of the predictive law, without encoder steps. What is
recorded takes about 300 MB a minute for as long as it runs. Prints one line. Exit status: 0 all is
well, 1 something is not.

Needs h5py and numpy.
"""
from __future__ import annotations

import argparse
import subprocess
import sys
import tempfile
import threading
import time
import tomllib
from pathlib import Path

import h5py
import numpy as np

RATE = 100          # of the hand's path [Hz]
REACH = 0.26        # of the built-in arm's tip, less a centimetre [m]
MOST_GAIN = 1e-6    # of what the bodies' world makes [J]
MOST_GROWTH = 20.0  # of the process, from the first quarter to the last, beside what it buffers [MB]


def path(scene: dict, seconds: float, random: np.random.Generator) -> np.ndarray:
    """Rows of time, place and magnet: from way point to way point as people reach (Flash and Hogan
    1985), each near where one of the bodies started, down to 15 mm below that."""
    places = np.array([body["position"] for body in scene["body"]])
    magnetic = any(body.get("magnet") for body in scene["body"])
    now, magnet, rows, t = np.array([0.19, 0.0, 0.02]), 0.0, [], 0.0
    while t < seconds:
        to = random.choice(places) + random.uniform([-0.03, -0.03, -0.015], [0.03, 0.03, 0.02])
        to *= min(1.0, REACH / np.linalg.norm(to))
        took = random.uniform(0.25, 1.2)
        if magnetic and random.uniform() < 0.3:
            magnet = 1.0 - magnet
        s = np.arange(1, round(took * RATE) + 1) / round(took * RATE)
        blend = s**3 * (10 - 15 * s + 6 * s**2)
        for each in blend:
            rows.append([0.0, *(now + (to - now) * each), magnet])
        now, t = to, t + took
    all_rows = np.array(rows)
    all_rows[:, 0] = np.arange(len(rows)) / RATE
    return all_rows


def resident(process: subprocess.Popen) -> list[float]:
    """What it has in memory, once a second until it ends [MB]."""
    seen = []
    while process.poll() is None:
        try:
            status = Path(f"/proc/{process.pid}/status").read_text()
        except OSError:
            break
        for line in status.splitlines():
            if line.startswith("VmRSS"):
                seen.append(int(line.split()[1]) / 1024)
        time.sleep(1)
    return seen


def largest(file: h5py.File, name: str) -> float:
    data = file[name]
    return max(float(np.nanmax(data[i:i + 100000])) for i in range(0, len(data), 100000))


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n", maxsplit=1)[0])
    parser.add_argument("limpid", type=Path)
    parser.add_argument("scene", type=Path)
    parser.add_argument("--minutes", type=float, default=30)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--set", action="append", default=[])
    asked = parser.parse_args()
    rows = path(tomllib.loads(asked.scene.read_text()), 60 * asked.minutes,
                np.random.default_rng(asked.seed))
    with tempfile.TemporaryDirectory(prefix="limpid-soak-") as folder:
        hand, session = Path(folder) / "hand.csv", Path(folder) / "session.h5"
        np.savetxt(hand, rows, delimiter=",", header="time_s,x_m,y_m,z_m,magnet", comments="",
                   fmt="%.6g")
        settings = [word for each in asked.set for word in ("--set", each)]
        run = subprocess.Popen(
            [asked.limpid, "run", "--scene", asked.scene, "--hand", hand, "--coupling",
             "predictive", "--record", session, *settings], stdout=subprocess.PIPE, text=True)
        memory: list[float] = []
        watch = threading.Thread(target=lambda: memory.extend(resident(run)))
        watch.start()
        said, _ = run.communicate()
        watch.join()
        if run.returncode != 0:
            print(said)
            return 1
        with h5py.File(session) as file:
            moved = file["objects/pose"]
            seen = {"gain": largest(file, "energy/objects_gain"),
                    "E_c": largest(file, "energy/controller_total"),
                    "left out": largest(file, "objects/left_out"),
                    "unsettled": largest(file, "coupling/unsettled"),
                    "not solved": float(np.sum(file["coupling/solved"][()] == 3)),
                    "awake": float(np.mean(file["objects/awake"][()])),
                    "went": float(np.linalg.norm(moved[-1, :, :3] - moved[0, :, :3], axis=1).max())}
    quarter = max(1, len(memory) // 4)
    first, last = np.median(memory[quarter:2 * quarter]), np.median(memory[-quarter:])
    wrong = [name for name, bad in (
        ("gain", seen["gain"] > MOST_GAIN), ("left out", seen["left out"] > 0),
        ("not solved", seen["not solved"] > 0), ("memory", last - first > MOST_GROWTH)) if bad]
    print(f"{asked.scene.stem} seed {asked.seed} {' '.join(asked.set)}: {len(rows) / RATE:.0f} s, "
          f"gain {seen['gain']:.1e} J, E_c {1e3 * seen['E_c']:.3f} mJ, left out "
          f"{seen['left out']:.0f}, unsettled {seen['unsettled']:.1e}, not solved "
          f"{seen['not solved']:.0f}, awake {seen['awake']:.1f}, went {seen['went']:.2f} m, memory "
          f"{first:.0f} to {last:.0f} MB" + (f"  <- {', '.join(wrong)}" if wrong else ""))
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
