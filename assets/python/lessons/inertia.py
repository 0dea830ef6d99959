"""Lesson 2: what the hand feels of free motion. Run as it is, or cell by cell (# %%)."""

# %% A hand shakes the arm in the air, twice a second, under several values of eta.
import math

import numpy
from lesson import figure, limpid, show

SHAKE = [(t / 100, 0.19, min(1, t / 100) * 0.02 * math.sin(0.04 * math.pi * t), 0) for t in range(301)]
ETAS = (0.5, 0.6, 0.7, 1, 1.5)


def felt(law: str, eta: float) -> tuple:
    """What the hand's torque about the vertical is made of, once it shakes evenly: inertia [kg m^2] times
    acceleration, and damping [N m s/rad] times speed."""
    session = limpid.run(hand=SHAKE, coupling=law, eta=eta)
    velocity = session["device/velocity"][1500:, 0]
    shares = numpy.stack([numpy.gradient(velocity, session.tick), velocity], axis=1)
    return tuple(numpy.linalg.lstsq(shares, session["hand/torque"][1500:, 0], rcond=None)[0])


# %% The proposed law scales the damping, the predictive one the inertia itself.
found = {law: [felt(law, eta) for eta in ETAS] for law in ("proposed", "predictive")}
figure("inertia", "Inertia that is felt", "eta [-]", "inertia [kg cm^2]",
       {law: (ETAS, [1e4 * inertia for inertia, _ in both]) for law, both in found.items()})
figure("damping", "Damping that is felt", "eta [-]", "damping [N mm s/rad]",
       {law: (ETAS, [1e3 * damping for _, damping in both]) for law, both in found.items()})
for law, both in found.items():
    print(f"{law:>10}: " + ", ".join(f"eta {eta:g}: {1e4 * inertia:.2f} kg cm^2, {1e3 * damping:.1f} N mm s/rad"
                                     for eta, (inertia, damping) in zip(ETAS, both)))

# %% To be felt: lighter than the arm is.
show("Shake it to and fro: it is lighter than it is.", **{"coupling.kind": "predictive", "coupling.eta": 0.25})
