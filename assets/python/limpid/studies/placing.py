"""Does the drift of the standard coupling hurt placing? A task of Fitts' kind on a table.

    python3 -m limpid.studies.placing --out DIR [--participant N] [--connect NAME]
    python3 -m limpid.studies.placing --out DIR --simulate

The first is for a person at a window, `limpid --listen NAME`, the second for a simulated one.

The tip, pressed on the table, is brought beside one of two balls as fast as it can be; what counts is
the proxy, which the person sees, and the time until it is there. The simulated participant leads the
hand to the place with an error, looks, and leads it on by what is missing until it is there.
"""

import math
import random
from pathlib import Path

import limpid
from limpid import study
from limpid.study.report import Report, intervals

LAWS = ("standard", "proposed", "predictive")
DISTANCES = (0.02, 0.05)  # from x = START [m]
WIDTH = 0.002  # of the place [m]
START, ABOVE, PRESSED = 0.17, 0.0, -0.05  # the table is at -0.04 [m]
FIRST, ANOTHER, LOOK = 0.6, 0.3, 0.2  # of the simulated participant's motions, and a look [s]
ERROR = 0.05  # of them: a share of the way
BALL = '[[sphere]]\nname = "to {cm:g} cm"\ncenter = [{x}, 0.015, {z}]\nradius = {r}\nstiffness = 1000\n'
LARGE, SMALL = 0.004, 0.0025  # balls, at the beginning and at the places [m]
TABLE = 'title = "Places"\n[[plane]]\nname = "table"\npoint = [0, 0, -0.04]\nnormal = [0, 0, 1]\n'


def scene_in(folder: Path) -> str:
    """A table without friction, with a ball at the beginning and one beside each place."""
    file = (folder / "places.toml").resolve()
    file.write_text(TABLE + "stiffness = 1000\n" + "".join(
        BALL.format(cm=100 * d, x=START + d, r=r, z=r - 0.04)
        for d, r in ((0.0, LARGE), *((d, SMALL) for d in DISTANCES))))
    return str(file)


def simulated(scene: str, law: str, distance: float, chance: random.Random, out: Path) -> float:
    """Until the proxy is at the place [s]."""
    place, goal, taken = START + distance, START + distance * (1 + chance.gauss(0, ERROR)), FIRST
    path = [(0, START, 0, ABOVE), (0.3, START, 0, PRESSED), (0.5, START, 0, PRESSED)]
    for _ in range(10):
        moved, rested = 0.5 + taken, 0.5 + taken + LOOK
        path += [(moved, goal, 0, PRESSED), (rested, goal, 0, PRESSED)]
        out.unlink(missing_ok=True)
        session = limpid.run(scene=scene, hand=path, coupling=law, record=out)
        missing = place - float(session.proxy_tip[-20:, 0].mean())
        if abs(missing) < WIDTH / 2:
            break
        goal += missing * (1 + chance.gauss(0, ERROR))
        taken += LOOK + ANOTHER
    return taken


def person(loop: limpid.Client, distance: float, out: Path) -> float:
    """The same of a person, who says when it is there; again if it began or ended somewhere else."""
    while True:
        study.remove_session(out)
        loop.ask("Hold the tip on the table beside the large ball. Enter begins: then bring it beside "
                 f"the small one {100 * distance:g} cm further as fast as you can.", beside=True)
        loop.record(out)
        taken = loop.ask("Now. Enter, as soon as the tip is there.", beside=True).seconds
        loop.stop()
        tip = 1000 * limpid.session(out).proxy_tip  # [mm]
        aside, above = abs(tip[0, 0] - 1000 * START), tip[0, 2] + 40
        off = abs(tip[-20:, 0].mean() - 1000 * (START + distance))
        if aside > 4 or above > 2:
            wrong = f"It began {aside:.1f} mm off the ball, {above:.1f} mm above the table; allowed: 4 and 2"
        elif off >= 500 * WIDTH:
            wrong = f"It ended {off:.1f} mm off the place; allowed: {500 * WIDTH:g}"
        else:
            return taken
        loop.ask(f"{wrong} mm. Once more.")


def main() -> None:
    arguments = study.words(__doc__, "repeats", 8, "of each distance, for each law")
    scene = scene_in(arguments.out)
    loop = None if arguments.simulate else limpid.connect(arguments.connect)
    if loop:
        loop.open(scene=scene)
    who = study.Person(loop) if loop else study.Simulated(1.0)
    run = study.Study("placing", arguments.out, arguments.participant, who)
    run.tell("You bring the tip from ball to ball along the table, as fast as you can. What counts is "
             "where you see the tip. A ball is reached within 1 mm.")
    found = {}
    for law in run.blocks(LAWS):
        if loop:
            who.use({"coupling.kind": law})
        plan = study.ConstantStimuli(DISTANCES, arguments.repeats, f"{arguments.participant} {law}")
        rates = []
        while not plan.done:
            distance, trial, chance = plan.level, len(rates), run.chance()
            out = arguments.out / f"placing-{arguments.participant:03d}-{law}-{trial:03d}.h5"

            def measure() -> tuple:
                return (person(loop, distance, out) if loop
                        else simulated(scene, law, distance, chance, out)), [out.name]

            taken = run.value(law, trial, measure, distance)
            rates.append(math.log2(distance / WIDTH + 1) / taken)
            plan.answer(True)
        found[law] = study.Fit(*study.mean_interval(rates), len(rates))
    report = Report("Placing under each law", arguments.out, run)
    report.text(f"Fitts' task, places {1000 * WIDTH:g} mm wide; {2 * arguments.repeats} trials a law.")
    report.figure("placing", intervals("Placing", "throughput [bit/s]", {
        law: each[:3] for law, each in found.items()}), "Mean, interval of 95 %.")
    report.results("placing", "throughput [bit/s]", found)
    report.write("placing")
    for law, (mean, low, high, _) in found.items():
        print(f"{law:>10}: {mean:.2f} bit/s ({low:.2f} to {high:.2f})", flush=True)
    run.tell("That was all. Thank you.")


if __name__ == "__main__":
    study.carry_out(main)
