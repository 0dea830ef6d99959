"""A case of bad input, and the good input it spoils."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

import arms


@dataclass(frozen=True)
class Good:
    """A set of good inputs, and the folder for the bad ones."""

    directory: Path
    arm: arms.ArmFiles
    session: Path

    def run(self, option: str = "", value: str | Path = "") -> list[str | Path]:
        """`limpid run` with good options, but for one that is added or replaced."""
        words: dict[str, str | Path] = {
            "--device": self.arm.urdf,
            "--scene": self.arm.scene,
            "--hand": self.arm.hand,
            "--duration": "0.05",
            "--record": self.directory / "refused.h5",
        }
        if option:
            words[option] = value
        return ["run", *(word for pair in words.items() for word in pair)]

    def file(self, name: str, text: str | bytes) -> Path:
        path = self.directory / name
        path.write_bytes(text.encode() if isinstance(text, str) else text)
        return path


@dataclass(frozen=True)
class Case:
    name: str
    words: Callable[[Good], list[str | Path]]
    names: list[str] = field(default_factory=list)  # what the complaint must contain


def edited(kind: str, old: str, new: str) -> Callable[[Good], str]:
    """The text of a good input with its first `old` replaced."""

    def text(good: Good) -> str:
        whole = Path(getattr(good.arm, kind)).read_text()
        assert old in whole, f"{old!r} is not in the {kind}"
        return whole.replace(old, new, 1)

    return text


def file_case(
    name: str, option: str, file: str, text: str | bytes | Callable[[Good], str], *names: str
) -> Case:
    def words(good: Good) -> list[str | Path]:
        content = text(good) if callable(text) else text
        return good.run(option, good.file(file, content))

    return Case(f"{option[2:]}: {name}", words, [file, *names])
