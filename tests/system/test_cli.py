#!/usr/bin/python3
"""Commands, as the contract promises them to users and scripts."""

from __future__ import annotations

import csv
import fcntl
import json
import os
import pty
import struct
import subprocess
import termios
import unittest
from pathlib import Path

import h5py
import numpy as np

from limpid_check.session import ATTRIBUTES, DATASETS, read_session
from support import ASSETS, LIMPID, Result, Started, SystemTest, WithAnArm, Words, limpid

COMMANDS = ("play", "run", "story", "experiment", "sweep", "analyze", "devices", "info", "recover")


class Help(SystemTest):
    def test_help_and_version_are_everywhere(self) -> None:
        for command in ([], *([c] for c in COMMANDS)):
            for option in ("--help", "--version"):
                with self.subTest(command=command, option=option):
                    result = limpid(*command, option)
                    self.assertEqual((result.status, result.err), (0, ""))
                    self.assertRegex(result.out, r"\d+\.\d+" if option == "--version" else "limpid")

    def test_the_help_of_the_program_names_every_command(self) -> None:
        text = limpid("--help").out
        for command in COMMANDS:
            self.assertIn(command, text)

    def test_a_command_that_is_nearly_one_is_guessed(self) -> None:
        for wrong, meant in (("anlyze", "analyze"), ("experimnt", "experiment"), ("rnu", "run")):
            refused = limpid(wrong)
            self.assertEqual(refused.status, 2)
            self.assertIn(f"did you mean {meant}?", refused.err)
        self.assertNotIn("did you mean", limpid("banana").err)

    def test_the_help_of_run_names_every_option(self) -> None:
        text = limpid("run", "--help").out
        for option in (
            "device", "scene", "hand", "config", "set", "coupling", "eta", "alpha",
            "duration", "realtime", "seed", "record", "force",
        ):  # fmt: skip
            self.assertIn(f"--{option}", text)

    def test_help_says_what_each_parameter_is_in_lines_that_a_terminal_has_room_for(self) -> None:
        for command in ("run", "analyze", "serve", "check", "sweep"):
            for line in limpid(command, "--help").out.splitlines():
                if command in ("run", "analyze", "serve") or line.startswith("  -"):
                    self.assertLessEqual(len(line), 110, line)
        text = " ".join(limpid("run", "--help").out.split())
        self.assertIn("Spring between device and proxy, equations (1)-(2).", text)
        self.assertIn("Share of the packets between device and proxy that never arrive", text)

    def test_help_and_the_version_are_found_by_their_other_names(self) -> None:
        self.assertEqual(limpid("help").out, limpid("--help").out)
        self.assertEqual(limpid("help", "run").out, limpid("run", "--help").out)
        self.assertEqual(limpid("-V").out, limpid("--version").out)

    def test_an_option_an_experiment_or_a_file_that_is_nearly_one_is_guessed(self) -> None:
        plan = self.out(".toml")
        plan.write_text('measure = ["enrgy"]\naxis = [{key = "coupling.eta", values = [1]}]\n')
        for words, meant in (
            (("run", "--sene", "table.toml"), "--scene"),
            (("run", "--scene", "tabel.toml"), "table.toml"),
            (("check", "stak.toml"), "stack.toml"),
            (("story", "frst.toml"), "first.toml"),
            (("sweep", "tiny.tml", "--out", self.out("")), "tiny.toml"),
            (("info", "tabel.h5"), "table.h5"),
            (("experiment", "inerta", "--out", self.out("")), "inertia"),
            (("sweep", plan, "--out", self.out("")), "energy"),
        ):
            with self.subTest(words=words):
                refused = limpid(*words)
                self.assertEqual(refused.status, 2, refused.err)
                self.assertIn(f"did you mean {meant}?", refused.err)

    def test_what_came_along_is_found_by_its_name(self) -> None:
        for words in (
            ("check", "stack.toml"), ("check", "omni.urdf"), ("info", "table.h5"),
            ("story", "first.toml", "--check"),
            ("run", "--hand", "table.h5", "--duration", "0.01"),
            ("sweep", "tiny.toml", "--out", self.out(""), "--threads", "1"),
        ):  # fmt: skip
            with self.subTest(words=words):
                done = limpid(*words, cwd=self.directory)
                self.assertEqual(done.status, 0, done.out + done.err)

    def test_devices_says_what_there_is_without_any(self) -> None:
        result = limpid("devices")
        self.assertEqual(result.status, 0, result.err)
        self.assertTrue(result.out.strip())


