"""What callers give, turned into Python's own numbers, rows and names.

Numbers of numpy and other packages print and compare in ways of their own; none of them goes
further than here.
"""

from __future__ import annotations

import difflib
import math
import numbers
import os
from typing import TYPE_CHECKING, Any, Callable, Dict, Iterable, List, Mapping, Sequence, Union

from limpid.errors import ArgumentError

if TYPE_CHECKING:
    import numpy

PathLike = Union[str, "os.PathLike[str]"]
Hand = Union[PathLike, Iterable[Sequence[float]]]
Value = Union[bool, int, float, str]
FEWEST_ROWS = 2


def no_channel(name: Any, known: Iterable[str]) -> str:
    """The sentence that says so, with the one of nearly that name."""
    among = list(known)
    near = difflib.get_close_matches(str(name).lstrip("/"), among, n=1)
    return f"{name} is no channel; " + (f"did you mean {near[0]}? " if near else "") + f"there are {', '.join(among)}"


def plain(name: str, value: Any) -> Value:
    """The value as Python has it; of numpy's numbers, also arrays of a single one. Raises
    ArgumentError for what is neither a number, a text, true nor false, or is not finite."""
    if getattr(value, "shape", None) == () and callable(getattr(value, "item", None)):
        value = value.item()
    if isinstance(value, bool):
        return value
    if isinstance(value, str):
        return str(value)
    if isinstance(value, numbers.Integral):
        return int(value)
    if isinstance(value, numbers.Real):
        number = float(value)
        if math.isfinite(number):
            return number
    raise ArgumentError(f"{name}: {_shown(value)} is not allowed; allowed: a finite number, a text, "
                        "True or False")  # fmt: skip


def number(name: str, value: Any, allowed: str = "a finite number",
           holds: Callable[[float], bool] = math.isfinite) -> float:  # fmt: skip
    """The same of what has to be a number; `allowed` says which ones `holds` is true of."""
    try:
        found = plain(name, value)
        if not isinstance(found, str) and holds(float(found)):
            return float(found)
    except (ArgumentError, OverflowError):
        pass
    raise ArgumentError(f"{name}: {_shown(value)} is not allowed; allowed: {allowed}")


def number_above(name: str, value: Any, least: float = 0) -> float:
    """The same of what has to be a number above that one."""
    return number(name, value, f"a finite number above {least:g}", lambda x: x > least)


def whole(name: str, value: Any, least: int = 0) -> int:
    """The same of what has to be a whole number from `least` on."""
    try:
        found = plain(name, value)
        if not isinstance(found, (str, bool)) and found >= least and found == int(found):
            return int(found)
    except ArgumentError:
        pass
    raise ArgumentError(f"{name}: {_shown(value)} is not allowed; allowed: a whole number from {least} on")


def items_of(name: str, given: Any, allowed: str, fewest: int = 0) -> List[Any]:
    """What is in a list, a generator or an array; a text and a dict are none of them."""
    single = isinstance(given, (str, bytes, Mapping)) or getattr(given, "shape", None) == ()
    if isinstance(given, Iterable) and not single:
        found = list(given)
        if len(found) >= fewest:
            return found
    raise ArgumentError(f"{name}: {_shown(given)} is not allowed; allowed: {allowed}")


def pairs_of(name: str, given: Any, of: str) -> List[List[Any]]:
    """A list of pairs; `of` says what is in one."""
    found = []
    for each in items_of(name, given, f"a list of pairs of {of}"):
        found.append(items_of(f"{name}, pair {len(found) + 1}", each, of, 2))
        if len(found[-1]) > 2:
            raise ArgumentError(f"{name}, pair {len(found)}: has {len(found[-1])} values; allowed: {of}")
    return found


def text_of(value: Value) -> str:
    """As the program reads it, to the last digit."""
    if isinstance(value, bool):
        return "true" if value else "false"
    return str(value)


def settings_of(given: Any, more: Mapping[str, Any] = {}, name: str = "settings") -> Dict[str, Value]:
    """Settings by their keys: those of a mapping, and those of keywords, which have two underscores
    for the dot, coupling__k_vc=8. A short word stands for three of them: eta, coupling, alpha."""
    if given is not None and not isinstance(given, Mapping):
        raise ArgumentError(f'{name}: {_shown(given)} is not allowed; allowed: a dict such as '
                            '{"coupling.eta": 0.5}')  # fmt: skip
    found: Dict[str, Value] = {}
    for key, value in [*(given or {}).items(), *more.items()]:
        if not isinstance(key, str):
            raise ArgumentError(f"{name}: {_shown(key)} is no key; allowed: a text such as coupling.eta")
        whole_key = SHORT.get(key, key.replace("__", "."))
        if whole_key in found and found[whole_key] != plain(whole_key, value):
            raise ArgumentError(f"{whole_key}: is given twice, {found[whole_key]} and {value}")
        found[whole_key] = plain(whole_key, value)
    return found


