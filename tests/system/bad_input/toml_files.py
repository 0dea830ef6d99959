"""Configurations and scenes with a wrong statement each."""

from __future__ import annotations

from .case import Case, file_case


def _config(name: str, text: str, *names: str) -> Case:
    return file_case(name, "--config", "bad.toml", text, *names)


CONFIG: list[Case] = [
    _config("a syntax error", "[coupling]\neta = = 1\n", "2"),
    _config("an open string", '[coupling]\nkind = "standard\n', "2"),
    _config("a key twice", "[coupling]\neta = 1\neta = 2\n", "eta"),
    _config("an unknown key", "[coupling]\netha = 1\n", "coupling.etha"),
    _config("an unknown table", "[couplings]\neta = 1\n", "couplings"),
    _config("a key without its table", "eta = 1\n", "eta"),
    _config("a word for a number", '[coupling]\neta = "small"\n', "coupling.eta"),
    _config("a list for a number", "[coupling]\neta = [1]\n", "coupling.eta"),
    _config("a truth for a number", "[coupling]\neta = true\n", "coupling.eta"),
    _config("a number for a truth", "[observer]\nanti_windup = 1\n", "observer.anti_windup"),
    _config("a number for a word", "[coupling]\nkind = 1\n", "coupling.kind"),
    _config("half a substep", "[device]\nsubsteps = 2.5\n", "device.substeps"),
    _config("a table for a number", "[coupling.eta]\nvalue = 1\n", "coupling.eta"),
    _config("not a number", "[coupling]\neta = nan\n", "coupling.eta"),
    _config("infinite", "[coupling]\nk_vc = inf\n", "coupling.k_vc"),
    _config("out of range", "[coupling]\neta = -1\n", "coupling.eta"),
]


def _scene(name: str, text: str, *names: str) -> Case:
    return file_case(name, "--scene", "bad.toml", 'title = "T"\nabout = "A"\n' + text, *names)


_PLANE = "[[plane]]\nname='p'\npoint=[0,0,-1]\nnormal=[0,0,1]\nstiffness=600.0\n"

SCENE: list[Case] = [
    _scene("a syntax error", "[[plane]\n", "3"),
    _scene("an unknown key", _PLANE + "friction = 1.0\n", "friction"),
    _scene("an unknown table", "[[cone]]\nname='c'\n", "cone"),
    _scene("plane without point", _PLANE.replace("point=[0,0,-1]\n", ""), "point"),
    _scene("plane without normal", _PLANE.replace("normal=[0,0,1]\n", ""), "normal"),
    _scene("plane with no direction", _PLANE.replace("[0,0,1]", "[0,0,0]"), "normal"),
    _scene("point of two numbers", _PLANE.replace("[0,0,-1]", "[0,0]"), "point"),
    _scene("point with a word", _PLANE.replace("[0,0,-1]", "[0,0,'low']"), "point"),
    _scene("point not a number", _PLANE.replace("[0,0,-1]", "[0,0,nan]"), "point"),
    _scene("stiffness negative", _PLANE.replace("600.0", "-600.0"), "stiffness"),
    _scene("stiffness not a number", _PLANE.replace("600.0", "nan"), "stiffness"),
    _scene("stiffness a word", _PLANE.replace("600.0", "'hard'"), "stiffness"),
    _scene("sphere of radius zero",
           "[[sphere]]\nname='s'\ncenter=[0,0,-1]\nradius=0.0\nstiffness=600.0\n", "radius"),
    _scene("box of negative size",
           "[[box]]\nname='b'\ncenter=[0,0,-1]\nsize=[0.1,-0.1,0.1]\nstiffness=600.0\n", "size"),
    _scene("contact of an unknown joint",
           "[[joint_contact]]\nname='j'\njoint='nosuch'\nangle=0.5\nside='above'\nstiffness=20.0\n",
           "nosuch"),
    _scene("contact on no side",
           "[[joint_contact]]\nname='j'\njoint='joint1'\nangle=0.5\nside='left'\nstiffness=20.0\n",
           "left"),
    _scene("probe on an unknown link",
           "[[probe]]\nname='p'\nlink='nosuch'\nfrom=[0,0,0]\nto=[0.1,0,0]\nradius=0.01\n",
           "nosuch"),
    _scene("tip radius negative", "tip_radius = -0.01\n", "tip_radius"),
]  # fmt: skip
