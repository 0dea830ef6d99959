"""A delay between device and proxy: the row whose state each side knows."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .session import Session
from .urdf import Array

_WORD = (1 << 64) - 1
_NEVER = 1 << 62
TO_PROXY, TO_DEVICE = 1, 2  # directions


@dataclass(frozen=True)
class Known:
    """For every row the row whose packet counts there (N,), and whether it counts as at rest (N,)."""

    row: Array
    resting: Array

    def of(self, values: Array) -> Array:
        return values[self.row]

    def moving(self, values: Array) -> Array:
        """`values` at the known rows, zero at rest (N, n)."""
        return np.where(self.resting[:, None], 0.0, values[self.row])


def _mixed(z: int) -> int:
    """Output of SplitMix64 after its state."""
    z = (z + 0x9E3779B97F4A7C15) & _WORD
    z = ((z ^ (z >> 30)) * 0xBF58476D1CE4E5B9) & _WORD
    z = ((z ^ (z >> 27)) * 0x94D049BB133111EB) & _WORD
    return z ^ (z >> 31)


def fate(seed: int, direction: int, packet: int, jitter: int, loss: float) -> tuple[bool, int]:
    """Whether a packet is lost, and by how many ticks it comes later than link.delay."""
    first = _mixed((_mixed((_mixed(seed) + direction) & _WORD) + packet) & _WORD)
    late = ((_mixed(first) >> 32) * (jitter + 1)) >> 32
    return (first >> 11) / (1 << 53) < loss, late


def linked(s: Session) -> Array:
    """Rows (N,) with a link between device and proxy."""
    return np.any([s.number(f"link.{key}")[:, 0] > 0 for key in ("delay", "jitter", "loss")], axis=0)


def known(s: Session, direction: int) -> Known:
    """Row of the other side known to one side at every row. Each law counts packets anew."""
    kind, on = s["/coupling/kind"].astype(int), linked(s)
    delay, jitter, seed = (s.number(f"link.{key}")[:, 0].astype(int) for key in ("delay", "jitter", "seed"))
    loss = s.number("link.loss")[:, 0]
    rows, resting = np.arange(len(s)), np.zeros(len(s), dtype=bool)
    packets: list[tuple[int, int]] = []  # tick of arrival and row, on their way
    held, rests, number, fresh = 0, True, 0, True
    for k in range(len(s)):
        if k == 0 or kind[k] != kind[k - 1]:
            number, fresh = 0, True
        if not on[k] or kind[k] == 2:
            fresh = True
            continue
        if fresh:
            packets, held, rests, fresh = [], k, True, False
        lost, late = fate(int(seed[k]), direction, number, int(jitter[k]), float(loss[k]))
        packets.append((_NEVER if lost else number + int(delay[k]) + late, k))
        there = [row for arrives, row in packets if arrives <= number]
        if there:
            held, rests = max(there), False
            packets = [packet for packet in packets if packet[1] > held]
        rows[k], resting[k] = held, rests
        number += 1
    return Known(rows, resting)
