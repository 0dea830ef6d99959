"""An encoder's steps: how quick a filter weighs them, by how much it makes the velocity jump, and the
damper of a wall, which that jump excites. SI; stacks over rows."""

from __future__ import annotations

import functools
import tomllib
from dataclasses import dataclass

import numpy as np

from .session import Session
from .urdf import Array

_SURFACES = ("plane", "sphere", "box", "mesh")
_STIFFNESS = 600.0  # default of a surface [N/m]
_PUSH = 0.05  # bound of a wall damper's force by an encoder's step [N]
_HAND = 10.0  # rate of the force of a hand at rest [N/s]
HELD = 200.0  # and what its speed adds [N/m]


def faded_jump(p: Array, step: Array, tick: float) -> Array:
    """Jump of a joint's predicted velocity at a step of its encoder, by a filter with memory p [rad/s]."""
    return 1.5 * (1 - p) ** 2 * (1 + p) * step / tick


def own_damper(stiffness: float, mass: Array, part: Array, jump_there: Array, tick: float) -> Array:
    """A wall's own damper [N s/m]: a part of m_n/T, reduced where that is large, so that a jump of
    the velocity pushes with _PUSH at most."""
    damper = np.minimum(part * mass / tick, np.sqrt(stiffness * mass))
    with np.errstate(divide="ignore"):
        return np.minimum(damper, np.where(jump_there > 0, _PUSH / jump_there, np.inf))


def stiffest(s: Session) -> float:
    """Largest stiffness of the scene's surfaces, 0 without any [N/m]."""
    return _stiffest(s.attributes["scene"])


@functools.cache
def _stiffest(text: str) -> float:
    scene = tomllib.loads(text)
    walls = [wall for name in _SURFACES for wall in scene.get(name, [])]
    return max((float(wall.get("stiffness", _STIFFNESS)) for wall in walls), default=0.0)


def _largest(symmetric: Array) -> Array:
    """The 8-norm of the eigenvalues (N,): nearly the largest one, and smooth."""
    values = np.linalg.eigvalsh(symmetric)
    size = np.sum(values, axis=1)
    return size * np.sum((values / size[:, None]) ** 8, axis=1) ** (1 / 8)


@dataclass(frozen=True)
class Tip:
    """Mass along the easiest direction [kg] and longest lever [m] of every row."""

    mass: Array
    lever: Array

    @staticmethod
    def of(jacobian: Array, locked: Array) -> Tip:
        turned = jacobian.transpose(0, 2, 1)
        return Tip(1 / _largest(jacobian @ np.linalg.solve(locked, turned)),
                   np.sqrt(_largest(jacobian @ turned)))  # fmt: skip


def resting_rate(stiffness: float, tip: Tip, step: Array) -> Array:
    """Rate of the force of a hand at rest (N,) [N/s]: on a wall the filter is as quick as that."""
    swings = np.sqrt(stiffness / tip.mass)  # [rad/s]
    return np.maximum(_HAND, tip.mass * swings**3 * step * tip.lever / np.sqrt(12))


def quickest(tick: float) -> float:
    """Largest bandwidth of a filter that weighs readings [rad/s]."""
    return 1.2 / tick


def weighed_jump(rate: Array, step: Array, late: Array, tick: float) -> Array:
    """The jump by a filter whose acceleration changes at this rate [rad/s^3], a time `late` later."""
    with np.errstate(divide="ignore", invalid="ignore"):
        w = np.minimum(np.cbrt(np.sqrt(12) * rate / step), quickest(tick))
        return np.where(step > 0, step * w * (1 + w * late), 0)
