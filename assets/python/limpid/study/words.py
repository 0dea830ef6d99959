"""The words that a study is started with, and how it ends."""

import argparse
import sys
from pathlib import Path
from typing import Callable

from limpid.errors import LimpidError
from limpid.study.trials import folder_for


def words(about: str, count: str, usual: int, help: str, least: int = 1) -> argparse.Namespace:
    """Those of the command line, of a study that `about` tells of in its first line: `out`, a folder
    that is there then, `participant`, `connect`, `simulate`, and the number named `count`, which is at
    `least` so large."""
    parser = argparse.ArgumentParser(description=about.splitlines()[0])
    parser.add_argument("--out", type=Path, required=True, help="folder of answers, sessions, report")
    parser.add_argument("--participant", type=int, default=0, help="number, from 0 on")
    parser.add_argument("--connect", default="control", help="name of the program's socket")
    parser.add_argument("--simulate", action="store_true", help="a simulated participant")
    parser.add_argument(f"--{count}", type=int, default=usual, help=help)
    found = parser.parse_args()
    if found.participant < 0:
        parser.error(f"--participant: {found.participant} is not allowed; allowed: a number from 0 on")
    if getattr(found, count) < least:
        parser.error(f"--{count}: {getattr(found, count)} is not allowed; allowed: a number from {least} on")
    folder_for(found.out)
    return found


def carry_out(main: Callable[[], None]) -> None:
    """Runs a study; what goes wrong is said in a sentence, and the status is 1 then."""
    try:
        main()
    except LimpidError as error:
        sys.exit(str(error))
    except OSError as error:
        # Of a file that is open already the system does not say the name.
        where = error.filename or "a file in the folder of --out"
        sys.exit(f"{where}: {error.strerror}. Every answer up to now is kept; the same words go on "
                 "behind them.")  # fmt: skip
    except KeyboardInterrupt:
        sys.exit("\nStopped. Every answer up to now is kept; the same words go on behind them.")
