#!/usr/bin/env python3
"""The paper's Figs. 3 to 7 beside the built-in arm and a Touch: paper_table.py LIMPID DIR

Runs the commands below, leaves their results in DIR, and prints a table in Markdown. The Touch has the
paper's gains; those that suit its delay are softer (k_vc 4 N m/rad), as `limpid run` has them."""
import csv
import json
import subprocess
import sys
from pathlib import Path

import h5py
import numpy as np

FIGURES = ("coordination", "inertia", "passivity", "spectrum")
TOUCH = ("--device", "touch.urdf", "--readings", "--set", "coupling.k_vc=10")
ARMS = {"ideal": (), "Touch": TOUCH}
ETAS = (0.6, 0.5, 0.45, 0.4)


class Arm:
    """What the commands found on one arm."""

    def __init__(self, limpid: str, name: str, out: Path) -> None:
        self.out, self.limpid, self.words = out / name, limpid, ARMS[name]
        for figure in FIGURES:
            self.call("experiment", figure, "--out", str(self.out))
        with (out / "paper/table.csv").open() as file:
            rows = [row for row in csv.DictReader(file) if row["arm"] == name]
        self.given = {eta: max(float(r["commanded_highest [J]"]) for r in rows if float(r["eta"]) == eta)
                      for eta in ETAS}  # fmt: skip

    def call(self, *words: str) -> str:
        done = subprocess.run([self.limpid, *words, *self.words], stdout=subprocess.PIPE, text=True, check=True)
        return done.stdout

    def check(self, figure: str, words: str) -> float:
        checks = json.loads((self.out / f"{figure}.json").read_text())["checks"]
        return next(check["value"] for check in checks if words in check["what"])

    def slope(self, law: str) -> str:
        with (self.out / "coordination.csv").open() as file:
            labels = {row["series"] for row in csv.DictReader(file)}
        return next(label for label in labels if label.startswith(f"{law}: ")).split()[1]

    def error(self, law: str) -> float:
        with h5py.File(self.out / f"coordination/{law}.h5") as session:
            apart = session["device/position"][:] - session["proxy/position"][:]
        return 1e3 * np.linalg.norm(apart, axis=1).max()

    def torque(self, eta: str, which: str) -> float:
        with h5py.File(self.out / f"inertia/eta-{eta}.h5") as session:
            return np.sqrt((session[f"hand/{which}"][:] ** 2).sum(axis=1).mean())

    def torques(self, which: str) -> str:
        one = self.torque("1", which)
        return ", ".join(f"{self.torque(eta, which) / one:.2f}" for eta in ("0.6", "5"))

    def eta_min(self, *words: str) -> str:
        return f"{json.loads(self.call('analyze', '--json', *words))['eta_min']:.2f}"


def energy(joules: float) -> str:
    if joules < 1e-10:
        return "0"
    return f"{1e3 * joules:.1f} mJ" if joules >= 1e-4 else f"{1e6 * joules:.2g} μJ"


ROWS = (
    ("Fig. 3: contacts made, standard and proposed", "6, 6",
     lambda a: ", ".join(f"{a.check('coordination', f'made with the {law}'):.0f}" for law in ("standard", "proposed"))),
    ("Fig. 3: largest error, standard and proposed [mrad]", "",
     lambda a: f"{a.error('standard'):.0f}, {a.error('proposed'):.1f}"),
    ("Fig. 4: error over contact torque, standard; 1/k_vc is 100 mrad/(N m)", "proportional", lambda a: a.slope("standard")),
    ("Fig. 4: the same, proposed", "bounded, small", lambda a: a.slope("proposed")),
    ("Fig. 5: estimated human torque at η 0.6 and 5, divided by that at η 1", "smaller, larger",
     lambda a: a.torques("torque_estimate")),
    ("Fig. 5: true human torque, likewise", "not measured", lambda a: a.torques("torque")),
    ("Fig. 6: highest E_c of ten trials, standard", "passive",
     lambda a: energy(a.check("passivity", "commanded E_c of all trials, standard"))),
    *((f"Fig. 6: the same, proposed, η {eta}", words, lambda a, eta=eta: energy(a.given[eta]))
      for eta, words in zip(ETAS, ("passive", "not passive", "not passive", "not passive"))),
    ("Fig. 7: share of the motion's power below 5 Hz", "most",
     lambda a: f"{100 * a.check('spectrum', 'power of all trials'):.1f} %"),
    ("η_min by (25), damping b_d of the device alone", "0.8", lambda a: a.eta_min("--set", "coupling.b_v=0")),
    ("η_min by (25), b = b_d + b_v", "", lambda a: a.eta_min()),
)  # fmt: skip


def main(limpid: str, out: Path) -> None:
    plan = Path(__file__).resolve().parent.parent / "sweeps/paper.toml"
    subprocess.run([limpid, "sweep", plan, "--out", out / "paper", "--csv"], stdout=subprocess.DEVNULL, check=True)
    ideal, touch = (Arm(limpid, name, out) for name in ARMS)
    print("| | paper | ideal arm | Touch |\n| --- | --- | --- | --- |")
    for what, paper, found in ROWS:
        cells = (what, paper, found(ideal), found(touch))
        print("|" + "".join(f" {cell} |" if cell else " |" for cell in cells))


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit("which program, and which folder? paper_table.py LIMPID DIR")
    main(sys.argv[1], Path(sys.argv[2]))
