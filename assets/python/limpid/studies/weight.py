"""Which eta of the predictive law feels as heavy as each other law? By the method of adjustment.

    python3 -m limpid.studies.weight --out DIR [--participant N] [--connect NAME]
    python3 -m limpid.studies.weight --out DIR --simulate

The first is for a person at a window, `limpid --listen NAME`, the second for a simulated one.

The arm is shaken in the air under another law, the reference, and under the predictive one, whose eta
the participant changes with keys until both are equally heavy. The simulated participant shakes it by the
same motion and judges the inertia, as in the study of that name.
"""

from pathlib import Path

import limpid
from limpid import study
from limpid.studies.inertia import LAW, SCENE, WEBER, felt
from limpid.study.report import equality_report

REFERENCES = ("standard", "proposed")  # at eta 1
LOW, HIGH = 0.1, 4.0  # of eta


def stimulus(law: str, eta: float) -> study.Stimulus:
    return study.Stimulus(eta, {"coupling.kind": law, "coupling.eta": eta})


def participant(simulate: bool, connect: str, seed: int, scene: Path):
    """A person at a window, or the simulated one."""
    if simulate:
        return study.Simulated(WEBER, seed=seed, percept=lambda shown: felt(
            shown.settings["coupling.kind"], shown.level, scene))
    loop = limpid.connect(connect)
    loop.open(scene=scene)
    return study.Person(loop)


def main() -> None:
    arguments = study.words(__doc__, "pairs", 5, "of trials for each reference, from above and below",
                            least=2)
    scene = (arguments.out / "nothing.toml").resolve()
    scene.write_text(SCENE)
    run = study.Study("weight", arguments.out, arguments.participant, participant(
        arguments.simulate, arguments.connect, arguments.participant, scene))
    run.tell("Shake the arm to and fro. First you feel the reference, then you make the arm lighter or "
             "heavier with the keys 1 and 2, until it is as heavy as the reference was.")
    matches = {}
    for law in run.blocks(REFERENCES):
        matches[law] = run.adjustments(
            law, stimulus(law, 1.0), lambda eta: stimulus(LAW, eta),
            "Make the arm as heavy as the reference.", ("lighter", "heavier"), low=LOW, high=HIGH,
            trials=2 * arguments.pairs, practice=1, pause_every=10)
    fits = equality_report("As heavy as the other laws", arguments.out, "eta of the predictive law", matches,
                           f"Method of adjustment; participant {arguments.participant}.", "weight", run)
    for law, found in fits.items():
        print(f"{law:>10}: as eta {found}", flush=True)
    run.tell("That was all. Thank you.")


if __name__ == "__main__":
    study.carry_out(main)
