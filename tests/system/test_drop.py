"""Drops files on the window, as a file manager would."""

import struct
import subprocess
import unittest
from pathlib import Path

from support import ASSETS, LIMPID
from test_scene_window import CORNERS, FACES, write_pyramid
from window import WindowTest

try:
    from drop import drop
except ImportError:
    drop = None


def write_stl(path: Path) -> None:
    """Writes the pyramid in millimetres, as CAD programs do."""
    facets = b"".join(
        struct.pack("<3f", 0, 0, 0) + b"".join(struct.pack("<3f", *CORNERS[i]) for i in face)
        + b"\0\0" for face in FACES)
    path.write_bytes(b" " * 80 + struct.pack("<I", len(FACES)) + facets)


def write_obj(path: Path) -> None:
    path.write_text("".join(f"v {x} {y} {z}\n" for x, y, z in CORNERS)
                    + "".join(f"f {a + 1} {b + 1} {c + 1}\n" for a, b, c in FACES))


def two_arms() -> str:
    """Writes a URDF of two arms on one body; the right one has a joint more."""
    body = ("<inertial><mass value='0.1'/><inertia ixx='1e-4' ixy='0' ixz='0' iyy='1e-4' iyz='0'"
            " izz='1e-4'/></inertial>")
    ways = {"left": ("left upper", "left hand"), "right": ("right upper", "right lower",
                                                           "right hand")}
    links, joints = ["body"], ""
    for way in ways.values():
        before = "body"
        for link in way:
            joints += (f"<joint name='{link}' type='revolute'><parent link='{before}'/>"
                       f"<child link='{link}'/><origin xyz='0.1 0.02 0'/><axis xyz='0 1 0'/>"
                       "<limit lower='-1' upper='1' effort='1' velocity='1'/></joint>")
            links.append(link)
            before = link
    return ("<robot name='two arms'>" + "".join(f"<link name='{name}'>{body}</link>"
                                                for name in links) + joints + "</robot>")


@unittest.skipUnless(drop, "needs python3-xlib")
class Drop(WindowTest):
    def drop(self, *files: Path) -> None:
        drop(self.environment["DISPLAY"], int(self.window), list(files))

    def test_models_of_all_kinds_come_in_at_once(self) -> None:
        glb, stl, obj = (self.home / f"pyramid {kind}" for kind in ("a.glb", "b.STL", "c.obj"))
        write_pyramid(glb)
        write_stl(stl)
        write_obj(obj)
        self.drop(glb, stl, obj)
        self.wait("three models", lambda s: s["objects"] == 4 and not s["loading"])
        self.wait_for_notice("in mm, z up (guessed), largest size 6 cm")
        self.wait_for_notice("in m, y up")

    def test_what_cannot_be_opened_says_what_can(self) -> None:
        wrong = [self.home / "notes.txt", self.home / "folder.glb"]
        wrong[0].write_text("nothing")
        wrong[1].mkdir()
        broken = self.home / "broken.stl"
        broken.write_bytes(b"solid nothing")
        self.drop(*wrong, broken)
        self.wait_for_notice("notes.txt, folder.glb: not opened. Drop models (.glb, .gltf, .stl")
        self.wait_for_notice("broken.stl: ")
        self.assertEqual(self.settled()["objects"], 1)

    def test_a_scene_and_then_a_recording(self) -> None:
        self.drop(ASSETS / "scenes/spheres.toml")
        self.wait("the scene", lambda s: s["file"].endswith("spheres.toml") and not s["loading"])
        session = self.home / "touch.h5"
        subprocess.run([LIMPID, "run", "--duration", "1", "--record", str(session)], check=True,
                       stdout=subprocess.DEVNULL)
        self.drop(session)
        self.wait("playback", lambda s: s["playing"])

    def test_a_hands_path_is_run_in_the_present_world(self) -> None:
        self.drop(ASSETS / "hands/touch.csv")
        self.wait("playback", lambda s: s["playing"])
        self.assertTrue((self.home / "data/limpid/sessions/hand-touch.h5").exists())

    def test_an_arm_takes_the_place_of_the_present_one(self) -> None:
        self.drop(ASSETS / "devices/joystick.urdf")
        self.wait_for_notice("joystick")

    def test_an_arm_that_branches_asks_for_its_tip(self) -> None:
        arm = self.home / "two arms.urdf"
        arm.write_text(two_arms())
        self.drop(arm)
        self.wait("the question", lambda s: s["dialog"] == "arm tip")
        self.key("Escape")
        self.wait("no question", lambda s: s["dialog"] == "")
        self.drop(arm)
        self.wait("the question", lambda s: s["dialog"] == "arm tip")
        self.key("Down")
        self.key("Return")
        self.wait("no question", lambda s: s["dialog"] == "")
        self.wait_for_notice("2 joints to left hand")


if __name__ == "__main__":
    unittest.main()
