"""All recomputations of a session, by name."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import numpy as np

from .energy import check_controller_energy, check_proxy_balance
from .observer import check_observer
from .predictive import check_predictive
from .report import Check
from .session import Session
from .slopes import check_slopes
from .tank import check_tank
from .torques import check_motors, check_torques, sampled_velocity


def check_layout(s: Session) -> list[Check]:
    """Times a tick apart, finite rows, raw velocities that are differences of positions."""
    steps = np.diff(s["/time"])
    uneven = float(np.max(np.abs(steps - s.tick), initial=0)) / s.tick
    # a real device's human torque is not known, and a headless run has no clock to be late by
    may_be_nan = ("/hand/torque", "/timing/wake_latency", "/timing/compute")
    bad = sum(
        int(np.sum(~np.isfinite(values)))
        for path, values in s.data.items()
        if path not in may_be_nan
    )
    checks = [
        Check("time steps", uneven, 1e-6, "of a tick, worst"),
        Check("not finite", bad, 0, "values that are not finite"),
    ]
    if all(value == "raw" for value in s.settings["observer.velocity"]):
        error = np.max(np.abs(sampled_velocity(s) - s["/device/measured_velocity"]))
        checks.append(Check("raw velocity", float(error), 1e-9, "rad/s from dx1/T"))
    if not np.any(s.number("device.encoder_step") > 0):
        error = np.max(np.abs(s["/device/position"] - s["/device/measured_position"]))
        checks.append(Check("encoder", float(error), 0, "rad, without encoder steps"))
    return checks


CHECKS: Mapping[str, Callable[[Session], list[Check]]] = {
    "layout": check_layout,
    "energy": check_controller_energy,
    "proxy": check_proxy_balance,
    "torques": check_torques,
    "motors": check_motors,
    "observer": check_observer,
    "slopes": check_slopes,
    "predictive": check_predictive,
    "tank": check_tank,
}


def verify(s: Session, names: Sequence[str] = tuple(CHECKS)) -> list[Check]:
    """Every named check of a session, in the order of CHECKS."""
    if len(s) < 2:
        return [Check("rows", -len(s), -2, "rows in the file, negative")]
    return [check for name in CHECKS if name in names for check in CHECKS[name](s)]
