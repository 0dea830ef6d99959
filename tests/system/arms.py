#!/usr/bin/python3
"""Writes arms to test with: a URDF, a scene and a hand path for 1 to 30 joints.

The arms are general on purpose: skew axes, turned origins, off-diagonal inertias, fixed joints
with masses in between and a fixed tip link. They are made from the number of joints alone, so the
same files come out every time. The hand's path is forward kinematics of a small smooth joint
motion around a bent pose: every point of it is in reach. The scene's plane lies where the tip goes
deepest, so that the last part of each stroke is a contact.

    arms.py DIR [JOINTS ...]        writes DIR/armN.urdf, DIR/armN.toml, DIR/armN.csv
"""

from __future__ import annotations

import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from limpid_check.dynamics import tip_position
from limpid_check.urdf import Array, Chain, parse_chain

DEFAULT_JOINTS = (1, 2, 3, 6, 7, 15, 30)

_REACH = 0.3  # sum of the links' lengths [m]
_MASS = 0.03  # mass of all links [kg]
_EXCURSION = 0.03  # excursion of the tip along the stroke [m]
_DEPTH = 0.008  # how far the hand's path goes below the plane [m]
_DURATION = 4.0  # [s]
_RATE = 200  # rows per second


@dataclass(frozen=True)
class ArmFiles:
    urdf: Path
    scene: Path
    hand: Path


def _triple(values: Array) -> str:
    return " ".join(repr(float(value)) for value in values)


def _inertial(rng: np.random.Generator, mass: float, length: float, weight: float) -> str:
    """A body with an asymmetric inertia: unequal moments, turned axes, products; all times
    `weight`."""
    moments = weight * (2e-4 + mass * length**2 * np.array([0.3, 0.9, 1.0]))
    mass *= weight
    turn, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    tensor = turn @ np.diag(moments) @ turn.T
    names = {"ixx": (0, 0), "ixy": (0, 1), "ixz": (0, 2), "iyy": (1, 1), "iyz": (1, 2)}
    entries = {name: tensor[at] for name, at in (names | {"izz": (2, 2)}).items()}
    inertia = " ".join(f'{name}="{float(value)!r}"' for name, value in entries.items())
    centre = np.array([length / 2, 0, 0]) + 0.1 * length * rng.normal(size=3)
    turned = _triple(rng.normal(size=3))
    return (
        f'    <inertial>\n      <origin xyz="{_triple(centre)}" rpy="{turned}"/>\n'
        f'      <mass value="{mass!r}"/>\n      <inertia {inertia}/>\n    </inertial>\n'
    )


def _link(name: str, inertial: str = "") -> str:
    return f'  <link name="{name}">\n{inertial}  </link>\n'


def _joint(name: str, kind: str, parent: str, child: str, xyz: Array, rpy: Array, more: str) -> str:
    return (
        f'  <joint name="{name}" type="{kind}">\n'
        f'    <parent link="{parent}"/>\n    <child link="{child}"/>\n'
        f'    <origin xyz="{_triple(xyz)}" rpy="{_triple(rpy)}"/>\n{more}  </joint>\n'
    )


def arm_urdf(dof: int, weight: float = 1) -> str:
    """A URDF chain of `dof` joints; every third link is followed by a fixed one with a mass. All of
    it can be `weight` times as heavy."""
    rng = np.random.default_rng(1000 + dof)
    length, mass = _REACH / dof, _MASS / dof
    parts = [_link("base")]
    parent, offset = "base", np.zeros(3)
    for i in range(dof):
        link = f"link{i + 1}"
        axis = np.roll([0.1, 0.2, 1.0], -i) + 0.15 * rng.normal(size=3)
        kind = "continuous" if i % 2 else "revolute"
        bounds = "" if i % 2 else 'lower="-3.0" upper="3.0" '
        more = (
            f'    <axis xyz="{_triple(axis)}"/>\n'
            f'    <limit {bounds}effort="20" velocity="20"/>\n'
            '    <dynamics damping="0.015" friction="0"/>\n'
        )
        parts.append(
            _joint(f"joint{i + 1}", kind, parent, link, offset, 0.2 * rng.normal(size=3), more)
        )
        parts.append(_link(link, _inertial(rng, mass, length, weight)))
        parent, offset = link, np.array([length, 0.05 * length, -0.03 * length])
        if i % 3 == 2 and i + 1 < dof:
            flange = f"flange{i + 1}"
            parts.append(
                _joint(f"weld{i + 1}", "fixed", parent, flange, offset, [0.1, -0.2, 0.3], "")
            )
            parts.append(_link(flange, _inertial(rng, 0.2 * mass, 0.3 * length, weight)))
            parent, offset = flange, np.zeros(3)
    parts.append(_joint("weld_tip", "fixed", parent, "tip", offset, [0.3, 0.2, -0.1], ""))
    parts.append(_link("tip"))
    return f'<?xml version="1.0"?>\n<robot name="arm{dof}">\n{"".join(parts)}</robot>\n'


