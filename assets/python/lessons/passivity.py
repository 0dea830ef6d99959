"""Lesson 3: below eta_min the proposed coupling may give energy. Run as it is, or cell by cell (# %%)."""

# %% What `limpid analyze` says of the limit, (25).
import json

from lesson import figure, limpid, show
from limpid.program import carry_out

eta_min = json.loads(carry_out(["analyze", "--json"]))["eta_min"]
print(f"eta_min is {eta_min:.3f}")

# %% A hand touches a table, above the limit, just above it, and far below it.
ETAS = (1.0, 0.6, 0.3)
sessions = {eta: limpid.run(coupling="proposed", eta=eta) for eta in ETAS}
lines = {f"eta {eta:g}": (s.time, s["energy/controller_total"]) for eta, s in sessions.items()}
figure("passivity", "Energy that the controller has given", "time [s]", "E_c [J]", lines)

# %% Passive means that it never gives any: E_c stays at or below zero.
for eta, s in sessions.items():
    print(f"eta {eta:g}: E_c is {float(s['energy/controller_total'].max()):.3f} J at most")

# %% To be felt, with the force off at a touch of the space bar.
show("Touch the table: it may tremble, as the controller can give energy. The space bar takes the force off.",
     **{"coupling.kind": "proposed", "coupling.eta": 0.4})
