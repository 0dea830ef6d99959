"""Inertia M(x) and Coriolis matrix C(x, v) of a chain, for many configurations at once.

M is assembled from the Jacobians of the bodies' centres of mass. Its derivatives are taken by the
complex step, M(x + i h e_j) / h, exact to round-off because M is analytic in x and no difference
is formed. C is the one of the Christoffel symbols, so that Mdot - 2 C is skew:

    C_ij = sum_k (dM_ij/dx_k + dM_ik/dx_j - dM_jk/dx_i) v_k / 2
         = (Mdot + P - P^T)_ij / 2,        P_ij = sum_k dM_ik/dx_j v_k

Arrays are shaped (rows, n) for configurations and (rows, n, n) for matrices. SI and radians.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from .urdf import SLIDE_UNIT, Array, Chain

Field = NDArray[Any]  # float64, or complex128 inside a complex step

_STEP = 1e-40  # any size does, as long as its square vanishes beside 1
_CHUNK_DOUBLES = 4_000_000  # largest temporary, keeps long sessions in the cache


def _skew(a: Array) -> Array:
    return np.array([[0, -a[2], a[1]], [a[2], 0, -a[0]], [-a[1], a[0], 0]])


def _rotate(matrix: Field, other: Field) -> Field:
    """Rotation matrices (rows, 3, 3) times a constant (3, k) or another stack."""
    return np.einsum("rij,jk->rik" if other.ndim == 2 else "rij,rjk->rik", matrix, other)


def _frames(chain: Chain, x: Field) -> tuple[list[Field], list[Field], list[Field]]:
    """Rotation (rows, 3, 3), origin (rows, 3) and axis (rows, 3) of every moving frame."""
    rows = len(x)
    rotation: Field = np.broadcast_to(np.eye(3, dtype=x.dtype), (rows, 3, 3))
    origin: Field = np.zeros((rows, 3), dtype=x.dtype)
    rotations, origins, axes = [], [], []
    for i, joint in enumerate(chain.joints):
        origin = origin + rotation @ joint.origin.translation
        fixed = _rotate(rotation, joint.origin.rotation)
        axes.append(fixed @ joint.axis)
        if joint.slides:
            rotation = fixed
            origin = origin + SLIDE_UNIT * x[:, i, None] * axes[i]
            rotations.append(rotation)
            origins.append(origin)
            continue
        # Rodrigues: R(x) = I + sin(x) [a] + (1 - cos(x)) [a]^2
        cross = _skew(joint.axis)
        sine, versine = np.sin(x[:, i]), 1 - np.cos(x[:, i])
        turn = (
            np.eye(3)
            + sine[:, None, None] * cross
            + versine[:, None, None] * (cross @ cross)
        )
        rotation = _rotate(fixed, turn)
        rotations.append(rotation)
        origins.append(origin)
    return rotations, origins, axes


def tip_position(chain: Chain, x: Array) -> Array:
    """Tip (rows, 3) [m] in the base frame for configurations (rows, n)."""
    rotations, origins, _ = _frames(chain, x)
    return origins[-1] + rotations[-1] @ chain.tip.translation


def tip_jacobian(chain: Chain, x: Array) -> Array:
    """Translational Jacobian (rows, 3, n) of the tip [m/rad]."""
    _, origins, axes = _frames(chain, x)
    tip = tip_position(chain, x)
    columns = [
        SLIDE_UNIT * a if joint.slides else np.cross(a, tip - o)
        for joint, a, o in zip(chain.joints, axes, origins)
    ]
    return np.stack(columns, axis=-1)


def _inertia_factor(inertia: Array) -> Array:
    """F with F^T F = inertia, for a positive semidefinite inertia."""
    values, vectors = np.linalg.eigh(inertia)
    return np.sqrt(np.clip(values, 0, None))[:, None] * vectors.T


def _inertia(chain: Chain, x: Field) -> Field:
    """M(x) = A^T A with a block of six rows of A per body: sqrt(m) J_v and I^(1/2) J_omega."""
    rotations, origins, axes = _frames(chain, x)
    blocks = np.zeros((len(x), 6 * len(chain.bodies), chain.dof), dtype=x.dtype)
    for b, body in enumerate(chain.bodies):
        rotation = rotations[body.joint]
        centre = origins[body.joint] + rotation @ body.pose.translation
        # J_omega in the body's principal axes: rows of the factor, turned into the base frame
        factor = _inertia_factor(body.inertia) @ body.pose.rotation.T
        to_body = np.einsum("ij,rkj->rik", factor, rotation)
        top = slice(6 * b, 6 * b + 3)
        bottom = slice(6 * b + 3, 6 * b + 6)
        for i in range(body.joint + 1):
            if chain.joints[i].slides:
                blocks[:, top, i] = np.sqrt(body.mass) * SLIDE_UNIT * axes[i]
                continue
            arm = np.sqrt(body.mass) * (centre - origins[i])
            blocks[:, top, i] = np.cross(axes[i], arm)
            blocks[:, bottom, i] = np.einsum("rij,rj->ri", to_body, axes[i])
    return np.matmul(blocks.transpose(0, 2, 1), blocks)


def _coriolis(chain: Chain, x: Array, v: Array) -> Array:
    n = chain.dof
    mdot = np.imag(_inertia(chain, x + 1j * _STEP * v)) / _STEP
    p = np.empty((len(x), n, n))
    for j in range(n):
        shifted = x.astype(np.complex128)
        shifted[:, j] += 1j * _STEP
        derivative = np.imag(_inertia(chain, shifted)) / _STEP  # dM/dx_j
        p[:, :, j] = np.einsum("rik,rk->ri", derivative, v)
    return (mdot + p - p.transpose(0, 2, 1)) / 2


def _chunks(chain: Chain, rows: int) -> list[slice]:
    size = max(1, _CHUNK_DOUBLES // (6 * len(chain.bodies) * chain.dof))
    return [slice(start, start + size) for start in range(0, rows, size)]


def inertia(chain: Chain, x: Array) -> Array:
    """M (rows, n, n) [kg m^2] at configurations x (rows, n)."""
    x = np.asarray(x, dtype=np.float64)
    return np.concatenate([_inertia(chain, x[part]) for part in _chunks(chain, len(x))])


def coriolis(chain: Chain, x: Array, v: Array) -> Array:
    """C (rows, n, n) [N m s/rad] of the Christoffel symbols at (x, v), each (rows, n)."""
    x, v = np.asarray(x, dtype=np.float64), np.asarray(v, dtype=np.float64)
    return np.concatenate([_coriolis(chain, x[p], v[p]) for p in _chunks(chain, len(x))])