class Run(WithAnArm):
    def test_without_options_but_a_duration_it_records_the_default_arm(self) -> None:
        out = self.record("--duration", "0.5")
        with h5py.File(out, "r") as file:
            self.assertEqual(int(file.attrs["dof"]), 3)
            self.assertEqual(len(file["/time"]), 500)

    def test_the_file_holds_all_the_contract_lists_and_stands_alone(self) -> None:
        out = self.record(*self.arm, "--duration", "0.2", "--seed", "7", "--eta", "0.8")
        with h5py.File(out, "r") as file:
            for name in DATASETS:
                self.assertIn(name, file)
            for name in ATTRIBUTES:
                self.assertIn(name, file.attrs)
            self.assertEqual(file["/coupling/kind"].dtype, np.uint8)
            self.assertEqual(file["/time"].dtype, np.float64)
        session = read_session(out)
        self.assertEqual(int(session.attributes["seed"]), 7)
        self.assertEqual(session.attributes["device_urdf"], self.files.urdf.read_text())
        self.assertEqual(session.attributes["scene"], self.files.scene.read_text())
        iso_8601 = r"^\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d"
        self.assertRegex(session.attributes["created"], iso_8601)
        self.assertEqual(set(np.unique(session["/coupling/eta"])), {0.8})

    def test_a_variation_of_the_hand_is_what_is_random_in_a_run(self) -> None:
        def path(*words: str) -> np.ndarray:
            with h5py.File(self.record(*self.arm, "--duration", "1", *words), "r") as file:
                return file["/hand/target"][...]

        first = path("--variation", "1", "--seed", "1")
        np.testing.assert_array_equal(first, path("--variation", "1", "--seed", "1"))
        self.assertFalse(np.array_equal(first, path("--variation", "2", "--seed", "1")))
        self.assertFalse(np.array_equal(first, path("--variation", "1", "--seed", "2")))
        self.assertFalse(np.array_equal(first, path()))
        np.testing.assert_array_equal(path(), path("--variation", "0", "--seed", "5"))

    def test_a_seed_that_changes_nothing_is_said_to(self) -> None:
        seeded = limpid("run", "--duration", "0.1", "--seed", "3")
        self.assertIn("--seed changes nothing here", seeded.err)
        varied = limpid("run", "--duration", "0.1", "--seed", "3", "--variation", "1")
        self.assertNotIn("--seed", varied.err)

    def test_a_hand_that_does_more_than_follow_a_path_has_no_variations(self) -> None:
        refused = limpid("run", "--hand", ASSETS / "sessions/cup.h5", "--variation", "1")
        self.assertEqual(refused.status, 2)
        self.assertIn("cup.h5 contains more than a path", refused.err)

    def test_short_options_config_and_set_mean_the_same(self) -> None:
        config = self.out(".toml")
        config.write_text('[coupling]\nkind = "standard"\neta = 0.7\n[observer]\nalpha = 0.02\n')
        ways: list[Words] = [
            ["--coupling", "standard", "--eta", "0.7", "--alpha", "0.02"],
            ["--config", config],
            ["--set", "coupling.kind=standard", "--set", "coupling.eta=0.7",
             "--set", "observer.alpha=0.02"],
        ]  # fmt: skip
        rows = []
        for way in ways:
            with h5py.File(self.record(*self.arm, "--duration", "0.3", *way), "r") as file:
                rows.append({n: file[n][()].tobytes() for n in DATASETS if "timing" not in n})
                self.assertEqual(set(file["/coupling/kind"][()]), {0})
                self.assertEqual(set(file["/coupling/alpha"][()]), {0.02})
        self.assertEqual(rows[0], rows[1])
        self.assertEqual(rows[0], rows[2])

    def test_set_overrides_the_config_file(self) -> None:
        config = self.out(".toml")
        config.write_text("[coupling]\neta = 0.7\n")
        out = self.record(
            *self.arm, "--duration", "0.05", "--config", config, "--set", "coupling.eta=0.9"
        )
        self.assertEqual(read_session(out)["/coupling/eta"][0], 0.9)

    def test_the_duration_defaults_to_the_hands_path(self) -> None:
        self.assertEqual(len(read_session(self.record(*self.arm))), 4000)

    def test_an_existing_file_is_kept_unless_forced(self) -> None:
        out = self.record(*self.arm, "--duration", "0.05")
        before = out.read_bytes()
        result = limpid("run", *self.arm, "--duration", "0.1", "--record", out)
        self.assertEqual(result.status, 2)
        self.assertIn(str(out), result.err)
        self.assertEqual(out.read_bytes(), before)
        self.record(*self.arm, "--duration", "0.1", "--force", out=out)
        self.assertEqual(len(read_session(out)), 100)

    def test_an_existing_picture_is_kept_unless_forced(self) -> None:
        picture = self.out(".png")
        picture.write_text("mine")
        result = limpid("run", "--duration", "0.05", "--picture", picture)
        self.assertEqual((result.status, picture.read_text()), (2, "mine"), result.err)
        self.assertIn(str(picture), result.err)

    def test_nothing_is_written_over_what_is_read(self) -> None:
        hand, scene, story = self.out(".csv"), self.out("-scene.toml"), self.out("-story.toml")
        hand.write_bytes((ASSETS / "hands/touch.csv").read_bytes())
        scene.write_bytes((ASSETS / "scenes/free.toml").read_bytes())
        story.write_bytes((ASSETS / "stories/first.toml").read_bytes())
        recorded = self.record("--duration", "0.05")
        for words, file in ((["run", "--hand", hand, "--record", hand], hand),
                            (["run", "--scene", scene, "--record", scene], scene),
                            (["run", "--hand", recorded, "--picture", recorded], recorded),
                            (["story", story, "--record", story], story),
                            (["info", recorded, "--csv", recorded], recorded)):  # fmt: skip
            with self.subTest(words=words):
                before = file.read_bytes()
                result = limpid(*words, "--force")
                self.assertEqual((result.status, len(result.error_lines)), (2, 1), result.err)
                self.assertIn("the command reads this file", result.err)
                self.assertEqual(file.read_bytes(), before)

    def test_a_file_has_the_ending_of_what_is_written_into_it(self) -> None:
        recorded, story = self.record("--duration", "0.05"), ASSETS / "stories/first.toml"
        for words, end in ((["run", "--duration", "0.05", "--record"], ".h5"),
                           (["run", "--duration", "0.05", "--picture"], ".png"),
                           (["story", story, "--record"], ".h5"),
                           (["recover", recorded.with_name("none.h5.part"), "--out"], ".h5")):  # fmt: skip
            for wrong in ("a.txt", "a"):
                with self.subTest(words=words, wrong=wrong):
                    result = limpid(*words, wrong, "--force", cwd=self.directory)
                    self.assertEqual((result.status, len(result.error_lines)), (2, 1), result.err)
                    self.assertIn(f"{wrong}: is not allowed; allowed: a name that ends in {end}", result.err)
                    self.assertFalse((self.directory / wrong).exists())

    def test_a_scene_that_came_along_is_found_by_its_name(self) -> None:
        for words in (["--scene", "cup.toml"], ["--hand", "touch.csv"], ["--device", "joystick.urdf"]):
            with self.subTest(words=words):
                result = limpid("run", *words, "--duration", "0.05", cwd=self.directory)
                self.assertEqual(result.status, 0, result.err)
        result = limpid("run", "--scene", "nothing.toml", cwd=self.directory)
        self.assertEqual(result.status, 2)
        self.assertIn("nothing.toml", result.err)

    def test_what_cannot_be_printed_is_no_success(self) -> None:
        for words in (["--help"], ["analyze", "--json"], ["run", "--duration", "0.05"]):
            with self.subTest(words=words), open("/dev/full", "w") as full:
                result = subprocess.run([LIMPID, *words], stdout=full, stderr=subprocess.PIPE, text=True)
                self.assertEqual(result.returncode, 1)
                self.assertIn("No space left", result.stderr)

    def test_without_record_it_sums_up_and_writes_nothing(self) -> None:
        folder = self.out("")
        folder.mkdir()
        result = limpid("run", *self.arm, "--duration", "0.1", cwd=folder)
        self.assertEqual((result.status, result.err), (0, ""))
        self.assertRegex(result.out, r"ticks +100\b")
        self.assertEqual(list(folder.iterdir()), [])

    def on_a_terminal(self, columns: int, *words: str | Path) -> bytes:
        """Output of a command on a terminal of this width."""
        master, slave = pty.openpty()
        fcntl.ioctl(slave, termios.TIOCSWINSZ, struct.pack("HHHH", 24, columns, 0, 0))
        shown = b""
        with Started(*words, stderr=slave) as started:
            os.close(slave)
            try:
                while chunk := os.read(master, 4096):
                    shown += chunk
            except OSError:  # the last holder of the other end has gone
                pass
            self.assertEqual(started.process.wait(timeout=20), 0)
        os.close(master)
        return shown

    def test_progress_is_one_line_on_a_terminal_that_leaves_nothing(self) -> None:
        words = ["run", *self.arm, "--realtime", "--duration", "2.5"]
        for columns in (100, 33):
            with self.subTest(columns):
                shown = self.on_a_terminal(columns, *words).decode()
                if columns == 100:
                    line = r"run: \d+ %, \d\.\d of 2\.5 s, 1\.0 times real time, [12] s left"
                    self.assertRegex(shown, line)
                screen, at = [" "] * columns, 0
                for letter in shown:
                    self.assertTrue(letter == "\r" or letter.isprintable(), repr(letter))
                    if letter == "\r":
                        at = 0
                        continue
                    self.assertLess(at, columns - 1, "a terminal would wrap")
                    screen[at] = letter
                    at += 1
                    after = "".join(screen[at:]).strip()
                    self.assertTrue(letter == " " or not after, "the rest of a longer line")
                self.assertEqual("".join(screen).strip(), "", "something stays")

    def test_progress_is_shown_on_a_terminal_only_and_of_long_runs_only(self) -> None:
        words = ["run", *self.arm, "--realtime", "--duration", "1.5"]
        quiet = limpid(*words, "--record", self.out())
        self.assertEqual((quiet.status, quiet.err), (0, ""))
        self.assertEqual(self.on_a_terminal(80, "run", *self.arm, "--duration", "0.2"), b"")


