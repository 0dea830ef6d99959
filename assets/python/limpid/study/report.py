"""Figures as SVG and one page that has them all, with the numbers as a table."""

from __future__ import annotations

import html
import math
import os
from pathlib import Path
from typing import Callable, Dict, List, Optional, Sequence, Tuple

from limpid.study.fits import Fit, chance_of, equality, fit, proportion_interval

WIDTH, HEIGHT = 560, 340  # of a figure [px]
LEFT, RIGHT, TOP, BOTTOM = 64, 16, 34, 48  # its margins [px]
# Told apart by those who see few colours, too (Okabe and Ito 2008).
COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9")


def nice_ticks(low: float, high: float, most: int = 6) -> List[float]:
    """Round numbers between two ends."""
    rough = (high - low) / most or 1.0
    power = 10.0 ** math.floor(math.log10(rough))
    step = next(power * f for f in (1, 2, 5, 10) if power * f >= rough * 0.999)
    first = math.ceil(low / step - 1e-9)
    return [round(step * k, 12) for k in range(first, int(math.floor(high / step + 1e-9)) + 1)]


class Axes:
    """A figure with two axes, drawn from left to right and from below."""

    def __init__(self, title: str, x: str, y: str, x_range: Tuple[float, float],
                 y_range: Tuple[float, float], x_names: Sequence[str] = ()) -> None:  # fmt: skip
        """`x` and `y`: what they are, with the unit in brackets."""
        self._x_range, self._y_range = x_range, y_range
        self._parts = [f'<text x="{LEFT}" y="20" font-weight="bold">{html.escape(title)}</text>']
        for tick in nice_ticks(*y_range):
            at = self.y(tick)
            self._parts.append(f'<path d="M{LEFT} {at:.1f}H{WIDTH - RIGHT}" stroke="#ddd"/>')
            self._text(LEFT - 6, at + 4, f"{tick:g}", "end")
        ticks = list(range(len(x_names))) if x_names else nice_ticks(*x_range)
        for tick in ticks:
            self._text(self.x(tick), HEIGHT - BOTTOM + 16, x_names[int(tick)] if x_names else f"{tick:g}")
        self._text((LEFT + WIDTH - RIGHT) / 2, HEIGHT - 10, x)
        middle = (TOP + HEIGHT - BOTTOM) / 2
        self._parts.append(f'<text transform="translate(16 {middle:.1f}) rotate(-90)" '
                           f'text-anchor="middle">{html.escape(y)}</text>')  # fmt: skip
        self._legend = 0

    def x(self, value: float) -> float:
        """[px]"""
        low, high = self._x_range
        return LEFT + (value - low) / (high - low) * (WIDTH - LEFT - RIGHT)

    def y(self, value: float) -> float:
        """[px]"""
        low, high = self._y_range
        return HEIGHT - BOTTOM - (value - low) / (high - low) * (HEIGHT - TOP - BOTTOM)

    def _text(self, x: float, y: float, text: str, anchor: str = "middle") -> None:
        self._parts.append(f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}">'
                           f"{html.escape(text)}</text>")  # fmt: skip

    def bar(self, x: float, y: float, low: float, high: float, colour: str, size: float = 4) -> None:
        """A point with its interval, which ends at the figure's edge where it has no end."""
        top, bottom = self._y_range[1], self._y_range[0]
        low, high = max(low, bottom), min(high, top)
        self._parts.append(f'<path d="M{self.x(x):.1f} {self.y(low):.1f}V{self.y(high):.1f}" '
                           f'stroke="{colour}" stroke-width="1.5"/>'
                           f'<circle cx="{self.x(x):.1f}" cy="{self.y(y):.1f}" r="{size:.1f}" '
                           f'fill="{colour}"/>')  # fmt: skip

    def curve(self, f: Callable[[float], float], colour: str, name: str = "") -> None:
        """Of a function over the whole axis."""
        low, high = self._x_range
        xs = [low + (high - low) * i / 160 for i in range(161)]
        self.line(xs, [f(x) for x in xs], colour, name)

    def line(self, xs: Sequence[float], ys: Sequence[float], colour: str, name: str = "") -> None:
        """Through points, with its name in the legend; of many points as many as there are pixels."""
        step = max(1, len(xs) // (2 * WIDTH))
        low, high = self._y_range
        points = " ".join(f"{self.x(float(x)):.1f},{self.y(min(max(float(y), low), high)):.1f}"
                          for x, y in zip(xs[::step], ys[::step]))  # fmt: skip
        self._parts.append(f'<polyline points="{points}" fill="none" stroke="{colour}" '
                           'stroke-width="2"/>')  # fmt: skip
        if name:
            self._text(WIDTH - RIGHT - 4, HEIGHT - BOTTOM - 10 - 16 * self._legend, name, "end")
            self._parts[-1] = self._parts[-1].replace("<text", f'<text fill="{colour}"', 1)
            self._legend += 1

    def svg(self) -> str:
        """The figure."""
        return (f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" '
                f'width="{WIDTH}" height="{HEIGHT}" font-family="sans-serif" font-size="12">'
                f'<rect width="{WIDTH}" height="{HEIGHT}" fill="white"/>{"".join(self._parts)}'
                f'<path d="M{LEFT} {TOP}V{HEIGHT - BOTTOM}H{WIDTH - RIGHT}" fill="none" '
                'stroke="#444"/></svg>\n')  # fmt: skip


def psychometric(title: str, unit: str, answers: Dict[str, List[Tuple[float, bool]]],
                 fits: Dict[str, Fit], lapse: float = 0.02) -> str:  # fmt: skip
    """Right answers over the level, with the curve of each fit, for each condition."""
    top = 1.1 * max(level for each in answers.values() for level, _ in each)
    axes = Axes(title, f"difference [{unit}]", "right answers [-]", (0, top), (0.3, 1.0))
    for (name, each), colour in zip(answers.items(), COLOURS):
        for level, right, of in binned(each):
            low, high = proportion_interval(right, of)
            axes.bar(level, right / of, low, high, colour, 2 + min(4.0, 0.8 * math.sqrt(of)))
        threshold = fits[name].threshold
        axes.curve(lambda x, at=threshold: chance_of(x, at, lapse), colour, name)  # type: ignore[misc]
    return axes.svg()


def binned(answers: Sequence[Tuple[float, bool]], bins: int = 7) -> List[Tuple[float, int, int]]:
    """Of levels that are hardly the same twice, so many groups of neighbours: their mean level, how
    many right answers, of how many."""
    ordered = sorted(answers)
    levels = sorted({level for level, _ in ordered})
    if len(levels) <= bins:
        groups = [[each for each in ordered if each[0] == level] for level in levels]
    else:
        cuts = [round(i * len(ordered) / bins) for i in range(bins + 1)]
        groups = [ordered[a:b] for a, b in zip(cuts, cuts[1:]) if b > a]
    return [(sum(level for level, _ in group) / len(group), sum(right for _, right in group),
             len(group)) for group in groups]  # fmt: skip


def intervals(title: str, unit: str, found: Dict[str, Tuple[float, float, float]]) -> str:
    """A value with its interval for each condition."""
    ends = [high for _, _, high in found.values() if math.isfinite(high)]
    top = 1.15 * max(ends + [value for value, _, _ in found.values()])
    axes = Axes(title, "", unit, (-0.6, len(found) - 0.4), (0, top), list(found))
    for i, ((value, low, high), colour) in enumerate(zip(found.values(), COLOURS)):
        axes.bar(i, value, low, high, colour, 5)
    return axes.svg()


def matched(title: str, quantity: str, matches: Dict[str, List[Tuple[float, float]]],
            fits: Dict[str, Fit]) -> str:  # fmt: skip
    """Each match beside the point of equality with its interval, for each condition."""
    top = 1.1 * max([level for each in matches.values() for pair in each for level in pair]
                    + [f.high for f in fits.values()])  # fmt: skip
    axes = Axes(title, "", quantity, (-0.6, len(fits) - 0.4), (0, top), list(fits))
    for i, (condition, colour) in enumerate(zip(fits, COLOURS)):
        for level in (level for pair in matches[condition] for level in pair):
            axes.bar(i - 0.12, level, level, level, colour, 2)
        f = fits[condition]
        axes.bar(i, f.threshold, f.low, f.high, colour, 5)
    return axes.svg()


class Report:
    """FOLDER/NAME.html with its figures beside it as SVG."""

    def __init__(self, title: str, folder: "os.PathLike[str] | str") -> None:
        self._title, self._folder = title, Path(folder)
        self._parts: List[str] = []

    def text(self, text: str) -> None:
        """A paragraph."""
        self._parts.append(f"<p>{html.escape(text)}</p>")

    def figure(self, name: str, svg: str, caption: str) -> None:
        """Shown in the page, and a file of its own."""
        (self._folder / f"{name}.svg").write_text(svg, encoding="utf-8")
        self._parts.append(f"<figure>{svg}<figcaption>{html.escape(caption)}</figcaption></figure>")

    def table(self, head: Sequence[str], rows: Sequence[Sequence[object]]) -> None:
        """Cells as they print."""
        lines = [f"<tr>{''.join(f'<th>{html.escape(cell)}</th>' for cell in head)}</tr>"]
        lines += [f"<tr>{''.join(f'<td>{html.escape(str(cell))}</td>' for cell in row)}</tr>"
                  for row in rows]  # fmt: skip
        self._parts.append(f"<table>{''.join(lines)}</table>")

    def write(self, name: str) -> Path:
        """The page's file."""
        file = self._folder / f"{name}.html"
        file.write_text(
            '<!doctype html><html lang="en"><meta charset="utf-8">'
            f"<title>{html.escape(self._title)}</title><style>body{{font-family:sans-serif;"
            "max-width:46em;margin:2em auto;line-height:1.5}table{border-collapse:collapse}"
            "td,th{border:1px solid #ccc;padding:.2em .6em;text-align:left}</style>"
            f"<h1>{html.escape(self._title)}</h1>{''.join(self._parts)}</html>\n", encoding="utf-8")  # fmt: skip
        return file


def threshold_report(title: str, folder: "os.PathLike[str] | str", unit: str,
                     answers: Dict[str, List[Tuple[float, bool]]], about: str,
                     name: str = "report", fits: Optional[Dict[str, Fit]] = None
                     ) -> Dict[str, Fit]:  # fmt: skip
    """Fits each condition's answers, unless they are fitted already, and writes the page of it:
    NAME.html."""
    fits = fits or {condition: fit(each) for condition, each in answers.items()}
    report = Report(title, folder)
    report.text(about)
    report.figure(f"{name}-curves", psychometric(title, unit, answers, fits),
                  "Right answers with their intervals of 95 %, and the curve of each fit.")
    report.figure(f"{name}-thresholds", intervals("Thresholds", f"threshold [{unit}]", {
        condition: (f.threshold, f.low, f.high) for condition, f in fits.items()}),
        "The difference of 75 % right answers, with the interval of 95 %.")  # fmt: skip
    report.table(["condition", f"threshold [{unit}]", "from", "to", "trials"], [
        [condition, f"{f.threshold:.4g}", f"{f.low:.4g}", f"{f.high:.4g}", f.trials]
        for condition, f in fits.items()])  # fmt: skip
    report.write(name)
    return fits


def equality_report(title: str, folder: "os.PathLike[str] | str", quantity: str,
                    matches: Dict[str, List[Tuple[float, float]]], about: str, name: str = "report"
                    ) -> Dict[str, Fit]:  # fmt: skip
    """The point of subjective equality of each condition's pairs of matches, from above and below,
    and the page of it: NAME.html. `quantity`: what was adjusted, with its unit in brackets."""
    fits = {condition: equality(each) for condition, each in matches.items()}
    report = Report(title, folder)
    report.text(about)
    report.figure(f"{name}-equality", matched(title, quantity, matches, fits),
                  "What felt like the reference: each trial as a small point, and the mean of their "
                  "logarithms with its interval of 95 %.")  # fmt: skip
    report.table(["condition", quantity, "from", "to", "trials"], [
        [condition, f"{f.threshold:.4g}", f"{f.low:.4g}", f"{f.high:.4g}", f.trials]
        for condition, f in fits.items()])  # fmt: skip
    report.write(name)
    return fits
