#!/usr/bin/python3
"""Counts the instructions of a tick with valgrind, which counts the same on every machine that
runs the same binary, and compares them with what they were.

usage: instructions.py LIMPID_BENCH [--update]

LIMPID_BENCH: the program, an optimised build. The counts stand in instructions.json beside this file;
--update writes them anew, once somebody has seen that they grew and wants them so. Exit status: 0
nothing grew by more than 3 %, 1 something did, 77 they cannot be counted or compared here.
"""
import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

BUDGET = pathlib.Path(__file__).with_name("instructions.json")
TICKS = 1000
MOST_GROWTH = 0.03
COUNTED = {  # the line of limpid_bench, and the function that its instructions are those of
    "tick/3/standard": "limpid::Tick<3>::run(*",
    "tick/3/proposed": "limpid::Tick<3>::run(*",
    "tick/3/predictive": "limpid::Tick<3>::run(*",
    "tick/7/proposed": "limpid::Tick<7>::run(*",
    "tick/7/predictive": "limpid::Tick<7>::run(*",
    "tick/30/proposed": "limpid::Tick<-1>::run(*",
    "tick/30/predictive": "limpid::Tick<-1>::run(*",
    "arm/3": "limpid::VirtualArm<3>::live(*",
    "arm/7": "limpid::VirtualArm<7>::live(*",
    "bodies/10/rest": "*measured_step*",
    "bodies/10/slide": "*measured_step*",
    "bodies/50/asleep": "*measured_step*",
}


def count(program, line, function):
    """Instructions a tick."""
    with tempfile.TemporaryDirectory() as folder:
        ran = subprocess.run(
            ["valgrind", "--tool=callgrind", f"--toggle-collect={function}",
             f"--callgrind-out-file={folder}/out", program, "--only", line, "--ticks", str(TICKS),
             "--json"], capture_output=True, text=True, check=False)
    found = re.search(r"Collected : (\d+)", ran.stderr)
    if ran.returncode != 0 or not found or int(found[1]) == 0:
        raise RuntimeError(f"{line}: nothing was counted:\n{ran.stderr[-2000:]}")
    return int(found[1]) / TICKS, json.loads(ran.stdout)["machine"]["compiler"]


def main(arguments):
    if not arguments or "--help" in arguments:
        print(__doc__.strip(), file=sys.stderr)
        return 2
    if not shutil.which("valgrind"):
        print("skipped: no valgrind")
        return 77
    counts, compiler = {}, ""
    for line, function in COUNTED.items():
        counts[line], compiler = count(arguments[0], line, function)
    if "--update" in arguments:
        BUDGET.write_text(json.dumps({"compiler": compiler, "instructions": {
            line: round(number) for line, number in counts.items()}}, indent=2) + "\n")
        print(f"wrote {BUDGET}")
        return 0
    budget = json.loads(BUDGET.read_text())
    grown = 0
    for line, number in counts.items():
        was = budget["instructions"][line]
        more = number / was - 1
        grown += more > MOST_GROWTH
        print(f"{line:<20}{was:>9}{number:>9.0f}{100 * more:>+7.1f} %"
              f"{'  <- grew' if more > MOST_GROWTH else ''}")
    if compiler != budget["compiler"]:
        print(f"skipped: counted for {budget['compiler']}, this was built by {compiler}")
        return 77
    if grown:
        print(f"{grown} grew; if that is worth it: {sys.argv[0]} {arguments[0]} --update")
    return 1 if grown else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
