"""Scenes and arms as values: built, read, changed, and written as the files that Limpid reads.

Values are checked where they are used, in the words of `limpid check`.
"""

from __future__ import annotations

import os
import xml.etree.ElementTree as xml
from pathlib import Path
from typing import Any, Dict, Iterable, Iterator, List, Mapping, Optional, Sequence

from limpid.errors import ArgumentError, LimpidError
from limpid.program import assets
from limpid.values import PathLike, number, path_of

KINDS = ("plane", "sphere", "box", "cylinder", "capsule", "mesh", "joint_contact", "body", "spring", "probe", "visual")


class Scene:
    """What can be touched, a table each, as scene files have them.

        scene = limpid.Scene(title="Two walls")
        scene.add("plane", "floor", point=(0, 0, -0.04), normal=(0, 0, 1), stiffness=800)
        scene.add("body", "ball", sphere=0.01, mass=0.02, position=(0.2, 0, 0))
        scene["floor"]["friction_kinetic"] = 0.2
        loop = limpid.Loop(scene=scene)
    """

    def __init__(self, **values: Any) -> None:
        """`values` stand before all objects: title, about, tip_radius, gravity."""
        self.values: Dict[str, Any] = dict(values)
        self.objects: List[Dict[str, Any]] = []  # in their order, each with its "kind"

    def __setattr__(self, name: str, value: Any) -> None:
        if name not in ("values", "objects"):
            raise ArgumentError(f"{name}: cannot be assigned to; scene.values[{name!r}] has what stands before all objects")
        super().__setattr__(name, value)

    @classmethod
    def read(cls, file: PathLike) -> "Scene":
        """The scene of a file, or of one that came along ("table.toml"). Raises LimpidError."""
        import tomllib

        path = assets(path_of("scene", file), "scenes")
        try:
            found = tomllib.loads(Path(path).read_text(encoding="utf-8"))
        except (OSError, ValueError) as error:
            raise LimpidError(f"{path}: {error}") from error
        scene = cls(**{key: value for key, value in found.items() if key not in KINDS})
        for kind in KINDS:
            for table in found.get(kind, []):
                if "file" in table:  # it is meant from the file's folder
                    table["file"] = os.path.abspath(os.path.join(os.path.dirname(path), table["file"]))
                scene.objects.append({"kind": kind, **table})
        return scene

    def add(self, kind: str, name: str = "", **keys: Any) -> Dict[str, Any]:
        """Adds an object with the keys that its table in a file has; returns it. A name is taken once."""
        if kind not in KINDS:
            raise ArgumentError(f"{kind} is no kind of object; there are {', '.join(KINDS)}")
        if name and any(each.get("name") == name for each in self.objects):
            raise ArgumentError(f"the scene has an object {name} already: change scene[{name!r}], or delete it first")
        self.objects.append({"kind": kind, **({"name": name} if name else {}), **keys})
        return self.objects[-1]

    def __getitem__(self, name: str) -> Dict[str, Any]:
        for each in self.objects:
            if each.get("name") == name:
                return each
        names = ", ".join(str(each["name"]) for each in self.objects if "name" in each)
        raise ArgumentError(f"{name} is no object of the scene; there are {names}")

    def __delitem__(self, name: str) -> None:
        self.objects.remove(self[name])

    def __contains__(self, name: object) -> bool:
        return any(each is name or each.get("name") == name for each in self.objects)

    def __iter__(self) -> Iterator[Dict[str, Any]]:
        return iter(self.objects)

    def __len__(self) -> int:
        return len(self.objects)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Scene) and (self.values, self.objects) == (other.values, other.objects)

    def __repr__(self) -> str:
        return f"Scene of {', '.join(str(each.get('name', each['kind'])) for each in self.objects) or 'nothing'}"

    def text(self) -> str:
        """The scene as TOML."""
        out = "".join(f"{key} = {_toml(key, value)}\n" for key, value in self.values.items())
        for each in self.objects:
            out += f"\n[[{each['kind']}]]\n"
            out += "".join(f"{key} = {_toml(key, value)}\n" for key, value in each.items() if key != "kind")
        return out

    def write(self, file: PathLike, force: bool = False) -> None:
        """Writes the scene, in place of a file that is there with `force`."""
        _write(path_of("scene", file), self.text(), force)


JOINT_KEYS = ("name", "slides", "position", "rpy", "axis", "lower", "upper", "effort", "damping", "friction", "mass",
              "center", "inertia")  # fmt: skip


