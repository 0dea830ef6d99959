"""Energy that the predictive coupling has stored and may still give: inertia network, ledger,
governors. Steps (3) to (5) of the design sheet. The network runs on the readings alone, the ledger
on the readings, the applied torques and the proxy's recorded state."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .decomposition import transposed
from .predictor import Prediction
from .session import Session
from .urdf import Array

# the ladder: inertances and resistances that make an inertia up to the band's edge
_A1, _A2, _A3, _R, _R1 = 1.0081, 1.4799, 0.344, 1.3198, 0.05
_FASTEST, _SLOWEST = 2 * np.pi * 25, 2 * np.pi * 2  # w_g of the added mass [rad/s]
_ON_PROXY = 0.5  # most mass added to a proxy, as a part of M1
_GHOST_DAMPING = 0.7  # zeta
# relative to beta, the added mass's damping for its inertia, times its delay
_OWN, _LATE = 0.9, 0.35
LIMITED = 1  # value of /coupling/solved: motors at their limit and contacts were solved together
# relative to ledger.energy: the largest reserve, and where damping is whole, damping is gone and
# all torque is gone
_CAP, _FULL, _EMPTY, _NOTHING = 4, 0.8, 0.35, 0.25
_CONTACT_RECOVERY, _DAMPING_RECOVERY = 0.05, 0.2  # [s]
_PUSHED, _MOST_SURPRISE = 4e-4, 0.5  # of a hand in a tick [N s], what it makes of velocity [rad/s]


@dataclass(frozen=True)
class Reserve:
    """Results of every row (N, ...)."""

    reserve: Array  # H [J]
    stored: Array  # V + S + W2 [J], large beside H
    governor: Array  # gf
    damping_governor: Array  # gb
    torque_governor: Array  # ga
    b_w: Array  # [N m s/rad]
    u_n: Array  # inertia torque without the part that damps the coming tick [N m]
    k_n: Array  # K_N (N, n, n)


class _Network:
    """State of all joints, in the coordinates into which R_N turns a velocity."""

    def __init__(self, tick: float, joints: int) -> None:
        self.tick = tick
        self.side = 0.0  # -1 below eta 1, 1 above
        self.q = np.zeros((3, joints))  # (s, w', s2) or (s, g, -)
        self.r = np.zeros((joints, joints))  # R_N of the last tick, and its edge
        self.edge = 0.0

    def advance(self, moved: Array) -> None:
        """Advances over the last tick, in which the reading changed by `moved`."""
        t, edge, nu = self.tick, self.edge, self.r.T @ moved / self.tick
        if self.side < 0:
            a = np.array([[0, -1 / _A1, 0], [1 / _A2, -_R1 / _A2, -1 / _A2],
                          [0, 1 / _A3, -1 / (_A3 * _R)]])  # fmt: skip
            driven = self.q + np.outer([t * edge / (2 * _A1), 0, 0], nu)
            middle = np.linalg.solve(np.eye(3) - t * edge / 2 * a, driven)
            self.q = 2 * middle - self.q
        elif self.side > 0:
            h, (s, g, _) = t * edge, self.q
            d = (nu - g - h * s / 2) / (1 + _GHOST_DAMPING * h + h * h / 4)
            self.q = np.stack([s + h * d, 2 * (nu - d) - g, 0 * s])

    def lose(self, energy: float) -> None:
        """Loses what a motor at its limit did not take: the ladder from all of its states, the
        added mass from its spring."""
        own = self.q[0] @ self.q[0] / 2 if self.side > 0 else self.stored
        if energy > 0 and own > 0:
            self.q[: 1 if self.side > 0 else 3] *= np.sqrt(max(0.0, 1 - energy / own))

    def turn(self, eta: float) -> None:
        """Turns to eta's present side of 1."""
        if np.sign(eta - 1) != self.side:
            self.q[:] = 0
            self.side = float(np.sign(eta - 1))

    @property
    def stored(self) -> float:
        weights = np.array([_A1, _A2, _A3]) if self.side < 0 else np.array([1.0, 1.0, 0.0])
        return float(weights @ np.sum(self.q**2, axis=1) / 2)

    def torque(self, eta: float, gb: float, locked: Array, edge: float) -> tuple[Array, Array]:
        """u_N and K_N over the coming tick; `edge` of the ladder's band or w_g."""
        s, g, _ = self.q
        self.edge = edge
        if self.side == 0:
            self.r = 0 * locked
            return 0 * s, 0 * locked
        if self.side < 0:
            share = 1 + (_R + _R1) * edge * self.tick / 2
            self.r = np.linalg.cholesky((1 - eta) * locked / share)
            return -edge * self.r @ s, 0 * locked
        self.r = np.sqrt(gb * (eta - 1)) * np.linalg.cholesky(locked)
        h = self.tick * edge
        gain = edge * (h / 2 + 2 * _GHOST_DAMPING)
        gain /= 1 + _GHOST_DAMPING * h + h * h / 4
        u_n = -self.r @ (edge * s - gain * (g + h * s / 2))
        return u_n, gain * self.r @ self.r.T