SHORT = {"coupling": "coupling.kind", "eta": "coupling.eta", "alpha": "observer.alpha"}


def names_of(what: str, given: Any) -> List[str]:
    """A list of names; a single one is that one, and not its letters."""
    if isinstance(given, str):
        return [given]
    if isinstance(given, Iterable) and not isinstance(given, (bytes, Mapping)):
        found = list(given)
        if all(isinstance(name, str) for name in found):
            return [str(name) for name in found]
    raise ArgumentError(f"{what}: {_shown(given)} is not allowed; allowed: a list of texts")


def path_of(name: str, value: Any) -> str:
    """A file's name. Raises ArgumentError for anything else."""
    if isinstance(value, (str, os.PathLike)):
        found = os.fspath(value)
        if isinstance(found, str) and found and "\0" not in found:
            return found
    raise ArgumentError(f"{name}: {_shown(value)} is not allowed; allowed: the name of a file")


def is_path(value: Any) -> bool:
    """Whether it names a file, and is not what could be in one."""
    return isinstance(value, (str, os.PathLike))


HAND_COLUMNS = ("time_s", "x_m", "y_m", "z_m")  # of a hand's file


def hand_rows(hand: Any) -> List[List[float]]:
    """Rows of a hand's path: time [s], x, y, z [m], of a list, a generator, an array of N x 4, or
    a table of pandas. Raises ArgumentError for anything else."""
    needed = "needed: at least two rows of time [s], x, y, z [m], each later than the one before"
    if hasattr(hand, "to_numpy"):
        hand = _in_order(hand).to_numpy()
    if hasattr(hand, "mask"):
        raise ArgumentError("hand: is a masked array; needed: all of its numbers")
    if isinstance(hand, (str, bytes, Mapping)) or not isinstance(hand, Iterable):
        raise ArgumentError(f"hand: {_shown(hand)} is no path of a hand; {needed}")
    rows: List[List[float]] = []
    try:
        for row in hand:
            if isinstance(row, (str, bytes, Mapping)) or not isinstance(row, Iterable):
                raise ArgumentError(f"hand: row {len(rows) + 1}: {_shown(row)} is no row; {needed}")
            cells = [number(f"hand: row {len(rows) + 1}", cell) for cell in row]
            if len(cells) != 4:
                raise ArgumentError(f"hand: row {len(rows) + 1}: has {len(cells)} numbers; {needed}")
            if rows and cells[0] <= rows[-1][0]:
                raise ArgumentError(f"hand: row {len(rows) + 1}: time {cells[0]} after "
                                    f"{rows[-1][0]}; {needed}")  # fmt: skip
            rows.append(cells)
    except TypeError as error:  # an array without dimensions
        raise ArgumentError(f"hand: {_shown(hand)} is no path of a hand; {needed}") from error
    if len(rows) < FEWEST_ROWS:
        raise ArgumentError(f"hand: has {len(rows)} row{'s' * (len(rows) != 1)}; {needed}")
    return rows


def hand_array(hand: Any) -> "numpy.ndarray":
    """The same as an array of N x 4; one that is right is taken as it is."""
    import numpy

    whole = type(hand) is numpy.ndarray and hand.dtype == float and hand.ndim == 2 and hand.shape[1] == 4
    if whole and len(hand) >= FEWEST_ROWS and numpy.isfinite(hand).all() and (numpy.diff(hand[:, 0]) > 0).all():
        return hand
    return numpy.array(hand_rows(hand))


def _in_order(table: Any) -> Any:
    """A table of pandas with its columns as a hand's file has them; numbered columns stay."""
    names = list(getattr(table, "columns", ()))
    if not any(isinstance(name, str) for name in names):
        return table
    if sorted(map(str, names)) != sorted(HAND_COLUMNS):
        raise ArgumentError(f"hand: has columns {', '.join(map(str, names))[:60]}; "
                            f"needed: {', '.join(HAND_COLUMNS)}")  # fmt: skip
    return table[list(HAND_COLUMNS)]


def _shown(value: Any) -> str:
    """Short enough for a message."""
    text = f"{type(value).__name__} {value}" if not isinstance(value, (str, type(None))) else repr(value)
    text = " ".join(text.split())
    return text if len(text) <= 60 else text[:57] + "..."
