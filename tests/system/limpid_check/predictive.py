"""A session of the predictive coupling, recomputed: predictors, network, ledger, governors, torques
and, where a single plane is all there is, its force as well.

Nothing inside a law is recorded, so it runs again here: on readings, torques as applied and the
proxy's recorded states. What comes out of a tick is then compared with what the row says.

With encoder steps the predictors are now and then left alone between two steps and then corrected
hard; what they are off by may grow from tick to tick until round-off decides what they do. Where it
does, each tick is recomputed from what the torques of the row before say of the active predictor. Where
they say nothing, and where the other one takes over, rows go unchecked; where motors are at their
limit or all torque is governed, torques are not recomputed at all.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .decomposition import apply
from .joint_solve import Law, Proxy, Solved, law, proxy_dynamics, solve, solve_limited
from .predictor import Prediction, Seen, predict, predict_seen, unseen
from .report import Check, not_applicable
from .reserve import LIMITED, Reserve, balance
from .session import Session
from .torques import mean_proxy_velocity
from .urdf import Array
from .wall import Wall, contact_solve, known_force, only_wall

KIND = 2
_TOLERANCE = 1e-9  # relative to the largest of its kind: round-off, amplified by the recursion
_HARDLY = 1e4  # factor of the tolerance of quantities that an unknown predictor hardly affects
_ROUNDS = 12
_LEAST_DAMPING = 1e-4  # least damping of the coupling that reveals the motion [N m s/rad]


@dataclass(frozen=True)
class Replayed:
    prediction: Prediction
    reserve: Reserve
    given: Solved  # with the recorded contact torque
    wall: Wall | None
    forces: Solved | None  # with the wall's force as the law has it
    limited: Solved  # as a tick with motors at their limit
    sure: Array  # bool (N,): false in rows that a predictor has just taken over


def _motion(s: Session) -> Array:
    """Mean velocity of the proxy over the tick of every row; unknown for the last one."""
    return np.concatenate([mean_proxy_velocity(s), np.zeros((1, s.dof))])


def _seen(s: Session, p: Prediction, proxy: Proxy, r: Reserve, the: Law) -> Seen:
    """tau1 + tau2 = -b_w w + C_LE (w - u) + u_N - K_N w tells w, tau2 then x."""
    u, tau1, tau2 = _motion(s), s["/device/commanded_torque"], s["/proxy/torque"]
    c_le = -the.shared.u
    left = r.b_w[:, :, None] * np.eye(s.dof) - the.shared.w
    tells = np.min(np.abs(np.linalg.eigvals(left)), axis=1) > _LEAST_DAMPING
    left[~tells] = np.eye(s.dof)
    w = np.linalg.solve(left, (r.u_n - apply(c_le, u) - tau1 - tau2)[:, :, None])[:, :, 0]
    off = tau2 - the.proxy.at(w, u, s["/proxy/contact_torque"])
    x = p.x + off / s.number("coupling.k_vc")
    free = ~np.any(np.abs(tau1) >= s.law_limit, axis=1) & (the.authority[:, 0] == 1)
    known = tells & (s["/coupling/solved"] == 0) & free
    known[-1] = False
    return Seen(x, w, known)


def _followed(s: Session, p: Prediction, proxy: Proxy) -> bool:
    """Whether predictions that ran over the whole session agree with the torques."""
    the = law(s, p, proxy, balance(s, p, proxy.m, proxy.c, _motion(s)))
    u, tau1, f2 = _motion(s), s["/device/commanded_torque"], s["/proxy/contact_torque"]
    usual = solve(s, p, proxy, the, lambda u0, per_torque: f2)
    limited = solve_limited(s, p, the, u, f2)
    at_limit = (s["/coupling/solved"] == LIMITED)[:, None]
    off = np.where(at_limit, limited.tau1, usual.tau1) - tau1, np.where(at_limit, 0, usual.u - u)
    worst = max(_largest(a[:-1]) / _largest(b) for a, b in zip(off, (tau1, u)))
    return worst < _TOLERANCE / 10


def _predictions(s: Session, proxy: Proxy) -> tuple[Prediction, Array] | None:
    """Predictions and the rows in which they are sure; nothing if there is no such row."""
    p, stepped = predict(s, proxy.m), np.any(s.number("device.encoder_step") > 0)
    if not stepped or _followed(s, p, proxy):
        return p, np.ones(len(s), dtype=bool)
    if np.any(s.number("model.delay") > 0):  # the torques tell of a tick to come
        return None
    p = unseen(s, proxy.m)
    for _ in range(_ROUNDS):
        r = balance(s, p, proxy.m, proxy.c, _motion(s))
        seen = _seen(s, p, proxy, r, law(s, p, proxy, r))
        p, moved = predict_seen(s, proxy.m, p, seen)
        if moved < 1e-14:
            break
    return p, _sure(p, seen.known)


def _sure(p: Prediction, known: Array) -> Array:
    """Rows that tell the motion and whose predictor is known. It is the one of the row before, and
    was confirmed twice since it was last unknown."""
    changed = np.diff(p.heavy.astype(int), prepend=0) != 0
    sure, seen = np.zeros(len(known), dtype=bool), 2
    for k in range(len(known)):
        seen = 0 if changed[k] or not known[k] else seen
        sure[k] = seen >= 2
        if known[k] and (seen >= 2 or p.confirmed[k]):
            seen += 1
    return sure


def replay(s: Session) -> Replayed | None:
    proxy = proxy_dynamics(s)
    found = _predictions(s, proxy)
    if found is None:
        return None
    p, sure = found
    r = balance(s, p, proxy.m, proxy.c, _motion(s))
    the = law(s, p, proxy, r)
    f2 = s["/proxy/contact_torque"]
    given = solve(s, p, proxy, the, lambda u0, per_torque: f2)
    wall = only_wall(s, p, proxy.m)
    forces = wall and solve(s, p, proxy, the, contact_solve(wall, s.tick))
    limited = solve_limited(s, p, the, _motion(s), f2)
    return Replayed(p, r, given, wall, forces, limited, sure)


def _largest(*fields: Array) -> float:
    return max(1e-12, *(float(np.max(np.abs(field), initial=0)) for field in fields))


def _compare(name: str, mine: Array, theirs: Array, scale: float, what: str) -> Check:
    error = float(np.max(np.abs(mine - theirs), initial=0)) / scale
    return Check(name, error, _TOLERANCE, f"worst row, of {what} {scale:.3g}")


def _reserve_checks(s: Session, r: Reserve, sure: Array) -> list[Check]:
    """Checks of the reserve. The ledger's network depends on the predictor only by the inertia's
    place: hardly."""
    reserve, gf, gb, ga = (s[path] for path in (
        "/energy/ledger", "/coupling/governor", "/coupling/damping_governor",
        "/coupling/torque_governor"))
    energy, one = _largest(r.reserve, r.stored), "1, not governed"
    rough = 1 if np.all(sure) else _HARDLY
    return [
        _compare("ledger", r.reserve, reserve, rough * energy, f"{rough:g} largest energy [J]"),
        _compare("governor", r.governor[sure], gf[sure], 1, one),
        _compare("damping governor", r.damping_governor, gb, rough, one),
        _compare("torque governor", r.torque_governor, ga, rough, one),
    ]


def _torque_checks(s: Session, solved: Solved, rows: Array, name: str) -> list[Check]:
    tau1, tau2 = s["/device/commanded_torque"], s["/proxy/torque"]
    u, moves = mean_proxy_velocity(s), rows[:-1]
    rows = np.append(moves, False)
    torque = _largest(tau1, tau2, s["/proxy/contact_torque"])
    unit = "largest torque [N m]"
    return [
        _compare(f"tau1 {name}", solved.tau1[rows], tau1[rows], torque, unit),
        _compare(f"tau2 {name}", solved.tau2[rows], tau2[rows], torque, unit),
        _compare(f"motion {name}", solved.u[:-1][moves], u[moves], _largest(u),
                 "largest speed [rad/s]"),
    ]  # fmt: skip


def _wall_checks(s: Session, done: Replayed) -> list[Check]:
    if done.wall is None or done.forces is None:
        return [not_applicable("wall force", "more than one smooth plane may be touched")]
    f2, stored, how = s["/proxy/contact_torque"], done.wall.potential(), s["/coupling/solved"]
    usual, limited = done.sure & (how == 0), done.sure & (how == LIMITED)
    limited[-1] = False
    known = known_force(done.wall, _motion(s), s.tick)
    unit = "largest contact torque [N m]"
    return [
        _compare("wall potential", stored, s["/energy/contact_potential"], _largest(stored),
                 "its largest [J]"),
        _compare("wall force", done.forces.f2[usual], f2[usual], _largest(f2), unit),
        _compare("wall force at the limit", known[limited], f2[limited], _largest(f2), unit),
        *_torque_checks(s, done.forces, usual, "with the wall"),
        _which_are_limited(s, done),
    ]  # fmt: skip


def _which_are_limited(s: Session, done: Replayed) -> Check:
    """Ticks with limits: a motor would pass its own, or the tick before had limits and goes on."""
    limited = s["/coupling/solved"] == LIMITED
    asked = done.forces.over | np.concatenate([[False], (limited & done.limited.on)[:-1]])
    wrong = np.sum((asked != limited)[done.sure])
    return Check("ticks with limits", float(wrong), 0.5, "rows that had none, or had them without need")


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
    done = replay(s)
    if done is None:
        why = "encoder steps and a delay that is reckoned with: the predictor is not known"
        return [not_applicable("predictive", why)]
    unsure = 1 - float(np.mean(done.sure))
    checks = [
        _port_check(s),
        *_reserve_checks(s, done.reserve, done.sure),
        Check("unchecked rows", unsure, 1, "of all: what the predictor was is not known"),
    ]
    how = s["/coupling/solved"]
    held_back = np.any(how != 0) or np.any(done.reserve.torque_governor < 1)
    if not np.all(done.sure) and held_back:
        why = "encoder steps and motors at their limit or governed: the predictor is not known"
        return checks + [not_applicable("torques, wall force", why)]
    checks += _torque_checks(s, done.given, done.sure & (how == 0), "predictive")
    if np.any(how == LIMITED):
        checks += _torque_checks(s, done.limited, done.sure & (how == LIMITED), "at the limit")
    return checks + _wall_checks(s, done)
