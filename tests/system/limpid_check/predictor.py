"""Where the predictive coupling takes the device to be: its two predictors, step (1) and (8).

Both run on the readings and on the torques as applied, alone: nothing of the proxy enters. The
model's M1 and C1 are taken where the active predictor is, which is known only after the recursion;
so the recursion is repeated with the model at its own last answer until nothing changes.
"""

from __future__ import annotations

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
    heavy: Array  # bool (N,): the one with a hand's mass
    m1: Array  # M1 and C1 as the controller believes them, at (x, v)
    c1: Array
    mp: Array  # inertia of the predictor
    d0: Array  # 2/T Mp + C1 + b_d
    w: Array  # mean velocity over the tick, with the torque as applied
    surprise: Array  # delta_k = y_k - y_{k-1} - T w_{k-1}

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


def _recursion(s: Session, g: Gains, mp: Array, d0: Array) -> tuple[Array, ...]:
    """x, v, f, w and which one, of the active predictor at every row."""
    t, rows, n = s.tick, len(s), s.dof
    y, tau = s["/device/measured_position"], s["/device/motor_torque"]
    half = s.number("device.encoder_step")[:, 0] / 2
    both = s.number("predictor.hand_mass")[:, 0] > 0
    keep = float(np.exp(-t / _FORGETTING))
    inverse = np.linalg.inv(d0)
    pair = _Pair(
        *(np.tile(start, (2, 1)) for start in
          (y[0], s["/device/velocity"][0], s["/hand/torque_estimate"][0])),
        np.zeros(2),
    )  # fmt: skip
    out = np.zeros((4, rows, n))
    heavy = np.zeros(rows, dtype=bool)
    for k in range(rows):
        e = y[k] - pair.x
        e = e - np.clip(e, -half[k], half[k])
        pair.correct(e, g.p[k], t, keep, bool(both[k]))
        pair.f = pair.f + (1 - g.p[k]) ** 3 / t**2 * (mp[k] @ e[..., None])[..., 0]
        push = 2 / t * (mp[k] @ pair.v[..., None])[..., 0] + pair.f + tau[k]
        w = (inverse[k] @ push[..., None])[..., 0]
        a = pair.active
        heavy[k] = a == 1
        out[:, k] = pair.x[a], pair.v[a], pair.f[a], w[a]
        pair.x = pair.x + t * w
        pair.v = 2 * w - pair.v
    return *out, heavy


def predict(s: Session) -> Prediction:
    """Both predictors over the whole session, which the law is in force in from the first row."""
    g, t, y = gains(s), s.tick, s["/device/measured_position"]
    x, v = y, np.diff(y, axis=0, prepend=y[:1]) / t
    own = np.eye(s.dof) * s.damping[:, :, None]
    for _ in range(_ROUNDS):
        m1, c1 = _model(s, x, v)
        mp = _masses(s, x, m1, g.mu)
        d0 = 2 / t * mp + (c1 + own)[:, None]
        before = x, v
        x, v, f, w, heavy = _recursion(s, g, mp, d0)
        moved = max(np.max(np.abs(x - before[0])), t * np.max(np.abs(v - before[1])))
        if moved < 1e-15:
            break
    rows = np.arange(len(s))
    which = heavy.astype(int)
    surprise = np.diff(y, axis=0, prepend=y[:1])
    surprise[1:] -= t * w[:-1]
    return Prediction(x, v, f, heavy, m1, c1, mp[rows, which], d0[rows, which], w, surprise)
