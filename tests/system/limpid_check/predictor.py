"""The device as the predictive coupling predicts it: its two predictors, step (1) and (8). Both run
on the readings and on the applied torques alone: nothing of the proxy enters. The model's M1 and C1
are taken at the active predictor's place, which is known only after the recursion; so the recursion
is repeated with the model at its own last answer until nothing changes. With a known delay the
device is predicted further, to where the coming torque meets it."""

from __future__ import annotations

import copy
from dataclasses import dataclass

import numpy as np

from .decomposition import apply, transposed
from .dynamics import coriolis, inertia, tip_jacobian
from .session import Session
from .steps import HELD, Tip, faded_jump, quickest, resting_rate, stiffest, weighed_jump
from .urdf import Array

_COARSE = 1.5e-4  # encoders coarser than this have other constants where a memory is set [rad]
_FORGETTING = 0.05  # time constant of the predictors' errors [s]
_SURER = 1.0  # log of the likelihoods' ratio at which the other predictor takes over
_ROUNDS = 20
# Number of ticks that are brought to agree with their model at a time. Between two encoder steps
# nothing corrects a predictor, and its error grows: rounds over the whole session need not settle.
_WINDOW = 32
_SETTLED = 1e-15  # [rad]
_SAME = 1e-9  # a predictor this near to the observed place was the active one [rad]


@dataclass(frozen=True)
class Gains:
    """Gains of every row (N,)."""

    p: Array  # memory; not a number where readings are weighed by the encoder's step
    mu: Array
    wall: Array  # damper of a wall, as a part of m_n / T


@dataclass(frozen=True)
class Prediction:
    """The active predictor at t_k (N, ...), and the tick that follows."""

    x: Array
    v: Array
    f: Array  # external torque [N m]
    w: Array  # mean velocity over the tick, with the applied torque
    met_x: Array  # x and v where the coming torque meets the device
    met_v: Array
    heavy: Array  # bool (N,): the predictor with a hand's mass
    jump: Array  # of a joint's velocity at a step of the encoder (N,) [rad/s]
    ahead: Array  # theta^-1 (N, n): 2 by the midpoint rule
    jacobian: Array  # of the tip (N, 3, n)
    m1: Array  # M1 and C1 as the controller believes them, at (x, v)
    c1: Array
    mt: Array  # inertia of the predictor over the tick it takes, Mp theta^-1/T
    d0: Array  # Mp theta^-1/T + C1 + b_d
    surprise: Array  # delta_k = y_k - y_{k-1} - T w_{k-1}
    confirmed: Array  # bool (N,): the torques confirm its place

    @property
    def drive(self) -> Array:
        """Torque on the device besides the motors', in the tick that the torque meets."""
        return apply(self.mt, self.met_v) + self.f


def gains(s: Session) -> Gains:
    """Gains of the settings, or as usual where nothing is set."""
    step = s.number("device.encoder_step")[:, 0]
    own_p, own_mu = (s.number(f"predictor.{name}")[:, 0] for name in ("p", "mu"))
    coarse = ~np.isnan(own_p) & (step > _COARSE)
    p = np.where(np.isnan(own_p) & ~(step > 0), 0.2, own_p)
    mu = np.where(np.isnan(own_mu), np.where(coarse, 0.5, 1.0), own_mu)
    return Gains(p, mu, np.where(coarse, 0.1, 0.2))


def _model(s: Session, x: Array, v: Array) -> tuple[Array, Array]:
    """M1 and C1 as the controller believes them."""
    believed = s.number("model.inertia_error")[:, :, None]
    return believed * inertia(s.chain, x), believed * coriolis(s.chain, x, v)


