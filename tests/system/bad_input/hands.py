"""Hand paths and sessions that cannot be followed."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import h5py
import numpy as np

from .case import Case, Good, file_case


def _csv(name: str, text: str | bytes, *names: str) -> Case:
    return file_case(name, "--hand", "bad.csv", text, *names)


_HEADER = "time_s,x_m,y_m,z_m\n"


def _csv_rows(name: str, third: str, *names: str) -> Case:
    """A path whose fourth line, row three, is bad."""

    def words(good: Good) -> list[str | Path]:
        lines = good.arm.hand.read_text().splitlines()
        lines[3] = third
        return good.run("--hand", good.file("bad.csv", "\n".join(lines) + "\n"))

    return Case(f"hand: {name}", words, ["bad.csv", *names])


CSV: list[Case] = [
    _csv("empty", ""),
    _csv("header only", _HEADER, "bad.csv"),
    _csv("bytes", bytes(range(256)) * 4),
    _csv("no z column", "time_s,x_m,y_m\n0,0.2,0\n1,0.2,0\n", "z_m"),
    _csv("other names", "t,x,y,z\n0,0.2,0,0\n1,0.2,0,0\n", "time_s"),
    _csv("out of reach", _HEADER + "0,5,0,0\n1,5,0,0\n"),
    _csv_rows("a word", "0.01,here,0,0", "4"),
    _csv_rows("not a number", "0.01,nan,0,0", "4"),
    _csv_rows("infinite", "0.01,inf,0,0", "4"),
    _csv_rows("too large for a double", "0.01,1e999,0,0", "4"),
    _csv_rows("an empty cell", "0.01,,0,0", "4"),
    _csv_rows("a short row", "0.01,0.2", "4"),
    _csv_rows("a number with a tail", "0.01,0.2abc,0,0", "4"),
    _csv_rows("time not a number", "nan,0.2,0,0", "4"),
    _csv_rows("time going back", "0.001,0.2,0,0", "4"),
]


def _copied(change: Callable[[h5py.File], None]) -> Callable[[Good], Path]:
    def make(good: Good) -> Path:
        path = good.file("bad.h5", good.session.read_bytes())
        with h5py.File(path, "r+") as file:
            change(file)
        return path

    return make


def _reshaped(name: str, shape: tuple[int, ...]) -> Callable[[h5py.File], None]:
    def change(file: h5py.File) -> None:
        del file[name]
        file[name] = np.zeros(shape)

    return change


def _removed(name: str) -> Callable[[h5py.File], None]:
    return lambda file: file.__delitem__(name)


def _attribute(name: str, value: object) -> Callable[[h5py.File], None]:
    return lambda file: file.attrs.__setitem__(name, value)


def _bad_time(file: h5py.File) -> None:
    file["/time"][5] = np.nan


def _bad_change(file: h5py.File) -> None:
    """A setting that was never allowed, among the changes of a session."""
    for name, value in (("row", 3), ("setting", b"coupling.eta = -5")):
        file[f"/events/{name}"].resize((1,))
        file[f"/events/{name}"][0] = value


def _other_hdf5(good: Good) -> Path:
    path = good.directory / "bad.h5"
    with h5py.File(path, "w") as file:
        file["/time"] = np.arange(5.0)
    return path


def _session_cases(name: str, make: Callable[[Good], Path], *names: str) -> list[Case]:
    """A bad session as the hand of a run, and shown by `info`."""
    expected = ["bad.h5", *names]
    return [
        Case(f"hand of a session: {name}", lambda good: good.run("--hand", make(good)), expected),
        Case(f"info of a session: {name}", lambda good: ["info", make(good)], expected),
    ]


SESSIONS: list[Case] = [
    case
    for name, make, *names in (
        ("not HDF5", lambda good: good.file("bad.h5", "time,x\n0,1\n")),
        ("empty", lambda good: good.file("bad.h5", "")),
        ("cut off", lambda good: good.file("bad.h5", good.session.read_bytes()[:3000])),
        ("some other HDF5", _other_hdf5),
        ("another format", _copied(_attribute("format", "somebody-elses")), "somebody-elses"),
        ("another version", _copied(_attribute("version", 99)), "99"),
        ("no rows dataset", _copied(_removed("/time")), "/time"),
        ("no hand", _copied(_removed("/hand/target")), "/hand/target"),
        ("hand of two columns", _copied(_reshaped("/hand/target", (50, 2))), "/hand/target"),
        ("hand too short", _copied(_reshaped("/hand/target", (49, 3))), "/hand/target"),
        ("times not finite", _copied(_bad_time), "/time"),
    )
    for case in _session_cases(name, make, *names)
] + [
    Case(
        "hand of a session: a change that is not allowed",
        lambda good: good.run("--hand", _copied(_bad_change)(good)),
        ["bad.h5", "coupling.eta"],
    )
]
