"""Where the predictive coupling takes the device to be: its two predictors, step (1) and (8).

Both run on the readings and on the torques as applied, alone: nothing of the proxy enters. The
model's M1 and C1 are taken where the active predictor is, which is known only after the recursion;
so the recursion is repeated with the model at its own last answer until nothing changes.
"""

from __future__ import annotations

import copy
from dataclasses import dataclass

import numpy as np

from .decomposition import apply, transposed
from .dynamics import coriolis, inertia, tip_jacobian
from .session import Session
from .urdf import Array

_COARSE = 1.5e-4  # encoders coarser than this take the coarse preset [rad]
_FORGETTING = 0.05  # of the predictors' errors [s]
_PRESETS = {"fine": (0.2, 1.0, 0.2), "coarse": (0.45, 0.5, 0.1)}
_ROUNDS = 20
# Ticks that are brought to agree with their model at a time. Between two encoder steps nothing
# corrects a predictor, and what it is off by grows: rounds over the whole session need not settle.
_WINDOW = 32
_SETTLED = 1e-15  # [rad]
_SAME = 1e-9  # a predictor this near to what was seen was the active one [rad]


@dataclass(frozen=True)
class Gains:
    """Of every row (N,)."""

    p: Array
    mu: Array
    wall: Array  # damper of a wall, as a part of m_n / T


@dataclass(frozen=True)
class Prediction:
    """Of the active predictor at t_k (N, ...), and of the tick that follows."""

    x: Array
    v: Array
    f: Array  # external torque [N m]
    w: Array  # mean velocity over the tick, with the torque as applied
    heavy: Array  # bool (N,): the one with a hand's mass
    m1: Array  # M1 and C1 as the controller believes them, at (x, v)
    c1: Array
    mp: Array  # inertia of the predictor
    d0: Array  # 2/T Mp + C1 + b_d
    surprise: Array  # delta_k = y_k - y_{k-1} - T w_{k-1}
    confirmed: Array  # bool (N,): it is where it was seen

    def drive(self, tick: float) -> Array:
        """What moves the device besides the motors."""
        return 2 / tick * apply(self.mp, self.v) + self.f


def gains(s: Session) -> Gains:
    """The preset's where nothing else is set."""
    steps = s.number("device.encoder_step")[:, 0]
    named = [
        _PRESETS[name if name in _PRESETS else "coarse" if step > _COARSE else "fine"]
        for name, step in zip(s.settings["predictor.preset"], steps)
    ]
    p, mu, wall = np.array(named).T
    own_p, own_mu = (s.number(f"predictor.{name}")[:, 0] for name in ("p", "mu"))
    return Gains(np.where(np.isnan(own_p), p, own_p), np.where(np.isnan(own_mu), mu, own_mu), wall)


def _model(s: Session, x: Array, v: Array) -> tuple[Array, Array]:
    """M1 and C1 as the controller believes them."""
    believed = s.number("model.inertia_error")[:, :, None]
    return believed * inertia(s.chain, x), believed * coriolis(s.chain, x, v)


@dataclass
class _Pair:
    """Light and heavy predictor, in this order: (2, n)."""

    x: Array  # predicted
    v: Array
    f: Array
    error: Array  # J (2,)
    active: int = 0

    def correct(self, e: Array, p: float, tick: float, keep: float, both: bool) -> None:
        """All but f, whose inertia belongs to where the active one then is."""
        self.x = self.x + (1 - p**3) * e
        self.v = self.v + 1.5 * (1 - p) ** 2 * (1 + p) / tick * e
        self.error = keep * self.error + np.sum(e * e, axis=1)
        light, heavy = self.error
        if not both:
            self.active = 0
        elif self.active == 0:
            self.active = int(2 * heavy < light)
        else:
            self.active = int(not light < heavy)


def _masses(s: Session, x: Array, m1: Array, mu: Array) -> Array:
    """Mp of both predictors (N, 2, n, n)."""
    jacobian = tip_jacobian(s.chain, x)
    light = mu[:, None, None] * m1
    hand = s.number("predictor.hand_mass")[:, :, None] * (transposed(jacobian) @ jacobian)
    return np.stack([light, light + hand], axis=1)


@dataclass(frozen=True)
class Seen:
    """What the rows' torques say of the active predictor: where it was and what it foretold."""

    x: Array  # (N, n) [rad]
    w: Array
    known: Array  # bool (N,)