class Warnings(SystemTest):
    """Runs that give energy or diverge are reported, and kept."""

    WILD = ("--coupling", "proposed", "--eta", "0.05", "--set", "hand.stiffness=3000",
            "--set", "hand.damping=0")  # fmt: skip

    def test_a_run_that_gave_energy_says_so_and_its_recording_keeps_it(self) -> None:
        out = self.out(".h5")
        done = limpid("run", *self.WILD, "--record", out)
        self.assertEqual(done.status, 0, "it is whole")
        self.assertRegex(done.err, r"limpid: warning: E_c rose to .* J.*: this run is not passive")
        with h5py.File(out) as file:
            kept = file.attrs["warnings"]
            energy = np.max(file["energy/controller_total"][()])
        self.assertIn("this run is not passive", kept)
        self.assertIn(f"E_c rose to {energy:.3g} J", kept)
        for line in str(kept).splitlines():
            self.assertIn(line, limpid("info", out).out)
        self.assertEqual(json.loads(limpid("info", out, "--json").out)["warnings"],
                         str(kept).splitlines())  # fmt: skip

    def test_a_run_as_it_should_be_says_nothing(self) -> None:
        for law in ("standard", "proposed", "predictive", "tank", "eba", "popc", "wave", "tdpn"):
            out = self.out(".h5")
            done = limpid("run", "--coupling", law, "--record", out)
            self.assertEqual((done.status, done.err), (0, ""), law)
            with h5py.File(out) as file:
                self.assertNotIn("warnings", file.attrs)

    def test_sessions_that_came_along_have_nothing_to_warn_of(self) -> None:
        for session in sorted((ASSETS / "sessions").glob("*.h5")):
            with self.subTest(session=session.name):
                self.assertEqual(json.loads(limpid("info", session, "--json").out)["warnings"], [])

    def test_json_has_what_the_lines_have(self) -> None:
        done = limpid("run", "--twin", "--duration", "0.5", "--json")
        found = json.loads(done.out)
        self.assertEqual([run["ticks"] for run in found["runs"]], [500, 500])
        self.assertEqual(found["warnings"], [])
        self.assertRegex(found["provenance"], r"settings [0-9a-f]{8}, seed 0, ")
        self.assertEqual(json.loads(limpid("devices", "--json").out)["devices"], [])
        checked = json.loads(limpid("check", "stack.toml", "--json").out)
        self.assertEqual(checked["warnings"], [])