@dataclass
class _Pair:
    """The light and the heavy predictor, in this order: (2, n)."""

    x: Array  # predicted
    v: Array
    f: Array
    error: Array  # J (2,)
    known: Array  # covariance of position, velocity and acceleration of each joint (2, n, 3, 3)
    rate: Array  # of the acceleration by a hand
    doubt: float = 0.0  # log of the likelihood of the heavy one over that of the light one
    active: int = 0

    def correct(self, e: Array, p: float, step: float, tick: float, keep: float, both: bool) -> Array:
        """Corrects all but f by the readings' distance, and returns by how much f changes the
        acceleration; f's inertia depends on the next active predictor's place."""
        if np.isnan(p):
            return self._weigh(e, step, tick, keep, both)
        e = e - np.clip(e, -step / 2, step / 2)
        self.x = self.x + (1 - p**3) * e
        self.v = self.v + 1.5 * (1 - p) ** 2 * (1 + p) / tick * e
        self.error = keep * self.error + np.sum(e * e, axis=1)
        self.doubt = keep * self.doubt if both else 0.0
        light, heavy = self.error
        if not both:
            self.active = 0
        elif self.active == 0:
            self.active = int(2 * heavy < light)
        else:
            self.active = int(not light < heavy)
        return (1 - p) ** 3 / tick**2 * e

    def _weigh(self, e: Array, step: float, tick: float, keep: float, both: bool) -> Array:
        """Kalman's filter of each joint."""
        moves = np.array([[1, tick, tick**2 / 2], [0, 1, tick], [0, 0, 1]])
        known = moves @ self.known @ moves.T
        most = quickest(tick) ** 3 * step / np.sqrt(12)
        known[..., 2, 2] += (np.minimum(self.rate, most) * tick) ** 2
        variance = known[..., 0, 0] + step**2 / 12
        gain = known[..., 0] / variance[..., None]
        self.known = known - gain[..., None] * known[..., :1, :]
        self.x, self.v = self.x + gain[..., 0] * e, self.v + gain[..., 1] * e
        light, heavy = np.sum(np.log(variance) + e * e / variance, axis=1) / 2
        self.doubt = keep * self.doubt + light - heavy if both else 0.0
        if not both:
            self.active = 0
        elif (self.doubt > _SURER) if self.active == 0 else (self.doubt < -_SURER):
            self.active = 1 - self.active
        return gain[..., 2] * e


def _decays(s: Session, m1: Array) -> Array:
    """a = T b_d (M^-1)_jj: part of a joint's motion that dies in a tick, the others free (N, n)."""
    return s.tick * s.damping * np.diagonal(np.linalg.inv(m1), axis1=1, axis2=2)


def _quick(s: Session) -> Array:
    """Whether some joint's motion dies within a tick, as judged when b_d last changed (N,)."""
    y = s["/device/measured_position"]
    now = np.any(_decays(s, _model(s, y, 0 * y)[0]) > 1, axis=1)
    fresh = np.any(np.diff(s.damping, axis=0, prepend=0) != 0, axis=1)
    judged = np.maximum.accumulate(np.where(fresh, np.arange(len(s)), -1))
    return np.where(judged < 0, False, now[judged])


def _ahead(s: Session, m1: Array, quick: Array) -> Array:
    """1/theta (N, n): change of the velocity over a tick per w - v, with the mean w. It is 2 by the
    midpoint rule. A motion that dies as exp(-a t/T) ends at v exp(-a) and has the mean v (1 -
    exp(-a))/a; its 1/theta follows from these."""
    a = _decays(s, m1)
    safe = np.where(a > 1e-3, a, 1.0)
    lost = -np.expm1(-safe)
    exact = np.where(a > 1e-3, lost / (1 - lost / safe), 12 / (6 + a))
    return np.where(quick[:, None], exact, 2.0)


def _masses(s: Session, jacobian: Array, m1: Array, mu: Array) -> Array:
    """Mp of both predictors (N, 2, n, n)."""
    light = mu[:, None, None] * m1
    hand = s.number("predictor.hand_mass")[:, :, None] * (transposed(jacobian) @ jacobian)
    return np.stack([light, light + hand], axis=1)


@dataclass(frozen=True)
class Seen:
    """Place and prediction of the active predictor, as far as the rows' torques tell them."""

    x: Array  # (N, n) [rad]
    w: Array
    known: Array  # bool (N,)


@dataclass(frozen=True)
class _Model:
    """The device as both predictors model it, for every row."""

    m1: Array
    c1: Array
    jacobian: Array
    mp: Array  # Mp (N, 2, n, n)
    mt: Array  # Mp theta^-1/T
    d0: Array
    ahead: Array  # theta^-1 (N, n)
    p: Array  # as Gains have it
    jump: Array  # as Prediction has it
    rest: Array  # rate of the force of a hand at rest (N,) [N/s]
    levers: Array  # acceleration by a force at the tip, of both predictors (N, 2, n)