@dataclass(frozen=True)
class _Input:
    """What the recursion is fed with, of every row."""

    y: Array
    tau: Array
    gains: Gains
    half: Array  # of an encoder's step (N,) [rad]
    both: Array  # bool (N,): there is a heavy one
    tick: float
    seen: Seen | None
    confirmed: Array  # filled in

    def recur(self, pair: _Pair, rows: range, mp: Array, d0: Array) -> tuple[Array, ...]:
        """x, v, f, w and which one, of the active predictor at these rows; `pair` goes on."""
        p, t, keep = self.gains.p, self.tick, float(np.exp(-self.tick / _FORGETTING))
        inverse = np.linalg.inv(d0)
        out = np.zeros((4, len(rows), self.y.shape[1]))
        heavy = np.zeros(len(rows), dtype=bool)
        for i, k in enumerate(rows):
            e = self.y[k] - pair.x
            e = e - np.clip(e, -self.half[k], self.half[k])
            stayed = pair.active
            pair.correct(e, p[k], t, keep, bool(self.both[k]))
            pair.f = pair.f + (1 - p[k]) ** 3 / t**2 * (mp[i] @ e[..., None])[..., 0]
            push = 2 / t * (mp[i] @ pair.v[..., None])[..., 0] + pair.f + self.tau[k]
            w = (inverse[i] @ push[..., None])[..., 0]
            if self.seen is not None and self.seen.known[k]:
                off = self._off(k, pair.x, w)
                if self.both[k]:
                    pair.active = stayed if off[stayed] < _SAME else int(np.argmin(off))
                a = pair.active
                self.confirmed[k] = off[a] < _SAME
                out[:, i] = pair.x[a], pair.v[a], pair.f[a], w[a]
                self._believe(k, pair, w, mp[i, a], d0[i, a])
            else:
                a = pair.active
                out[:, i] = pair.x[a], pair.v[a], pair.f[a], w[a]
            heavy[i] = a == 1
            pair.x = pair.x + t * w
            pair.v = 2 * w - pair.v
        return *out, heavy

    def _off(self, k: int, x: Array, w: Array) -> Array:
        """How far each is from what was seen (2,) [rad]."""
        return np.max(np.abs(x - self.seen.x[k]) + self.tick * np.abs(w - self.seen.w[k]), axis=1)

    def _believe(self, k: int, pair: _Pair, w: Array, mp: Array, d0: Array) -> None:
        """Takes over what was seen. x and w are; of v and f only the sum is, 2/T Mp v + f, and of
        the sum's error each gets half: then both are right after two rows."""
        a = pair.active
        half = d0 @ (self.seen.w[k] - w[a]) / 2
        pair.f[a] += half
        pair.v[a] += self.tick / 2 * np.linalg.solve(mp, half)
        pair.x[a], w[a] = self.seen.x[k], self.seen.w[k]


def _input(s: Session, seen: Seen | None = None) -> tuple[_Input, _Pair]:
    """And the pair at the first row."""
    given = _Input(s["/device/measured_position"], s.law_torque, gains(s),
                   s.number("device.encoder_step")[:, 0] / 2,
                   s.number("predictor.hand_mass")[:, 0] > 0, s.tick, seen,
                   np.zeros(len(s), dtype=bool))  # fmt: skip
    start = (s[f"/{name}"][0] for name in ("device/measured_position", "device/velocity",
                                           "hand/torque_estimate"))  # fmt: skip
    return given, _Pair(*(np.tile(value, (2, 1)) for value in start), np.zeros(2))


def _dynamics(s: Session, x: Array, v: Array) -> tuple[Array, Array, Array, Array]:
    """M1, C1, and Mp and D0 of both predictors."""
    m1, c1 = _model(s, x, v)
    mp = _masses(s, x, m1, gains(s).mu)
    return m1, c1, mp, 2 / s.tick * mp + (c1 + np.eye(s.dof) * s.damping[:, :, None])[:, None]


def _apart(s: Session, a: tuple[Array, Array], b: tuple[Array, Array]) -> float:
    return max(np.max(np.abs(a[0] - b[0])), s.tick * np.max(np.abs(a[1] - b[1])))


_Fields = tuple[Array, ...]  # x, v, f, w, heavy, M1, C1, Mp, D0


def _window(s: Session, given: _Input, pair: _Pair, rows: range) -> tuple[_Pair, _Fields]:
    """The pair after these rows, and what they have."""
    part = s.rows(slice(rows.start, rows.stop))
    x, v = given.y[rows.start : rows.stop], np.tile(pair.v[pair.active], (len(rows), 1))
    for _ in range(_ROUNDS):
        m1, c1, mp, d0 = _dynamics(part, x, v)
        after, before = copy.copy(pair), (x, v)
        x, v, f, w, heavy = given.recur(after, rows, mp, d0)
        if _apart(s, (x, v), before) < _SETTLED:
            break
    each, which = np.arange(len(rows)), heavy.astype(int)
    return after, (x, v, f, w, heavy, m1, c1, mp[each, which], d0[each, which])


def _prediction(s: Session, fields: _Fields, w: Array, confirmed: Array) -> Prediction:
    surprise = np.diff(s["/device/measured_position"], axis=0, prepend=0)
    surprise[0] = 0
    surprise[1:] -= s.tick * w[:-1]
    return Prediction(*fields, surprise, confirmed)


def predict(s: Session) -> Prediction:
    """Both predictors over the whole session, which the law is in force in from the first row."""
    given, pair = _input(s)
    parts = []
    for begin in range(0, len(s), _WINDOW):
        pair, part = _window(s, given, pair, range(begin, min(begin + _WINDOW, len(s))))
        parts.append(part)
    fields = tuple(np.concatenate(field) for field in zip(*parts))
    return _prediction(s, fields, fields[3], given.confirmed)


def unseen(s: Session) -> Prediction:
    """Something to begin with: the model where the readings are, at rest."""
    y = s["/device/measured_position"]
    return _from(s, y, 0 * y, Seen(y, y, np.zeros(len(s), dtype=bool)))


def predict_seen(s: Session, model: Prediction, seen: Seen) -> tuple[Prediction, float]:
    """Every row from what was seen until the row before, with the model where `model` is; and how
    far from there it leads."""
    p = _from(s, model.x, model.v, seen)
    return p, _apart(s, (p.x, p.v), (model.x, model.v))


def _from(s: Session, model_x: Array, model_v: Array, seen: Seen) -> Prediction:
    given, pair = _input(s, seen)
    m1, c1, mp, d0 = _dynamics(s, model_x, model_v)
    x, v, f, w, heavy = given.recur(pair, range(len(s)), mp, d0)
    each, which = np.arange(len(s)), heavy.astype(int)
    fields = (x, v, f, w, heavy, m1, c1, mp[each, which], d0[each, which])
    used = np.where(seen.known[:, None], seen.w, w)
    return _prediction(s, fields, used, given.confirmed)
