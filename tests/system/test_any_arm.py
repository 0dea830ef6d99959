#!/usr/bin/python3
"""Arms from their makers' files: `limpid check`, and a run without a hand made for them."""

from __future__ import annotations

import re
import unittest
from pathlib import Path

import h5py
import numpy as np
from support import ASSETS, SystemTest, limpid

_LAWS = ("standard", "proposed", "predictive")


def _link(name: str, mass: float = 0, inside: str = "", at: str = "0 0 0") -> str:
    inertia = mass * 0.01
    inertial = (
        f'<inertial><origin xyz="{at}"/><mass value="{mass}"/><inertia ixx="{inertia}" ixy="0" '
        f'ixz="0" iyy="{inertia}" iyz="0" izz="{inertia}"/></inertial>'
    )
    return f'<link name="{name}">{inertial if mass else ""}{inside}</link>\n'


def _joint(kind: str, parent: str, child: str, inside: str) -> str:
    return (
        f'<joint name="{parent}_{child}" type="{kind}"><parent link="{parent}"/>'
        f'<child link="{child}"/>{inside}</joint>\n'
    )


def _limit(low: float, high: float, effort: float) -> str:
    return f'<limit lower="{low}" upper="{high}" effort="{effort}" velocity="3"/>'


_MESH = (
    '<visual><geometry><mesh filename="package://nobody/meshes/arm.stl"/></geometry></visual>'
)

# Two joints that turn, a spindle that slides and turns, a flange without mass; no damping.
SCARA = (
    '<robot name="scara">'
    + _link("base")
    + _joint("revolute", "base", "inner", '<axis xyz="0 0 1"/>' + _limit(-2, 2, 100))
    + _link("inner", 8, at="0.15 0 0")
    + _joint("revolute", "inner", "outer",
             '<origin xyz="0.3 0 0"/><axis xyz="0 0 1"/>' + _limit(-2.4, 2.4, 60))
    + _link("outer", 4, at="0.1 0 0")
    + _joint("prismatic", "outer", "spindle",
             '<origin xyz="0.25 0 0"/><axis xyz="0 0 -1"/>' + _limit(0, 0.2, 200))
    + _link("spindle", 1)
    + _joint("continuous", "spindle", "flange",
             '<axis xyz="0 0 1"/><limit effort="5" velocity="9"/>')
    + _link("flange", 0.2)
    + _joint("fixed", "flange", "tool0", '<origin xyz="0.02 0 -0.05"/>')
    + _link("tool0")
    + "</robot>"
)  # fmt: skip

# Six joints of a metre's reach, efforts left out, pictures that are not there, a gripper.
INDUSTRIAL = (
    '<robot name="industrial">'
    + _link("base", 0, _MESH)
    + _joint("revolute", "base", "l1", '<origin xyz="0 0 0.3"/><axis xyz="0 0 1"/>' + _limit(-3, 3, 0))
    + _link("l1", 12, _MESH, "0 0 0.05")
    + _joint("revolute", "l1", "l2", '<axis xyz="0 1 0"/>' + _limit(-3, 3, 0))
    + _link("l2", 8, _MESH, "0.2 0 0")
    + _joint("revolute", "l2", "l3", '<origin xyz="0.4 0 0"/><axis xyz="0 1 0"/>' + _limit(-3, 3, 0))
    + _link("l3", 5, _MESH, "0.2 0 0")
    + _joint("continuous", "l3", "l4", '<origin xyz="0.4 0 0"/><axis xyz="1 0 0"/>')
    + _link("l4", 1)
    + _joint("revolute", "l4", "l5", '<axis xyz="0 1 0"/>' + _limit(-2, 2, 0))
    + _link("l5", 0.5)
    + _joint("continuous", "l5", "l6", '<origin xyz="0.1 0 0"/><axis xyz="1 0 0"/>')
    + _link("l6", 0.3)
    + _joint("prismatic", "l6", "left", '<axis xyz="0 1 0"/>' + _limit(0.01, 0.05, 20))
    + _link("left", 0.05)
    + _joint("prismatic", "l6", "right", '<axis xyz="0 -1 0"/>' + _limit(0.01, 0.05, 20))
    + _link("right", 0.05)
    + "</robot>"
)  # fmt: skip


