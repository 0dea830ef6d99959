"""A small, slow simulation of the paper's loop that writes a session file as the contract says.

It exists to test the verification: a session that obeys the equations must pass every check, and
one that breaks a single rule must fail. Explicit substeps for the arm, the midpoint rule of the
theory for the proxy, one contact plane on the proxy's tip. SI and radians.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import h5py
import numpy as np

from limpid_check.decomposition import feedforward
from limpid_check.dynamics import coriolis, inertia, tip_jacobian, tip_position
from limpid_check.session import DATASETS
from limpid_check.urdf import Array, Chain, parse_chain

_SUBSTEPS = 4


@dataclass
class Setup:
    urdf: str
    start: Array  # joint angles (n,)
    proposed: bool = True
    eta: float = 1.0
    alpha: float = 0.035
    k_vc: float = 10.0
    b_vc: float = 0.001
    b_v: float = 0.012
    inertia_ratio: float = 5e-4  # so large that its energy is above round-off
    torque_limit: float = 20.0
    tick: float = 1e-3
    rows: int = 500
    stroke: Array = field(default_factory=lambda: np.array([0.0, -0.03, 0.0]))  # of the hand [m]
    depth: float = 0.02  # depth of the stroke's end below the plane [m]
    plane_stiffness: float = 600.0
    hand_stiffness: float = 300.0
    hand_damping: float = 2.0

    def config(self) -> str:
        return (
            f'[coupling]\nkind = "{"proposed" if self.proposed else "standard"}"\n'
            f"k_vc = {self.k_vc!r}\nb_vc = {self.b_vc!r}\nb_v = {self.b_v!r}\n"
            f"[proxy]\ninertia_ratio = {self.inertia_ratio!r}\n"
            f"[device]\ntorque_limit = {self.torque_limit!r}\n"
        )


class _Proxy:
    """x2 and nu = R^T v2 with M2 = R R^T: |nu|^2 / 2 is the kinetic energy."""

    def __init__(self, setup: Setup, chain: Chain) -> None:
        self.setup, self.chain = setup, chain
        self.x, self.nu = setup.start.copy(), np.zeros(chain.dof)
        base = tip_position(chain, self.x[None])[0]
        self.normal = -setup.stroke / np.linalg.norm(setup.stroke)
        self.point = base + setup.stroke + setup.depth * self.normal
        self.refresh()

    def refresh(self) -> None:
        """M2, C2 and v2 at the present state."""
        self.m = self.setup.inertia_ratio * inertia(self.chain, self.x[None])[0]
        self.r = np.linalg.cholesky(self.m)
        self.v = np.linalg.solve(self.r.T, self.nu)
        self.c = self.setup.inertia_ratio * coriolis(self.chain, self.x[None], self.v[None])[0]

    def _shuffle(self) -> Array:
        """W = Rdot^T R^-T - R^-1 C R^-T, skew."""
        r_inverse = np.linalg.inv(self.r)
        turned = r_inverse @ (self.c + self.c.T) @ r_inverse.T
        lower = np.tril(turned, -1) + np.diag(np.diag(turned)) / 2
        w = (self.r @ lower).T @ r_inverse.T - r_inverse @ self.c @ r_inverse.T
        return (w - w.T) / 2

    def _mean_velocity(self, pull: Array, springs: Array) -> Array:
        """vbar2 from the midpoint rule under the torque pull - springs vbar2."""
        t, r = self.setup.tick, self.r
        left = (2 / t * np.eye(len(pull)) - self._shuffle()) @ r.T + np.linalg.solve(r, springs)
        return np.linalg.solve(left, 2 / t * self.nu + np.linalg.solve(r, pull))

    def advance(self, pull: Array, springs: Array, on_contact: Array) -> tuple[Array, Array]:
        """vbar2 and f2; the total torque is pull - springs vbar2 + on_contact f2."""
        k, t = self.setup.plane_stiffness, self.setup.tick
        jacobian = tip_jacobian(self.chain, self.x[None])[0]
        tip = tip_position(self.chain, self.x[None])[0]
        gradient = -jacobian.T @ self.normal  # gradient of the depth
        depth = -self.normal @ (tip - self.point)
        vbar = self._mean_velocity(pull, springs)
        f2 = np.zeros_like(pull)
        if depth + t / 2 * gradient @ vbar > 0:
            stiffness = k * t / 2 * np.outer(on_contact @ gradient, gradient)
            still = pull - k * depth * (on_contact @ gradient)
            vbar = self._mean_velocity(still, springs + stiffness)
            f2 = -k * (depth + t / 2 * gradient @ vbar) * gradient
        self.nu = 2 * self.r.T @ vbar - self.nu
        self.x = self.x + t * vbar
        self.refresh()
        return vbar, f2


class _Arm:
    """The device with a hand at its tip."""

    def __init__(self, setup: Setup, chain: Chain) -> None:
        self.setup, self.chain = setup, chain
        self.x, self.v = setup.start.copy(), np.zeros(chain.dof)
        self.damping = np.array([joint.damping for joint in chain.joints])

    def advance(self, motor: Array, target: Array, velocity: Array) -> Array:
        """One tick under a held torque; returns the hand's mean torque [N m]."""
        h = self.setup.tick / _SUBSTEPS
        mean = np.zeros_like(motor)
        for _ in range(_SUBSTEPS):
            x, v = self.x[None], self.v[None]
            jacobian = tip_jacobian(self.chain, x)[0]
            force = self.setup.hand_stiffness * (target - tip_position(self.chain, x)[0])
            force += self.setup.hand_damping * (velocity - jacobian @ self.v)
            hand = jacobian.T @ force
            net = motor + hand - self.damping * self.v - coriolis(self.chain, x, v)[0] @ self.v
            self.v = self.v + h * np.linalg.solve(inertia(self.chain, x)[0], net)
            self.x = self.x + h * self.v
            target = target + h * velocity
            mean += hand / _SUBSTEPS
        return mean


