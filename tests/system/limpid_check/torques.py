"""The torques of a session, recomputed from its positions: (1), (2), (14), (15), saturation."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .decomposition import feedforward
from .dynamics import coriolis, inertia
from .link import TO_DEVICE, TO_PROXY, Known, known
from .report import Check, not_applicable
from .session import Session
from .urdf import Array

# A coupling that is switched, or a force that is armed or cut, slews the motors for a while.
_SWITCHING_SECONDS = 1.0  # 0.2 s of slewing, or 0.5 s of fading, and a fade may start anew


@dataclass(frozen=True)
class Torques:
    device: Array  # tau1 without the device's own damping (N, n) [N m]
    proxy: Array  # tau2 (N - 1, n) [N m]; the last row's needs a proxy state that is not recorded


def sampled_velocity(s: Session) -> Array:
    """(x1_k - x1_{k-1}) / T (N, n) [rad/s], zero at k = 0."""
    x1 = s["/device/measured_position"]
    return np.diff(x1, axis=0, prepend=x1[:1]) / s.tick


def mean_proxy_velocity(s: Session) -> Array:
    """vbar2_k = (x2[k+1] - x2[k]) / T (N - 1, n) [rad/s]."""
    return np.diff(s["/proxy/position"], axis=0) / s.tick


def recompute(s: Session) -> Torques:
    """tau1 and tau2 of every row with the coupling in force at that row."""
    x1, x2 = s["/device/measured_position"], s["/proxy/position"]
    k_vc, b_vc, b_v = (s.number(f"coupling.{name}") for name in ("k_vc", "b_vc", "b_v"))
    v1, vbar2 = sampled_velocity(s), mean_proxy_velocity(s)
    vbar2_before = np.concatenate([np.zeros((1, s.dof)), vbar2])
    xbar2 = (x2[1:] + x2[:-1]) / 2

    # Each side goes by what it knows of the other.
    to_proxy, to_device = known(s, TO_PROXY), known(s, TO_DEVICE)
    x1_far, v1_far = to_proxy.of(x1)[:-1], to_proxy.moving(v1)[:-1]
    tau1 = -b_vc * (v1 - to_device.moving(vbar2_before)) - k_vc * (x1 - to_device.of(x2))
    tau2 = -b_v[:-1] * vbar2 - b_vc[:-1] * (vbar2 - v1_far) - k_vc[:-1] * (xbar2 - x1_far)

    rows = np.flatnonzero(s["/coupling/kind"] == 1)
    if len(rows):
        own = Known(np.arange(len(s)), np.zeros(len(s), dtype=bool))
        extra1, _ = _feedforward(s, rows, own, to_device)
        _, extra2 = _feedforward(s, rows, to_proxy, own)
        tau1[rows] += extra1
        inside = rows < len(tau2)
        tau2[rows[inside]] += extra2[inside]
    return Torques(tau1, tau2)


def _feedforward(s: Session, rows: Array, device: Known, proxy: Known) -> tuple[Array, Array]:
    """What (14) and (15) add at the given rows, where that is known of device and proxy."""
    x1, v1 = device.of(s["/device/measured_position"])[rows], device.moving(s["/device/measured_velocity"])[rows]
    x2, v2 = proxy.of(s["/proxy/position"])[rows], proxy.moving(s["/proxy/velocity"])[rows]
    believed = device.of(s.number("model.inertia_error"))[rows][:, :, None]
    ratio = proxy.of(s.number("proxy.inertia_ratio"))[rows][:, :, None]
    return feedforward(
        m1=believed * inertia(s.chain, x1),
        c1=believed * coriolis(s.chain, x1, v1),
        m2=ratio * inertia(s.chain, x2),
        c2=ratio * coriolis(s.chain, x2, v2),
        v1=v1,
        v2=v2,
        f1=device.of(s["/hand/torque_estimate"])[rows],
        f2=proxy.of(s["/proxy/contact_torque"])[rows],
        eta=s["/coupling/eta"][rows],
    )


def check_torques(s: Session) -> list[Check]:
    """tau1 and tau2 at every row of the paper's couplings, to 1e-6 of the largest torque there."""
    rows = s["/coupling/kind"] <= 1
    if not np.any(rows):
        return [not_applicable("tau1, tau2", "none of the paper's couplings")]
    mine = recompute(s)
    device, proxy = s["/device/commanded_torque"], s["/proxy/torque"][:-1]
    off1, off2 = (device - mine.device)[rows], (proxy - mine.proxy)[rows[:-1]]
    largest = max(_worst(device[rows]), _worst(proxy[rows[:-1]]), 1e-12)
    unit = f"worst row, of largest torque {largest:.3g} N m"
    return [
        Check("tau1 (1)/(14)", _worst(off1) / largest, 1e-6, unit),
        Check("tau2 (2)/(15)", _worst(off2) / largest, 1e-6, unit),
    ]


def _worst(values: Array) -> float:
    return float(np.max(np.abs(values), initial=0))


def switching_rows(s: Session) -> Array:
    """Rows (N,) at which the motors may slew or fade: force off, or a change not long ago."""
    kind = s["/coupling/kind"].astype(int)
    change = np.diff(kind, prepend=kind[:1]) != 0
    off = np.zeros(len(s), dtype=bool)
    if "/device/force_wanted" in s.data:
        wanted = s["/device/force_wanted"] != 0
        change |= np.diff(wanted.astype(int), prepend=1) != 0
        off = ~wanted
    reach = int(np.ceil(_SWITCHING_SECONDS / s.tick))
    recent = np.convolve(change.astype(float), np.ones(reach))[: len(s)] > 0.5
    return off | recent


def check_motors(s: Session) -> list[Check]:
    """Motors get the commanded torque, and what holds the device's own forces, clipped at their limit; never more than the limit."""
    error = np.abs(s.sent_torque - s.asked_torque)
    steady = ~switching_rows(s)
    above = float(np.max(np.abs(s.sent_torque) - s.torque_limit))
    return [
        Check(
            "motor torque",
            float(np.max(error[steady], initial=0)),
            1e-12,
            f"N m from clipped command, {int(steady.sum())} of {len(s)} rows",
        ),
        Check("motor limit", above, 1e-12, "N m above the torque limit"),
    ]