def _model_at(s: Session, x: Array, v: Array, m2: Array, quick: Array) -> _Model:
    """The model with the device at `x`; M2 of the proxy is given."""
    g = gains(s)
    m1, c1 = _model(s, x, v)
    jacobian, ahead = tip_jacobian(s.chain, x), _ahead(s, m1, quick)
    mp = _masses(s, jacobian, m1, g.mu)
    mt = mp * ahead[:, None, None, :] / s.tick
    d0 = mt + (c1 + np.eye(s.dof) * s.damping[:, :, None])[:, None]
    step = s.number("device.encoder_step")[:, 0]
    rest = resting_rate(stiffest(s), Tip.of(jacobian, m1 + m2), step)
    on_tip = np.linalg.solve(m1 + m2, transposed(jacobian))
    hand = s.number("predictor.hand_mass")[:, :, None]
    carried = on_tip @ np.linalg.inv(np.eye(3) + hand * (jacobian @ on_tip))
    levers = np.linalg.norm(np.stack([on_tip, carried], axis=1), axis=3)
    late = s.number("model.delay")[:, 0] * s.tick
    jump = np.where(np.isnan(g.p), weighed_jump(rest * np.max(levers[:, 0], axis=1), step, late, s.tick),
                    faded_jump(g.p, step, s.tick))  # fmt: skip
    return _Model(m1, c1, jacobian, mp, mt, d0, ahead, g.p, jump, rest, levers)


@dataclass(frozen=True)
class _Input:
    """Input of the recursion, for every row."""

    y: Array
    tau: Array  # torque that left for the motors
    delay: Array  # known delay (N,) [ticks]
    step: Array  # of the encoders (N,) [rad]
    both: Array  # bool (N,): the heavy predictor exists
    quick: Array  # bool (N,)
    tick: float
    seen: Seen | None
    confirmed: Array  # filled in

    def recur(self, pair: _Pair, rows: range, model: _Model) -> tuple[Array, ...]:
        """x, v, f, w, x and v where the torque meets the device, and the number of the active
        predictor at these rows; advances `pair`."""
        t, keep = self.tick, float(np.exp(-self.tick / _FORGETTING))
        inverse = np.linalg.inv(model.d0)
        out = np.zeros((6, len(rows), self.y.shape[1]))
        heavy = np.zeros(len(rows), dtype=bool)
        for i, k in enumerate(rows):
            ahead, stayed = model.ahead[i], pair.active
            if k > 0:  # the first reading is where the device is taken to be
                change = pair.correct(self.y[k] - pair.x, model.p[i], self.step[k], t, keep,
                                      bool(self.both[k]))  # fmt: skip
                pair.f = pair.f + (model.mp[i] @ change[..., None])[..., 0]

            def mean(v: Array, tau: Array, i: int = i) -> Array:
                push = (model.mt[i] @ v[..., None])[..., 0] + pair.f + tau
                return (inverse[i] @ push[..., None])[..., 0]

            w, met_x, met_v = None, pair.x, pair.v
            for sent in range(k - self.delay[k], k):
                mean_then = mean(met_v, self.tau[sent] if sent >= 0 else 0 * self.tau[0])
                w = mean_then if w is None else w
                met_x, met_v = met_x + t * mean_then, met_v + ahead * (mean_then - met_v)
            w = mean(met_v, self.tau[k]) if w is None else w
            if self.seen is not None and self.seen.known[k]:
                off = self._off(k, pair.x, w)
                if self.both[k]:
                    pair.active = stayed if off[stayed] < _SAME else int(np.argmin(off))
                a = pair.active
                self.confirmed[k] = off[a] < _SAME
                out[:, i] = pair.x[a], pair.v[a], pair.f[a], w[a], met_x[a], met_v[a]
                self._believe(k, pair, w, model.mt[i, a], model.d0[i, a])
            else:
                a = pair.active
                out[:, i] = pair.x[a], pair.v[a], pair.f[a], w[a], met_x[a], met_v[a]
            heavy[i] = a == 1
            speed = np.linalg.norm(pair.v @ model.jacobian[i].T, axis=1)
            pair.rate = (model.rest[i] + HELD * speed)[:, None] * model.levers[i]
            pair.x = pair.x + t * w
            pair.v = pair.v + ahead * (w - pair.v)
        return *out, heavy

    def _off(self, k: int, x: Array, w: Array) -> Array:
        """Distance of each predictor from the observed place (2,) [rad]."""
        return np.max(np.abs(x - self.seen.x[k]) + self.tick * np.abs(w - self.seen.w[k]), axis=1)

    def _believe(self, k: int, pair: _Pair, w: Array, mt: Array, d0: Array) -> None:
        """Takes over the observed state. It tells x and w, but of v and f only mt v + f; each gets
        half of the sum's error, so both are right after two rows."""
        a = pair.active
        half = d0 @ (self.seen.w[k] - w[a]) / 2
        pair.f[a] += half
        pair.v[a] += np.linalg.solve(mt, half)
        pair.x[a], w[a] = self.seen.x[k], self.seen.w[k]


