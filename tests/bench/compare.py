#!/usr/bin/python3
"""Compares two tables of `limpid_bench --json`: what became slower or faster, line by line.

usage: compare.py BEFORE.json AFTER.json [--within PERCENT]

Instructions are compared where both counted them, else the ratios to what was measured in the
same run, else the medians. Exit status: 0 nothing grew by more than PERCENT (3 for instructions,
15 for times unless told), 1 something did, 2 a file that is none of these.
"""
import json
import sys


def read(path):
    try:
        with open(path, encoding="utf-8") as file:
            report = json.load(file)
        return report, {line["id"]: line for line in report["lines"]}
    except (OSError, ValueError, KeyError, TypeError) as error:
        print(f"compare.py: {path}: no table of `limpid_bench --json`: {error}", file=sys.stderr)
        sys.exit(2)


def figure(before, after):
    """What of two lines says most, its name, and by how much it may grow [%]."""
    for key, within in (("instructions", 3), ("ratio", 15), ("median", 15)):
        if key in before and key in after and before.get("of") == after.get("of"):
            return key, before[key], after[key], within
    return "median", before["median"], after["median"], 15


def main(arguments):
    within = None
    if "--within" in arguments:
        at = arguments.index("--within")
        within = float(arguments[at + 1])
        del arguments[at:at + 2]
    if len(arguments) != 2 or "--help" in arguments:
        print(__doc__.strip(), file=sys.stderr)
        return 2
    (old, before), (new, after) = read(arguments[0]), read(arguments[1])
    print(f"{'':<34}{'':>14}{old['limpid'][:14]:>16}{new['limpid'][:14]:>16}{'':>9}")
    grown = 0
    for name in before | after:
        if name not in before or name not in after:
            print(f"{name:<34}{'only ' + ('before' if name in before else 'after'):>14}")
            continue
        key, a, b, usual = figure(before[name], after[name])
        percent = 100 * (b / a - 1) if a else 0.0
        worse = percent > (usual if within is None else within)
        grown += worse
        print(f"{name:<34}{key:>14}{a:>16.4g}{b:>16.4g}{percent:>+8.1f}%{'  <-' if worse else ''}")
    if old["machine"] != new["machine"]:
        print("the machines differ: medians say nothing, ratios little")
    print(f"{grown} grew" if grown else "nothing grew")
    return 1 if grown else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