def _added_mass(s: Session) -> tuple[Array, Array]:
    """eta and w_g of every row (N,), where eta is above 1. Above w_g the added mass is a damper of
    beta = 2 zeta (eta - 1) w_g. Its delay bounds beta, and so w_g, or at last eta. A proxy of
    `ratio` times the device's inertia bounds eta at 1 + 0.5/ratio."""
    t = s.tick
    eta = np.minimum(s["/coupling/eta"], 1 + _ON_PROXY / s.number("proxy.inertia_ratio")[:, 0])
    _, most = s.possible_delays
    with np.errstate(divide="ignore"):
        beta = np.minimum(_OWN / t, _LATE / (most * t))
    above = np.where(eta > 1, eta - 1, 1)
    edge = np.minimum(_FASTEST, beta / (2 * _GHOST_DAMPING * above))
    left = np.minimum(above, beta / (2 * _GHOST_DAMPING * _SLOWEST))
    return np.where(eta > 1, 1 + left, eta), np.maximum(edge, _SLOWEST)


class _Account:
    """Energy that may be given, by the delay from command to motor: the least account counts."""

    def __init__(self) -> None:
        self.delays = range(1)
        self.energy = np.zeros(1)
        self.on_its_way = 0.0  # what torques that may not have acted yet would put out if all goes on

    def expect(self, delays: range) -> None:
        """Sets the possible delays; newly possible ones begin with the least account."""
        if delays != self.delays:
            self.delays, self.energy = delays, np.full(len(delays), self.least)

    def add(self, sent: Array, k: int, along: Array, damped: float) -> None:
        """Adds the tick before row k, with the torques sent at each row."""
        ticks = k - 1 - np.array(self.delays)
        acted = np.where(ticks[:, None] < 0, 0, sent[np.maximum(ticks, 0)])
        self.energy = self.energy + damped - acted @ along
        later = k - 1 - np.arange(self.delays[-1])
        coming = np.where(later[:, None] < 0, 0, sent[np.maximum(later, 0)])
        self.on_its_way = float(np.sum(np.maximum(0, coming @ along)))

    def keep(self, most: float) -> None:
        self.energy = np.minimum(self.energy, most)

    @property
    def least(self) -> float:
        return float(np.min(self.energy))


def spring_energy(x_e: Array, k_vc: Array, limit: Array) -> Array:
    """V of every row (N,) [J]: a spring limited to the motors' torque."""
    x, limit = np.abs(x_e), np.broadcast_to(limit, x_e.shape)
    with np.errstate(invalid="ignore"):
        beyond = limit * x - limit**2 / (2 * k_vc)
    return np.sum(np.where(k_vc * x > limit, beyond, k_vc * x**2 / 2), axis=1)


def _leaks(s: Session, p: Prediction, locked: Array) -> Array:
    """Bound of the energy given away by the contact force in the tick (N,) [J]: for the
    prediction's error, joint by joint, and for a push's effect on the velocity."""
    y, f2 = s["/device/measured_position"], s["/proxy/contact_torque"]
    off = 2 * np.abs(p.surprise[1:]) + 0.1 * np.abs(np.diff(y, axis=0))
    moved = np.linalg.solve(locked, transposed(p.jacobian))
    push = np.minimum(_PUSHED * np.sqrt(np.sum(moved**2, axis=(1, 2))), _MOST_SURPRISE)
    by_push = s.tick * push[1:] * np.linalg.norm(f2[:-1], axis=1)
    return np.concatenate([[0.0], np.sum(np.abs(f2[:-1]) * off, axis=1) + by_push])


def _follow(value: float, target: float, share: float) -> float:
    return target if target < value else value + share * (target - value)


def _between(value: float, nothing: float, whole: float) -> float:
    return float(np.clip((value - nothing) / (whole - nothing), 0, 1))


def _share_cancelled(s: Session) -> Array:
    """c_eta times 2/3: cancelled part of b_d + b_v in free motion (N,)."""
    as_eta = 2 / 3 * np.clip(2 * (1 - s["/coupling/eta"]), 0, 1)
    felt = s.number("coupling.damping")[:, 0]
    return np.where(np.isnan(felt), as_eta, 1 - felt)


def _springs(s: Session) -> Array:
    """V of every row (N,) [J]. After a tick with motors at their limit it returns the work of a
    constant torque, the row's limit, from where the motors reached it: limits of motors that get
    warm fall meanwhile, and motors can return only what they can still give."""
    x = np.abs(s["/device/measured_position"] - s["/proxy/position"])
    limit, limited = s.law_limit, np.roll(s["/coupling/solved"] == LIMITED, 1)
    limited[0] = False
    spring = spring_energy(x, s.number("coupling.k_vc"), limit)
    out, reached = spring.copy(), 0
    for k in range(len(s)):
        if limited[k]:
            out[k] = max(spring[k], limit[k] @ (x[k] - x[reached]) + spring[reached])
        else:
            reached = k
    return out


