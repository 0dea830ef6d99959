"""The energy tanks of a session, and its torques under them, recomputed from its positions and from
what left for the motors."""

from __future__ import annotations

import numpy as np

from .decomposition import apply
from .dynamics import inertia
from .link import TO_DEVICE, TO_PROXY, known
from .report import Check, not_applicable
from .session import Session
from .torques import mean_proxy_velocity, sampled_velocity
from .urdf import Array

_REFILL = 0.2  # of the device's inertia over a tick, the most that fills its tank


class _DeviceTank:
    """What the device's side has: what came in, less the most that was spent under any delay."""

    def __init__(self, dof: int, energy: float) -> None:
        self.came = energy
        self.spent: dict[int, float] = {}
        self.aside = np.zeros(dof)
        self.dx = np.zeros(dof)
        self.turn = np.zeros(dof)

    @property
    def energy(self) -> float:
        return self.came - max(self.spent.values(), default=0.0)

    def delays(self, least: int, most: int) -> None:
        if set(self.spent) != set(range(least, most + 1)):
            worst = max(self.spent.values(), default=0.0)
            self.spent = {d: worst for d in range(least, most + 1)}

    def tick(self, dx: Array, torque_before: Array, b_d: Array, step: float, T: float, most: float) -> None:
        """torque_before[d]: that left d ticks before the last one."""
        self.turn, self.dx = dx - self.dx, dx
        self.came += float(np.sum(b_d * np.maximum(0, np.abs(dx) - step) ** 2)) / T
        aside = np.clip(dx / 2, -step / 2, step / 2)  # the edge that was crossed, by the reading
        along, self.aside = dx - aside + self.aside, aside
        for d in self.spent:
            self.spent[d] += float(torque_before[d] @ along)
        self.came -= max(0.0, self.energy - most)

    def share(self, torque: Array, under_way: list[Array], m1: Array, T: float) -> float:
        def spends(tau: Array) -> float:
            return max(0.0, float(tau @ self.dx), float(tau @ (self.dx + self.turn)))

        has = self.energy - sum(spends(tau) for tau in under_way)
        if has <= 0:
            return 0.0
        reach = (1 + len(under_way)) * T
        alone = reach * reach / 2 * float(torque @ np.linalg.solve(m1, torque))
        if spends(torque) + alone <= has:
            return 1.0
        return float(np.max(np.roots([alone, spends(torque), -has]).real))


def check_tank(s: Session) -> list[Check]:
    """Reserve, tau1 and tau2 at every row of a session under the tank coupling alone."""
    kinds = s["/coupling/kind"]
    if not np.any(kinds == 3):
        return [not_applicable("tank", "another law")]
    if np.any(kinds != 3):
        return [not_applicable("tank", "the law is changed on the way")]
    if "/device/force_wanted" in s.data and not np.all(s["/device/force_wanted"]):
        return [not_applicable("tank", "force is off for a while")]
    T, n = s.tick, s.dof
    x1, x2 = s["/device/measured_position"], s["/proxy/position"]
    v1, vbar2 = sampled_velocity(s), mean_proxy_velocity(s)
    vbar2_before = np.concatenate([np.zeros((1, n)), vbar2])
    to_proxy, to_device = known(s, TO_PROXY), known(s, TO_DEVICE)
    x1_far, v1_far = to_proxy.of(x1), to_proxy.moving(v1)
    x2_far, vbar2_far = to_device.of(x2), to_device.moving(vbar2_before)
    k_vc, b_vc, b_v = (s.number(f"coupling.{key}")[:, 0] for key in ("k_vc", "b_vc", "b_v"))
    E0, cap, beta, refill = (s.number(f"tank.{key}")[:, 0] for key in ("energy", "most", "share", "damping"))
    m1 = s.number("model.inertia_error")[:, :, None] * inertia(s.chain, x1)
    momentum = apply(m1, v1)
    left, step = s.law_torque, s.number("device.encoder_step")[:, 0]
    least, most = s.possible_delays
    law_limit = s.law_limit
    work2 = np.sum(s["/proxy/torque"][:-1] * np.diff(x2, axis=0), axis=1)

    size = len(s)
    sent1, sent2 = np.zeros(size), np.zeros(size)
    tau1, tau2 = np.zeros((size, n)), np.zeros((size, n))
    reserve = np.zeros(size)
    half = min(E0[0], s["/energy/ledger"][0]) / 2
    device, proxy = _DeviceTank(n, half), half
    got1 = got2 = total1 = total2 = 0.0
    for k in range(size):
        device.delays(int(least[k]), int(most[k]))
        if k > 0:
            before = {d: left[k - 1 - d] if k > d else np.zeros(n) for d in device.spent}
            device.tick(x1[k] - x1[k - 1], before, s.damping[k], float(step[k]), T, cap[k])
            proxy = min(proxy - work2[k - 1], cap[k])
        reserve[k] = device.energy + proxy + (total1 - got2) + (total2 - got1)

        over = beta[k] * max(0.0, device.energy - E0[k] / 2)
        device.came -= over
        total1 += over
        sent1[k] = total1
        proxy += sent1[to_proxy.row[k]] - got2
        got2 = sent1[to_proxy.row[k]]
        over = beta[k] * max(0.0, proxy - E0[k] / 2)
        proxy -= over
        total2 += over
        sent2[k] = total2

        drive = b_vc[k] * v1_far[k] - k_vc[k] * (x2[k] - x1_far[k])
        damping = b_v[k] + b_vc[k] + k_vc[k] * T / 2
        if proxy > 0:
            damping = max(damping, float(drive @ drive) * T / 4 / proxy)
        else:
            drive = np.zeros(n)
        tau2[k] = drive - (damping * vbar2[k] if k < size - 1 else 0)

        device.came += sent2[to_device.row[k]] - got1
        got1 = sent2[to_device.row[k]]
        lacks = min(max(1 - device.energy / (E0[k] / 2), 0.0), 1.0)
        wanted = -b_vc[k] * (v1[k] - vbar2_far[k]) - k_vc[k] * (x1[k] - x2_far[k])
        wanted = np.clip(wanted, -law_limit[k], law_limit[k])
        under_way = [left[k - 1 - d] if k > d else np.zeros(n) for d in range(int(most[k]))]
        rate = min(refill[k], _REFILL / (T * (1 + int(most[k]))))
        tau1[k] = device.share(wanted, under_way, m1[k], T) * wanted - lacks * rate * momentum[k]

    commanded, of_proxy = s["/device/commanded_torque"], s["/proxy/torque"]
    largest = max(_worst(commanded), _worst(of_proxy), 1e-12)
    unit = f"worst row, of largest torque {largest:.3g} N m"
    return [
        Check("tank tau1", _worst(commanded - tau1) / largest, 1e-6, unit),
        Check("tank tau2", _worst((of_proxy - tau2)[:-1]) / largest, 1e-6, unit),
        Check("tank reserve", _worst(s["/energy/ledger"] - reserve), 1e-9, "J, worst row"),
    ]


def _worst(values: Array) -> float:
    return float(np.max(np.abs(values), initial=0))
