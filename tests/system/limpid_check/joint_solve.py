"""Device and proxy of the predictive coupling, solved together for a tick: step (6) of the design
sheet, and where motors are at their limit.

Stacks over rows. The unknown is (w, u), the mean velocities of device and proxy over the tick; all
of it is linear in them and in the contact torque f2. SI and radians.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from .decomposition import apply, transposed
from .dynamics import coriolis, inertia
from .predictor import Prediction
from .reserve import Reserve
from .session import Session
from .urdf import Array

STILL_PULLED = 0.02  # of the limit: a spring that pulls more keeps the next tick limited


@dataclass(frozen=True)
class Proxy:
    """M2 at x2, C2 and S2 at (x2, v2) of every row."""

    m: Array
    c: Array
    skew: Array


def proxy_dynamics(s: Session) -> Proxy:
    """With M2 = R R^T, nu = R^T v and nu' = W nu + R^-1 tau, the midpoint rule reads
    (2/T M2 + S2) u = 2/T M2 v2 + tau, S2 = -R W R^T."""
    ratio = s.number("proxy.inertia_ratio")[:, :, None]
    x, v = s["/proxy/position"], s["/proxy/velocity"]
    m, c = ratio * inertia(s.chain, x), ratio * coriolis(s.chain, x, v)
    r = np.linalg.cholesky(m)
    inverse = np.linalg.inv(r)
    turned = inverse @ (c + transposed(c)) @ transposed(inverse)
    rate = np.tril(turned, -1) + np.eye(s.dof) * turned / 2
    w = transposed(r @ rate) @ transposed(inverse) - inverse @ c @ transposed(inverse)
    return Proxy(m, c, -r @ ((w - transposed(w)) / 2) @ transposed(r))


@dataclass(frozen=True)
class Affine:
    """A torque as a function of w, u and f2."""

    w: Array
    u: Array
    f2: Array
    rest: Array

    def at(self, w: Array, u: Array, f2: Array) -> Array:
        return apply(self.w, w) + apply(self.u, u) + apply(self.f2, f2) + self.rest


@dataclass(frozen=True)
class Law:
    """tau1 = tE + tL and tau2 of the sheet."""

    authority: Array  # share of tau1 that leaves for the motors (N, 1)
    shared: Affine  # C_LE v_E + u_N - K_N w, shared between the sides
    spring: Affine  # tE
    locked: Affine  # tL
    proxy: Affine  # tau2


def _fed_forward(s: Session, p: Prediction) -> Array:
    """Share of the hand's observed torque that is fed forward (N,): with it, by Routh's criterion,
    no hand's mass makes device and proxy swing against each other."""
    k_vc, b_vc, delay = (
        s.number(key)[:, 0] for key in ("coupling.k_vc", "coupling.b_vc", "model.delay")
    )
    alpha = s["/coupling/alpha"]
    own = np.trace(p.m1, axis1=1, axis2=2)
    ratio = s.number("proxy.inertia_ratio")[:, 0]
    lag = own / alpha + (1.5 + delay) * s.tick
    most = b_vc * (1 / (b_vc + k_vc * lag) + 1 / (ratio * alpha))
    return np.minimum(1, most * (1 + ratio) / ratio)


def law(s: Session, p: Prediction, proxy: Proxy, r: Reserve) -> Law:
    one = np.broadcast_to(np.eye(s.dof), p.m1.shape)
    k_vc, b_vc = (s.number(f"coupling.{name}") for name in ("k_vc", "b_vc"))
    phi = np.linalg.solve(p.m1 + proxy.m, proxy.m)
    phi_t = transposed(phi)
    c_le = transposed(proxy.c) - transposed(p.c1 + proxy.c) @ phi
    c_el = -transposed(c_le)
    c = (b_vc + k_vc * s.tick / 2)[:, :, None] * one
    s0 = k_vc * (p.met_x - s["/proxy/position"])
    gf = r.governor[:, None, None] * one
    f1 = _fed_forward(s, p)[:, None] * apply(phi_t, s["/hand/torque_estimate"])
    # v_E = w - u, v_L = (1 - phi) w + phi u
    spring = Affine(c_el @ (one - phi) - c, c + c_el @ phi, gf - phi_t, -s0 - f1)
    shared = Affine(c_le - r.k_n, -c_le, 0 * one, r.u_n)
    locked = Affine(
        (one - phi_t) @ shared.w - r.b_w[:, :, None] * one,
        (one - phi_t) @ shared.u,
        0 * one,
        apply(one - phi_t, shared.rest),
    )
    tau2 = Affine(
        c - c_el @ (one - phi) + phi_t @ shared.w,
        phi_t @ shared.u - c - c_el @ phi,
        phi_t - gf,
        s0 + apply(phi_t, shared.rest) + f1,
    )
    return Law(r.torque_governor[:, None], shared, spring, locked, tau2)


