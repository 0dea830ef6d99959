"""A serial chain of revolute and prismatic joints, read from URDF text.

Nothing is merged: every link with an inertia stays a body of its own, fixed to the moving frame
that carries it. All lengths in metres, angles in radians; a slide has 0.1 m where a joint has 1 rad.
"""

from __future__ import annotations

import xml.etree.ElementTree as ElementTree
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

SLIDE_UNIT = 0.1  # travel of a slide per unit of its coordinate [m]


@dataclass(frozen=True)
class Transform:
    """p_parent = rotation @ p_child + translation."""

    rotation: Array = field(default_factory=lambda: np.eye(3))
    translation: Array = field(default_factory=lambda: np.zeros(3))  # [m]

    def then(self, other: Transform) -> Transform:
        """The frame `other`, given in this frame, in this frame's parent."""
        return Transform(
            self.rotation @ other.rotation, self.rotation @ other.translation + self.translation
        )


@dataclass(frozen=True)
class Joint:
    name: str
    origin: Transform  # joint frame at zero angle, in the previous moving frame
    axis: Array  # unit, in the joint frame
    slides: bool
    damping: float  # b_d [N m s/rad]
    friction: float  # Coulomb [N m]
    effort: float  # torque limit [N m]
    continuous: float = 0  # torque that the motor bears for hours; 0: not known [N m]


@dataclass(frozen=True)
class Body:
    """One inertial element, fixed to moving frame `joint` (0 is moved by the first joint)."""

    joint: int
    mass: float  # [kg]
    pose: Transform  # centre of mass and inertia axes, in the moving frame
    inertia: Array  # about the centre of mass, in the axes of `pose` [kg m^2]


@dataclass(frozen=True)
class Chain:
    joints: list[Joint]
    bodies: list[Body]
    tip: Transform  # in the last moving frame

    @property
    def dof(self) -> int:
        return len(self.joints)


def rotation_from_rpy(roll: float, pitch: float, yaw: float) -> Array:
    """Rz(yaw) Ry(pitch) Rx(roll), URDF's fixed-axis convention."""
    cr, sr, cp, sp, cy, sy = (f(a) for a in (roll, pitch, yaw) for f in (np.cos, np.sin))
    about_x = np.array([[1, 0, 0], [0, cr, -sr], [0, sr, cr]])
    about_y = np.array([[cp, 0, sp], [0, 1, 0], [-sp, 0, cp]])
    about_z = np.array([[cy, -sy, 0], [sy, cy, 0], [0, 0, 1]])
    return about_z @ about_y @ about_x


def _numbers(text: str) -> Array:
    return np.array([float(part) for part in text.split()])


def _origin(element: ElementTree.Element) -> Transform:
    origin = element.find("origin")
    if origin is None:
        return Transform()
    rpy = _numbers(origin.get("rpy", "0 0 0"))
    return Transform(rotation_from_rpy(*rpy), _numbers(origin.get("xyz", "0 0 0")))


def _body(link: ElementTree.Element, joint: int, frame: Transform) -> Body | None:
    inertial = link.find("inertial")
    if inertial is None:
        return None
    mass, inertia = inertial.find("mass"), inertial.find("inertia")
    assert mass is not None and inertia is not None
    rows = (("ixx", "ixy", "ixz"), ("ixy", "iyy", "iyz"), ("ixz", "iyz", "izz"))
    tensor = np.array([[float(inertia.get(name, "0")) for name in row] for row in rows])
    return Body(joint, float(mass.get("value", "0")), frame.then(_origin(inertial)), tensor)


def _joint(element: ElementTree.Element, origin: Transform, bears: dict[str, str]) -> Joint:
    axis_element, dynamics, limit = (element.find(tag) for tag in ("axis", "dynamics", "limit"))
    axis = _numbers("1 0 0" if axis_element is None else axis_element.get("xyz", "1 0 0"))
    own = {} if dynamics is None else dynamics.attrib
    effort = "inf" if limit is None else limit.get("effort", "inf")
    slides = element.get("type") == "prismatic"
    unit = SLIDE_UNIT if slides else 1
    return Joint(
        name=element.get("name", ""),
        origin=origin,
        axis=axis / np.linalg.norm(axis),
        slides=slides,
        damping=float(own.get("damping", "0")) * unit**2,
        friction=float(own.get("friction", "0")) * unit,
        effort=float(effort) * unit,
        continuous=float(bears.get(element.get("name", ""), "0")) * unit,
    )


def parse_chain(text: str) -> Chain:
    """The chain in a URDF text. Raises ValueError for anything but a chain of such joints."""
    root = ElementTree.fromstring(text)
    links = {link.get("name"): link for link in root.findall("link")}
    following = {}
    for element in root.findall("joint"):
        parent, child = element.find("parent"), element.find("child")
        assert parent is not None and child is not None
        if parent.get("link") in following:
            raise ValueError(f"link {parent.get('link')} has two children")
        following[parent.get("link")] = (element, child.get("link"))
    children = {child for _, child in following.values()}
    roots = [name for name in links if name not in children]
    if len(roots) != 1:
        raise ValueError(f"{len(roots)} root links")

    bears = {own.get("joint", ""): own.get("continuous", "0") for own in root.findall("limpid/warmth")}
    joints: list[Joint] = []
    bodies: list[Body] = []
    frame, link = Transform(), roots[0]
    while True:
        if joints and (body := _body(links[link], len(joints) - 1, frame)) is not None:
            bodies.append(body)
        if link not in following:
            return Chain(joints, bodies, tip=frame)
        element, link = following[link]
        frame = frame.then(_origin(element))
        kind = element.get("type")
        if kind in ("revolute", "continuous", "prismatic"):
            joints.append(_joint(element, frame, bears))
            frame = Transform()
        elif kind != "fixed":
            raise ValueError(f"joint {element.get('name')} is {kind}")
