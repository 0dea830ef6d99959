"""Runs without a window, as fast as they go: what `limpid run` and `limpid sweep` do."""

from __future__ import annotations

import itertools
import os
import tempfile
from pathlib import Path
from typing import Any, Dict, Iterable, Iterator, List, Mapping, Optional, Sequence, Tuple, Union

from limpid.errors import LimpidError
from limpid.program import PathLike, carry_out, setting_words
from limpid.session import Session

Hand = Union[PathLike, Iterable[Sequence[float]]]


def write_hand(hand: Iterable[Sequence[float]], file: PathLike) -> str:
    """Writes the path of a hand as CSV: rows of time [s], x, y, z [m], of which time increases. A
    numpy array of N x 4 is one as well. Raises LimpidError for rows of another length or too few."""
    rows = [[float(number) for number in row] for row in hand]
    if len(rows) < 2 or any(len(row) != 4 for row in rows):
        raise LimpidError("a hand's path has at least two rows of time [s], x, y, z [m]")
    with open(file, "w", encoding="ascii") as out:
        out.write("time_s,x_m,y_m,z_m\n")
        for row in rows:
            out.write(",".join(repr(number) for number in row) + "\n")
    return os.fspath(file)


def run(scene: Optional[PathLike] = None, hand: Optional[Hand] = None,
        coupling: Optional[str] = None, eta: Optional[float] = None, alpha: Optional[float] = None,
        arm: Optional[PathLike] = None, duration: Optional[float] = None,
        seed: Optional[int] = None, twin: Optional[Mapping[str, Any]] = None,
        record: Optional[PathLike] = None, **settings: Any) -> Session:  # fmt: skip
    """Leads a hand through a coupling and returns what was recorded.

    `hand`: FILE.csv, FILE.h5 of a recorded session, or rows of time [s], x, y, z [m]; the default is
    a hand that touches a table. `duration` [s]. `twin`: settings of a second run on the same hand.
    Further settings by their keys with two underscores for the dot: coupling__k_vc=8. `record`: where
    the session is kept; else it goes once it has been read. Raises ProgramError for what the program
    refuses, or where the run becomes unstable."""
    with tempfile.TemporaryDirectory(prefix="limpid-") as folder:
        out = Path(record) if record is not None else Path(folder, "run.h5")
        words: List[PathLike] = ["run", "--record", out]
        if hand is not None and not isinstance(hand, (str, os.PathLike)):
            hand = write_hand(hand, Path(folder, "hand.csv"))
        for option, value in (("--scene", scene), ("--hand", hand), ("--device", arm),
                              ("--coupling", coupling), ("--eta", eta), ("--alpha", alpha),
                              ("--duration", duration), ("--seed", seed)):  # fmt: skip
            if value is not None:
                words += [option, value if isinstance(value, (str, os.PathLike)) else repr(value)]
        words += setting_words({key.replace("__", "."): value for key, value in settings.items()})
        if twin is not None:
            words += ["--twin", *(word for word in setting_words(dict(twin)) if word != "--set")]
        carry_out(words)
        return Session(out)


def sweep(axes: Mapping[str, Sequence[Any]], **common: Any) -> Iterator[Tuple[Dict[str, Any], Session]]:
    """run() at every point of a grid, one after the other: `axes` are arguments of run() with the
    values each of them takes, `common` those that stay. Yields the point and its session.

        for point, session in limpid.sweep({"eta": [0.5, 1], "coupling": ["proposed", "predictive"]}):
            ...

    Thousands of runs on all processors, with measures in a table: `limpid sweep PLAN.toml`."""
    names = [name.replace(".", "__") for name in axes]
    for values in itertools.product(*axes.values()):
        point = dict(zip(names, values))
        yield dict(zip(axes, values)), run(**{**common, **point})