def _smooth_motion(chain: Chain) -> tuple[Array, Array]:
    """Times (rows,) and joint angles (rows, n): two strokes and back, starting at rest."""
    dof = chain.dof
    rng = np.random.default_rng(2000 + dof)
    time = np.arange(int(_DURATION * _RATE) + 1) / _RATE
    phase = 2 * np.pi * time / _DURATION
    stroke = (1 - np.cos(2 * phase)) / 2  # two strokes, at rest at both ends
    sway = np.sin(phase) ** 3
    pose = 0.8 * np.where(np.arange(dof) % 2, 1, -1) / np.sqrt(max(1, dof / 3))
    along, across = rng.normal(size=(2, dof))

    def joints(scale: float) -> Array:
        return pose + scale * (np.outer(stroke, along) + 0.3 * np.outer(sway, across))

    scale = 1.0
    for _ in range(20):  # scale the motion until the tip goes _EXCURSION away
        tip = tip_position(chain, joints(scale))
        scale *= _EXCURSION / np.max(np.linalg.norm(tip - tip[0], axis=1))
    return time, joints(scale)


def _scene_toml(dof: int, tip: Array) -> str:
    """A plane across the stroke, _DEPTH above its deepest point."""
    deepest = int(np.argmax(np.linalg.norm(tip - tip[0], axis=1)))
    stroke = tip[deepest] - tip[0]
    normal = -stroke / np.linalg.norm(stroke)
    point = tip[deepest] + _DEPTH * normal

    def numbers(values: Array) -> str:
        return "[" + ", ".join(repr(float(value)) for value in values) + "]"

    return (
        f'title = "Wall for {dof} joints"\nabout = "A plane across the stroke of the hand."\n'
        f'tip_radius = 0.0\n\n[[plane]]\nname = "wall"\npoint = {numbers(point)}\n'
        f"normal = {numbers(normal)}\nstiffness = 600.0\n"
    )


def write_arm(directory: Path, dof: int, weight: float = 1) -> ArmFiles:
    """Writes armN.urdf, armN.toml and armN.csv into `directory`."""
    files = ArmFiles(*(directory / f"arm{dof}{kind}" for kind in (".urdf", ".toml", ".csv")))
    urdf = arm_urdf(dof, weight)
    chain = parse_chain(urdf)
    time, x = _smooth_motion(chain)
    tip = tip_position(chain, x)
    rows = [f"{t!r}," + ",".join(repr(float(c)) for c in p) for t, p in zip(time.tolist(), tip)]
    files.urdf.write_text(urdf)
    files.scene.write_text(_scene_toml(dof, tip))
    files.hand.write_text("time_s,x_m,y_m,z_m\n" + "\n".join(rows) + "\n")
    return files


def main(arguments: list[str]) -> int:
    if not arguments or not all(word.isdigit() for word in arguments[1:]):
        print("usage: arms.py DIR [JOINTS ...]", file=sys.stderr)
        return 2
    directory = Path(arguments[0])
    directory.mkdir(parents=True, exist_ok=True)
    for dof in [int(word) for word in arguments[1:]] or DEFAULT_JOINTS:
        files = write_arm(directory, dof)
        print(files.urdf, files.scene, files.hand)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
