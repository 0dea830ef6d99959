"""The force of one wall over a tick of the predictive coupling, step (7) of the design sheet, and
which scenes have no more than that."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass

import numpy as np

from .decomposition import apply
from .dynamics import tip_jacobian, tip_position
from .predictor import Prediction, gains
from .session import Session
from .steps import own_damper
from .urdf import Array

_OTHERS = ("sphere", "box", "mesh", "joint_contact", "probe")
_NEAR = 2e-3  # farther walls that are not approached are left out [m]
_MOST_DAMPING = 0.34  # of m_n/T, for the material's damper and the wall's own together


@dataclass(frozen=True)
class Wall:
    """Of every row: a frictionless plane and the tip."""

    stiffness: float
    damper: Array  # B (N,) [N s/m]
    depth: Array  # at x2 (N,) [m], positive inside
    push: Array  # N (N, n): joint torque of a unit force

    def potential(self) -> Array:
        return self.stiffness * np.maximum(self.depth, 0) ** 2 / 2


def only_wall(s: Session, p: Prediction, m2: Array) -> Wall | None:
    """The wall of a scene that holds nothing but one plane for the tip; else nothing."""
    scene = tomllib.loads(s.attributes["scene"])
    planes = scene.get("plane", [])
    if len(planes) != 1 or any(scene.get(name) for name in _OTHERS):
        return None
    (plane,) = planes
    if plane.get("friction_static", 0) or plane.get("friction_kinetic", 0):
        return None
    x2 = s["/proxy/position"]
    normal = np.array(plane["normal"], dtype=float)
    normal /= np.linalg.norm(normal)
    height = (tip_position(s.chain, x2) - np.array(plane["point"], dtype=float)) @ normal
    push = normal @ tip_jacobian(s.chain, x2)
    stiffness = float(plane.get("stiffness", 600))
    eased = np.linalg.solve(p.m1 + m2, push[:, :, None])[:, :, 0]
    mass = 1 / np.sum(push * eased, axis=1)  # m_n
    stepped = p.jump * np.linalg.norm(push, axis=1)
    damper = own_damper(stiffness, mass, gains(s).wall, stepped, s.tick) + plane.get("damping", 0)
    damper = np.minimum(damper, _MOST_DAMPING * mass / s.tick)
    depth = scene.get("tip_radius", 0) - height
    return Wall(stiffness, damper, depth, push)


def _kept(k: Array, b: Array, d: Array, a: Array, c: Array) -> Array:
    """Inside throughout; b stands for B/T."""
    return np.maximum((k * (d + a / 2) + b * a) / (1 + c * (k / 2 + b)), 0)


def _broken(k: Array, b: Array, d: Array, a: Array, c: Array) -> Array:
    h = a - c * b * d
    root = h * h + 4 * c * (a * b * d + k * d * d / 2)
    return np.where(root < 0, 0, np.maximum(h + np.sqrt(np.maximum(root, 0)), 0) / (2 * c))


def _made(k: Array, b: Array, d: Array, a: Array, c: Array) -> Array:
    s = d + a
    al = k * c * c / 2 + b * c * c + c
    be = k * s * c + b * (s + a) * c + a
    ga = k * s * s / 2 + b * s * a
    root = np.sqrt(np.maximum(be * be - 4 * al * ga, 0))
    return np.where(s > 0, 2 * ga / np.where(s > 0, be + root, 1), 0)


def wall_force(k: Array, b: Array, d: Array, a: Array, c: Array) -> Array:
    """F (N,) [N]: depth d, its change a - c F, stiffness k and damper per tick b = B/T."""
    kept = _kept(k, b, d, a, c)
    inside = np.where(d + a - c * kept >= 0, kept, _broken(k, b, d, a, c))
    return np.where(d >= 0, inside, _made(k, b, d, a, c))


def known_force(wall: Wall, u: Array, tick: float) -> Array:
    """f2 (N, n) where the proxy's motion is known: the change of depth D is, and F D is what the spring loses and the damper
    takes while inside."""
    k, b, d = np.full(len(u), wall.stiffness), wall.damper / tick, wall.depth
    change = -tick * np.sum(wall.push * u, axis=1)
    safe = np.where(change == 0, 1, change)
    end = d + change
    inside = k * (d + change / 2) + b * change
    breaks = -k * d * d / (2 * safe) - b * d
    makes = k * end * end / (2 * safe) + b * end
    force = np.where(d >= 0, np.where(end >= 0, inside, breaks), np.where(end > 0, makes, 0))
    return np.maximum(force, 0)[:, None] * wall.push


def contact_solve(wall: Wall, tick: float):
    """As a `joint_solve.ContactSolve`."""

    def solve(u0: Array, per_torque: Array) -> Array:
        c = tick * np.sum(wall.push * apply(per_torque, wall.push), axis=1)
        a = -tick * np.sum(wall.push * u0, axis=1)
        stiffness = np.full(len(c), wall.stiffness)
        force = wall_force(stiffness, wall.damper / tick, wall.depth, a, c)
        culled = (wall.depth < -_NEAR) & (a <= 0)
        return np.where(culled, 0, force)[:, None] * wall.push

    return solve
