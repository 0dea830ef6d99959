"""Which level comes next. Each method gives `level` until it is `done`, and takes the answers."""

from __future__ import annotations

import math
import random
from typing import List, Optional, Sequence, Tuple

from limpid.errors import ArgumentError
from limpid.study.fits import Fit, chance_of


class Staircase:
    """1-up-3-down (Levitt 1971): harder after three right answers, easier after each wrong one; it
    comes to rest where 79.4 % of the answers are right. Levels are multiplied and divided by a step
    that gets smaller at the first reversals."""

    def __init__(self, start: float, steps: Sequence[float] = (2.0, 1.4, 1.2), reversals: int = 12,
                 trials: int = 80, low: float = 0.0, high: float = math.inf, down: int = 3) -> None:  # fmt: skip
        """`start`: the first level; `steps`: factors, the next one from each second reversal on;
        ends after so many `reversals`, or `trials`; levels stay between `low` and `high`."""
        steps = [float(step) for step in steps]
        if not (low <= start <= high and start > 0 and steps and all(step > 1 for step in steps)):
            raise ArgumentError("a staircase needs a start between its limits, and steps, each above 1")
        if down < 1 or reversals < 1 or trials < 1:
            raise ArgumentError("a staircase needs at least 1 trial, 1 reversal, and 1 right answer to go down")
        self.level = float(start)
        self._steps, self._down = steps, down
        self._reversals, self._trials = reversals, trials
        self._low, self._high = low, high
        self._right = self._direction = self._count = 0
        self.turned: List[float] = []  # levels of the reversals

    @property
    def done(self) -> bool:
        return len(self.turned) >= self._reversals or self._count >= self._trials

    def answer(self, correct: bool) -> None:
        """To the present level."""
        self._count += 1
        self._right = self._right + 1 if correct else 0
        if correct and self._right < self._down:
            return
        self._right = 0
        direction = -1 if correct else 1
        if self._direction and direction != self._direction:
            self.turned.append(self.level)
        self._direction = direction
        step = self._steps[min(len(self.turned) // 2, len(self._steps) - 1)]
        self.level = min(max(self.level * step**direction, self._low), self._high)

    def threshold(self) -> Optional[float]:
        """Geometric mean of the levels of the last reversals; None before there are four."""
        last = self.turned[len(self.turned) // 3 :]
        if len(last) < 4:
            return None
        return math.exp(sum(map(math.log, last)) / len(last))


class Quest:
    """As QUEST (Watson and Pelli 1983): the level is where the threshold most probably is, by all
    answers so far, with the mean of the posterior in place of its mode."""

    def __init__(self, guess: float, spread: float = 3.0, trials: int = 40, low: float = 0.0,
                 high: float = math.inf, lapse: float = 0.02) -> None:  # fmt: skip
        """`guess`: of the threshold, right within a factor `spread` two times of three."""
        if not (guess > 0 and spread > 1 and trials > 0):
            raise ArgumentError("QUEST needs a guess above 0, a spread above 1, and trials")
        self._trials, self._low, self._high, self._lapse = trials, low, high, lapse
        width = math.log(spread)
        self._grid = [math.log(guess) + width * 4 * (i / 200 - 1) for i in range(401)]
        self._log = [-0.5 * ((x - math.log(guess)) / width) ** 2 for x in self._grid]
        self._count = 0

    @property
    def done(self) -> bool:
        return self._count >= self._trials

    def _weights(self) -> List[float]:
        top = max(self._log)
        weights = [math.exp(value - top) for value in self._log]
        total = sum(weights)
        return [weight / total for weight in weights]

    @property
    def level(self) -> float:
        mean = sum(x * w for x, w in zip(self._grid, self._weights()))
        return min(max(math.exp(mean), self._low), self._high)

    def answer(self, correct: bool) -> None:
        """To the present level."""
        level = self.level
        self._count += 1
        for i, x in enumerate(self._grid):
            right = chance_of(level, math.exp(x), self._lapse)
            self._log[i] += math.log(right if correct else 1 - right)

    def interval(self, part: float = 0.95) -> Tuple[float, float]:
        """Within which the threshold is with this probability."""
        ends, total = [], 0.0
        wanted = [(1 - part) / 2, (1 + part) / 2]
        for x, weight in zip(self._grid, self._weights()):
            total += weight
            while wanted and total >= wanted[0]:
                ends.append(math.exp(x))
                wanted.pop(0)
        ends += [math.exp(self._grid[-1])] * len(wanted)
        return ends[0], ends[1]

    def found(self) -> Fit:
        """The threshold with the interval of its posterior. fit() takes answers for as many as they
        are wherever they were asked; those that all lie near the threshold say less of its ends."""
        return Fit(self.level, *self.interval(), self._count)


class ConstantStimuli:
    """Each level equally often, in an order of chance that is the same for the same seed."""

    def __init__(self, levels: Sequence[float], repeats: int, seed: str) -> None:
        levels = [float(level) for level in levels]
        if not levels or repeats < 1:
            raise ArgumentError("constant stimuli need levels, each at least once")
        self._left = [level for level in levels for _ in range(repeats)]
        random.Random(seed).shuffle(self._left)

    @property
    def done(self) -> bool:
        return not self._left

    @property
    def level(self) -> float:
        return self._left[-1]

    def answer(self, correct: bool) -> None:
        """To the present level."""
        del correct
        self._left.pop()


class Adjustment:
    """The participant moves the level up and down until it is as the standard: an answer is "more",
    "less" or "same"; a step is a factor, and smaller after each change of direction."""

    def __init__(self, start: float, step: float = 1.5, finest: float = 1.02, trials: int = 100,
                 low: float = 0.0, high: float = math.inf) -> None:  # fmt: skip
        """Levels stay between `low` and `high`; it ends after so many answers, `trials`, whether it is
        as the standard or not."""
        if not (start > 0 and low <= start <= high and step >= finest > 1):
            raise ArgumentError("an adjustment needs a start above 0 between its limits, and steps above 1")
        self.level, self._step, self._finest = start, step, finest
        self._low, self._high = low, high
        self._direction, self._trials, self._count = 0, trials, 0
        self.matched = False  # the participant has said that it is the same
        self.at_limit = False  # the last answer has led to one

    @property
    def done(self) -> bool:
        return self.matched or self._count >= self._trials

    def answer(self, wanted: str) -> None:
        """Of the participant."""
        if wanted not in ("more", "less", "same"):
            raise ArgumentError(f'"{wanted}" is not allowed; allowed: more, less, same')
        self._count += 1
        self.matched = wanted == "same"
        if self.matched:
            return
        direction = 1 if wanted == "more" else -1
        if self._direction and direction != self._direction:
            self._step = max(math.sqrt(self._step), self._finest)
        self._direction = direction
        self.level = min(max(self.level * self._step**direction, self._low), self._high)
        self.at_limit = self.level in (self._low, self._high)