class Arm:
    """An arm as URDF: built of joints, or read and changed.

        arm = limpid.Arm.read("touch.urdf")
        arm.set("waist", damping=0.02, friction=0)
        loop = limpid.Loop(arm=arm)
    """

    def __init__(self, name: str = "arm", joints: Iterable[Mapping[str, Any]] = (),
                 tip: Sequence[float] = (0, 0, 0)) -> None:  # fmt: skip
        """`joints`, base first, each a dict: name; slides (False); position, rpy: its origin in the
        frame of the joint before; axis (0, 0, 1); lower, upper, effort, damping, friction; mass,
        center, inertia (xx, xy, xz, yy, yz, zz) of the link that it moves. `tip` in the last frame."""
        self._root = xml.Element("robot", name=_text("name", name))
        xml.SubElement(self._root, "link", name="base")
        parent = "base"
        for given in _all("joints", joints):
            if not isinstance(given, Mapping):
                raise ArgumentError(f"joints: {given!s:.40} is not allowed; allowed: a dict for each joint")
            parent = self._add(dict(given), parent)
        end = xml.SubElement(self._root, "joint", name="to_tip", type="fixed")
        xml.SubElement(end, "origin", xyz=_numbers("tip", tip))
        xml.SubElement(end, "parent", link=parent)
        xml.SubElement(end, "child", link="tip")
        xml.SubElement(self._root, "link", name="tip")

    def _add(self, given: Dict[str, Any], parent: str) -> str:
        name = _text("name", given.pop("name", f"joint_{len(self.joints) + 1}"))
        link = f"{name}_link"
        slides = given.pop("slides", False)
        if slides not in (True, False) or isinstance(slides, str):
            raise ArgumentError(f"joint {name}: slides {slides!s:.40} is not allowed; allowed: True or False")
        joint = xml.SubElement(self._root, "joint", name=name,
                               type="prismatic" if slides else "revolute")  # fmt: skip
        xml.SubElement(joint, "origin", xyz=_numbers("position", given.pop("position", (0, 0, 0))),
                       rpy=_numbers("rpy", given.pop("rpy", (0, 0, 0))))  # fmt: skip
        xml.SubElement(joint, "parent", link=parent)
        xml.SubElement(joint, "child", link=link)
        xml.SubElement(joint, "axis", xyz=_numbers("axis", given.pop("axis", (0, 0, 1))))
        effort = given.pop("effort", None)
        if effort is not None and not number("effort", effort) > 0:
            raise ArgumentError(f"joint {name}: effort {effort} is not allowed; allowed: above 0, or none: "
                                "what holds the arm stretched out, twice")  # fmt: skip
        limit = {"lower": given.pop("lower", -3.14), "upper": given.pop("upper", 3.14),
                 "effort": effort or 0, "velocity": 10}  # fmt: skip
        xml.SubElement(joint, "limit", {key: _number(key, value) for key, value in limit.items()})
        dynamics = {key: given.pop(key, 0) for key in ("damping", "friction")}
        xml.SubElement(joint, "dynamics", {key: _number(key, value) for key, value in dynamics.items()})
        moved = xml.SubElement(self._root, "link", name=link)
        mass, center = given.pop("mass", 0), given.pop("center", (0, 0, 0))
        inertia = given.pop("inertia", (0,) * 6)
        if given:
            raise ArgumentError(f"joint {name}: {', '.join(map(str, given))} is none of its keys; "
                                f"there are {', '.join(JOINT_KEYS)}")  # fmt: skip
        if mass:
            inertial = xml.SubElement(moved, "inertial")
            xml.SubElement(inertial, "origin", xyz=_numbers("center", center))
            xml.SubElement(inertial, "mass", value=_number("mass", mass))
            parts = _numbers("inertia", inertia, 6).split()
            xml.SubElement(inertial, "inertia", dict(zip(("ixx", "ixy", "ixz", "iyy", "iyz", "izz"), parts)))
        return link

    @classmethod
    def read(cls, file: PathLike) -> "Arm":
        """The arm of a URDF file, or of one that came along ("touch.urdf"). Raises LimpidError."""
        path = assets(path_of("arm", file), "devices")
        try:
            root = xml.parse(path).getroot()
        except (OSError, xml.ParseError) as error:
            raise LimpidError(f"{path}: {error}") from error
        arm = cls.__new__(cls)
        arm._root = root
        for mesh in root.iter("mesh"):
            named = mesh.get("filename", "")
            if named and "://" not in named:  # it is meant from the file's folder
                mesh.set("filename", os.path.abspath(os.path.join(os.path.dirname(path), named)))
        return arm

    @property
    def joints(self) -> List[str]:
        """Names of the joints that move, in the order of the text."""
        return [str(each.get("name")) for each in self._root.findall("joint") if each.get("type") != "fixed"]

    def _joint(self, name: str) -> xml.Element:
        for each in self._root.findall("joint"):
            if each.get("name") == name:
                return each
        raise ArgumentError(f"{name} is no joint of the arm; there are {', '.join(self.joints)}")

    def get(self, name: str) -> Dict[str, float]:
        """Limits and resistance of a joint: lower, upper, effort, damping, friction, as its text has them."""
        joint = self._joint(name)
        found = {**_attributes(joint.find("limit")), **_attributes(joint.find("dynamics"))}
        return {key: float(value) for key, value in found.items() if key != "velocity"}

    def set(self, name: str, **values: float) -> None:
        """Changes some of them [rad, N m, N m s/rad; of joints that slide m, N, N s/m]."""
        joint = self._joint(name)
        for key, value in values.items():
            if key not in ("lower", "upper", "effort", "damping", "friction"):
                raise ArgumentError(f"{key}: joints have lower, upper, effort, damping, friction")
            tag = "dynamics" if key in ("damping", "friction") else "limit"
            of = joint.find(tag)
            (xml.SubElement(joint, tag) if of is None else of).set(key, _number(key, value))

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Arm) and self.text() == other.text()

    def __repr__(self) -> str:
        return f"Arm {self._root.get('name')} of {len(self.joints)} joints"

    def text(self) -> str:
        """The arm as URDF."""
        xml.indent(self._root)
        return xml.tostring(self._root, encoding="unicode", xml_declaration=False) + "\n"

    def write(self, file: PathLike, force: bool = False) -> None:
        """Writes the arm, in place of a file that is there with `force`."""
        _write(path_of("arm", file), self.text(), force)