def _input(s: Session, seen: Seen | None = None) -> tuple[_Input, _Pair]:
    """Input of the recursion, and the pair at the first row."""
    given = _Input(s["/device/measured_position"], s.law_torque,
                   s.number("model.delay")[:, 0].astype(int),
                   s.number("device.encoder_step")[:, 0],
                   s.number("predictor.hand_mass")[:, 0] > 0, _quick(s), s.tick, seen,
                   np.zeros(len(s), dtype=bool))  # fmt: skip
    start = (s[f"/{name}"][0] for name in ("device/measured_position", "device/velocity",
                                           "hand/torque_estimate"))  # fmt: skip
    known = np.tile(np.diag([1e-8, 1.0, 1e4]), (2, s.dof, 1, 1))
    state = [np.tile(value, (2, 1)) for value in start]
    return given, _Pair(*state, np.zeros(2), known, np.zeros((2, s.dof)))


def _apart(s: Session, a: tuple[Array, Array], b: tuple[Array, Array]) -> float:
    return max(np.max(np.abs(a[0] - b[0])), s.tick * np.max(np.abs(a[1] - b[1])))


_Fields = tuple[Array, ...]  # those of Prediction up to d0


def _fields(model: _Model, moved: tuple[Array, ...]) -> _Fields:
    each, which = np.arange(len(moved[0])), moved[-1].astype(int)
    return (*moved, model.jump, model.ahead, model.jacobian, model.m1, model.c1,
            model.mt[each, which], model.d0[each, which])  # fmt: skip


def _window(s: Session, m2: Array, given: _Input, pair: _Pair, rows: range) -> tuple[_Pair, _Fields]:
    """The pair after these rows, and the fields of the rows."""
    which = slice(rows.start, rows.stop)
    part = s.rows(which)
    x, v = given.y[which], np.tile(pair.v[pair.active], (len(rows), 1))
    for _ in range(_ROUNDS):
        model = _model_at(part, x, v, m2[which], given.quick[which])
        after, before = copy.copy(pair), (x, v)
        moved = given.recur(after, rows, model)
        x, v = moved[:2]
        if _apart(s, (x, v), before) < _SETTLED:
            break
    return after, _fields(model, moved)


def _prediction(s: Session, fields: _Fields, w: Array, confirmed: Array) -> Prediction:
    surprise = np.diff(s["/device/measured_position"], axis=0, prepend=0)
    surprise[0] = 0
    surprise[1:] -= s.tick * w[:-1]
    return Prediction(*fields, surprise, confirmed)


def predict(s: Session, m2: Array) -> Prediction:
    """Both predictors over a whole session with this law from the first row on; M2 of the proxy (N,
    n, n)."""
    given, pair = _input(s)
    parts = []
    for begin in range(0, len(s), _WINDOW):
        rows = range(begin, min(begin + _WINDOW, len(s)))
        pair, part = _window(s, m2, given, pair, rows)
        parts.append(part)
    fields = tuple(np.concatenate(field) for field in zip(*parts))
    return _prediction(s, fields, fields[3], given.confirmed)


def unseen(s: Session, m2: Array) -> Prediction:
    """A first guess: the model at the readings, at rest."""
    y = s["/device/measured_position"]
    return _from(s, m2, y, 0 * y, Seen(y, y, np.zeros(len(s), dtype=bool)))


def predict_seen(s: Session, m2: Array, model: Prediction, seen: Seen) -> tuple[Prediction, float]:
    """Predicts every row from the observed state of the row before, with the model at `model`; also
    returns how far from there the prediction leads."""
    p = _from(s, m2, model.x, model.v, seen)
    return p, _apart(s, (p.x, p.v), (model.x, model.v))


def _from(s: Session, m2: Array, x: Array, v: Array, seen: Seen) -> Prediction:
    given, pair = _input(s, seen)
    model = _model_at(s, x, v, m2, given.quick)
    moved = given.recur(pair, range(len(s)), model)
    used = np.where(seen.known[:, None], seen.w, moved[3])
    return _prediction(s, _fields(model, moved), used, given.confirmed)
