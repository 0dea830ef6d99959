"""Files that do not exist, and places that cannot be written."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from .case import Case, Good


def _missing(option: str, name: str) -> Case:
    def words(good: Good) -> list[str | Path]:
        return good.run(option, good.directory / name)

    return Case(f"{option} {name} missing", words, [name])


def _folder(option: str) -> Case:
    return Case(f"{option} is a folder", lambda good: good.run(option, good.directory))


FILES: list[Case] = [
    _missing("--device", "no.urdf"),
    _missing("--scene", "no.toml"),
    _missing("--hand", "no.csv"),
    _missing("--hand", "no.h5"),
    _missing("--config", "no.toml"),
    *(_folder(option) for option in ("--device", "--scene", "--hand", "--config")),
    Case("info of nothing", lambda good: ["info", good.directory / "no.h5"], ["no.h5"]),
    Case("recover of nothing", lambda good: ["recover", good.directory / "no.h5.part"], ["no.h5"]),
    Case(
        "recover of something else",
        lambda good: ["recover", good.file("other.h5.part", "not a session")],
        ["other.h5.part"],
    ),
    Case("play of nothing", lambda good: ["play", good.directory / "no.h5"], ["no.h5"]),
    Case("a hand of another kind", lambda good: good.run("--hand", good.arm.urdf), ["arm3.urdf"]),
]


def _record(name: str, place: Callable[[Good], str | Path], *names: str) -> Case:
    return Case(f"record: {name}", lambda good: good.run("--record", place(good)), list(names))


OUTPUT: list[Case] = [
    _record("a folder that is not there", lambda good: good.directory / "no/out.h5", "no"),
    _record("a folder", lambda good: good.directory),
    _record("below a file", lambda good: good.arm.urdf / "out.h5", "arm3.urdf"),
    _record("a place nobody can write", lambda good: "/proc/limpid.h5", "/proc"),
    _record("no name", lambda good: ""),
    _record("a file that exists", lambda good: good.session, "good.h5"),
    *(
        Case(
            f"picture: {name}",
            lambda good, place=place: good.run("--picture", good.directory / place),
            [str(place), reason],
        )
        for name, place, reason in (
            ("a folder that is not there", Path("no/a.png"), "No such file or directory"),
            ("below a file", Path("good/arm3.urdf/a.png"), "Not a directory"),
            ("a folder", Path("good"), "Is a directory"),
        )
    ),
]
