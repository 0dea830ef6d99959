"""Which level comes next. Each method gives `level` until it is `done`, and takes the answers."""

from __future__ import annotations

import math
import random
from typing import Any, List, Optional, Sequence, Tuple, Union

from limpid.errors import ArgumentError
from limpid.study.fits import Fit, chance_of, lapse_of, probability
from limpid.values import items_of, number, number_above, plain, whole


def limits_of(low: Any, high: Any) -> Tuple[float, float]:
    """Of levels; the upper one may be infinite."""
    low = number("low", low, "a finite number from 0 on", lambda x: x >= 0)
    if isinstance(high, float) and high == math.inf:
        return low, math.inf
    return low, number("high", high, f"a number from {low:g} on, the lower limit", lambda x: x >= low)


def _start_within(start: Any, low: float, high: float) -> float:
    return number("start", start, f"a number above 0, between the limits {low:g} and {high:g}",
                  lambda x: x > 0 and low <= x <= high)  # fmt: skip


class Staircase:
    """1-up-3-down (Levitt 1971): harder after three right answers, easier after each wrong one; it
    comes to rest where 79.4 % of the answers are right. Levels are multiplied and divided by a step
    that gets smaller at the first reversals."""

    def __init__(self, start: float, steps: Sequence[float] = (2.0, 1.4, 1.2), reversals: int = 12,
                 trials: int = 80, low: float = 0.0, high: float = math.inf, down: int = 3) -> None:  # fmt: skip
        """`start`: the first level; `steps`: factors, the next one from each second reversal on;
        ends after so many `reversals`, or `trials`; levels stay between `low` and `high`."""
        self._low, self._high = limits_of(low, high)
        self.level = _start_within(start, self._low, self._high)
        factors = items_of("steps", steps, "a list of at least 1 number above 1", 1)
        self._steps = [number_above("steps", factor, 1) for factor in factors]
        self._reversals, self._trials = whole("reversals", reversals, 1), whole("trials", trials, 1)
        self._down = whole("down", down, 1)
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
        middle, width = math.log(number_above("guess", guess)), math.log(number_above("spread", spread, 1))
        self._trials, self._lapse = whole("trials", trials, 1), lapse_of(lapse)
        self._low, self._high = limits_of(low, high)
        self._grid = [middle + width * 4 * (i / 200 - 1) for i in range(401)]
        self._log = [-0.5 * ((x - middle) / width) ** 2 for x in self._grid]
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
        part = probability(part)
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

    def __init__(self, levels: Sequence[float], repeats: int, seed: Union[str, int]) -> None:
        found = [number("levels", level) for level in items_of("levels", levels, "a list of at least 1 number", 1)]
        self._left = [level for level in found for _ in range(whole("repeats", repeats, 1))]
        random.Random(plain("seed", seed)).shuffle(self._left)

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
        self._low, self._high = limits_of(low, high)
        self.level = _start_within(start, self._low, self._high)
        self._finest = finest = number_above("finest", finest, 1)
        self._step = number("step", step, f"a finite number from {finest:g} on, the finest", lambda x: x >= finest)
        self._direction, self._trials, self._count = 0, whole("trials", trials, 1), 0
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
