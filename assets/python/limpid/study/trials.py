"""Trials one after the other, each answer in the CSV before the next one begins."""

from __future__ import annotations

import csv
import io
import os
import random
from datetime import datetime, timezone
from pathlib import Path
from typing import Any, Callable, Dict, Iterator, List, Optional, Sequence, Tuple, Union

from limpid.errors import LimpidError
from limpid.study.methods import ConstantStimuli, Quest, Staircase
from limpid.study.orders import order_for
from limpid.study.participants import Person, Simulated, Stimulus

COLUMNS = ("study", "participant", "row", "kind", "block", "condition", "trial", "practice", "level",
           "standard", "order", "answer", "correct", "value", "seconds", "sessions", "time")  # fmt: skip
Method = Union[Staircase, Quest, ConstantStimuli]
Who = Union[Person, Simulated]


class StudyError(LimpidError):
    """A study that cannot begin, or go on where it stopped."""


class Study:
    """One participant of a study. The answers are in FOLDER/NAME-PARTICIPANT.csv, a row each, and the
    sessions beside it; rows that are there already are taken as they are, in their order, so that a
    study that was cut off goes on behind them."""

    def __init__(self, name: str, folder: "os.PathLike[str] | str", participant: int, who: Who) -> None:
        """`participant`: a number from 0 on, which decides orders and chance. Raises StudyError for a
        file that is not this study's."""
        self.name, self.participant, self.who = name, participant, who
        self.folder = Path(folder)
        self.folder.mkdir(parents=True, exist_ok=True)
        self.file = self.folder / f"{name}-{participant:03d}.csv"
        self._known = self._read()
        self._next = 0
        self.rows: List[Dict[str, str]] = []

    def _read(self) -> List[Dict[str, str]]:
        """Half a row, as a crash may leave it, was no answer yet."""
        if not self.file.exists():
            self._append(list(COLUMNS))
            return []
        data = self.file.read_bytes()
        whole = data[: data.rfind(b"\n") + 1]
        if len(whole) < len(data):
            os.truncate(self.file, len(whole))
        rows = list(csv.DictReader(io.StringIO(whole.decode())))
        if whole and not whole.startswith(",".join(COLUMNS).encode()):
            raise StudyError(f"{self.file}: has other columns than this study's")
        if not whole:
            self._append(list(COLUMNS))
        return rows

    def _append(self, cells: List[str]) -> None:
        line = io.StringIO()
        csv.writer(line, lineterminator="\n").writerow(cells)
        with open(self.file, "ab") as out:
            out.write(line.getvalue().encode())
            out.flush()
            os.fsync(out.fileno())

    def _row(self, asked: Dict[str, Any], ask: Callable[[], Dict[str, Any]]) -> Dict[str, str]:
        """What is known of the next row, or else what is asked and written now."""
        number = self._next
        self._next += 1
        plan = {key: _text(value) for key, value in asked.items()}
        if number < len(self._known):
            row = self._known[number]
            other = [key for key, value in plan.items() if row[key] != value]
            if other:
                raise StudyError(f"{self.file}: row {number + 1}: {other[0]} is {row[other[0]]}; needed: "
                                 f"{plan[other[0]]}, as the study has it now")  # fmt: skip
        else:
            answers = {key: _text(value) for key, value in ask().items()}
            now = datetime.now(timezone.utc).isoformat(timespec="milliseconds")
            row = {**dict.fromkeys(COLUMNS, ""), "study": self.name,
                   "participant": str(self.participant), "row": str(number + 1), **plan, **answers,
                   "time": now}  # fmt: skip
            self._append([row[key] for key in COLUMNS])
        self.rows.append(row)
        return row

    def chance(self) -> random.Random:
        """The same for the same row of the same participant, whenever that is asked for."""
        return random.Random(f"{self.name} {self.participant} {self._next}")

    def blocks(self, conditions: Sequence[str], pause: str = "Take a break. Enter goes on."
               ) -> Iterator[str]:  # fmt: skip
        """The conditions in this participant's order, with breaks in between."""
        for i, condition in enumerate(order_for(self.participant, conditions)):
            if i > 0 and self._next >= len(self._known):
                self.who.tell(pause)
            yield condition

    def tell(self, text: str) -> None:
        """Something to read, where the study is not past it already."""
        if self._next >= len(self._known):
            self.who.tell(text)

    def question(self, text: str, choices: Sequence[str], condition: str = "") -> str:
        """A question beside the trials; its answer is a row."""

        def ask() -> Dict[str, Any]:
            said = self.who.choose(text, choices)
            return {"answer": said.answer, "seconds": said.seconds}

        return self._row({"kind": "question", "condition": condition}, ask)["answer"]

    def value(self, condition: str, trial: int, measure: Callable[[], Tuple[float, List[str]]],
              level: Optional[float] = None) -> float:  # fmt: skip
        """A trial whose outcome is a number, and the sessions that it has recorded."""

        def ask() -> Dict[str, Any]:
            value, sessions = measure()
            return {"value": value, "sessions": " ".join(sessions)}

        asked = {"kind": "value", "condition": condition, "trial": trial, "level": level}
        return float(self._row(asked, ask)["value"])

    def two_intervals(self, method: Method, condition: str, standard: float,
                      make: Callable[[float], Stimulus], question: str, practice: int = 0,
                      pause_every: int = 0) -> List[Tuple[float, bool]]:  # fmt: skip
        """Two-interval forced choice: the standard and one that has more by the method's level, in an
        order of chance; which one has more? `make` gives the stimulus of a value. The first `practice`
        trials are at the method's first level, are told whether they were right, and do not count.
        Returns the answers that count: (level, right)."""
        counted: List[Tuple[float, bool]] = []
        first_level, trial = method.level, 0
        while trial < practice or not method.done:
            practised = trial < practice
            level = first_level if practised else method.level
            second = self.chance().random() < 0.5  # the comparison comes second
            if pause_every and trial and trial % pause_every == 0:
                self.tell("Take a break. Enter goes on.")
            correct = self._compare(condition, trial, practised, level, standard, second, make, question)
            if practised:
                self.tell("Right." if correct else "It was the other one.")
            else:
                method.answer(correct)
                counted.append((level, correct))
            trial += 1
        return counted

    def _compare(self, condition: str, trial: int, practised: bool, level: float, standard: float,
                 second: bool, make: Callable[[float], Stimulus], question: str) -> bool:  # fmt: skip
        name = f"{self.name}-{self.participant:03d}-{condition}-{trial:03d}".replace("/", "-")
        stimuli = [make(standard), make(standard + level)]

        def ask() -> Dict[str, Any]:
            shown = stimuli if second else stimuli[::-1]
            said, sessions = self.who.compare(shown, question, ("the first", "the second"),
                                              self.folder, name)  # fmt: skip
            return {"answer": said.answer, "correct": int(said.index == int(second)),
                    "seconds": said.seconds, "sessions": " ".join(sessions)}  # fmt: skip

        asked = {"kind": "2ifc", "condition": condition, "trial": trial, "practice": int(practised),
                 "level": level, "standard": standard, "order": 2 if second else 1}  # fmt: skip
        return self._row(asked, ask)["correct"] == "1"


def _text(value: Any) -> str:
    """To the last digit, so that it is the same when it is read."""
    return "" if value is None else repr(value) if isinstance(value, float) else str(value)
