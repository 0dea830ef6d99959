"""Who takes part: a person at the window, or one that is simulated."""

from __future__ import annotations

import itertools
import math
import os
import random
from pathlib import Path
from typing import Any, Callable, Dict, List, Mapping, NamedTuple, Optional, Sequence, Tuple

from limpid.client import Client
from limpid.errors import ArgumentError, ProgramError, RequestError
from limpid.study.fits import lapse_of
from limpid.study.sheet import program_version
from limpid.values import number_above, plain, settings_of


class StimulusError(RequestError):
    """The program refuses what a stimulus asks for."""


class Stimulus(NamedTuple):
    """What an interval is made of."""

    level: float  # what the participant compares, in the study's unit
    settings: Dict[str, Any] = {}  # of the program
    scene: Optional[str] = None  # a file; None: what is there stays


class Said(NamedTuple):
    """What came of a question."""

    index: int
    answer: str
    seconds: float  # from the question to its answer


class Shown(NamedTuple):
    """What a participant is given to adjust."""

    stimulus: Stimulus  # that is felt now
    reference: Stimulus
    text: str
    choices: Sequence[str]  # go on; or less, more, the reference again, the same
    step: int  # of its trial, from 0 on


class Person:
    """At the window of a program that listens: `limpid --listen`. Law, settings and plots are hidden
    meanwhile."""

    def __init__(self, loop: Client, seconds: float = 4.0) -> None:
        """`seconds`: how long an interval is [s]."""
        self._loop, self._seconds = loop, number_above("seconds", seconds)
        self._settings: Dict[str, Any] = {}  # of all stimuli, once a study has begun
        self._begun = False
        self._session, self._scene = "", ""  # of a trial that is adjusted
        state = loop.state()
        if state["recording"]:  # of a study that was cut off
            loop.stop()
        self._how = "" if state["device"] else " Pull the arm by its tip, with the left mouse button."
        loop.blind()

    def begin(self, settings: Mapping[str, Any]) -> Tuple[Dict[str, Any], str]:
        """From now on all stimuli have these settings, and all others their usual values. Returns
        what the answers are given under, and the program's version."""
        self._settings, self._begun = dict(settings), True
        state = self._loop.state()
        if state.get("twin"):
            self._loop.twin(on=False)
        self.use({})
        return {"settings": self._loop.get(), "truth": None, "arm": state.get("arm")}, str(
            self._loop.about.get("version", "unknown"))

    def use(self, settings: Mapping[str, Any], scene: Optional[str] = None) -> None:
        """Sets these over the study's, in this scene. Raises StimulusError where the program refuses
        what they are."""
        if scene is not None:
            try:
                self._loop.open(scene=scene)
            except RequestError as error:
                if os.path.basename(scene) in str(error):
                    raise StimulusError(str(error)) from error
                raise
        try:
            self._loop.set({**self._settings, **settings_of(settings)}, reset=self._begun)
        except (RequestError, ArgumentError) as error:
            raise StimulusError(str(error)) from error

    def tell(self, text: str) -> None:
        """Waits for Enter. The first time it says what the hand is, too."""
        text, self._how = text + self._how, ""
        self._loop.ask(text)

    def choose(self, text: str, choices: Sequence[str]) -> Said:
        """A question with its answers."""
        found = self._loop.ask(text, choices)
        return Said(found.index, found.answer, found.seconds)

    def compare(self, stimuli: Sequence[Stimulus], question: str, choices: Sequence[str],
                folder: Path, name: str) -> Tuple[Said, List[str]]:  # fmt: skip
        """Presents one after the other, records each, and asks. Returns the answer and the
        sessions."""
        sessions = []
        for i, stimulus in enumerate(stimuli):
            self.use(stimulus.settings, stimulus.scene)
            place = f"Interval {i + 1} of {len(stimuli)}" if len(stimuli) > 1 else "Interval"
            self._loop.ask(f"{place}, {self._seconds:g} s. Enter begins.")
            file = folder / f"{name}-{i + 1}.h5"
            remove_session(file)  # of a trial that was cut off
            sessions.append(os.path.basename(self._loop.record(file)))
            self._loop.ask(f"{place}: feel it now.", beside=True, seconds=self._seconds)
            self._loop.stop()
        return self.choose(question, choices), sessions

    def adjust(self, shown: Shown, folder: Path, name: str) -> Tuple[Said, List[str]]:
        """Goes on with a trial: what is shown is felt while the question stands beside the picture.
        The trial is one session, or one for each time that it needs another scene."""
        scene, self._scene = self._scene, shown.stimulus.scene or self._scene
        if scene != self._scene:
            self.rest()
        self.use(shown.stimulus.settings, self._scene if scene != self._scene else None)
        if not self._session:
            parts = (folder / f"{name}-{part}.h5" for part in itertools.count(1))
            file = next(file for file in parts if not (file.exists() or part_of(file).exists()))
            self._session = os.path.basename(self._loop.record(file))
        session = self._session
        self._loop.mark("reference" if len(shown.choices) == 1 else f"{shown.stimulus.level:g}")
        found = self._loop.ask(shown.text, shown.choices, beside=True)
        if found.index == len(shown.choices) - 1 and len(shown.choices) > 1:
            self.rest()  # it is the same: the session is complete before the answer is kept
        return Said(found.index, found.answer, found.seconds), [session]

    def rest(self) -> None:
        """Ends the session of the trial that is adjusted."""
        if self._session:
            self._session = ""
            self._loop.stop()


