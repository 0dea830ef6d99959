"""A session of the predictive coupling, recomputed: predictors, network, ledger, governors, torques
and, where a single plane is all there is, its force as well.

Nothing inside a law is recorded, so it runs again here: on readings, torques as applied and the
proxy's recorded states. What comes out of a tick is then compared with what the row says.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .joint_solve import Solved, law, proxy_dynamics, solve
from .predictor import Prediction, predict
from .report import Check, not_applicable
from .reserve import Reserve, balance
from .session import Session
from .torques import mean_proxy_velocity
from .urdf import Array
from .wall import Wall, contact_solve, only_wall

KIND = 2
_TOLERANCE = 1e-9  # of the largest of its kind: round-off, fed on through the recursion


@dataclass(frozen=True)
class Replayed:
    prediction: Prediction
    reserve: Reserve
    given: Solved  # with the recorded contact torque
    wall: Wall | None
    forces: Solved | None  # with the wall's force as the law has it


def replay(s: Session) -> Replayed:
    p = predict(s)
    proxy = proxy_dynamics(s)
    r = balance(s, p, p.m1 + proxy.m)
    the = law(s, p, proxy, r)
    f2 = s["/proxy/contact_torque"]
    given = solve(s, p, proxy, the, lambda u0, per_torque: f2)
    wall = only_wall(s, p)
    forces = wall and solve(s, p, proxy, the, contact_solve(wall, s.tick))
    return Replayed(p, r, given, wall, forces)


def _largest(*fields: Array) -> float:
    return max(1e-12, *(float(np.max(np.abs(field), initial=0)) for field in fields))


def _compare(name: str, mine: Array, theirs: Array, scale: float, what: str) -> Check:
    error = float(np.max(np.abs(mine - theirs), initial=0)) / scale
    return Check(name, error, _TOLERANCE, f"worst row, of {what} {scale:.3g}")


def _reserve_checks(s: Session, r: Reserve) -> list[Check]:
    energy = _largest(r.reserve, r.stored)
    return [
        _compare("ledger", r.reserve, s["/energy/ledger"], energy, "largest energy [J]"),
        _compare("governor", r.governor, s["/coupling/governor"], 1, "1, not governed"),
        _compare("damping governor", r.damping_governor, s["/coupling/damping_governor"], 1,
                 "1, not governed"),
    ]  # fmt: skip


def _torque_checks(s: Session, solved: Solved, name: str) -> list[Check]:
    tau1, tau2 = s["/device/commanded_torque"], s["/proxy/torque"]
    u = mean_proxy_velocity(s)
    torque = _largest(tau1, tau2, s["/proxy/contact_torque"])
    unit = "largest torque [N m]"
    return [
        _compare(f"tau1 {name}", solved.tau1, tau1, torque, unit),
        _compare(f"tau2 {name}", solved.tau2, tau2, torque, unit),
        _compare(f"motion {name}", solved.u[:-1], u, _largest(u), "largest speed [rad/s]"),
    ]


def _port_check(s: Session) -> Check:
    dx1 = np.diff(s["/device/position"], axis=0)
    work = np.sum(s["/device/motor_torque"][:-1] * dx1, axis=1)
    own = np.sum(s.damping[:-1] * dx1 * dx1, axis=1) / s.tick
    mine = np.concatenate([[0.0], np.cumsum(work - own)])
    return _compare("energy port", mine, s["/energy/port"], _largest(mine), "its largest [J]")


def check_predictive(s: Session) -> list[Check]:
    """Every part of the law, to 1e-9 of the largest of its kind."""
    kinds = set(s["/coupling/kind"].tolist())
    if KIND not in kinds:
        return [not_applicable("predictive", "another law")]
    if kinds != {KIND}:
        return [not_applicable("predictive", "the law is changed on the way")]
    if np.any(s.number("model.delay") > 0):
        return [not_applicable("predictive", "a delay is reckoned with")]
    done = replay(s)
    checks = [_port_check(s), *_reserve_checks(s, done.reserve)]
    if not np.any(done.given.marks):
        checks += _torque_checks(s, done.given, "predictive")
    if done.wall is None or done.forces is None:
        return checks + [not_applicable("wall force", "more than one plane may be touched")]
    f2 = s["/proxy/contact_torque"]
    stored = done.wall.potential()
    return checks + [
        _compare("wall potential", stored, s["/energy/contact_potential"], _largest(stored),
                 "its largest [J]"),
        _compare("wall force", done.forces.f2, f2, _largest(f2), "largest contact torque [N m]"),
        *_torque_checks(s, done.forces, "with the wall"),
    ]  # fmt: skip
