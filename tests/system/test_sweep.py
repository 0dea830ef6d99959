#!/usr/bin/python3
"""`limpid sweep`: the same table from any programs, with any of them killed meanwhile."""

from __future__ import annotations

import csv
import os
import random
import shutil
import signal
import subprocess
import time
import unittest
from pathlib import Path

import h5py
import numpy as np

from cluster import Slurm
from limpid_check.session import read_session
from support import ASSETS, LIMPID, Result, Started, SystemTest, limpid

# Two thousand points of a few milliseconds each.
LARGE = """title = "Pressed"
hand = { at = [0.19, 0, -0.035], jump = [0, 0, -0.015] }
seconds = 0.6
measure = ["energy_highest", "chatter", "diverged"]
block = 20
axis = [
  { key = "coupling.kind", values = ["standard", "predictive"] },
  { key = "hand.stiffness", from = 100, to = 3000, count = 10, scale = "log" },
  { key = "scene.stiffness", from = 200, to = 5000, count = 10, scale = "log" },
  { key = "coupling.eta", from = 0.3, to = 1, count = 10 },
]
"""


def plan_of(directory: Path, text: str) -> Path:
    path = directory / "plan.toml"
    path.write_text(text)
    return path


def processes(*words: str) -> list[int]:
    """Running programs with all these words on their command line."""
    found = []
    for entry in Path("/proc").iterdir():
        if not entry.name.isdigit() or int(entry.name) == os.getpid():
            continue
        try:
            said = (entry / "cmdline").read_bytes().split(b"\0")
            exe = os.readlink(entry / "exe")
        except OSError:
            continue
        if exe == str(LIMPID.resolve()) and all(word.encode() in said for word in words):
            found.append(int(entry.name))
    return found


def kill_one(*words: str) -> bool:
    """Kills one of the programs at once, like a machine that goes down."""
    there = processes(*words)
    if not there:
        return False
    try:
        os.kill(random.choice(there), signal.SIGKILL)
    except ProcessLookupError:
        return False
    return True


class Tiny(SystemTest):
    plan = ASSETS / "sweeps" / "tiny.toml"
    result: Result
    out_dir: Path

    @classmethod
    def setUpClass(cls) -> None:
        super().setUpClass()
        cls.out_dir = cls.directory / "tiny"
        cls.result = limpid("sweep", cls.plan, "--out", cls.out_dir, "--csv")

    def test_it_succeeds_and_says_where(self) -> None:
        self.assertEqual((self.result.status, self.result.err), (0, ""))
        self.assertIn("48 of 48 points", self.result.out)

    def test_the_table_names_axes_units_and_plan(self) -> None:
        with h5py.File(self.out_dir / "table.h5") as table:
            self.assertEqual(table.attrs["format"], "limpid-sweep")
            self.assertEqual(table.attrs["plan"], self.plan.read_text())
            self.assertEqual(table["/axis/stiffness"].attrs["unit"], "N/m")
            self.assertEqual(table["/axis/stiffness"].attrs["scale"], "log")
            self.assertIn("predictive", table["/axis/kind"].attrs["words"].split("\n"))
            self.assertEqual(table["/measure/human_rms"].attrs["unit"], "N m")
            self.assertTrue(np.all(table["/done"][:] == 1))
            # Below (25) an undamped grip is not stable under the paper's law; at 0.8 every grip is.
            eta, kind = table["/axis/eta"][:], table["/axis/kind"][:]
            stable = table["/measure/stable"][:]
            self.assertTrue(np.all(stable[np.isclose(eta, 0.8)] == 1))
            self.assertFalse(np.any(stable[(np.isclose(eta, 0.3)) & (kind == 1)] == 1))

    def test_text_and_table_agree(self) -> None:
        with (self.out_dir / "table.csv").open() as file:
            rows = list(csv.DictReader(file))
        with h5py.File(self.out_dir / "table.h5") as table:
            written = [float(row["human_rms [N m]"]) for row in rows]
            self.assertEqual(written, list(table["/measure/human_rms"][:]))
            self.assertEqual({row["kind"] for row in rows}, {"proposed", "predictive"})

    def test_the_figure_says_which_plan_it_is_of_and_no_day(self) -> None:
        with h5py.File(self.out_dir / "table.h5") as table:
            key = str(table.attrs["key"])[:8]
        svg = (self.out_dir / "figure.svg").read_text()
        self.assertRegex(svg, rf"<metadata>limpid \S+, settings {key}, seed \d+</metadata>")

    def test_there_is_a_figure_and_nothing_half_written(self) -> None:
        self.assertEqual((self.out_dir / "figure.png").read_bytes()[:4], b"\x89PNG")
        self.assertEqual(list(self.out_dir.rglob("*.new")), [])

    def test_a_point_is_that_very_run(self) -> None:
        environment = {k: v for k, v in os.environ.items() if "DISPLAY" not in k}
        subprocess.run([LIMPID, "sweep", self.plan, "--out", self.out_dir, "--open", "7"],
                       env=environment, check=True, capture_output=True)  # fmt: skip
        session = read_session(self.out_dir / "points" / "7.h5")
        self.assert_verified(session)
        torque = np.sqrt(np.mean(np.sum(session["/hand/torque"] ** 2, axis=1)))
        with h5py.File(self.out_dir / "table.h5") as table:
            self.assertAlmostEqual(torque, table["/measure/human_rms"][7], delta=1e-12)

    def test_what_is_not_allowed_is_refused_before_anything_is_written(self) -> None:
        out = self.directory / "none"
        for words in (["--shard", "0/3"], ["--shard", "4/3"], ["--shard", "x"], ["--mpi"],
                      ["--shard", "1/2", "--gather"], ["--threads", "0"], ["--tasks", "3"],
                      ["--open", "48"]):  # fmt: skip
            with self.subTest(words):
                result = limpid("sweep", self.plan, "--out", out, *words)
                self.assertEqual((result.status, len(result.error_lines)), (2, 1), result.err)
        text = self.plan.read_text().replace("coupling.eta", "coupling.etta")
        bad = plan_of(self.directory, text)
        result = limpid("sweep", bad, "--out", out)
        self.assertEqual(result.status, 2)
        self.assertRegex(result.err, r"plan\.toml:\d+: axis\.key: .*coupling\.eta\?")
        self.assertFalse((out / "blocks").exists())


