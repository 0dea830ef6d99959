"""Memory of the predictors: an encoder's steps, which reach the tip through a wall, ask for a long
one, the wall itself for a short one. Also the damper of a wall, which an encoder's steps excite as
well. SI; stacks over rows."""

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
_LONGEST = 0.85  # longest memory that is chosen
_QUIET = 1e-4  # bound of the change of the tip's velocity by an encoder's step [m/s]
_LIGHT, _FULL = 0.02, 0.04  # masses at which the effect begins, and is complete [kg]


def jump(p: Array, step: Array, tick: float) -> Array:
    """Jump of a joint's predicted velocity at a step of its encoder [rad/s]."""
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


def _with_jump(share: Array) -> Array:
    """p of (1 - p)^2 (1 + p) = share, in [0, 1]: the middle root of the cubic, by its cosine."""
    angle = (2 * np.pi - np.arccos(27 / 16 * share - 1)) / 3
    return (1 + 4 * np.cos(angle)) / 3


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


def chosen(stiffness: float, tip: Tip, step: Array, least: Array, part: Array, tick: float) -> Array:
    """p of the tick after each row (N,), from `least` on."""
    if stiffness <= 0:
        return least
    # without memory: the force by a step, and the tip's motion by that force in a tick
    force = stiffness * tick / 2 + own_damper(stiffness, tip.mass, part, 0 * step, tick)
    force = force * jump(0 * least, step, tick) * tip.lever
    shaken = force * tick / tip.mass
    share = np.minimum(_QUIET / np.where(shaken > 0, shaken, _QUIET), 1)
    quiet = np.where(share < 1, np.clip(_with_jump(share), least, 1), least)
    counts = np.clip((tip.mass - _LIGHT) / (_FULL - _LIGHT), 0, 1)
    short = np.minimum(_LONGEST, 1 - tick * np.sqrt(stiffness / tip.mass))
    needed = np.minimum(least + counts * (quiet - least), short)
    return np.where(step > 0, np.maximum(least, needed), least)
