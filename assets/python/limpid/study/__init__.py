"""Psychophysics on a running program: methods, trials that survive a crash, fits and a report.

    from limpid import study

A study is a plain function that asks for one trial after the other. Every answer is written to one
CSV before the next trial begins; started again with the same words, the study takes the answers that
are there and goes on behind them. The three modules of limpid.studies are examples.
"""

from limpid.study.answers import StudyError
from limpid.study.fits import Fit, equality, fit, mean_interval, proportion_interval
from limpid.study.methods import Adjustment, ConstantStimuli, Quest, Staircase
from limpid.study.orders import latin_square, order_for
from limpid.study.participants import Person, Shown, Simulated, Stimulus, StimulusError, remove_session
from limpid.study.report import Report
from limpid.study.trials import Study
from limpid.study.words import carry_out, words

__all__ = [
    "Adjustment", "ConstantStimuli", "Fit", "Person", "Quest", "Report", "Shown", "Simulated",
    "Staircase", "Stimulus", "StimulusError", "Study", "StudyError", "carry_out", "equality", "fit", "latin_square",
    "mean_interval", "order_for",
    "proportion_interval", "remove_session", "words",
]  # fmt: skip
