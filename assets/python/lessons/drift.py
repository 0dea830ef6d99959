"""Lesson 1: the standard coupling drifts. Run as it is, or cell by cell (# %%)."""

# %% One hand presses onto a table, under each law.
import numpy
from lesson import LAWS, figure, limpid, show

PRESS = [(0, 0.19, 0, 0), (0.2, 0.19, 0, 0), (0.7, 0.19, 0, -0.05), (1.5, 0.19, 0, -0.05)]
sessions = {law: limpid.run(hand=PRESS, coupling=law) for law in LAWS}

# %% How far are device and proxy apart?
apart = {law: 1000 * numpy.linalg.norm(s.device_tip - s.proxy_tip, axis=1) for law, s in sessions.items()}
figure("drift", "Device and proxy, while the hand presses", "time [s]", "apart [mm]",
       {law: (sessions[law].time, apart[law]) for law in LAWS})

# %% In the end. A spring holds the standard coupling together: it drifts by force over stiffness.
for law in LAWS:
    print(f"{law:>10}: {apart[law][-1]:6.3f} mm")

# %% To be felt.
show("Press onto the table: device and proxy drift apart.", **{"coupling.kind": "standard"})
