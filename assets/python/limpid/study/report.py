"""Figures as SVG and one page that has them all, with the numbers as a table."""

from __future__ import annotations

import csv
import html
import json
import math
import os
import re
from pathlib import Path
from typing import Callable, Dict, Iterable, List, Mapping, Optional, Sequence, Tuple

from limpid.study.fits import Fit, chance_of, equality, fit, mean_interval, proportion_interval
from limpid.study.trials import Study

WIDTH, HEIGHT = 560, 340  # of a figure [px]
LEFT, RIGHT, TOP, BOTTOM = 64, 16, 34, 48  # its margins [px]
# Told apart by those who see few colours, too (Okabe and Ito 2008).
COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9")
# Of each law as the program has it (app/style/law_colours.h).
LAW_COLOURS = {"standard": "#6B7280", "proposed": "#6A3D9A", "predictive": "#6B9100", "tank": "#7A2E0E",
               **dict.fromkeys(("direct", "eba", "popc", "wave", "tdpn", "sfa"), "#274060")}  # fmt: skip


def colours_of(names: Iterable[str]) -> List[str]:
    """A colour for each name: a law has its own, whatever else there is; all others go by order."""
    return [LAW_COLOURS.get(name, COLOURS[i % len(COLOURS)]) for i, name in enumerate(names)]


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

    def text_at(self, x: float, y: float, text: str, colour: str) -> None:
        """A small text beside a point."""
        self._text(self.x(x), self.y(y) - 6, text)
        self._parts[-1] = self._parts[-1].replace("<text", f'<text fill="{colour}" font-size="9"', 1)

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
    axes = Axes(title, f"difference [{unit}]", "right answers [-]", (0, top), (0, 1.04))
    for (name, each), colour in zip(answers.items(), colours_of(answers)):
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
    for i, ((value, low, high), colour) in enumerate(zip(found.values(), colours_of(found))):
        axes.bar(i, value, low, high, colour, 5)
    return axes.svg()


def matched(title: str, quantity: str, matches: Dict[str, List[Tuple[float, float]]],
            fits: Dict[str, Fit]) -> str:  # fmt: skip
    """Each match beside the point of equality with its interval, for each condition."""
    top = 1.1 * max([level for each in matches.values() for pair in each for level in pair]
                    + [f.high for f in fits.values()])  # fmt: skip
    axes = Axes(title, "", quantity, (-0.6, len(fits) - 0.4), (0, top), list(fits))
    for i, (condition, colour) in enumerate(zip(fits, colours_of(fits))):
        for level in (level for pair in matches[condition] for level in pair):
            axes.bar(i - 0.12, level, level, level, colour, 2)
        f = fits[condition]
        axes.bar(i, f.threshold, f.low, f.high, colour, 5)
    return axes.svg()


