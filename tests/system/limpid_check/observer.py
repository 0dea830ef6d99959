"""The observer's estimate against the true human torque, (16)-(18)."""

from __future__ import annotations

import numpy as np

from .dynamics import inertia
from .report import Check, not_applicable
from .session import Session
from .urdf import Array

_SETTLING = 0.1  # left out at the start [s]
_TOLERANCE = 0.03  # rms error over rms torque


def expected_input(s: Session) -> Array:
    """Limit of an ideal observer's estimate, tick by tick (N - 1, n) [N m]. With the right model
    and the true torque it is f1 (/hand/torque) itself. A model wrong by a factor e sees e (M a + C
    v) - tau instead of M a + C v - tau = f1. An observer without the saturation remedy takes the
    commanded torque for tau, and a late torque for a prompt one. Compensated weight and springs
    cancel."""
    own = s.damping[:-1] * np.diff(s["/device/position"], axis=0) / s.tick
    motor = (s["/device/motor_torque"] - s["/device/compensation_torque"])[:-1]
    remedy = np.array(s.settings["observer.anti_windup"], dtype=bool)[:-1, None]
    assumed = np.where(remedy, s.law_torque[:-1], s["/device/commanded_torque"][:-1])
    believed = s.number("model.inertia_error")[:-1]
    return believed * (s["/hand/torque"][:-1] + motor - own) - (assumed - own)


def expected_estimate(s: Session) -> Array:
    """`expected_input` through the error dynamics (18), f1_hat' = L (f1 - f1_hat) (N, n) [N m].

    L = alpha M^-1 is frozen over a tick and the tick solved exactly. The velocity that the
    observer is given at t_k is the mean over the tick before, so the estimate describes
    t_k - T/2: the mean of the filter's states at t_k and t_{k-1}.
    """
    m = s.number("model.inertia_error")[:, :, None] * inertia(
        s.chain, s["/device/measured_position"]
    )
    values, vectors = np.linalg.eigh(m)
    share = 1 - np.exp(-s["/coupling/alpha"][:, None] * s.tick / values)
    step = vectors @ (share[:, :, None] * vectors.transpose(0, 2, 1))
    wanted = expected_input(s)
    state = np.zeros((len(s), s.dof))
    for k in range(len(s) - 1):
        state[k + 1] = state[k] + step[k] @ (wanted[k] - state[k])
    before = np.concatenate([np.zeros((1, s.dof)), state[:-1]])
    return (state + before) / 2


def check_observer(s: Session) -> list[Check]:
    """rms of estimate minus expectation, over the rms of the expectation, after 0.1 s.

    Exact agreement is not to be had: the torque inside a tick is known by its mean only, and how
    (17) is discretised is the program's affair; both differ by fractions of a tick's lag, which
    is a percent or two of a torque with contacts in it. Only for an ideal sensor: encoder steps,
    velocity filters, Coulomb friction and unknown torques (a real device) say nothing here.
    """
    name = "observer (18)"
    if not np.all(np.isfinite(s["/hand/torque"])):
        return [not_applicable(name, "the true torque is not known")]
    if any(value != "raw" for value in s.settings["observer.velocity"]):
        return [not_applicable(name, "the velocity is filtered")]
    if np.any(s.number("device.encoder_step") > 0) or np.any(s.friction > 0):
        return [not_applicable(name, "encoder steps or friction")]
    for force in ("gravity", "springs"):
        if np.any(s.number(f"device.{force}") != s.number(f"model.{force}")):
            return [not_applicable(name, f"the device's {force} that nobody holds")]
    settled = s["/time"] - s["/time"][0] > _SETTLING
    if settled.sum() < 100:
        return [not_applicable(name, "shorter than 0.2 s")]
    expected = expected_estimate(s)[settled]
    rms = float(np.sqrt(np.mean(expected**2)))
    error = float(np.sqrt(np.mean((s["/hand/torque_estimate"][settled] - expected) ** 2)))
    return [Check(name, error / rms, _TOLERANCE, f"rms error of rms torque {rms:.3g} N m")]