class _Cut:
    """Torque that the motors' limit takes off tE + tL: tau2 and the motion tell it."""

    def __init__(self, s: Session, p: Prediction, m2: Array, c2: Array, u: Array) -> None:
        self.s, self.p, self.u = s, p, u
        phi = np.linalg.solve(p.m1 + m2, m2)
        self.c_le = np.swapaxes(c2, 1, 2) - np.swapaxes(p.c1 + c2, 1, 2) @ phi
        self.drive, self.b_v, self.limit = p.drive, s.number("coupling.b_v"), s.law_limit

    def possible(self, k: int, ga: float) -> bool:
        """Whether a motor is at its limit; unknown, so true, where no torque is asked."""
        asked = np.abs(self.s["/device/commanded_torque"][k])
        return bool(np.any(asked >= ga * self.limit[k] * (1 - 1e-12)))

    def at(self, k: int, b_w: float | Array, u_n: Array, k_n: Array, ga: float) -> Array:
        s, u = self.s, self.u[k]
        sent, tau2 = s["/device/commanded_torque"][k], s["/proxy/torque"][k]
        on_w = self.c_le[k] - k_n - np.eye(s.dof) * b_w
        rest = u_n - self.c_le[k] @ u - tau2
        if s["/coupling/solved"][k] == LIMITED:
            w = np.linalg.solve(self.p.d0[k], self.drive[k] + sent)
            rest = rest - self.b_v[k] * u
        else:
            w = np.linalg.solve(self.p.d0[k] - ga * on_w, self.drive[k] + ga * rest)
        given = on_w @ w + rest
        return given - np.clip(given, -self.limit[k], self.limit[k])


def balance(s: Session, p: Prediction, m2: Array, c2: Array, u: Array) -> Reserve:
    """M2 and C2 of the proxy (N, n, n), its mean velocities (N, n)."""
    rows, n, t, sent = len(s), s.dof, s.tick, s.law_torque
    locked, damping = p.m1 + m2, s.damping
    cut = _Cut(s, p, m2, c2, u)
    y, (eta, ghost_edge) = s["/device/measured_position"], _added_mass(s)
    moved = np.diff(y, axis=0, prepend=y[:1])
    edge = np.where(eta > 1, ghost_edge, 2 * np.pi * s.number("coupling.band")[:, 0])
    step = s.number("device.encoder_step")[:, 0]
    cell = step[:, None] / 2
    path = y + np.clip(p.x - y, -cell, cell)  # within the readings' cells, without their jumps
    path[0] = y[0]
    along = np.diff(path, axis=0, prepend=path[:1])
    held = _springs(s) + s["/energy/proxy_kinetic"] + s["/energy/contact_potential"]
    leak, cancelled = _leaks(s, p, locked), _share_cancelled(s)
    held_now = s["/objects/held"] > 0  # the magnet: a contact as long as it lasts
    pushed = np.any(s["/proxy/contact_torque"][:-1] != 0, axis=1) & ~(held_now[:-1] & ~held_now[1:])
    touching = (s["/energy/contact_potential"] > 0) | np.concatenate([[False], pushed]) | held_now
    b_v, energy = (s.number(key)[:, 0] for key in ("coupling.b_v", "ledger.energy"))
    least, most = s.possible_delays
    to_objects = s["/energy/to_objects"]  # bodies are a second port

    network, account = _Network(t, n), _Account()
    out = np.zeros((5, rows))
    b_w, u_n, k_n = np.zeros((rows, n)), np.zeros((rows, n)), np.zeros((rows, n, n))
    gf = gb = ga = 1.0
    for k in range(rows):
        account.expect(range(least[k], most[k] + 1))
        if k > 0:
            network.advance(along[k])
            if cut.possible(k - 1, ga):
                lost = cut.at(k - 1, b_w[k - 1], u_n[k - 1], k_n[k - 1], ga)
                network.lose(-lost @ along[k])
            sure = np.maximum(0, np.abs(moved[k]) - step[k])  # a step of the encoder may be no motion
            account.add(sent, k, along[k], np.sum(damping[k] * sure**2) / t)
            account.energy -= to_objects[k] - to_objects[k - 1]
        network.turn(eta[k])
        stored = held[k] + network.stored
        if k == 0:  # from an earlier part of the run
            account.energy += s["/energy/ledger"][0] + stored
        account.keep(stored + _CAP * energy[k])
        h = account.least - stored
        held_back = float(np.clip(h / leak[k], 0, 1)) if leak[k] > 0 else 1.0  # without contact
        gf = _follow(gf, held_back, t / _CONTACT_RECOVERY)
        gb = _follow(gb, _between(h / energy[k], _EMPTY, _FULL), t / _DAMPING_RECOVERY)
        ga = _follow(ga, _between((account.least - account.on_its_way) / energy[k], _NOTHING, _EMPTY), t / _DAMPING_RECOVERY)
        out[:, k] = h, stored, gf, gb, ga
        less = 0.0 if touching[k] else gb * cancelled[k]
        b_w[k] = b_v[k] - less * (damping[k] + b_v[k])
        u_n[k], k_n[k] = network.torque(eta[k], gb, locked[k], edge[k])
        if least[k] > 0:  # it damps by the actual velocity, not by the predicted one
            u_n[k], k_n[k] = u_n[k] - k_n[k] @ p.v[k], 0
    return Reserve(*out, b_w, u_n, k_n)