class Report:
    """FOLDER/NAME.html with its figures beside it as SVG. Of one participant of a study the names
    have its number, and page and figures say where they come from."""

    def __init__(self, title: str, folder: "os.PathLike[str] | str", run: Optional[Study] = None) -> None:
        self._title, self._folder, self._run = title, Path(folder), run
        self.provenance = str(run.sheet.has.get("provenance", "")) if run else ""
        self._parts: List[str] = []

    def named(self, name: str) -> str:
        """What a file of this page is called."""
        return f"{name}-{self._run.participant:03d}" if self._run else name

    def text(self, text: str) -> None:
        """A paragraph."""
        self._parts.append(f"<p>{html.escape(text)}</p>")

    def figure(self, name: str, svg: str, caption: str) -> None:
        """Shown in the page, and a file of its own."""
        about = f"<desc>{html.escape(self.provenance)}</desc>" if self.provenance else ""
        svg = re.sub("(<svg[^>]*>)", lambda head: head[0] + about, svg, count=1)
        (self._folder / f"{self.named(name)}.svg").write_text(svg, encoding="utf-8")
        self._parts.append(f"<figure>{svg}<figcaption>{html.escape(caption)}</figcaption></figure>")

    def table(self, head: Sequence[str], rows: Sequence[Sequence[object]]) -> None:
        """Cells as they print."""
        lines = [f"<tr>{''.join(f'<th>{html.escape(cell)}</th>' for cell in head)}</tr>"]
        lines += [f"<tr>{''.join(f'<td>{html.escape(str(cell))}</td>' for cell in row)}</tr>"
                  for row in rows]  # fmt: skip
        self._parts.append(f"<table>{''.join(lines)}</table>")

    def results(self, name: str, quantity: str, found: Mapping[str, Fit]) -> None:
        """What was found under each condition: a table here and, of a participant, a CSV of its own,
        from which the page over all of them is made: NAME.html."""
        self.table(["condition", quantity, "from", "to", "trials"], [
            [condition, _cell(f), f"{f.low:.4g}", f"{f.high:.4g}", f.trials]
            for condition, f in found.items()])  # fmt: skip
        if self._run is None:
            return
        _write_results(self._folder / f"{self.named(name)}-results.csv", found)
        group_report(f"{self._title}: all participants", self._folder, quantity, name)

    def write(self, name: str) -> Path:
        """The page's file."""
        if self._run is not None:
            self._say_under_what(self._run.sheet.has)
        file = self._folder / f"{self.named(name)}.html"
        file.write_text(
            '<!doctype html><html lang="en"><meta charset="utf-8">'
            f"<title>{html.escape(self._title)}</title><style>body{{font-family:sans-serif;"
            "max-width:46em;margin:2em auto;line-height:1.5}table{border-collapse:collapse}"
            "td,th{border:1px solid #ccc;padding:.2em .6em;text-align:left}</style>"
            f"<h1>{html.escape(self._title)}</h1>{''.join(self._parts)}</html>\n", encoding="utf-8")  # fmt: skip
        return file

    def _say_under_what(self, sheet: Mapping[str, object]) -> None:
        truth = sheet.get("truth")
        if isinstance(truth, Mapping):
            self.text(f"The participant was simulated: of two {truth['perceives']} that differ by "
                      f"{truth['threshold']:g} it names the larger one three times of four, and slips in "
                      f"{100 * truth['lapse']:g} % of the trials. Its seed is {truth['seed']}.")  # fmt: skip
        questions = sheet.get("questions")
        if isinstance(questions, Mapping) and questions:
            self.text("Asked: " + " ".join(f"{question}" for question in dict.fromkeys(questions.values())))
        settings = sheet.get("settings")
        over = " over the usual ones of this version" * isinstance(truth, Mapping)
        if isinstance(settings, Mapping) and not settings:
            self.text("Settings: the usual ones of this version, but for what a trial says.")
        elif isinstance(settings, Mapping):
            self._parts.append(f"<details><summary>Settings of all trials{over}, but for what a trial says</summary><pre>"
                               + html.escape("\n".join(f"{key} = {json.dumps(value)}"
                                                       for key, value in settings.items()))
                               + "</pre></details>")  # fmt: skip
        if self.provenance:
            self.text(self.provenance)


def _write_results(file: Path, found: Mapping[str, Fit]) -> None:
    with open(file, "w", encoding="utf-8", newline="") as out:
        cells = csv.writer(out, lineterminator="\n")
        cells.writerow(["condition", "value", "low", "high", "trials"])
        for condition, f in found.items():
            cells.writerow([condition, repr(float(f.threshold)), repr(float(f.low)), repr(float(f.high)), f.trials])


def _read_results(file: Path) -> Dict[str, Fit]:
    with open(file, encoding="utf-8", newline="") as opened:
        return {row["condition"]: Fit(float(row["value"]), float(row["low"]), float(row["high"]),
                                      int(row["trials"])) for row in csv.DictReader(opened)}  # fmt: skip


def group_report(title: str, folder: "os.PathLike[str] | str", quantity: str, name: str
                 ) -> Dict[str, Tuple[float, float, float]]:  # fmt: skip
    """The page over all participants that have a report in the folder, NAME.html, with a figure and
    a summary: of each condition the geometric mean of those of which it was found, with Student's
    interval from two participants on. Returns that; where there is no interval, its ends are not numbers."""
    folder = Path(folder)
    each: Dict[str, Dict[str, Fit]] = {}
    for file in sorted(folder.glob(f"{name}-*-results.csv")):
        number = file.name[len(name) + 1 : -len("-results.csv")]
        if number.isdigit():
            each[number] = _read_results(file)
    conditions = list(dict.fromkeys(condition for found in each.values() for condition in found))
    counted = {condition: [found[condition] for found in each.values()
                           if condition in found and found[condition].bounded]
               for condition in conditions}  # fmt: skip
    means = {condition: _mean_of(found) for condition, found in counted.items()}
    report = Report(title, folder)
    lines = [sheet.get("provenance", "") for sheet in (_sheet_of(folder / f"{name}-{number}.json")
                                                       for number in each)]  # fmt: skip
    report.provenance = "; ".join(dict.fromkeys(str(line) for line in lines if line))
    report.text(f"{len(each)} participant{'s' * (len(each) != 1)}: {', '.join(each)}.")
    if any(isinstance(_sheet_of(folder / f"{name}-{number}.json").get("truth"), dict) for number in each):
        report.text("Simulated participants are among them; the pages of each say which and how.")
    report.figure(f"{name}-group", _group_figure(title, quantity, each, means),
                  "Each participant's value with its interval, and beside it the geometric mean of all "
                  "with its interval of 95 %. What was not found is left out; intervals end at the figure's edge.")  # fmt: skip
    report.table(["condition", "participants", quantity, "from", "to"], [
        [condition, len(counted[condition]),
         *("-" if math.isnan(x) else f"{x:.4g}" for x in means[condition])]
        for condition in conditions])  # fmt: skip
    report.table(["participant", *conditions], [
        [number, *(_cell(found[condition]) if condition in found else "" for condition in conditions)]
        for number, found in each.items()])  # fmt: skip
    for line in dict.fromkeys(lines):
        report.text(str(line))
    report.write(name)
    return means