class Checked(SystemTest):
    """`limpid check` names the flaws of a scene."""

    def check(self, text: str) -> Result:
        scene = self.out(".toml")
        scene.write_text(text)
        return limpid("check", scene)

    def test_flaws_of_a_scene_are_said(self) -> None:
        plane = '[[plane]]\nname = "wall"\npoint = [0.2, 0.0, {z}]\nnormal = [0.0, 0.0, 1.0]\n'
        for text, said in (
            (plane.format(z=-5) + "stiffness = 600", "outside the tip's reach"),
            (plane.format(z=-0.04) + "stiffness = 600\nfriction_static = 0.1\nfriction_kinetic = 0.2",
             "above friction_static"),
            (plane.format(z=-0.04) + "stiffness = 20000", "is stiffer than"),
            (plane.format(z=0.5) + "stiffness = 600", "mm inside"),
            ('title = "x"\n', "the scene has nothing to touch"),
        ):
            with self.subTest(said=said):
                found = self.check(text)
                self.assertEqual(found.status, 1, found.out + found.err)
                self.assertIn(said, found.out)
        self.assertEqual(self.check(plane.format(z=-0.04) + "stiffness = 600").status, 0)


class Info(WithAnArm):
    def test_it_says_what_a_recording_holds(self) -> None:
        out = self.record(*self.arm, "--duration", "0.25", "--eta", "0.8")
        result = limpid("info", out)
        self.assertEqual((result.status, result.err), (0, ""))
        self.assertIn("250", result.out)
        self.assertRegex(result.out, r"\b3\b")

    def test_the_table_holds_every_number_of_the_file(self) -> None:
        out, table = self.record(*self.arm, "--duration", "0.05"), self.out(".csv")
        result = limpid("info", out, "--csv", table)
        self.assertEqual(result.status, 0, result.err)
        with table.open(newline="") as text:
            header, *lines = list(csv.reader(text))
        numbers = np.array([[float(word) for word in line] for line in lines])
        self.assertEqual(len(set(header)), len(header), "two columns of the same name")
        beside = json.loads(Path(f"{table}-metadata.json").read_text())
        self.assertEqual(beside["url"], table.name)
        with h5py.File(out) as file:
            self.assertIn(f"limpid {file.attrs['app_version']}, settings ", beside["dc:description"])
        self.assertEqual(numbers.shape, (50, len(header)))
        columns = {column.tobytes() for column in numbers.T}
        with h5py.File(out, "r") as file:
            for name in DATASETS:
                for column in file[name][()].reshape(50, -1).T.astype(np.float64):
                    self.assertIn(column.tobytes(), columns, f"{name} is not in the table")

    def test_an_existing_table_is_not_overwritten(self) -> None:
        out, table = self.record(*self.arm, "--duration", "0.05"), self.out(".csv")
        table.write_text("mine")
        self.assertEqual(limpid("info", out, "--csv", table).status, 2)
        self.assertEqual(table.read_text(), "mine")

    def test_a_folder_that_cannot_be_written_is_bad_input(self) -> None:
        out = self.record(*self.arm, "--duration", "0.05")
        self.assertEqual(limpid("info", out, "--csv", self.out("") / "none" / "a.csv").status, 2)

    def test_a_table_that_cannot_be_written_is_said(self) -> None:
        out = self.record(*self.arm, "--duration", "0.05")
        result = limpid("info", out, "--csv", "/dev/full", "--force")
        self.assertEqual((result.status, len(result.error_lines)), (2, 1), result.err)
        self.assertIn("/dev/full", result.err)
        self.assertIn("No space left", result.err)

    def test_a_table_on_standard_output_stands_there_alone(self) -> None:
        out = self.record(*self.arm, "--duration", "0.05")
        result = limpid("info", out, "--csv", "-")
        self.assertEqual(result.status, 0, result.err)
        header, *lines = list(csv.reader(result.out.splitlines()))
        self.assertEqual(header[0], "time_s")
        self.assertEqual({len(line) for line in lines}, {len(header)})
        self.assertEqual(len(lines), 50)
        self.assertIn("length", result.err)
        self.assertFalse(Path("-").exists())

    def test_a_table_in_a_folder_that_is_not_there_is_refused_as_all_files_are(self) -> None:
        out = self.record(*self.arm, "--duration", "0.05")
        result = limpid("info", out, "--csv", self.directory / "nowhere/a.csv")
        self.assertEqual((result.status, len(result.error_lines)), (2, 1), result.err)


