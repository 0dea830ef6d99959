"""Lesson 3: below eta_min the proposed coupling gives energy. Run as it is, or cell by cell (# %%)."""

# %% What `limpid analyze` says of the limit, (25).
import json

from lesson import figure, limpid, show
from limpid.program import carry_out

eta_min = json.loads(carry_out(["analyze", "--json"]))["eta_min"]
print(f"eta_min is {eta_min:.3f}")

# %% The energy that the controller has given, while a hand touches a table, above and below the limit.
ETAS = (1.5, 1.0, 0.7)
sessions = {eta: limpid.run(duration=3, coupling="proposed", eta=eta) for eta in ETAS}
lines = {f"eta {eta:g}": (s.time, 1000 * s["energy/controller_total"]) for eta, s in sessions.items()}
figure("passivity", "Energy that the controller has given", "time [s]", "E_c [mJ]", lines,
       top=max(1.0, *(float(max(values)) for _, values in lines.values())))

# %% Passive means that it never gives any: E_c stays at or below zero.
for eta, s in sessions.items():
    print(f"eta {eta:g}: E_c is {1000 * float(s['energy/controller_total'].max()):.3f} mJ at most")

# %% To be felt.
show(**{"coupling.kind": "proposed", "coupling.eta": 0.7})
