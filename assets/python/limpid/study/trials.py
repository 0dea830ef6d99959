"""Trials one after the other, each answer in the CSV before the next one begins."""

from __future__ import annotations

import contextlib
import functools
import math
import os
import random
import re
import tempfile
from datetime import datetime, timezone
from pathlib import Path
from typing import Any, Callable, Dict, Iterator, List, Mapping, Optional, Sequence, Tuple, Union

from limpid.errors import ArgumentError, ProgramError, RecordingError, RequestError
from limpid.study.answers import Answers, StudyError
from limpid.study.methods import Adjustment, ConstantStimuli, Quest, Staircase, limits_of
from limpid.study.orders import order_for
from limpid.study.participants import Person, Shown, Simulated, Stimulus, StimulusError
from limpid.study.sheet import Sheet
from limpid.values import number, number_above, plain, settings_of, text_of, whole

WANTED = ("less", "more", "reference", "same")  # by the keys 1 to 4 of who adjusts
COLUMNS = ("study", "participant", "row", "kind", "block", "condition", "trial", "practice", "level",
           "standard", "order", "answer", "correct", "value", "seconds", "sessions", "time")  # fmt: skip
Method = Union[Staircase, Quest, ConstantStimuli]
Who = Union[Person, Simulated]


def folder_for(folder: "os.PathLike[str] | str") -> Path:
    """The folder, which is there then. Raises StudyError where that cannot be, or nothing can be
    written to it."""
    try:
        path = Path(folder)
    except TypeError as error:
        raise StudyError(f"{folder!r} is no folder") from error
    try:
        path.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=path):
            pass
    except OSError as error:
        raise StudyError(f"{path}: answers cannot be written there: {error.strerror}; choose another "
                         "folder, or make room in it") from error  # fmt: skip
    return path


