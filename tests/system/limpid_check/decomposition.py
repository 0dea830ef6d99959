"""Passive decomposition (7)-(11) and the proposed coupling's feedforward (14)-(15).

Stacks over rows: vectors (rows, n), matrices (rows, n, n). SI and radians.
"""

from __future__ import annotations

import numpy as np

from .urdf import Array


def apply(matrix: Array, vector: Array) -> Array:
    """matrix[r] @ vector[r] for every row r."""
    return np.einsum("rij,rj->ri", matrix, vector)


def transposed(matrix: Array) -> Array:
    return matrix.transpose(0, 2, 1)


def feedforward(
    m1: Array,
    c1: Array,
    m2: Array,
    c2: Array,
    v1: Array,
    v2: Array,
    f1: Array,
    f2: Array,
    eta: Array,
) -> tuple[Array, Array]:
    """What (14) and (15) add to (1) and (2) [N m], for the device and for the proxy.

    phi and its rate come from their definitions, and C_LE, C_EL from the block product (11),
    S^-T M d(S^-1)/dt + S^-T C S^-1, multiplied out numerically instead of by its closed form.
    """
    rows, n = v1.shape
    locked = m1 + m2
    phi = np.linalg.solve(locked, m2)
    m1dot, m2dot = c1 + transposed(c1), c2 + transposed(c2)  # Mdot = C + C^T
    phidot = np.linalg.solve(locked, m2dot - (m1dot + m2dot) @ phi)

    one, none = np.broadcast_to(np.eye(n), phi.shape), np.zeros_like(phi)
    s_inverse = np.block([[one, phi], [one, phi - one]])
    s_inverse_dot = np.block([[none, phidot], [none, phidot]])
    both_m = np.block([[m1, none], [none, m2]])
    both_c = np.block([[c1, none], [none, c2]])
    s_inverse_t = transposed(s_inverse)
    blocks = s_inverse_t @ both_m @ s_inverse_dot + s_inverse_t @ both_c @ s_inverse
    c_le, c_el = blocks[:, :n, n:], blocks[:, n:, :n]

    v_l = np.linalg.solve(locked, (apply(m1, v1) + apply(m2, v2))[..., None])[..., 0]
    v_e = v1 - v2
    # (12), (13) without spring and damper, then decoded by S^T: tau_1 = (I - phi^T) tau_L + tau_E,
    # tau_2 = phi^T tau_L - tau_E
    f_l = f1 + f2
    f_e = apply(transposed(phi), f_l) - f2
    tau_l = apply(c_le, v_e) + ((1 - eta) / eta)[:, None] * f_l
    tau_e = apply(c_el, v_l) - f_e
    shared = apply(transposed(phi), tau_l)
    return tau_l - shared + tau_e, shared - tau_e
