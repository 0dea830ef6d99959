#!/usr/bin/env python3
"""Force over penetration of a recorded session: read_session.py SESSION.h5

The force is all that the scene puts on the proxy [N], the penetration how far the device's tip is from
the proxy's, which stays where the scene lets it [mm]. Both go into SESSION.force.csv, and, where there
is matplotlib, into SESSION.force.png. Recordings older than /proxy/tip get it from
`limpid run --hand OLD.h5 --record NEW.h5`."""
import sys

import h5py
import numpy as np

if len(sys.argv) != 2:
    sys.exit("which recording? read_session.py SESSION.h5")
try:
    with h5py.File(sys.argv[1]) as session:
        apart = session["device/tip"][:] - session["proxy/tip"][:]
        force = np.linalg.norm(session["contact/total_force"][:], axis=1)
except (OSError, KeyError) as error:
    sys.exit(f"{sys.argv[1]}: no recorded session: {error}")
table = np.column_stack([1e3 * np.linalg.norm(apart, axis=1), force])
out = sys.argv[1].removesuffix(".h5") + ".force"
np.savetxt(out + ".csv", table, delimiter=",", header="penetration_mm,force_N", comments="")
print("wrote", out + ".csv")
try:
    import matplotlib.pyplot as plt
except ImportError:
    sys.exit()
plt.plot(*table.T, ",", label="each tick")
plt.xlabel("penetration [mm]"), plt.ylabel("force [N]"), plt.savefig(out + ".png")