def _attributes(of: Optional[xml.Element]) -> Dict[str, str]:
    return {} if of is None else dict(of.attrib)


def _number(name: str, value: Any) -> str:
    try:
        return repr(float(value))
    except (TypeError, ValueError) as error:
        raise ArgumentError(f"{name}: {value!s:.40} is not allowed; allowed: a number") from error


def _numbers(name: str, values: Iterable[Any], count: int = 3) -> str:
    found = _all(name, values)
    if len(found) != count:
        raise ArgumentError(f"{name}: has {len(found)} numbers; needed: {count}")
    return " ".join(_number(name, each) for each in found)


def _all(name: str, values: Any) -> List[Any]:
    if isinstance(values, (str, bytes, Mapping)) or not isinstance(values, Iterable):
        raise ArgumentError(f"{name}: {values!s:.40} is not allowed; allowed: a list")
    return list(values)


def _text(name: str, value: Any) -> str:
    """A text that a file can hold."""
    if isinstance(value, str) and not any("\ud800" <= letter <= "\udfff" for letter in value):
        return str(value)
    raise ArgumentError(f"{name}: {value!a:.40} is not allowed; allowed: a text")


def _toml(key: str, value: Any) -> str:
    """A value as TOML has it; of numpy's arrays and numbers, too."""
    if hasattr(value, "tolist"):
        value = value.tolist()
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (int, float)):
        return repr(value)
    if isinstance(value, str):
        escaped = "".join(f"\\u{ord(c):04x}" if c in '"\\' or ord(c) < 32 else c for c in _text(key, value))
        return f'"{escaped}"'
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{name} = {_toml(name, each)}" for name, each in value.items()) + "}"
    if isinstance(value, Iterable):
        return "[" + ", ".join(_toml(key, each) for each in value) + "]"
    raise ArgumentError(f"{key}: {value!s:.40} is not allowed; allowed: numbers, texts, lists and dicts")


def _write(file: str, text: str, force: bool) -> None:
    try:
        with open(file, "w" if force else "x", encoding="utf-8") as out:
            out.write(text)
    except FileExistsError as error:
        raise LimpidError(f"{file}: is there already; force=True replaces it") from error
    except OSError as error:
        raise LimpidError(f"{file}: cannot be written: {error.strerror}") from error