def part_of(session: Path) -> Path:
    """What a session is written to until it is complete."""
    return session.with_name(session.name + ".part")


def remove_session(session: Path) -> None:
    """With what a program that was killed has left of it."""
    for file in (session, part_of(session)):
        if file.exists():
            file.unlink()


class Simulated:
    """Perceives each level with an error of normal distribution and names the larger one; slips now
    and then, and answers by chance. The same seed gives the same answers to the same trials."""

    def __init__(self, threshold: float, lapse: float = 0.02, seed: int = 0,
                 percept: Optional[Callable[[Stimulus], float]] = None) -> None:  # fmt: skip
        """`threshold`: the difference of 75 % right answers, in the study's unit. `percept`: what is
        perceived of a stimulus without the error; the default is its level."""
        self.threshold = number_above("threshold", threshold)
        # Phi(d / (sqrt(2) sigma)) is 75 % at the threshold.
        self.sigma = self.threshold / (0.6744897501960817 * math.sqrt(2))
        self.lapse, self._seed = lapse_of(lapse), plain("seed", seed)
        self._felt = percept

    def begin(self, settings: Mapping[str, Any]) -> Tuple[Dict[str, Any], str]:
        """Returns what the answers are given under, the truth about this participant among it, and the
        program's version."""
        truth = {"threshold": self.threshold, "lapse": self.lapse, "seed": self._seed,
                 "perceives": "levels" if self._felt is None else "runs of the loop"}  # fmt: skip
        return {"settings": dict(settings), "truth": truth, "arm": None}, program_version()

    def _percept(self, stimulus: Stimulus) -> float:
        if self._felt is None:
            return stimulus.level
        try:
            return self._felt(stimulus)
        except ProgramError as error:
            raise StimulusError(str(error)) from error

    def tell(self, text: str) -> None:
        """Reads nothing."""

    def choose(self, text: str, choices: Sequence[str]) -> Said:
        """The first answer."""
        del text
        return Said(0, choices[0], 0.0)

    def compare(self, stimuli: Sequence[Stimulus], question: str, choices: Sequence[str],
                folder: Path, name: str) -> Tuple[Said, List[str]]:  # fmt: skip
        """Names the largest; nothing is recorded."""
        del question, folder
        chance = random.Random(f"{self._seed} {name}")
        if chance.random() < self.lapse:
            index = chance.randrange(len(choices))
        else:
            felt = [self._percept(stimulus) + chance.gauss(0, self.sigma) for stimulus in stimuli]
            index = max(range(len(felt)), key=felt.__getitem__)
        return Said(index, choices[index], 0.0), []

    def adjust(self, shown: Shown, folder: Path, name: str) -> Tuple[Said, List[str]]:
        """Compares what is shown with the reference, and takes what is nearer than half of its
        threshold for the same; slips, too. The threshold is that at the reference, and grows with
        what is felt, as Weber's law has it."""
        del folder
        if len(shown.choices) == 1:
            return Said(0, shown.choices[0], 0.0), []
        chance = random.Random(f"{self._seed} {name} {shown.step}")
        if chance.random() < self.lapse:
            index = chance.randrange(2)
        else:
            reference = self._percept(shown.reference)
            off = math.log(self._percept(shown.stimulus) / reference)
            off += chance.gauss(0, math.sqrt(2) * self.sigma / reference)
            index = 3 if abs(off) < self.threshold / 2 / reference else 0 if off > 0 else 1
        return Said(index, shown.choices[index], 0.0), []

    def rest(self) -> None:
        """There is nothing to end."""
