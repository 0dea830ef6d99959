"""Energy books of a session, recomputed: E_c and the proxy's balance (contract, "What the rows
mean")."""

from __future__ import annotations

import numpy as np

from .decomposition import apply
from .dynamics import inertia
from .report import Check
from .session import Session
from .urdf import Array


def _running_sum(per_tick: Array) -> Array:
    return np.concatenate([[0.0], np.cumsum(per_tick)])


def controller_energy(s: Session) -> tuple[Array, Array]:
    """E_c (N,) [J], total and commanded, from torques and positions alone."""
    dx1 = np.diff(s["/device/position"], axis=0)
    dx2 = np.diff(s["/proxy/position"], axis=0)
    work1 = np.sum(s["/device/motor_torque"][:-1] * dx1, axis=1)
    work2 = np.sum(s["/proxy/torque"][:-1] * dx2, axis=1)
    own = np.sum(s.damping[:-1] / s.tick * dx1 * dx1, axis=1)
    commanded = _running_sum(work1 + work2)
    return commanded - _running_sum(own), commanded


def check_controller_energy(s: Session) -> list[Check]:
    """Both books, to 1e-9 of the largest |E_c| (round-off of sums over many ticks)."""
    checks = []
    for kind, mine in zip(("total", "commanded"), controller_energy(s)):
        theirs = s[f"/energy/controller_{kind}"]
        largest = max(float(np.max(np.abs(mine))), 1e-12)
        error = float(np.max(np.abs(theirs - mine))) / largest
        checks.append(Check(f"energy {kind}", error, 1e-9, f"of largest |E_c| {largest:.3g} J"))
    return checks + _compensation_check(s)


def _compensation_check(s: Session) -> list[Check]:
    """Part of E_c for the device's own forces, while force is on and no delay shifts it."""
    theirs, torque = s["/energy/compensation"], s["/device/compensation_torque"]
    if not np.any(torque):
        return []
    mine = _running_sum(np.sum(torque[:-1] * np.diff(s["/device/position"], axis=0), axis=1))
    largest = max(float(np.max(np.abs(mine))), 1e-12)
    error = float(np.max(np.abs(theirs - mine))) / largest
    return [Check("energy compensation", error, 1e-9, f"of its largest {largest:.3g} J")]


def check_proxy_balance(s: Session) -> list[Check]:
    """KE[k+1] - KE[k] = (tau2[k] + f2[k]) . dx2[k] at every tick, and KE = v2 . M2(x2) v2 / 2.

    The first to 1e-11 of the largest KE, the second to 1e-9.
    """
    kinetic = s["/energy/proxy_kinetic"]
    largest = max(float(np.max(kinetic)), 1e-300)
    x2 = s["/proxy/position"]
    dx2 = np.diff(x2, axis=0)
    work = np.sum((s["/proxy/torque"] + s["/proxy/contact_torque"])[:-1] * dx2, axis=1)
    leak = float(np.max(np.abs(np.diff(kinetic) - work), initial=0.0)) / largest

    v2 = s["/proxy/velocity"]
    m2 = s.number("proxy.inertia_ratio")[:, :, None] * inertia(s.chain, x2)
    state = np.sum(v2 * apply(m2, v2), axis=1) / 2
    wrong = float(np.max(np.abs(kinetic - state))) / largest
    return [
        Check("proxy balance", leak, 1e-11, f"worst tick, of largest energy {largest:.3g} J"),
        Check("proxy kinetic", wrong, 1e-9, "v2 . M2 v2 / 2, of its largest"),
    ]
