"""Where the program is, and how it is run to its end."""

from __future__ import annotations

import contextlib
import os
import shutil
import subprocess
from pathlib import Path
from typing import List, Mapping, Sequence

from limpid.errors import ProgramError, in_python
from limpid.values import PathLike, Value, text_of


def find_program() -> str:
    """The program: $LIMPID, else the one that was built or installed with this package, else `limpid`
    of PATH.

    Raises ProgramError where there is none."""
    named = os.environ.get("LIMPID")
    if named:
        if not os.access(named, os.X_OK):
            raise ProgramError(f"LIMPID: {named} is no program that can be started")
        return named
    # In a source tree this is assets/python/limpid, installed it is lib/python3/dist-packages/limpid.
    tree, prefix = list(Path(__file__).resolve().parents)[3:5]
    for program in (tree / "build/release/app/limpid", tree / "build/dev/app/limpid",
                    prefix / "bin/limpid"):  # fmt: skip
        if program.is_file() and os.access(program, os.X_OK):
            return str(program)
    installed = shutil.which("limpid")
    if installed is None:
        raise ProgramError("limpid is not installed; set LIMPID to the program")
    return installed


def assets(name: str, kind: str) -> str:
    """The file of that name, or the one of that name that came along with the program."""
    if os.path.exists(name) or os.path.dirname(name):
        return name
    # Beside this package, as `pip install` puts them, or as they are in a source tree.
    here = Path(__file__).resolve()
    folders = [folder / "share/limpid/assets" for folder in here.parents] + [here.parents[2]]
    with contextlib.suppress(ProgramError):
        program = os.path.realpath(find_program())
        folders = [folder / "share/limpid/assets" for folder in Path(program).parents] + folders
    for folder in folders:
        own = folder / kind / name
        if own.is_file():
            return str(own)
    return name


def carry_out(words: Sequence[PathLike]) -> str:
    """Runs `limpid WORDS` to its end and returns what it printed.

    Raises ProgramError with what it said where it fails."""
    command = [find_program(), *(os.fspath(word) for word in words)]
    try:
        done = subprocess.run(command, capture_output=True, text=True, errors="replace",
                              stdin=subprocess.DEVNULL, check=False)  # fmt: skip
    except (OSError, ValueError) as error:
        raise ProgramError(f"{command[0]}: cannot be started: {error}") from error
    if done.returncode != 0:
        said = done.stderr.strip() or done.stdout.strip() or f"exit status {done.returncode}"
        raise ProgramError(in_python(said))
    return done.stdout


def setting_words(values: Mapping[str, Value], option: str = "--set") -> List[str]:
    """Settings as the command line has them: {"coupling.eta": 0.5} becomes --set coupling.eta=0.5, or
    without an option the word alone."""
    words: List[str] = []
    for key, value in values.items():
        words += [option] * bool(option) + [f"{key}={text_of(value)}"]
    return words
