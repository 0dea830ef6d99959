"""What the lessons share: figures beside each other, and a window where one is wanted."""

from __future__ import annotations

import os
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))  # in the source tree

import limpid  # noqa: E402
from limpid.study.report import Axes, colours_of  # noqa: E402

LAWS = ("standard", "proposed", "predictive")


def figure(name: str, title: str, x: str, y: str, lines: dict, top: float | None = None) -> Path:
    """Lines by name, each of xs and ys, as NAME.svg in the folder LESSONS or the present one."""
    ends = [float(value) for xs, _ in lines.values() for value in xs]
    values = [float(value) for _, ys in lines.values() for value in ys]
    low, high = min(0.0, min(values)), top or max(values) * 1.1
    axes = Axes(title, x, y, (min(ends), max(ends)), (low, high))
    for (label, (xs, ys)), colour in zip(lines.items(), colours_of(lines)):
        axes.line(list(xs), list(ys), colour, label)
    file = Path(os.environ.get("LESSONS", "."), f"{name}.svg")
    file.write_text(axes.svg(), encoding="utf-8")
    return file


def show(what: str, scene: str | None = None, **settings: object) -> None:
    """With --window on the command line: the same in a window, which says `what` is to be felt; ends
    with it."""
    if "--window" not in sys.argv:
        return
    with limpid.serve(scene=scene, settings=settings, window=True) as loop:
        try:
            loop.ask(f"Pull the arm by its tip with the left mouse button. {what}", ("End the lesson",),
                     beside=True)
        except limpid.ProgramError:
            pass  # somebody has closed the window, which ends the lesson, too
