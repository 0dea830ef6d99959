"""From answers to thresholds with intervals.

A participant who compares two intervals perceives each with an error of normal distribution and
standard deviation sigma, and names the larger one: for a difference d the answer is right with the
chance Phi(d / (sqrt(2) sigma)) (Green and Swets 1966), less what is lost by slips (the lapse). The
threshold, or just noticeable difference, is the d of 75 % right answers without slips.
"""

from __future__ import annotations

import math
from statistics import NormalDist
from typing import Any, Iterable, List, NamedTuple, Sequence, Tuple

from limpid.errors import ArgumentError
from limpid.values import items_of, number, number_above, pairs_of, whole

LEVEL = 0.75  # of right answers, at the threshold
_QUARTILE = NormalDist().inv_cdf(LEVEL)


class Fit(NamedTuple):
    """A threshold, or a point of equality, in the unit of the levels, and the interval that has it
    with 95 %."""

    threshold: float
    low: float
    high: float
    trials: int

    @property
    def bounded(self) -> bool:
        """Whether the answers bound it on both sides; else the value itself says nothing."""
        return self.low > 0 and math.isfinite(self.high)

    def __str__(self) -> str:
        if not self.bounded:
            return f"not found{self.bound()} ({self.trials} trials)"
        return f"{self.threshold:.3g} ({self.low:.3g} to {self.high:.3g}, {self.trials} trials)"

    def bound(self) -> str:
        """Of one that is not bounded on both sides: ", below 4.2", or what else is known."""
        if self.low <= 0:
            return f", below {self.high:.3g}" if math.isfinite(self.high) else ""
        return f", above {self.low:.3g}"


def chance_of(level: float, threshold: float, lapse: float = 0.02) -> float:
    """That an answer to this difference is right. Without a lapse that is never quite certain, so that
    a wrong answer has a logarithm."""
    right = 0.5 * math.erfc(-_QUARTILE * level / threshold / math.sqrt(2))
    return min(0.5 * lapse + (1 - lapse) * right, 1 - 1e-15)


def lapse_of(value: Any) -> float:
    """A part of the answers that are slips."""
    return number("lapse", value, "a number from 0 to below 1", lambda x: 0 <= x < 1)


def probability(value: Any) -> float:
    """The probability of an interval."""
    return number("part", value, "a part above 0 and below 1, such as 0.95", lambda x: 0 < x < 1)


def fit(answers: Iterable[Tuple[float, bool]], lapse: float = 0.02, part: float = 0.95) -> Fit:
    """The threshold of the greatest likelihood for answers (level, right), with the interval of all
    those whose likelihood is not significantly less (its ratio by the chi-square distribution).

    Where the answers do not bound it, as where all are right, an end is 0 or infinite. Raises
    ArgumentError for fewer than 5 answers or levels that are not above 0."""
    lapse, part = lapse_of(lapse), probability(part)
    counted = _counted(answers)
    trials = sum(right + wrong for _, right, wrong in counted)
    if trials < 5:
        raise ArgumentError(f"a threshold needs at least 5 answers; found: {trials}")

    def loss(log_threshold: float) -> float:
        threshold, total = math.exp(log_threshold), 0.0
        for level, right, wrong in counted:
            chance = chance_of(level, threshold, lapse)
            total -= right * math.log(chance) + wrong * math.log1p(-chance)
        return total

    # Beyond these no level tells one threshold from another any more.
    first = math.log(min(level for level, _, _ in counted)) - 5
    last = math.log(max(level for level, _, _ in counted)) + 5
    grid = [first + (last - first) * i / 120 for i in range(121)]
    best = min(range(121), key=lambda i: loss(grid[i]))
    top = _least(loss, grid[max(best - 1, 0)], grid[min(best + 1, 120)])
    bound = loss(top) + 0.5 * NormalDist().inv_cdf(0.5 + part / 2) ** 2  # chi-square of 1 freedom
    low = 0.0 if loss(first) <= bound else math.exp(_crossing(loss, bound, top, first))
    high = math.inf if loss(last) <= bound else math.exp(_crossing(loss, bound, top, last))
    return Fit(math.exp(top), low, high, trials)