class Survival(SystemTest):
    plan: Path
    table: bytes  # the result of every way
    points: int  # number of points in the table

    @classmethod
    def setUpClass(cls) -> None:
        super().setUpClass()
        cls.plan = plan_of(cls.directory, LARGE)
        out = cls.directory / "reference"
        result = limpid("sweep", cls.plan, "--out", out, timeout=300)
        if result.status != 0:
            raise AssertionError(result.err)
        cls.table = (out / "table.h5").read_bytes()
        with h5py.File(out / "table.h5") as table:
            cls.points = int(table.attrs["points"])
        random.seed(16)

    def gathered(self, out: Path) -> bytes:
        result = limpid("sweep", self.plan, "--out", out, "--gather")
        self.assertEqual(result.status, 0, result.err + result.out)
        return (out / "table.h5").read_bytes()

    def test_killed_workers_are_taken_over(self) -> None:
        out = self.directory / "killed"
        for _ in range(4):
            with Started("sweep", self.plan, "--out", out, "--threads", "2") as started:
                time.sleep(random.uniform(0.1, 0.6))
                started.process.kill()
        self.assertLess(len(list((out / "blocks").glob("*.h5"))), 100)
        result = limpid("sweep", self.plan, "--out", out, timeout=300)
        self.assertEqual(result.status, 0, result.err)
        self.assertEqual((out / "table.h5").read_bytes(), self.table)

    def test_shards_and_their_gatherers_come_to_the_same_table(self) -> None:
        out = self.directory / "shards"
        for i in (3, 1):
            result = limpid("sweep", self.plan, "--out", out, "--shard", f"{i}/3", timeout=300)
            self.assertEqual((result.status, result.err), (0, ""))
        part = limpid("sweep", self.plan, "--out", out, "--gather")
        self.assertEqual(part.status, 1)
        self.assertIn("1340 of 2000 points", part.out)
        with h5py.File(out / "table.h5") as table:
            self.assertEqual(int(table["/done"][:].sum()), 1340)
        for _ in range(10):
            with Started("sweep", self.plan, "--out", out, "--gather") as started:
                time.sleep(random.uniform(0, 0.2))
                started.process.kill()
            with h5py.File(out / "table.h5") as table:
                self.assertEqual(int(table["/done"][:].sum()), 1340)
        limpid("sweep", self.plan, "--out", out, "--shard", "2/3", timeout=300)
        with Started("sweep", self.plan, "--out", out, "--gather"):
            self.assertEqual(self.gathered(out), self.table)
        self.assertEqual(self.gathered(out), self.table)

    def test_two_at_once_do_not_harm_each_other(self) -> None:
        out = self.directory / "two"
        with Started("sweep", self.plan, "--out", out) as other:
            result = limpid("sweep", self.plan, "--out", out, timeout=300)
            self.assertEqual(result.status, 0, result.err)
            self.assertEqual(other.process.wait(timeout=300), 0)
        self.assertEqual((out / "table.h5").read_bytes(), self.table)

    def test_ctrl_c_leaves_a_table_of_what_is_done(self) -> None:
        out = self.directory / "stopped"
        with Started("sweep", self.plan, "--out", out) as started:
            while len(list(out.glob("blocks/*.h5"))) < 3:
                time.sleep(0.02)
            self.assertEqual(started.stop(signal.SIGINT), 1)
            said = started.process.communicate()[1].decode()
        self.assertEqual(said, "limpid: stopped; the same command continues from here\n")
        with h5py.File(out / "table.h5") as table:
            done = table["/done"][:] == 1
            self.assertTrue(0 < done.sum() < self.points)
            self.assertTrue(np.all(np.isfinite(table["/measure/chatter"][:][done])))

    def test_a_full_disk_loses_nothing(self) -> None:
        place = self.directory / "full"
        place.mkdir()
        mount = ["mount", "-t", "tmpfs", "-o", "size=256k", "limpid-test", str(place)]
        if subprocess.run(mount, capture_output=True).returncode != 0:
            self.skipTest("may not mount a file system")
        self.addCleanup(subprocess.run, ["umount", str(place)], check=True)
        out = place / "sweep"
        result = limpid("sweep", self.plan, "--out", out, timeout=300)
        self.assertEqual(result.status, 1)
        self.assertRegex(result.err, r"No space left on device; the same command continues from here")
        self.assertEqual(list(out.rglob("*.new")), [])
        subprocess.run(["mount", "-o", "remount,size=32m", str(place)], check=True)
        result = limpid("sweep", self.plan, "--out", out, timeout=300)
        self.assertEqual(result.status, 0, result.err)
        self.assertEqual((out / "table.h5").read_bytes(), self.table)

    def test_past_a_limit_of_the_shell_it_says_so_and_loses_nothing(self) -> None:
        out = self.directory / "limited"
        size = (len(self.table) // 1024 + 1) // 2  # [KiB]; room for blocks, none for the table
        self.assertGreaterEqual(size, 65, "what is tried before the work begins is as large")
        run = ["bash", "-c", f'ulimit -f {size}; exec "$0" "$@"', str(LIMPID), "sweep",
               str(self.plan), "--out", str(out)]  # fmt: skip
        said = subprocess.run(run, capture_output=True, text=True, timeout=300)
        self.assertEqual(said.returncode, 1, said.stderr)
        self.assertRegex(said.stderr, r"table\.h5: cannot be written: File too large; the same command")
        self.assertEqual(list(out.rglob("*.new")), [])
        result = limpid("sweep", self.plan, "--out", out, timeout=300)
        self.assertEqual(result.status, 0, result.err)
        self.assertEqual((out / "table.h5").read_bytes(), self.table)

    def test_another_build_is_refused(self) -> None:
        out = self.directory / "build"
        limpid("sweep", self.plan, "--out", out, "--shard", "1/50", timeout=300)
        before = len(list((out / "blocks").glob("*.h5")))
        other = LIMPID.with_name("limpid-of-another-build")  # beside it, where its files are found
        self.addCleanup(other.unlink)
        shutil.copy(LIMPID, other)
        with other.open("ab") as file:
            file.write(b"\0")
        for words in (["--shard", "2/50"], ["--gather"]):
            done = subprocess.run([other, "sweep", self.plan, "--out", out, *words],
                                  capture_output=True, text=True)  # fmt: skip
            self.assertEqual(done.returncode, 2, done.stderr)
            self.assertIn("made from another build of limpid", done.stderr)
        self.assertEqual(len(list((out / "blocks").glob("*.h5"))), before)

    def test_ranks_of_mpirun_some_killed(self) -> None:
        mpirun = shutil.which("mpirun")
        if mpirun is None:
            self.skipTest("no mpirun here (openmpi-bin)")
        out = self.directory / "mpi"
        words = [mpirun, "--allow-run-as-root", "--oversubscribe", "-n", "3", str(LIMPID), "sweep",
                 str(self.plan), "--out", str(out), "--mpi"]  # fmt: skip
        killed = 0
        for _ in range(30):
            run = subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
            while killed < 3 and run.poll() is None:
                time.sleep(0.02)
                if len(list(out.glob("blocks/*.h5"))) > 5 * killed:
                    if kill_one("--mpi", str(out)):
                        killed += 1
                        break
            said = run.communicate(timeout=300)
            if run.returncode == 0:
                break
        self.assertEqual(run.returncode, 0, said[1].decode())
        self.assertEqual(killed, 3)
        self.assertEqual((out / "table.h5").read_bytes(), self.table)

    def test_tasks_of_slurm_some_killed_and_a_killed_gatherer(self) -> None:
        slurm = Slurm(self.directory / "slurm")
        self.addCleanup(slurm.stop)
        out = self.directory / "array"
        words = [str(LIMPID), "sweep", str(self.plan), "--out", str(out), "--slurm", "--tasks", "8"]

        def started() -> subprocess.Popen:
            return subprocess.Popen(words, env=slurm.environment, stdout=subprocess.PIPE,
                                    stderr=subprocess.PIPE)  # fmt: skip

        gatherer = started()
        killed = 0
        deadline = time.monotonic() + 120
        while killed < 4 and time.monotonic() < deadline and gatherer.poll() is None:
            time.sleep(random.uniform(0.1, 0.5))
            killed += kill_one("--shard", str(out))
            if killed == 2 and gatherer.poll() is None:
                gatherer.kill()
                gatherer.communicate()
                gatherer = started()
        said = gatherer.communicate(timeout=250)
        self.assertEqual(gatherer.returncode, 0, said)
        self.assertGreaterEqual(killed, 2)
        self.assertEqual((out / "table.h5").read_bytes(), self.table)
        self.assertGreater(len(list((out / "slurm").glob("*.log"))), 8, "none was submitted again")


if __name__ == "__main__":
    unittest.main()
