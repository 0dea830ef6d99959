"""The words that a study is started with."""

import argparse
from pathlib import Path


def words(about: str, count: str, usual: int, help: str) -> argparse.Namespace:
    """Those of the command line, of a study that `about` tells of in its first line: `out`, a folder
    that is there then, `participant`, `connect`, `simulate`, and the number named `count`."""
    parser = argparse.ArgumentParser(description=about.splitlines()[0])
    parser.add_argument("--out", type=Path, required=True, help="folder of answers, sessions, report")
    parser.add_argument("--participant", type=int, default=0, help="number, from 0 on")
    parser.add_argument("--connect", default="control", help="name of the program's socket")
    parser.add_argument("--simulate", action="store_true", help="a simulated participant")
    parser.add_argument(f"--{count}", type=int, default=usual, help=help)
    found = parser.parse_args()
    found.out.mkdir(parents=True, exist_ok=True)
    return found
