"""Runs without a window, as fast as they go: what `limpid run` and `limpid sweep` do."""

from __future__ import annotations

import contextlib
import hashlib
import itertools
import os
import tempfile
import warnings
from pathlib import Path
from typing import Any, Dict, Iterable, Iterator, List, Mapping, Optional, Sequence, Tuple, Union

from limpid.errors import ArgumentError, RunWarning
from limpid.program import carry_out, setting_words
from limpid.session import Session
from limpid.values import Hand, PathLike, hand_rows, is_path, number, path_of, settings_of, text_of, whole
from limpid.worlds import Arm, Scene


def write_hand(hand: Iterable[Sequence[float]], file: PathLike) -> str:
    """Writes the path of a hand as CSV: rows of time [s], x, y, z [m], of which time increases. A
    numpy array of N x 4 and a table of pandas are ones as well. Recordings of it say that its rows
    came from Python, and which they were. Raises LimpidError for rows of another length or too few."""
    rows = hand_rows(hand)
    text = "".join(",".join(repr(cell) for cell in row) + "\n" for row in rows)
    sum_ = hashlib.sha256(text.encode("ascii")).hexdigest()[:8]
    with open(file, "w", encoding="ascii") as out:
        out.write(f"# source: {len(rows)} rows from Python, SHA-256 {sum_}\ntime_s,x_m,y_m,z_m\n{text}")
    return os.fspath(file)


@contextlib.contextmanager
def hand_file(hand: Optional[Hand]) -> Iterator[Optional[str]]:
    """The file of a hand, which is one already or rows; those are in a file for so long."""
    if hand is None:
        yield None
    elif is_path(hand):
        yield path_of("hand", hand)
    else:
        with tempfile.TemporaryDirectory(prefix="limpid-") as folder:
            yield write_hand(hand, Path(folder, "hand.csv"))


def _file(folder: str, name: str, given: Union[PathLike, Arm, Scene]) -> str:
    """The file of an arm or a scene; of one that is a value, in the folder."""
    if not isinstance(given, (Arm, Scene)):
        return path_of(name, given)
    file = os.path.join(folder, "arm.urdf" if isinstance(given, Arm) else "scene.toml")
    given.write(file)
    return file


def run(scene: Union[None, PathLike, Scene] = None, hand: Optional[Hand] = None,
        coupling: Optional[str] = None, eta: Optional[float] = None, alpha: Optional[float] = None,
        arm: Union[None, PathLike, Arm] = None, duration: Optional[float] = None,
        seed: Optional[int] = None, twin: Union[None, bool, Mapping[str, Any]] = None,
        lane3: Union[None, bool, Mapping[str, Any]] = None,
        record: Optional[PathLike] = None, settings: Optional[Mapping[str, Any]] = None,
        variation: Optional[int] = None, force: bool = False,
        channels: Optional[Sequence[str]] = None, **more: Any) -> Session:  # fmt: skip
    """Leads a hand through a coupling and returns what was recorded.

    `hand`: FILE.csv, a recorded session or its file, rows of time [s], x, y, z [m], or a table of pandas
    with the columns time_s, x_m, y_m, z_m; the default is a hand that touches a table. The session's
    time begins at 0, with the first row of the hand, whatever its time. `variation`: the hand as the same person would lead it another time,
    which one of them `seed` decides with it; 0 is the hand as it is, and nothing else is random.
    `duration` [s]. `twin`: settings of a second run on the same hand, or True; `lane3`: of a third one.
    `settings`: by their keys, {"coupling.k_vc": 8}, or each as a keyword with two underscores for the
    dot: coupling__k_vc=8. `record`: where the session is kept, also in place of one that is there with
    `force`; else it goes once it has been read. `channels`: only these are read.

    A run that gave energy, or moved as no hand does, warns of it (RunWarning; session.warnings).
    Raises ProgramError for what the program refuses, or where the run becomes unstable, and
    ArgumentError for what cannot be asked of it."""
    chosen = settings_of(settings, {**more, **{name: value for name, value in (
        ("coupling", coupling), ("eta", eta), ("alpha", alpha)) if value is not None}})
    with tempfile.TemporaryDirectory(prefix="limpid-") as folder, hand_file(hand) as path:
        out = path_of("record", record) if record is not None else str(Path(folder, "run.h5"))
        words: List[PathLike] = ["run", "--record", out] + ["--force"] * force
        for name, option, file in (("scene", "--scene", scene), ("hand", "--hand", path),
                                   ("arm", "--device", arm)):  # fmt: skip
            if file is not None:
                words += [option, _file(folder, name, file)]
        if duration is not None:
            words += ["--duration", text_of(number("duration", duration))]
        for name, option, count in (("seed", "--seed", seed), ("variation", "--variation", variation)):
            if count is not None:
                words += [option, str(whole(name, count))]
        words += setting_words(chosen)
        for name, lane in (("twin", twin), ("lane3", lane3)):
            if lane is not None and lane is not False:
                words += [f"--{name}", *setting_words(settings_of({} if lane is True else lane, name=name), "")]
        carry_out(words)
        session = Session(out, channels)
        for warning in session.warnings:
            warnings.warn(warning, RunWarning, stacklevel=2)
        if record is None:
            session.keep()
        return session


def sweep(axes: Mapping[str, Iterable[Any]], **common: Any) -> Iterator[Tuple[Dict[str, Any], Session]]:
    """run() at every point of a grid, one after the other: `axes` are arguments of run(), or keys of
    settings, with the values each of them takes, `common` arguments that stay. Yields the point and
    its session. Raises what run() raises, and ArgumentError for an axis that is no list.

        for point, session in limpid.sweep({"eta": [0.5, 1], "coupling": ["proposed", "predictive"]}):
            ...

    Thousands of runs on all processors, with measures in a table: `limpid sweep PLAN.toml`."""
    if not isinstance(axes, Mapping):
        raise ArgumentError("sweep: axes are a dict such as {\"eta\": [0.5, 1]}")
    values = {name: _values(name, each) for name, each in axes.items()}
    hand = common.get("hand")
    if hand is not None and not is_path(hand):
        common["hand"] = hand_rows(hand)  # a generator would be empty from the second point on
    return _points(values, common)


def _points(axes: Mapping[str, List[Any]], common: Mapping[str, Any]
            ) -> Iterator[Tuple[Dict[str, Any], Session]]:  # fmt: skip
    for values in itertools.product(*axes.values()):
        point = dict(zip(axes, values))
        yield point, run(**{**common, **{name.replace(".", "__"): value for name, value in point.items()}})


def _values(name: str, values: Any) -> List[Any]:
    try:
        if isinstance(values, (str, bytes, Mapping)):
            raise TypeError
        found = [each.item() if getattr(each, "shape", None) == () else each for each in values]
        if not found:
            raise TypeError
        return found
    except TypeError as error:
        raise ArgumentError(f"sweep: {name}: {values!s:.60} is not allowed; allowed: a list of the values "
                            "that it takes") from error  # fmt: skip