class Study:
    """One participant of a study. The answers are in FOLDER/NAME-PARTICIPANT.csv, a row each, and the
    sessions beside it; rows that are there already are taken as they are, in their order, so that a
    study that was cut off goes on behind them. FOLDER/NAME-PARTICIPANT.json says under what they were
    given. No other process can write to them meanwhile."""

    def __init__(self, name: str, folder: "os.PathLike[str] | str", participant: int, who: Who,
                 settings: Optional[Mapping[str, Any]] = None) -> None:  # fmt: skip
        """`participant`: a number from 0 on, which decides orders and chance. `settings`: of the
        program in all trials, by their keys; all others have their usual values, whatever the window
        had before. What a stimulus sets holds for its interval.

        Raises StudyError for a file that is not this study's, that another process writes to, whose
        answers were given under other settings, or a folder that cannot be written to."""
        try:
            self.participant = whole("participant", participant)
            chosen = settings_of(settings)
        except ArgumentError as error:
            raise StudyError(str(error)) from error
        if not re.fullmatch(r"[\w.-]+( [\w.-]+)*", str(name)):
            raise StudyError(f"name: {name!r} is not allowed; allowed: letters, digits, and - _ . within them")
        self.name, self.who = str(name), who
        self.folder = folder_for(folder)
        self.file = self.folder / f"{self.name}-{self.participant:03d}.csv"
        sheet = self.file.with_suffix(".json")
        self._answers = Answers(self.file, COLUMNS, lambda: Sheet(sheet).who_has_it())
        self.sheet = Sheet(sheet)
        self.rows: List[Dict[str, str]] = []
        self._known = self._answers.rows
        if self._answers.empty:
            self._append(list(COLUMNS))
        with self._asking():
            known, version = who.begin(chosen)
        self.sheet.begin(self.name, self.participant, known, version, len(self._known))
        self._next = self._block = 0

    def _append(self, cells: List[str]) -> None:
        try:
            self._answers.append(cells)
        except OSError as error:
            raise StudyError(f"{self.file}: {error.strerror}; the last answer is not in it. Make room for "
                             f"it there and start the study again with the same words: {self._goes_on()}"
                             ) from error  # fmt: skip

    def _goes_on(self) -> str:
        kept = max(len(self._known), len(self.rows))
        return f"it goes on behind the {kept} answers that are there"

    @contextlib.contextmanager
    def _asking(self) -> Iterator[None]:
        """What goes wrong meanwhile, as where somebody closes the window, says where the answers are."""
        try:
            yield
        except StimulusError as error:
            raise StudyError(f"{error}. That is what the study asks for, so that starting it again ends here "
                             "again: change the study. Limits `low` and `high` of a method are those of its "
                             "level, which in trials of two intervals comes on top of the standard. Every "
                             f"answer up to then is in {self.file}; {self._goes_on()}") from error  # fmt: skip
        except (ProgramError, RecordingError, RequestError) as error:
            ended = isinstance(error, ProgramError)
            raise StudyError(f"{error}. Every answer up to then is in {self.file}; start "
                             f"{'`limpid --listen` and ' * ended}the study again with the same words: "
                             f"{self._goes_on()}") from error  # fmt: skip

    def _row(self, asked: Dict[str, Any], ask: Callable[[], Dict[str, Any]]) -> Dict[str, str]:
        """What is known of the next row, or else what is asked and written now."""
        place = self._next
        self._next += 1
        plan = {key: _text(value) for key, value in asked.items()}
        if place < len(self._known):
            row = self._known[place]
            other = [key for key, value in plan.items() if not _same(row.get(key), value)]
            if other:
                words = self.sheet.words()
                began = f" It began with the words: {words}" if words else ""
                raise StudyError(f"{self.file}: row {place + 1}: {other[0]} is {row.get(other[0])}; needed: "
                                 f"{plan[other[0]]}, as the study has it now. Start it as it began, or with "
                                 f"another folder or participant.{began}")  # fmt: skip
        else:
            with self._asking():
                answers = {key: _text(value) for key, value in ask().items()}
            now = datetime.now(timezone.utc).isoformat(timespec="milliseconds")
            row = {**dict.fromkeys(COLUMNS, ""), "study": self.name,
                   "participant": str(self.participant), "row": str(place + 1),
                   "block": str(self._block or ""), **plan, **answers, "time": now}  # fmt: skip
            self._append([row[key] for key in COLUMNS])
        self.rows.append(row)
        return row

    def chance(self) -> random.Random:
        """The same for the same row of the same participant, whenever that is asked for."""
        return random.Random(f"{self.name} {self.participant} {self._next}")

    def blocks(self, conditions: Sequence[str]) -> Iterator[str]:
        """The conditions in this participant's order, with breaks in between."""
        order = order_for(self.participant, conditions)
        for i, condition in enumerate(order):
            self._block = i + 1
            if i > 0:
                self.tell(f"Take a break. Part {i + 1} of {len(order)} comes next.")
            yield condition

    def tell(self, text: str) -> None:
        """Something to read, where the study is not past it already."""
        if self._next >= len(self._known):
            with self._asking():
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
        self.sheet.ask(condition, question)
        standard = number("standard", standard)
        practice, pause_every = whole("practice", practice), whole("pause_every", pause_every)
        counted: List[Tuple[float, bool]] = []
        first_level, trial = method.level, 0
        while trial < practice or not method.done:
            practised = trial < practice
            level = first_level if practised else method.level
            second = self.chance().random() < 0.5  # the comparison comes second
            self._before(trial, practice, pause_every, " You are told whether you were right.")
            correct = self._compare(condition, trial, practised, level, standard, second, make, question)
            if practised:
                self.tell("Right." if correct else "It was the other one.")
            else:
                method.answer(correct)
                counted.append((level, correct))
            trial += 1
        return counted

    def _before(self, trial: int, practice: int, pause_every: int, told: str) -> None:
        """What there is to read before a trial."""
        if practice and trial == 0:
            self.tell(f"First some practice: {practice} trial{'s' * (practice > 1)}, which "
                      f"do{'es' * (practice == 1)} not count.{told}")  # fmt: skip
        elif practice and trial == practice:
            self.tell("That was the practice. From now on it counts.")
        elif pause_every and trial and trial % pause_every == 0:
            self.tell("Take a break.")

    def adjustments(self, condition: str, reference: Stimulus, make: Callable[[float], Stimulus],
                    question: str, words: Tuple[str, str] = ("less", "more"), trials: int = 10,
                    around: Optional[float] = None, spread: float = 2.0, practice: int = 0,
                    pause_every: int = 0, low: float = 0.0, high: float = math.inf
                    ) -> List[Tuple[float, float]]:  # fmt: skip
        """Method of adjustment: the participant changes a quantity with keys until it feels like the
        reference, feels that again whenever it wants, and confirms with a key. `make` gives the
        stimulus of a value, `words` what its first two keys make of it. Of each two trials one starts
        above `around`, the reference's level, and one below, in an order of chance, by a factor up to
        `spread`. Each key that is pressed adds a row; the row that confirms has the value that was found.

        Returns the pairs for equality(). A trial that takes 100 keys is left, and its pair with it.
        Raises ArgumentError for a number of trials that is not even."""
        practice, pause_every = whole("practice", practice), whole("pause_every", pause_every)
        trials = whole("trials", trials, 2)
        if trials % 2:
            raise ArgumentError(f"trials come in pairs, from above and from below; found: {trials}")
        low, high = limits_of(low, high)
        spread = number("spread", spread, "a finite number from 1 on", lambda x: x >= 1)
        middle = number_above("around", reference.level if around is None else around)
        self.sheet.ask(condition, question)
        found: List[Optional[float]] = []
        above = False
        for trial in range(practice + trials):
            chance = self.chance()
            first = (trial - practice) % 2 == 0  # of its pair
            above = chance.random() < 0.5 if first else not above
            factor = spread ** ((1 if above else -1) * chance.uniform(0.5, 1))
            method = Adjustment(min(max(middle * factor, low), high), low=low, high=high)
            self._before(trial, practice, pause_every, "")
            self._adjust({"condition": condition, "trial": trial, "practice": int(trial < practice),
                          "order": 2 if above else 1}, reference, method, make, question, words)  # fmt: skip
            if trial >= practice:
                found.append(method.level if method.matched else None)
        return [(a, b) for a, b in zip(found[::2], found[1::2]) if a is not None and b is not None]

    def _adjust(self, asked: Dict[str, Any], reference: Stimulus, method: Adjustment,
                make: Callable[[float], Stimulus], question: str, words: Tuple[str, str]) -> None:  # fmt: skip
        """A trial; `asked` is what its rows have in common."""
        name = self._name_of(asked["condition"], asked["trial"])
        told = "This is the reference. Feel it, then go on to yours."
        first = Shown(reference, reference, told, ("Go on",), 0)
        step, again = 0, True
        while not method.done:
            if again:
                shown = first._replace(step=step)
            else:
                text = question + (" It goes no further." if method.at_limit else "")
                choices = (*words, "feel the reference again", "it feels the same")
                shown = Shown(make(method.level), reference, text, choices, step)
            row = {"kind": "reference" if again else "adjust", **asked, "level": shown.stimulus.level,
                   "standard": reference.level}  # fmt: skip
            ask = functools.partial(self._press, shown, name)
            answer = self._row(row, ask)["answer"]
            if not again and answer != "reference":
                method.answer(answer)
            again = answer == "reference"
            step += 1
        if not method.matched:
            with self._asking():
                self.who.rest()

    def _press(self, shown: Shown, name: str) -> Dict[str, Any]:
        said, sessions = self.who.adjust(shown, self.folder, name)
        answer = WANTED[said.index] if len(shown.choices) > 1 else "on"
        return {"answer": answer, "value": shown.stimulus.level if answer == "same" else None,
                "seconds": said.seconds, "sessions": " ".join(sessions)}  # fmt: skip

    def _name_of(self, condition: str, trial: int) -> str:
        return f"{self.name}-{self.participant:03d}-{condition}-{trial:03d}".replace("/", "-")

    def _compare(self, condition: str, trial: int, practised: bool, level: float, standard: float,
                 second: bool, make: Callable[[float], Stimulus], question: str) -> bool:  # fmt: skip
        name = self._name_of(condition, trial)
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
    return "" if value is None else text_of(plain("a cell", value))


def _same(before: Optional[str], now: str) -> bool:
    """Of two cells, also where a number is written otherwise, as 100 and 100.0 are."""
    if before == now:
        return True
    try:
        return float(before or "") == float(now)
    except ValueError:
        return False
