"""Just noticeable difference of eta, the scale of the felt inertia, by a QUEST-like method.

    python3 -m limpid.studies.inertia --out DIR [--participant N] [--connect NAME]
    python3 -m limpid.studies.inertia --out DIR --simulate

The first is for a person at a window, `limpid --listen NAME`, the second for a simulated one.

The arm is shaken in the air under two values of eta of the predictive law; which one is heavier? The
simulated participant shakes it by the same motion and judges the inertia by the torque that goes with
the acceleration, with an error.
"""

import argparse
import functools
import math
from pathlib import Path

import numpy

import limpid
from limpid import study
from limpid.study.report import threshold_report

STANDARD = 0.5  # eta
LAW = "predictive"
WEBER = 0.2  # of the simulated participant
SHAKES = 2.0  # [Hz]
SCENE = 'title = "Nothing"\n'


def shaking(seconds: float = 2.0, size: float = 0.02) -> list:
    """A hand that shakes the arm to and fro."""
    rows = []
    for i in range(int(100 * seconds) + 1):
        t = i / 100
        grows = min(1.0, t)
        rows.append((t, 0.19, grows * size * math.sin(2 * math.pi * SHAKES * t), 0.0))
    return rows


@functools.lru_cache(maxsize=None)
def inertia(law: str, eta: float, scene: Path) -> float:
    """What of the hand's torque about the vertical goes with the acceleration, and not with the speed:
    the inertia that is felt [kg m^2]."""
    session = limpid.run(scene=scene, hand=shaking(), coupling=law, eta=eta)
    velocity = session["device/velocity"][1000:, 0]
    acceleration = numpy.gradient(velocity, session.tick)
    shares = numpy.stack([acceleration, velocity], axis=1)
    return float(numpy.linalg.lstsq(shares, session["hand/torque"][1000:, 0], rcond=None)[0][0])


def felt(law: str, eta: float, scene: Path) -> float:
    """The same in units of eta, by that at the standard."""
    return STANDARD * inertia(law, round(eta, 3), scene) / inertia(LAW, STANDARD, scene)


def participant(arguments: argparse.Namespace, scene: Path):
    """A person at a window, or the simulated one, whose percepts are runs of the loop."""
    if not arguments.simulate:
        loop = limpid.connect(arguments.connect)
        loop.open(scene=scene)
        return study.Person(loop)
    return study.Simulated(WEBER * STANDARD, seed=arguments.participant,
                           percept=lambda stimulus: felt(LAW, stimulus.level, scene))


def main() -> None:
    arguments = study.words(__doc__, "trials", 40, "how many")
    scene = (arguments.out / "nothing.toml").resolve()
    scene.write_text(SCENE)
    run = study.Study("inertia", arguments.out, arguments.participant, participant(arguments, scene),
                      {"coupling.kind": LAW})
    run.tell("You feel the arm two times, one after the other. Shake it to and fro each time; then say "
             "which time it was heavier.")
    method = study.Quest(guess=0.5 * STANDARD, low=0.01, high=2.0, trials=arguments.trials)
    answers = run.two_intervals(
        method, LAW, STANDARD, lambda eta: study.Stimulus(eta, {"coupling.eta": eta}),
        "Which one is heavier?", practice=2, pause_every=20)
    found = method.found()
    threshold_report("Just noticeable difference of inertia", arguments.out, "eta", {LAW: answers},
                     f"Two-interval forced choice beside eta {STANDARD:g}; QUEST-like; participant "
                     f"{arguments.participant}.", "inertia", {LAW: found}, run)
    print(f"eta: {found}, {100 * found.threshold / STANDARD:.0f} %", flush=True)
    run.tell("That was all. Thank you.")


if __name__ == "__main__":
    study.carry_out(main)