def _couple(setup: Setup, arm: _Arm, proxy: _Proxy, v1: Array, vbar2: Array, f1: Array) -> tuple[
    Array, Array, Array
]:
    """One tick of (1), (2), (14), (15): tau1, tau2, f2. Advances the proxy."""
    x1, x2, n = arm.x.copy(), proxy.x.copy(), arm.chain.dof
    m1 = inertia(arm.chain, x1[None])
    state = dict(
        m1=m1, c1=coriolis(arm.chain, x1[None], v1[None]), m2=proxy.m[None], c2=proxy.c[None],
        v1=v1[None], v2=proxy.v[None], eta=np.array([setup.eta]),
    )  # fmt: skip

    def extra(f2: Array) -> tuple[Array, Array]:
        if not setup.proposed:
            return np.zeros(n), np.zeros(n)
        both = feedforward(f1=f1[None], f2=f2[None], **state)
        return both[0][0], both[1][0]

    plain = extra(np.zeros(n))[1]
    on_contact = np.eye(n) + np.stack([extra(e)[1] - plain for e in np.eye(n)], axis=1)
    pull = setup.b_vc * v1 - setup.k_vc * (x2 - x1) + plain
    springs = (setup.b_v + setup.b_vc + setup.k_vc * setup.tick / 2) * np.eye(n)
    mean, f2 = proxy.advance(pull, springs, on_contact)
    extra1, extra2 = extra(f2)
    tau1 = -setup.b_vc * (v1 - vbar2) - setup.k_vc * (x1 - x2) + extra1
    tau2 = -setup.b_v * mean - setup.b_vc * (mean - v1)
    tau2 = tau2 - setup.k_vc * ((x2 + proxy.x) / 2 - x1) + extra2
    return tau1, tau2, f2


def simulate(setup: Setup) -> dict[str, Array]:
    """Rows by dataset path."""
    chain = parse_chain(setup.urdf)
    arm, proxy = _Arm(setup, chain), _Proxy(setup, chain)
    n, t = chain.dof, setup.tick
    shape = {1: (setup.rows,), 3: (setup.rows, 3), 0: (setup.rows, n)}
    rows = {path: np.zeros(shape[columns]) for path, columns in DATASETS.items()}
    base = tip_position(chain, setup.start[None])[0]
    before, vbar2, z, energy = arm.x.copy(), np.zeros(n), np.zeros(n), np.zeros(2)
    for k in range(setup.rows):
        omega = 4 * np.pi / (setup.rows * t)  # two strokes
        target = base + setup.stroke * (1 - np.cos(omega * k * t)) / 2
        speed = setup.stroke * omega * np.sin(omega * k * t) / 2
        x1, x2, v2, nu = arm.x.copy(), proxy.x.copy(), proxy.v.copy(), proxy.nu.copy()
        v1 = (x1 - before) / t
        f1 = z + setup.alpha * v1
        tau1, tau2, f2 = _couple(setup, arm, proxy, v1, vbar2, f1)
        motor = np.clip(tau1, -setup.torque_limit, setup.torque_limit)
        m1, c1 = inertia(chain, x1[None])[0], coriolis(chain, x1[None], v1[None])[0]
        values, vectors = np.linalg.eigh(m1)
        step = vectors @ np.diag(1 - np.exp(-setup.alpha * t / values)) @ vectors.T
        true_v1 = arm.v.copy()
        hand = arm.advance(motor, target, speed)
        values_of = {
            "/time": k * t, "/device/position": x1, "/device/velocity": true_v1,
            "/device/measured_position": x1, "/device/measured_velocity": v1,
            "/device/commanded_torque": tau1, "/device/motor_torque": motor,
            "/proxy/position": x2, "/proxy/velocity": v2, "/proxy/torque": tau2,
            "/proxy/contact_torque": f2, "/hand/target": target, "/hand/torque": hand,
            "/hand/torque_estimate": f1, "/coupling/kind": float(setup.proposed),
            "/coupling/eta": setup.eta, "/coupling/alpha": setup.alpha,
            "/energy/controller_total": energy[0], "/energy/controller_commanded": energy[1],
            "/energy/proxy_kinetic": nu @ nu / 2,
        }  # fmt: skip
        for path, value in values_of.items():
            rows[path][k] = value
        z = z + step @ (c1 @ v1 - (motor - arm.damping * v1) - setup.alpha * v1 - z)
        dx1, vbar2, before = arm.x - x1, (proxy.x - x2) / t, x1
        work = motor @ dx1 + tau2 @ (proxy.x - x2)
        energy = energy + np.array([work - arm.damping / t @ (dx1 * dx1), work])
    rows["/coupling/kind"] = rows["/coupling/kind"].astype(np.uint8)
    return rows


def write(path: Path, setup: Setup, rows: dict[str, Array]) -> None:
    """A closed session file."""
    with h5py.File(path, "w") as file:
        for name, values in rows.items():
            file[name] = values
        file.attrs.update(
            {
                "format": "limpid-session", "version": 1, "tick": setup.tick,
                "dof": rows["/device/position"].shape[1], "created": "2024-01-01T00:00:00Z",
                "app_version": "0", "seed": 0, "source": "reference", "config": setup.config(),
                "device_urdf": setup.urdf, "scene": "",
            }
        )  # fmt: skip