@dataclass(frozen=True)
class Solved:
    """Solution of every row."""

    w: Array
    u: Array
    f2: Array
    tau1: Array  # torque that leaves for the motors
    tau2: Array
    over: Array  # (N,) bool: a motor would have to pass its limit
    on: Array  # (N,) bool: the next tick has limits as well, if this one has


# z0's u (N, n) and Z's u (N, n, n), the motion by a unit of each torque -> f2 (N, n)
ContactSolve = Callable[[Array, Array], Array]


def _system(p: Prediction, proxy: Proxy, the: Law, drive: Array, momentum: Array, tick: float) -> (
    tuple[Array, Array, Array]
):
    """A (N, 2n, 2n), b (N, 2n) and the columns of f2 (N, 2n, n), no motor at its limit."""
    share = the.authority[:, :, None]
    tau1_w, tau1_u = share * (the.spring.w + the.locked.w), share * (the.spring.u + the.locked.u)
    a = np.block(
        [[p.d0 - tau1_w, -tau1_u],
         [-the.proxy.w, 2 / tick * proxy.m + proxy.skew - the.proxy.u]]
    )  # fmt: skip
    b = np.concatenate(
        [drive + the.authority * (the.spring.rest + the.locked.rest), momentum + the.proxy.rest],
        axis=1,
    )
    h = np.concatenate([share * the.spring.f2, the.proxy.f2 + np.eye(drive.shape[1])], axis=1)
    return a, b, h


def solve(s: Session, p: Prediction, proxy: Proxy, the: Law, contact: ContactSolve) -> Solved:
    """(6) to (8) without limits: everything that a tick computes from the state before it."""
    n, limit = s.dof, s.law_limit
    drive, momentum = p.drive, 2 / s.tick * apply(proxy.m, s["/proxy/velocity"])
    a, b, h = _system(p, proxy, the, drive, momentum, s.tick)
    z = np.linalg.solve(a, np.concatenate([b[:, :, None], h], axis=2))
    f2 = contact(z[:, n:, 0], z[:, n:, 1:])
    both = z[:, :, 0] + apply(z[:, :, 1:], f2)
    w, u = both[:, :n], both[:, n:]
    spring, locked = the.spring.at(w, u, f2), the.locked.at(w, u, f2)
    tau1 = the.authority * np.clip(np.clip(spring, -limit, limit) + locked, -limit, limit)
    over = np.any(np.abs(spring) > limit, axis=1)
    return Solved(w, u, f2, tau1, the.proxy.at(w, u, f2), over, 0 * over)


def solve_limited(s: Session, p: Prediction, the: Law, u: Array, f2: Array) -> Solved:
    """A tick with motors at their limit, law_mend.md 1, from the torque that left and the proxy's
    motion: the torques must reproduce those they started from."""
    limit, none = s.law_limit, 0 * f2
    k_vc, b_vc, b_v = (s.number(f"coupling.{name}") for name in ("k_vc", "b_vc", "b_v"))
    w = np.linalg.solve(p.d0, (p.drive + s["/device/commanded_torque"])[:, :, None])[:, :, 0]
    stiffer = np.maximum(k_vc * s.tick / 2 - b_vc, 0)
    pull = np.clip(the.spring.at(w, u, f2) - stiffer * (w - u), -limit, limit)
    rest = the.proxy.at(w, u, none) + the.spring.at(w, u, none)
    tau1 = the.authority * np.clip(pull + the.locked.at(w, u, f2), -limit, limit)
    apart = k_vc * (p.met_x - s["/proxy/position"] + s.tick * (w - u))
    on = np.any((np.abs(pull) >= limit) | (np.abs(apart) > STILL_PULLED * limit), axis=1)
    return Solved(w, u, f2, tau1, rest - pull - b_v * u, 0 * on, on)