class Inertias(SystemTest):
    """Inertias of links: impossible ones are reported, others are not."""

    def checked(self, mass: float, moments: tuple[float, float, float]) -> str:
        file = self.out(".urdf")
        x, y, z = moments
        file.write_text(f"""<robot name="r"><link name="base"/>
            <joint name="j" type="revolute"><parent link="base"/><child link="l"/><axis xyz="0 0 1"/>
            <limit lower="-1.5" upper="1.5" effort="1" velocity="10"/><dynamics damping="0.02"/></joint>
            <link name="l"><inertial><origin xyz="0.05 0 0"/><mass value="{mass}"/>
            <inertia ixx="{x}" ixy="0" ixz="0" iyy="{y}" iyz="0" izz="{z}"/></inertial></link>
            <joint name="t" type="fixed"><parent link="l"/><child link="tip"/><origin xyz="0.15 0 0"/></joint>
            <link name="tip"/></robot>""")
        return limpid("check", file).out

    def test_what_no_body_has_is_a_warning(self) -> None:
        self.assertIn("moments given in kg m^2?", self.checked(0.1, (100, 100, 100)))
        self.assertIn("at most the sum of the other two", self.checked(0.1, (1e-5, 1e-5, 1e-3)))

    def test_a_rod_and_a_plate_are_fine(self) -> None:
        rod, plate = (1e-7, 1.9e-4, 1.9e-4), (1.2e-4, 1.2e-4, 2.41e-4)
        for moments in (rod, plate):
            self.assertTrue(self.checked(0.1, moments).endswith("fine\n"), moments)


if __name__ == "__main__":
    unittest.main()
