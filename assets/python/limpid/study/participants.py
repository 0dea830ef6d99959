"""Who takes part: a person at the window, or one that is simulated."""

from __future__ import annotations

import math
import os
import random
import time
from pathlib import Path
from typing import Any, Callable, Dict, List, NamedTuple, Optional, Sequence, Tuple

from limpid.client import Client


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


class Person:
    """At the window of a program that listens: `limpid --listen`. Law, settings and plots are hidden
    meanwhile."""

    def __init__(self, loop: Client, seconds: float = 4.0) -> None:
        """`seconds`: how long an interval is [s]."""
        self._loop, self._seconds = loop, seconds
        loop.blind()

    def tell(self, text: str) -> None:
        """Waits for Enter."""
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
            if stimulus.scene is not None:
                self._loop.open(scene=stimulus.scene)
            self._loop.set(stimulus.settings)
            place = f"{i + 1} of {len(stimuli)}" if len(stimuli) > 1 else ""
            self._loop.ask(f"Interval {place}: Enter begins.".replace(" : ", ": "))
            file = folder / f"{name}-{i + 1}.h5"
            file.unlink(missing_ok=True)  # of a trial that was cut off
            sessions.append(os.path.basename(self._loop.record(file)))
            time.sleep(self._seconds)
            self._loop.stop()
        return self.choose(question, choices), sessions


class Simulated:
    """Perceives each level with an error of normal distribution and names the larger one; slips now
    and then, and answers by chance. The same seed gives the same answers to the same trials."""

    def __init__(self, threshold: float, lapse: float = 0.02, seed: int = 0,
                 percept: Optional[Callable[[Stimulus], float]] = None) -> None:  # fmt: skip
        """`threshold`: the difference of 75 % right answers, in the study's unit. `percept`: what is
        perceived of a stimulus without the error; the default is its level."""
        if threshold <= 0 or not 0 <= lapse < 1:
            raise ValueError("a participant has a threshold above 0 and a lapse from 0 to below 1")
        self.threshold = threshold
        # Phi(d / (sqrt(2) sigma)) is 75 % at the threshold.
        self.sigma = threshold / (0.6744897501960817 * math.sqrt(2))
        self.lapse, self._seed = lapse, seed
        self._percept = percept or (lambda stimulus: stimulus.level)

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
