"""Arms without a chain of joints with masses."""

from __future__ import annotations

import re
from collections.abc import Callable

import arms

from .case import Case, Good, edited, file_case


def _urdf(name: str, text: str | bytes | Callable[[Good], str], *names: str) -> Case:
    return file_case(name, "--device", "bad.urdf", text, *names)


def _urdf_edit(name: str, old: str, new: str, *names: str) -> Case:
    return _urdf(name, edited("urdf", old, new), *names)


def _without_inertia(good: Good) -> str:
    """Removes the mass of every link. (If only the last ones had none, the chain would end
    earlier.)"""
    return re.sub(r"<inertial>.*?</inertial>", "", good.arm.urdf.read_text(), flags=re.S)


def _joint_text(name: str, parent: str, child: str) -> str:
    return (
        f'<joint name="{name}" type="fixed">'
        f'<parent link="{parent}"/><child link="{child}"/></joint>'
    )


URDF: list[Case] = [
    _urdf("empty", ""),
    _urdf("not XML", "solid cube\nfacet normal 0 0 1\n"),
    _urdf("bytes", bytes(range(256))),
    _urdf("cut off", lambda good: good.arm.urdf.read_text()[:700]),
    _urdf("another root", '<?xml version="1.0"?>\n<sdf version="1.6"></sdf>\n'),
    _urdf("no links", '<robot name="a"/>'),
    _urdf("no joints", '<robot name="a"><link name="base"/></robot>'),
    _urdf("only fixed joints", '<robot name="a"><link name="base"/><link name="tip"/>'
          + _joint_text("weld", "base", "tip") + "</robot>"),
    *(_urdf_edit(f"{kind} joint", 'name="joint2" type="continuous"', f'name="joint2" type="{kind}"',
                 "joint2")
      for kind in ("floating", "planar", "elastic")),
    _urdf_edit("two tips", "</robot>", '<link name="twig"><inertial><mass value="1"/>'
               '<inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>'
               + _joint_text("fork", "link1", "twig").replace("fixed", "continuous")
               + "</robot>", "link1", "twig", "--tip"),
    _urdf_edit("a loop", "</robot>", _joint_text("back", "tip", "base") + "</robot>"),
    _urdf_edit("two arms", "</robot>", '<link name="other"/></robot>'),
    _urdf_edit("an unknown parent", '<parent link="link1"/>', '<parent link="nobody"/>', "nobody"),
    _urdf_edit("an unknown child", '<child link="link2"/>', '<child link="nobody"/>', "nobody"),
    _urdf_edit("no parent", '<parent link="link1"/>', "", "joint2"),
    _urdf_edit("two links of one name", '<link name="link2">', '<link name="link1">', "link1"),
    _urdf_edit("two joints of one name", 'name="joint2"', 'name="joint1"', "joint1"),
    _urdf("joints that move no mass", _without_inertia, "inertia"),
    _urdf_edit("mass negative", '<mass value="0.01"/>', '<mass value="-0.01"/>', "link1"),
    _urdf_edit("mass not a number", '<mass value="0.01"/>', '<mass value="nan"/>', "link1"),
    _urdf_edit("mass infinite", '<mass value="0.01"/>', '<mass value="inf"/>', "link1"),
    _urdf_edit("mass a word", '<mass value="0.01"/>', '<mass value="heavy"/>', "link1"),
    _urdf_edit("inertia negative", 'ixx="', 'ixx="-', "link1"),
    _urdf_edit("inertia not a number", 'izz="', 'izz="nan" was="', "link1"),
    _urdf_edit("origin not a number", 'xyz="', 'xyz="nan 0 0" was="'),
    _urdf_edit("origin of two numbers", 'xyz="', 'xyz="0 0" was="'),
    _urdf_edit("axis zero", '<axis xyz="', '<axis xyz="0 0 0" was="', "joint1"),
    _urdf_edit("axis not a number", '<axis xyz="', '<axis xyz="0 nan 1" was="', "joint1"),
    _urdf_edit("damping negative", 'damping="0.015"', 'damping="-0.015"', "joint1"),
    _urdf_edit("damping not a number", 'damping="0.015"', 'damping="nan"', "joint1"),
    _urdf_edit("friction negative", 'friction="0"', 'friction="-1"', "joint1"),
    _urdf_edit("effort negative", 'effort="20"', 'effort="-20"', "joint1"),
    _urdf_edit("limits crossed", 'lower="-3.0" upper="3.0"', 'lower="3" upper="-3"', "joint1"),
    _urdf("too many joints", lambda good: arms.arm_urdf(33), "33"),
]  # fmt: skip