def _counted(answers: Iterable[Tuple[float, bool]]) -> List[Tuple[float, int, int]]:
    counts: "dict[float, List[int]]" = {}
    for level, right in pairs_of("answers", answers, "a level and whether the answer was right"):
        correct = number("right", right, "True or False", lambda x: x in (0, 1))
        counts.setdefault(number_above("level", level), [0, 0])[0 if correct else 1] += 1
    return [(level, right, wrong) for level, (right, wrong) in sorted(counts.items())]


def _least(f, a: float, b: float) -> float:  # type: ignore[no-untyped-def]
    """By golden sections."""
    golden = (math.sqrt(5) - 1) / 2
    c, d = b - golden * (b - a), a + golden * (b - a)
    while b - a > 1e-7:
        if f(c) < f(d):
            b, d = d, c
            c = b - golden * (b - a)
        else:
            a, c = c, d
            d = a + golden * (b - a)
    return 0.5 * (a + b)


def _crossing(f, bound: float, inside: float, outside: float) -> float:  # type: ignore[no-untyped-def]
    """Where f reaches the bound between a point below it and one above it."""
    for _ in range(60):
        middle = 0.5 * (inside + outside)
        if f(middle) <= bound:
            inside = middle
        else:
            outside = middle
    return 0.5 * (inside + outside)


def equality(matches: Sequence[Tuple[float, float]]) -> Fit:
    """The point of subjective equality of matches by adjustment: pairs of levels, of which one was
    approached from above and one from below. The mean and its interval are those of the logarithms,
    as the levels are adjusted by factors; a pair counts once, by its mean, so that what a participant
    stops short of the reference on either side is no part of the spread.

    Raises ArgumentError for fewer than 2 pairs or levels that are not above 0."""
    pairs = pairs_of("matches", matches, "two levels")
    if len(pairs) < 2:
        raise ArgumentError(f"a point of equality needs at least 2 pairs of matches; found: {len(pairs)}")
    logs = [[math.log(number_above("level", level)) for level in pair] for pair in pairs]
    found = mean_interval([0.5 * (a + b) for a, b in logs])
    return Fit(*(math.exp(x) for x in found), 2 * len(pairs))


def proportion_interval(right: int, of: int, part: float = 0.95) -> Tuple[float, float]:
    """Of a chance, by Wilson (1927)."""
    right, of = whole("right", right), whole("of", of, 1)
    if right > of:
        raise ArgumentError(f"right: {right} is not allowed; allowed: at most {of}, as many as there are")
    z = NormalDist().inv_cdf(0.5 + probability(part) / 2)
    centre = (right + z * z / 2) / (of + z * z)
    half = z / (of + z * z) * math.sqrt(right * (of - right) / of + z * z / 4)
    return max(0.0, centre - half), min(1.0, centre + half)


def mean_interval(values: Sequence[float]) -> Tuple[float, float, float]:
    """Mean and the ends of its interval of 95 %, by Student's distribution."""
    found = [number("values", value) for value in items_of("values", values, "a list of at least 2 numbers", 2)]
    n = len(found)
    mean = sum(found) / n
    deviation = math.sqrt(sum((x - mean) ** 2 for x in found) / (n - 1))
    half = _student(n - 1) * deviation / math.sqrt(n)
    return mean, mean - half, mean + half


def _student(freedom: int) -> float:
    """97.5 % of Student's distribution: of scipy where that is installed, else its expansion for
    large numbers (Abramowitz and Stegun 26.7.5), exact to 1 % from 3 degrees of freedom on."""
    try:
        from scipy.stats import t  # type: ignore[import-not-found,import-untyped]
    except ImportError:
        if freedom < 3:
            return (12.706, 4.303)[freedom - 1]
        z, v = NormalDist().inv_cdf(0.975), float(freedom)
        return z + (z**3 + z) / (4 * v) + (5 * z**5 + 16 * z**3 + 3 * z) / (96 * v * v) + (
            3 * z**7 + 19 * z**5 + 17 * z**3 - 15 * z) / (384 * v**3)  # fmt: skip
    return float(t.ppf(0.975, freedom))
