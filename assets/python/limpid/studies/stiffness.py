"""Just noticeable difference of stiffness under each law, by 1-up-3-down staircases.

    python3 -m limpid.studies.stiffness --out DIR [--participant N] [--connect NAME]
    python3 -m limpid.studies.stiffness --out DIR --simulate

The first is for a person at a window, `limpid --listen NAME`, the second for a simulated one.

Two walls are felt one after the other; which one is stiffer? The simulated participant presses with
the same hand on both, judges force over the way that the device has gone, and errs by 15 %.
"""

import argparse
from pathlib import Path

import limpid
from limpid import study
from limpid.study.report import threshold_report

STANDARD = 300.0  # of the wall [N/m]
LAWS = ("standard", "proposed", "predictive")
WEBER = 0.15  # of the simulated participant
WALL = """title = "Wall"
[[plane]]
name = "wall"
point = [0, 0, -0.04]
normal = [0, 0, 1]
stiffness = {stiffness}
"""
PRESS = [(0, 0.19, 0, 0), (0.2, 0.19, 0, 0), (0.7, 0.19, 0, -0.05), (1.2, 0.19, 0, -0.05)]


class Walls:
    """A scene for each stiffness."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    def file(self, stiffness: float) -> str:
        file = self.folder / f"wall-{stiffness:.6g}.toml"
        file.write_text(WALL.format(stiffness=stiffness))
        return str(file.resolve())

    def felt(self, law: str, stiffness: float) -> float:
        """Force over the device's way into the wall [N/m], as a hand finds it that presses."""
        session = limpid.run(scene=self.file(stiffness), hand=PRESS, coupling=law)
        force = session.contact_force[-100:, 2].mean()
        return float(force / (-0.04 - session.device_tip[-100:, 2].mean()))


def participant(arguments: argparse.Namespace, walls: Walls):
    """A person at a window, or the simulated one, whose percepts are runs of the loop."""
    if not arguments.simulate:
        return study.Person(limpid.connect(arguments.connect))
    known = {}

    def percept(stimulus: study.Stimulus) -> float:
        key = (stimulus.settings["coupling.kind"], round(stimulus.level, 1))
        if key not in known:
            known[key] = walls.felt(*key)
        return known[key]

    return study.Simulated(WEBER * STANDARD, seed=arguments.participant, percept=percept)


def main() -> None:
    arguments = study.words(__doc__, "trials", 60, "at most, for each law", least=5)
    walls = Walls(arguments.out)
    run = study.Study("stiffness", arguments.out, arguments.participant, participant(arguments, walls))
    run.tell("You feel two walls, one after the other. Press on each with the tip, as often as you like "
             "while it is there; then say which one is stiffer.")
    answers = {}
    for law in run.blocks(LAWS):
        answers[law] = run.two_intervals(
            study.Staircase(start=STANDARD, low=1, high=3 * STANDARD, trials=arguments.trials),
            law, STANDARD,
            lambda k, law=law: study.Stimulus(k, {"coupling.kind": law}, walls.file(k)),
            "Which wall is stiffer?", practice=3, pause_every=20)
        run.question("How sure were you?", ["guessed", "mostly sure", "sure"], law)
    fits = threshold_report("Just noticeable difference of stiffness", arguments.out, "N/m", answers,
                            f"Two-interval forced choice beside a wall of {STANDARD:g} N/m; 1-up-3-down "
                            f"staircases; participant {arguments.participant}.", "stiffness", run=run)
    for law, found in fits.items():
        share = f", {100 * found.threshold / STANDARD:.0f} %" if found.bounded else ""
        print(f"{law:>10}: {found} N/m{share}", flush=True)
    run.tell("That was all. Thank you.")


if __name__ == "__main__":
    study.carry_out(main)
