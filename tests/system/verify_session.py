#!/usr/bin/python3
"""Recomputes a session file from the file alone and prints what agrees.

    verify_session.py FILE.h5 [--checks layout,energy,proxy,torques,motors,observer,slopes,
                                       predictive]

Exit status 0 when every check passes, 1 when one fails, 2 when the file cannot be read.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from limpid_check.checks import CHECKS, verify
from limpid_check.report import table
from limpid_check.session import read_session


def _names(text: str) -> list[str]:
    names = text.split(",")
    unknown = [name for name in names if name not in CHECKS]
    if unknown:
        raise argparse.ArgumentTypeError(f"'{unknown[0]}' is none of {', '.join(CHECKS)}")
    return names


def main() -> int:
    parser = argparse.ArgumentParser(description="Recomputes what a session file claims.")
    parser.add_argument("file", type=Path, metavar="FILE.h5")
    parser.add_argument("--checks", type=_names, default=list(CHECKS), help=",".join(CHECKS))
    arguments = parser.parse_args()
    try:
        session = read_session(arguments.file)
    except (OSError, ValueError) as error:
        print(f"{arguments.file}: {error}", file=sys.stderr)
        return 2
    checks = verify(session, arguments.checks)
    print(f"{arguments.file}: {len(session)} rows, {session.dof} joints, T = {session.tick:g} s")
    print(table(checks))
    return 0 if all(check.passed for check in checks) else 1


if __name__ == "__main__":
    sys.exit(main())