class AnyArm(SystemTest):
    def write(self, name: str, text: str) -> Path:
        file = self.directory / name
        file.write_text(text)
        return file

    def test_check_ends_with_what_it_found(self) -> None:
        fine = limpid("check", self.write("scara.urdf", SCARA))
        self.assertEqual(fine.status, 0, fine.err + fine.out)
        for words in ("4 joints to 'tool0'", "0 to 0.2 m", "condition (3) is met", "fine",
                      "torque as in the column effort, reached in 20 ms"):
            self.assertIn(words, fine.out)
        warned = limpid("check", self.write("industrial.urdf", INDUSTRIAL))
        self.assertEqual(warned.status, 1, warned.err)
        for words in ("6 joints to 'l6'", "nobody/meshes/arm.stl", "no effort", "held still"):
            self.assertIn(words, warned.out)
        refused = limpid("check", self.write("none.urdf", re.sub("<inertial>.*?</inertial>", "", SCARA)))
        self.assertEqual(refused.status, 2)
        self.assertEqual(len(refused.error_lines), 1)
        self.assertIn("<inertial>", refused.err)

    def refused(self, file: Path | str, *words: str) -> None:
        """Asserts that `limpid check` ends with 2 and one line that names the file, and nothing
        else."""
        found = limpid("check", file)
        self.assertEqual(found.status, 2, f"{file}: {found.out}{found.err}")
        self.assertEqual(found.out, "")
        self.assertEqual(len(found.error_lines), 1, found.err)
        for word in (Path(file).name, *words):
            self.assertIn(word, found.err)

    def test_check_ends_with_2_for_whatever_cannot_be_opened(self) -> None:
        for suffix in ("urdf", "xacro", "toml", "glb", "gltf", "stl", "obj", "ply", "dae", "h5", "txt"):
            with self.subTest(suffix=suffix):
                self.refused(self.directory / f"not there.{suffix}", "no such file")
                folder = self.directory / f"folder.{suffix}"
                folder.mkdir()
                self.refused(folder)
                if suffix != "toml":  # which would be an empty scene
                    self.refused(self.write(f"empty.{suffix}", ""))
                self.refused(self.write(f"nonsense.{suffix}", "\x01\x02 nothing"))
        self.refused(self.directory, "needed: an arm")
        self.refused("/dev/null")
        session = self.record("--duration", "0.1")
        self.refused(session, "limpid info")
        self.refused(self.write("plan.toml", 'title = "a plan"\n[[axis]]\nkey = "coupling.eta"\n'),
                     "axis")
        self.refused(self.write("scene.toml", '[[mesh]]\nname = "part"\nfile = "gone.stl"\nstiffness = 600.0\n'),
                     "gone.stl")
        unreadable = self.write("unreadable.stl", "solid x")
        unreadable.chmod(0)
        self.refused(unreadable)

    def test_check_has_models_at_the_size_at_which_a_run_has_them(self) -> None:
        corners = (((0, 0, 0), (0, 40, 0), (30, 0, 0)), ((0, 0, 0), (30, 0, 0), (0, 0, 20)),
                   ((0, 0, 0), (0, 0, 20), (0, 40, 0)), ((30, 0, 0), (0, 40, 0), (0, 0, 20)))
        self.write("part.stl", "solid part\n" + "".join(
            "facet normal 0 0 0\nouter loop\n" + "".join(f"vertex {x} {y} {z}\n" for x, y, z in facet)
            + "endloop\nendfacet\n" for facet in corners) + "endsolid part\n")  # fmt: skip
        for more, size in (("", "0.03 x 0.04 x 0.02 m"), ("scale = 2.0\n", "0.06 x 0.08 x 0.04 m"),
                           ('unit = "m"\nscale = 0.01\n', "0.3 x 0.4 x 0.2 m")):
            scene = self.write("one.toml", '[[mesh]]\nname = "part"\nfile = "part.stl"\n'
                               "stiffness = 600.0\nposition = [0.1, 0.0, 0.0]\n" + more)
            found = limpid("check", scene)
            self.assertEqual(found.status, 0, found.out + found.err)
            self.assertIn(size, found.out)
        scene = self.write("large.toml", '[[mesh]]\nname = "part"\nfile = "part.stl"\n'
                           'stiffness = 600.0\nunit = "m"\n')
        found = limpid("check", scene)
        self.assertEqual(found.status, 1, found.out + found.err)
        self.assertIn("part: the model is 40 m long, more than 10 m", found.out)

    def test_check_says_how_far_the_tip_gets_and_from_where(self) -> None:
        # Links of 0.3 and 0.25 m in a plane, the tip 0.02 m beside and 0.05 m below, 0.2 m of slide.
        found = limpid("check", self.write("scara.urdf", SCARA))
        far = float(np.hypot(0.3 + 0.25 + 0.02, 0.05 + 0.2))
        self.assertIn(f"reach        {far:.3g} m from the origin of joint 'base_inner' to 'tool0'",
                      found.out)
        self.assertEqual(found.status, 0, found.out)
        endless = SCARA.replace('lower="0" upper="0.2"', 'lower="-1e6" upper="1e6"')
        found = limpid("check", self.write("endless.urdf", endless))
        self.assertEqual(found.status, 1, found.err)
        self.assertIn("joint 'outer_spindle' slides through 2e+06 m", found.out)

    def test_check_says_what_cannot_move(self) -> None:
        stuck = SCARA.replace('<limit lower="-2.4" upper="2.4" effort="60"',
                              '<dynamics friction="75"/><limit lower="-2.4" upper="2.4" effort="60"')
        found = limpid("check", self.write("stuck.urdf", stuck))
        self.assertEqual(found.status, 1, found.err)
        for words in ("'inner_outer'", "friction 75 N m", "effort 60 N m"):
            self.assertIn(words, found.out)
        shaft = ('<robot name="shaft">' + _link("base")
                 + _joint("continuous", "base", "shaft", '<axis xyz="0 0 1"/>') + _link("shaft", 1)
                 + _joint("fixed", "shaft", "end", '<origin xyz="0 0 0.1"/>') + _link("end")
                 + "</robot>")  # fmt: skip
        found = limpid("check", self.write("shaft.urdf", shaft))
        self.assertEqual(found.status, 1, found.err)
        self.assertIn("the tip lies on the axis of 'base_shaft'", found.out)

    def test_an_arm_runs_whose_last_link_has_no_mass(self) -> None:
        light = re.sub('<link name="flange">.*?</link>', '<link name="flange"/>', SCARA)
        arm = self.write("light.urdf", light)
        found = limpid("check", arm)
        self.assertEqual(found.status, 1, found.err)
        for words in ("3 joints to 'tool0'", "'flange'", "has no inertia", "'spindle_flange'"):
            self.assertIn(words, found.out)
        session = self.directory / "light.h5"
        done = limpid("run", "--device", arm, "--duration", "0.2", "--record", session)
        self.assertEqual(done.status, 0, done.err)

    def test_an_arm_that_branches_lists_all_of_its_tips(self) -> None:
        ways = ("".join(
            _joint("revolute", "base", f"{name}_1", '<axis xyz="0 0 1"/>' + _limit(-1, 1, 5))
            + _link(f"{name}_1", 1, at="0.1 0 0")
            + "".join(_joint("revolute", f"{name}_{k}", f"{name}_{k + 1}",
                             '<origin xyz="0.1 0 0"/>' + _limit(-1, 1, 5))
                      + _link(f"{name}_{k + 1}", 1, at="0.1 0 0") for k in range(1, joints))
            for name, joints in (("short", 2), ("long", 4), ("middle", 3))))  # fmt: skip
        found = limpid("check", self.write("tree.urdf", f'<robot name="tree">{_link("base")}{ways}</robot>'))
        self.assertEqual(found.status, 2, found.out)
        self.assertEqual(len(found.error_lines), 1, found.err)
        self.assertIn("'long_4' (4), 'middle_3' (3), 'short_2' (2)", found.err)

    def test_check_knows_scenes_and_models(self) -> None:
        for file, words in (("assets/scenes/gears.toml", "triangles"), ("assets/scenes/gear.glb", "triangles")):
            found = limpid("check", Path(__file__).resolve().parents[2] / file)
            self.assertIn(found.status, (0, 1), found.err)
            self.assertIn(words, found.out)

    def test_an_arm_without_a_hand_moves_and_gives_no_energy_under_every_law(self) -> None:
        for name, text in (("scara.urdf", SCARA), ("industrial.urdf", INDUSTRIAL)):
            arm = self.write(name, text)
            for law in _LAWS:
                with self.subTest(arm=name, law=law):
                    out = self.directory / f"{name}-{law}.h5"
                    run = limpid("run", "--device", arm, "--coupling", law, "--record", out)
                    self.assertEqual(run.status, 0, run.err)
                    self.assertIn("gains fitted", run.err)
                    with h5py.File(out) as session:
                        x = session["/device/position"][:]
                        energy = session["/energy/controller_total"][:]
                    self.assertTrue(np.all(np.isfinite(x)))
                    self.assertGreater(np.ptp(x, axis=0).max(), 1e-3)
                    self.assertLess(energy.max(), 1e-6 + 1e-3 * abs(energy.min()))

    def test_three_slides_keep_to_every_law_as_the_verifier_has_it(self) -> None:
        arm = ASSETS / "devices" / "inverse3.urdf"
        for law in _LAWS:
            with self.subTest(law=law):
                session = self.run_and_read("--device", arm, "--coupling", law)
                self.assert_verified(session)

    def test_a_recording_has_its_arm_without_any_file(self) -> None:
        arm = self.write("gone.urdf", INDUSTRIAL)
        first, again = self.directory / "first.h5", self.directory / "again.h5"
        short = ("--duration", "0.5")
        made = limpid("run", "--device", arm, "--tip", "l4", *short, "--record", first)
        self.assertEqual(made.status, 0, made.err)
        arm.unlink()
        replayed = limpid("run", "--hand", first, "--record", again)
        self.assertEqual(replayed.status, 0, replayed.err)
        with h5py.File(first) as a, h5py.File(again) as b:
            self.assertEqual(a["/device/position"].shape[1], 4)
            np.testing.assert_array_equal(a["/device/position"], b["/device/position"])

    def test_what_is_set_by_hand_is_not_fitted(self) -> None:
        arm = self.write("scara.urdf", SCARA)
        out = self.directory / "set.h5"
        run = limpid("run", "--device", arm, "--set", "coupling.k_vc=7", "--duration", "0.1",
                     "--record", out)  # fmt: skip
        self.assertEqual(run.status, 0, run.err)
        with h5py.File(out) as session:
            self.assertIn("k_vc = 7.0", str(session.attrs["config"]))


if __name__ == "__main__":
    unittest.main()