def _cell(f: Fit) -> str:
    return f"{f.threshold:.4g}" if f.bounded else f"not found{f.bound()}"


def _mean_of(found: Sequence[Fit]) -> Tuple[float, float, float]:
    """Geometric, as thresholds and matches differ by factors."""
    logs = [math.log(f.threshold) for f in found if f.threshold > 0]
    if not logs:
        return math.nan, math.nan, math.nan
    if len(logs) == 1:
        return math.exp(logs[0]), math.nan, math.nan
    mean, low, high = mean_interval(logs)
    return math.exp(mean), math.exp(low), math.exp(high)


def _sheet_of(file: Path) -> Dict[str, object]:
    try:
        found = json.loads(file.read_text(encoding="utf-8"))
        return found if isinstance(found, dict) else {}
    except (OSError, ValueError):
        return {}


def _group_figure(title: str, quantity: str, each: Mapping[str, Mapping[str, Fit]],
                  means: Mapping[str, Tuple[float, float, float]]) -> str:  # fmt: skip
    values = [f.threshold for found in each.values() for f in found.values() if f.bounded]
    top = 1.5 * max([*values, *(mean for mean, _, _ in means.values() if math.isfinite(mean))], default=1.0)
    axes = Axes(title, "", quantity, (-0.6, len(means) - 0.4), (0, top), list(means))
    for i, (condition, (mean, low, high)) in enumerate(means.items()):
        colour = colours_of(means)[i]
        there = [(number, found[condition]) for number, found in each.items()
                 if condition in found and found[condition].bounded]  # fmt: skip
        for k, (number, f) in enumerate(there):
            x = i - 0.35 + 0.5 * (k + 0.5) / len(there)
            axes.bar(x, f.threshold, f.low, f.high, colour, 2)
            if len(there) <= 12:
                axes.text_at(x, min(f.threshold, top), number, colour)
        if math.isfinite(mean):
            axes.bar(i + 0.28, mean, mean if math.isnan(low) else low, mean if math.isnan(high) else high,
                     colour, 5)  # fmt: skip
    return axes.svg()


def threshold_report(title: str, folder: "os.PathLike[str] | str", unit: str,
                     answers: Dict[str, List[Tuple[float, bool]]], about: str,
                     name: str = "report", fits: Optional[Dict[str, Fit]] = None,
                     run: Optional[Study] = None) -> Dict[str, Fit]:  # fmt: skip
    """Fits each condition's answers, unless they are fitted already, and writes the page of it:
    NAME.html. Of a study's participant, `run`, it is NAME-PARTICIPANT.html, and NAME.html the page
    over all participants in the folder."""
    fits = fits or {condition: fit(each) for condition, each in answers.items()}
    report = Report(title, folder, run)
    report.text(about)
    report.figure(f"{name}-curves", psychometric(title, unit, answers, fits),
                  "Right answers with their intervals of 95 %, and the curve of each fit.")
    report.figure(f"{name}-thresholds", intervals("Thresholds", f"threshold [{unit}]", {
        condition: (f.threshold, f.low, f.high) for condition, f in fits.items()}),
        "The difference of 75 % right answers, with the interval of 95 %.")  # fmt: skip
    report.results(name, f"threshold [{unit}]", fits)
    report.write(name)
    return fits


def equality_report(title: str, folder: "os.PathLike[str] | str", quantity: str,
                    matches: Dict[str, List[Tuple[float, float]]], about: str, name: str = "report",
                    run: Optional[Study] = None) -> Dict[str, Fit]:  # fmt: skip
    """The point of subjective equality of each condition's pairs of matches, from above and below,
    and the page of it: NAME.html. `quantity`: what was adjusted, with its unit in brackets. `run`: as
    threshold_report() has it."""
    fits = {condition: equality(each) for condition, each in matches.items()}
    report = Report(title, folder, run)
    report.text(about)
    report.figure(f"{name}-equality", matched(title, quantity, matches, fits),
                  "What felt like the reference: each trial as a small point, and the mean of their "
                  "logarithms with its interval of 95 %.")  # fmt: skip
    report.results(name, quantity, fits)
    report.write(name)
    return fits
