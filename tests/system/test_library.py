"""liblimpid and limpid.Loop from an installed tree, as other programs use them."""

from __future__ import annotations

import json
import os
import shutil
import socket
import subprocess
import time
import unittest
from pathlib import Path

from support import LIMPID, SystemTest

PYTHON = "/usr/bin/python3"
BUILD = LIMPID.parents[1]


def must(*words: str | Path, **how) -> str:
    done = subprocess.run(list(map(str, words)), capture_output=True, text=True, timeout=280, **how)
    if done.returncode != 0:
        raise AssertionError(f"{words}\n{done.stdout}{done.stderr}")
    return done.stdout


class Installed(SystemTest):
    prefix: Path

    @classmethod
    def setUpClass(cls) -> None:
        super().setUpClass()
        if "LIMPID_SANITIZE:STRING=\n" not in (BUILD / "CMakeCache.txt").read_text():
            raise unittest.SkipTest("other programs have no sanitized library")
        cls.prefix = cls.directory / "prefix"
        must("cmake", "--install", BUILD, "--prefix", cls.prefix)

    def modules(self) -> Path:
        return next(self.prefix.rglob("limpid/__init__.py")).parent.parent

    def environment(self) -> dict[str, str]:
        """Of a program that has the installed package, and no other program's name."""
        others = {name: value for name, value in os.environ.items() if name != "LIMPID"}
        return {**others, "PYTHONPATH": str(self.modules()), "PYTHONDONTWRITEBYTECODE": "1"}

    def python(self, text: str) -> str:
        return must(PYTHON, "-c", text, env=self.environment(), cwd=self.directory)

    def test_examples_are_built_by_cmake_and_run(self) -> None:
        examples = self.prefix / "share/doc/limpid/examples/library"
        for file in examples.glob("*.cpp"):
            self.assertLess(len(file.read_text().splitlines()), 80, file.name)
        out = self.directory / "examples"
        must("cmake", "-S", examples, "-B", out, "-G", "Ninja", f"-DCMAKE_PREFIX_PATH={self.prefix}",
             "-DCMAKE_CXX_FLAGS=-Wall -Wextra -Werror")
        must("cmake", "--build", out)
        names = sorted(file.stem for file in examples.glob("*.cpp"))
        self.assertGreaterEqual(len(names), 4)
        for name in names:
            if name == "beside_mujoco" and not (out / name).exists():
                continue  # no libmujoco-dev
            with self.subTest(name):
                self.assertNotEqual(must(out / name, cwd=out), "")
        readings = out / "readings.csv"
        readings.write_text("0,-0.6,1.5\n" * 50)
        self.assertIn("predictive", must(out / "compare_laws", readings, cwd=out))

    def test_a_program_is_built_by_pkg_config(self) -> None:
        (config,) = self.prefix.rglob("limpid.pc")
        environment = {**os.environ, "PKG_CONFIG_PATH": str(config.parent)}
        flags = must("pkg-config", "--cflags", "--libs", "limpid", env=environment).split()
        source = self.directory / "version.cpp"
        source.write_text("#include <limpid/limpid.h>\n#include <cstdio>\n"
                          "int main() { std::puts(limpid::library_version().c_str()); }\n")
        must("g++", "-std=c++20", source, "-o", self.directory / "version", *flags,
             f"-Wl,-rpath,{config.parent.parent}")
        self.assertEqual(f"limpid {must(self.directory / 'version').strip()}", must(LIMPID, "--version").strip())

    def test_nothing_but_the_header_is_seen_of_the_library(self) -> None:
        (library,) = [each for each in self.prefix.rglob("liblimpid.so.*.*.*")]
        names = must("nm", "-DC", "--defined-only", library).splitlines()
        strange = [name for name in names if "limpid::" not in name]
        self.assertEqual(strange, [])
        inner = [name for name in names if "limpid::Rig" in name or "limpid::Tick" in name]
        self.assertEqual(inner, [])
        needed = must("objdump", "-p", library)
        for window in ("libGL", "libEGL", "libglfw", "libimgui", "libX11", "libdbus", "libav"):
            self.assertNotIn(f"NEEDED               {window}", needed)

    def test_python_runs_the_rows_of_the_program(self) -> None:
        self.assertEqual(self.python("""
import limpid, numpy
hand = [(0, 0.19, 0, 0), (0.5, 0.19, 0.01, -0.05), (1, 0.2, 0, -0.05)]
for law in ("standard", "predictive", "proposed"):
    session = limpid.run(hand=hand, coupling=law, eta=0.7, scene="table.toml")
    run = limpid.Loop(scene="table.toml", coupling=law, eta=0.7).run(hand)
    assert run.rows == len(session.time), (run.rows, len(session.time))
    for name in run:
        if name.startswith("timing/"): continue
        ours, theirs = run[name], session.channel(name)
        assert ours.shape == theirs.shape, (name, ours.shape, theirs.shape)
        assert numpy.array_equal(ours, theirs, equal_nan=True), (law, name)
    assert run["contact/force"].shape[1:] == run["contact/point"].shape[1:] == (4, 3)
    assert numpy.allclose(session["contact/force"].sum(axis=1), session.contact_force, atol=1e-12)
    [contact] = session.contacts
    assert contact.point in {tuple(point) for point in session["contact/point"][:, 0]}
    few = limpid.Loop(scene="table.toml", coupling=law, eta=0.7).run(hand, channels=["/proxy/position", "hand/grip"])
    assert list(few) == ["time", "proxy/position", "hand/grip"]
    assert numpy.array_equal(few["proxy/position"], run["proxy/position"])
    assert set(session.channels) == set(run), (law, set(session.channels) ^ set(run))
print("the same")
"""), "the same\n")

    def test_python_has_the_same_shapes_in_rows_runs_and_sessions(self) -> None:
        """Also of an arm with a single joint, and of objects that move."""
        self.assertEqual(self.python('''
import limpid, numpy
arm = limpid.Arm("slide", [dict(name="slide", slides=True, axis=(1, 0, 0), lower=-0.2, upper=0.2, effort=8, damping=0.5,
                                mass=0.1)])
scene = limpid.Scene(gravity=(0, 0, 0))
scene.add("body", "ball", sphere=0.01, mass=0.02, position=(0.1, 0, 0))
hand = [(0, 0, 0, 0), (0.1, 0.01, 0, 0)]
loop = limpid.Loop(arm=arm, scene=scene)
row, run, session = loop.step((0.01, 0, 0)), loop.run(hand), limpid.run(arm=arm, scene=scene, hand=hand)
assert set(row) == set(run) == set(session.channels)
for name in run:
    assert run[name].shape == session[name].shape, (name, run[name].shape, session[name].shape)
    assert numpy.shape(row[name]) == run[name].shape[1:], (name, row[name])
assert isinstance(row["time"], float) and isinstance(row["energy/objects"], float)
assert row["device/position"].shape == row["hand/torque"].shape == (1,)
assert row["contact/force"].shape == (4, 3) and row["objects/pose"].shape == (1, 7)
few = loop.run(hand, channels=["contact/force", "device/position"])
assert numpy.array_equal(few["contact/force"], run["contact/force"]) and few["device/position"].shape == (100, 1)
device = limpid.DeviceLoop([0.0], arm=arm, motors="simulated")
assert device.tick([0.001]).shape == device.row["device/position"].shape == (1,)
print("alike")
'''), "alike\n")

    def test_python_refuses_to_record_into_a_file_of_another_kind(self) -> None:
        self.assertEqual(self.python('''
import limpid, os
loop = limpid.Loop()
for record in (loop.record, lambda file: limpid.run(hand=[(0, 0.19, 0, 0), (0.1, 0.19, 0, 0)], record=file)):
    for file in ("a.csv", "a"):
        try:
            record(file)
        except limpid.LimpidError as error:
            assert file in str(error) and ".h5" in str(error), error
        else:
            raise AssertionError("refused nothing")
        assert not os.path.exists(file) and not os.path.exists(file + ".part")
loop.record("refused-before.h5")
loop.step(loop.tip)
assert loop.finish_recording() == 0 and len(limpid.session("refused-before.h5")) == 1
print("refused")
'''), "refused\n")

    def test_python_derives_the_tips_of_arms_that_slide(self) -> None:
        self.assertEqual(self.python('''
import limpid, numpy
arm = limpid.Arm("gantry", [dict(name=n, slides=True, axis=a, lower=-0.2, upper=0.2, mass=0.3, damping=2, effort=20)
                            for n, a in (("x", (1, 0, 0)), ("y", (0, 1, 0)), ("z", (0, 0, 1)))], tip=(0.01, 0.02, 0.03))
loop = limpid.Loop(arm=arm, scene_text="gravity = [0, 0, 0]")
for k in range(400):
    row = loop.step((0.05, 0.02, -0.04))
assert numpy.allclose(row["device/tip"], row["device/position"] + (0.01, 0.02, 0.03), atol=1e-12)
assert numpy.linalg.norm(row["device/tip"]) > 0.02
assert numpy.allclose(row["proxy/tip_velocity"], row["proxy/velocity"], atol=1e-12)
run = loop.run([(0, 0, 0, 0), (0.5, 0.05, 0.02, -0.04)], channels=["device/tip"])
assert run["device/tip"].shape == (500, 3) and list(run) == ["time", "device/tip"]
print("derived")
'''), "derived\n")

    def test_python_hears_ctrl_c_during_a_run(self) -> None:
        self.assertEqual(self.python("""
import limpid, signal
def heard(*of):
    raise KeyboardInterrupt
signal.signal(signal.SIGALRM, heard)
loop = limpid.Loop()
loop.run([(0, 0.19, 0, 0), (1, 0.19, 0, -0.01)])
try:
    signal.setitimer(signal.ITIMER_REAL, 0.2)
    loop.run([(0, 0.19, 0, 0), (3000, 0.19, 0, -0.01)], channels=[])
except KeyboardInterrupt:
    print("heard", loop.run([(0, 0.19, 0, 0), (1, 0.19, 0, -0.01)]).rows)
"""), "heard 1000\n")

    def test_python_says_the_programs_version(self) -> None:
        said = self.python("import limpid; print(limpid.__version__)").strip()
        whole = must(LIMPID, "--version").split()[1]
        self.assertEqual(said, whole.split("+")[0])

    def test_python_says_which_channel_and_setting_was_meant(self) -> None:
        self.assertEqual(self.python("""
import limpid
loop = limpid.Loop(scene="table.toml")
row = loop.step(loop.tip)
def said(work):
    try:
        work()
    except limpid.LimpidError as error:
        return str(error)
assert "did you mean device/position?" in said(lambda: row["device/positon"])
assert "did you mean coupling.eta?" in said(lambda: loop.set({"coupling.etta": 1}))
assert "belongs to the simulated hand" in said(lambda: limpid.DeviceLoop([0, -0.8, 1.5], arm="omni.urdf", hand__stiffness=3))
assert "joint 1 has 9" in said(lambda: limpid.DeviceLoop([9, -0.8, 1.5], arm="omni.urdf"))
assert "effort 0" in said(lambda: limpid.Arm("a", [dict(name="j", effort=0, mass=1)]))
assert max(abs(a - b) for a, b in zip(loop.proxy_tip, loop.tip)) < 1e-6
print("said")
"""), "said\n")

    def test_python_steps_a_loop_and_one_of_a_device(self) -> None:
        self.assertEqual(self.python("""
import limpid, numpy
loop = limpid.Loop(coupling="standard")
x, y, z = loop.tip
for k in range(300):
    row = loop.step((x, y, z - 1e-4 * k))
assert row["device/position"].shape == (3,) and loop.joints == 3
assert abs(row["time"] - 0.299) < 1e-12
loop.set(eta=0.5)
assert loop.get("coupling.eta") == 0.5 and loop.get("coupling.kind") == "standard"
assert loop.energy.controller < 0

device = limpid.DeviceLoop([0, -0.8, 1.5], arm="omni.urdf", coupling="predictive", limits={"tip_force": 2})
assert not device.armed and device.force_share == 0 and "not armed" in device.force_text
assert list(device.tick([0, -0.8, 1.5])) == [0, 0, 0]
for wrong in (lambda: limpid.Loop(scene="no.toml"), lambda: limpid.Loop(eta=-1),
              lambda: limpid.Loop(etta=1), lambda: loop.step((0, 0)), lambda: row["place"], lambda: loop.step(None), lambda: loop.step(loop.tip, torque=None),
              lambda: loop.step(loop.tip, torque=(0, float("nan"), 0)),
              lambda: loop.run(numpy.ma.masked_less(numpy.array([[0, 0.19, 0, 0], [1, 0.19, 0, -0.01]]), 0)),
              lambda: limpid.DeviceLoop([0, 0], arm="omni.urdf"), lambda: limpid.DeviceLoop([0, -0.8, 1.5]), lambda: loop.run([(0, 1, 2, 3)]),
              lambda: loop.run([(0, 9, 9, 9), (1, 9, 9, 9)]), lambda: loop.set({"loop.tick": 0.002}),
              lambda: loop.set({"coupling.eta": 0.25, "coupling.k_vc": -1}),
              lambda: limpid.DeviceLoop([0, -0.8, 1.5], arm="omni.urdf", limits={"tip_force": 99}),
              lambda: limpid.DeviceLoop([0, -0.8, 1.5], arm="omni.urdf", limits={"force": 1})):
    try:
        wrong()
    except limpid.LimpidError as error:
        assert str(error)
    else:
        raise AssertionError("refused nothing")
assert loop.get("coupling.eta") == 0.5, "all settings or none"
assert "place" not in row and row.get("place", 0) == 0 and "device/position" in row
# Whatever a device's driver gives for no reading ends the force of real motors, and raises nothing.
for wrong in ([0, -0.8], [0, -0.8, 1.5, 0], None, "ab", [0, 0, "x"], [[0, 0, 0]] * 3, [0, float("nan"), 1.5]):
    real = limpid.DeviceLoop([0, -0.8, 1.5], arm="omni.urdf", coupling="standard")
    real.arm()
    for k in range(700):
        pushed = real.tick([1e-5 * min(k, 500), -0.8, 1.5], elapsed=0.001)
    assert real.force_share == 1 and numpy.abs(pushed).max() > 0, (real.force_text, pushed)
    assert list(real.tick(wrong, elapsed=0.001)) == [0, 0, 0], wrong
    assert real.force_share == 0 and real.force_text, wrong
    assert list(real.tick([0.005, -0.8, 1.5], elapsed=0.001)) == [0, 0, 0], wrong
real = limpid.DeviceLoop([0, -0.8, 1.5], arm="omni.urdf")
for late in (float("nan"), -1, "soon", None):
    assert list(real.tick([0, -0.8, 1.5], elapsed=late)) == [0, 0, 0]
assert list(real.tick([], fresh=False)) == [0, 0, 0]
simulated = limpid.DeviceLoop([0, -0.8, 1.5], motors="simulated")
for wrong in (lambda: setattr(loop, "eta", 0.3), lambda: __import__("pickle").dumps(loop), lambda: loop.get(3),
              lambda: simulated.tick([0, -0.8, 1.5], elapsed=float("nan")), lambda: loop.step((10**400, 0, 0)),
              lambda: loop.run([(0, *loop.tip), (1, *loop.tip)], duration=1e12), lambda: limpid.Arm("a", joints=[3]),
              lambda: limpid.Arm(3), lambda: limpid.Arm("a", tip=3), lambda: limpid.Arm("a", joints=[{"slides": "no"}]),
              lambda: limpid.Arm("a", joints=[{"mass": 1, "inertia": (1,) * 7}]), lambda: limpid.Scene(title=chr(0xd800)).text(),
              lambda: setattr(limpid.Scene(), "gravity", (0, 0, 0)), lambda: limpid.Loop(coupling__per_joints=True)):
    try:
        wrong()
    except limpid.LimpidError as error:
        assert str(error)
    else:
        raise AssertionError("refused nothing")
scene = limpid.Scene()
scene.add("plane", "floor", point=(0, 0, 0), normal=(0, 0, 1))
assert "floor" in scene and "wall" not in scene
for wrong in ("ab", [0, 0], None, [0, 0, "x"]):
    try:
        simulated.tick(wrong)
    except limpid.LimpidError as error:
        assert "position" in str(error)
    else:
        raise AssertionError("refused nothing")
print("as said")
"""), "as said\n")

    def test_python_loops_run_beside_each_other(self) -> None:
        self.assertEqual(self.python("""
import limpid, numpy
from concurrent.futures import ThreadPoolExecutor
loop = limpid.Loop(coupling="predictive")
hand = [(0, 0.19, 0, 0), (1, 0.19, 0, -0.05)]
alone = loop.run(hand)["device/position"]
with ThreadPoolExecutor(4) as threads:
    for found in threads.map(lambda _: loop.run(hand)["device/position"], range(12)):
        assert numpy.array_equal(alone, found)
print("alike")
"""), "alike\n")

    def test_a_learner_presses_as_hard_as_it_is_asked_to(self) -> None:
        said = must(PYTHON, self.prefix / "share/doc/limpid/examples/touch_env.py", env=self.environment())
        self.assertIn("at last 0.50 N", said)

    def test_scenes_and_arms_are_values(self) -> None:
        self.assertEqual(self.python("""
import limpid, math
scene = limpid.Scene(title="A \\"wall\\"", gravity=(0, 0, 0))
scene.add("plane", "wall", point=(0, 0, 0), normal=(-1, 0, 0), stiffness=400)
scene.add("body", "ball", sphere=0.01, mass=0.02, position=(0.2, 0, 0.1))
scene["wall"]["stiffness"] = 500
arm = limpid.Arm("slide", [dict(name="slide", slides=True, axis=(1, 0, 0), lower=-0.2, upper=0.2,
                                effort=8, damping=0.5, mass=0.1)])
assert arm.get("slide") == {"lower": -0.2, "upper": 0.2, "effort": 8, "damping": 0.5, "friction": 0}
loop = limpid.DeviceLoop([-0.01], arm=arm, scene=scene, motors="simulated", coupling="direct")
for k in range(2000):
    force = loop.tick([min(0.004, -0.01 + 1e-5 * k)])[0]
assert math.isclose(force, -500 * 0.004, abs_tol=1e-6), force

ideal = limpid.Arm.read("touch.urdf")
for name in ideal.joints:
    ideal.set(name, friction=0)
assert ideal.get("elbow")["friction"] == 0
cup = limpid.Scene.read("cup.toml")
count = len(cup)
del cup[next(each["name"] for each in cup if each["kind"] == "body")]
assert len(cup) == count - 1
hand = [(0, 0.19, 0, 0.02), (0.2, 0.19, 0, 0.01)]
here = limpid.Loop(arm=ideal, scene=cup).run(hand)
there = limpid.run(arm=ideal, scene=cup, hand=hand)
assert (here["device/position"] == there["device/position"]).all()
for wrong in (lambda: scene["floor"], lambda: scene.add("wal"),
              lambda: scene.add("plane", "wall"), lambda: arm.set("elbow", damping=1),
              lambda: arm.set("slide", mass=1), lambda: limpid.Arm(joints=[dict(nam="a")]),
              lambda: limpid.Loop(scene=limpid.Scene(gravty=1)), lambda: limpid.Scene.read("no.toml")):
    try:
        wrong()
    except limpid.LimpidError as error:
        assert str(error)
    else:
        raise AssertionError("refused nothing")
print("as said")
"""), "as said\n")

    def test_sessions_are_tables_where_there_is_a_library_for_them(self) -> None:
        said = self.python("""
import limpid
session = limpid.run(hand=[(0, 0.19, 0, 0), (0.1, 0.19, 0, -0.01)])
try:
    frame = session.frame(["device/position", "hand/grip"])
    assert list(frame) == ["device/position[0]", "device/position[1]", "device/position[2]", "hand/grip"]
    assert (frame["device/position[1]"].to_numpy() == session["device/position"][:, 1]).all()
    assert frame.index.name == "time" and len(frame) == len(session)
    data = session.dataset(["device/position", "contact/force"])
    assert data["device/position"].attrs["units"] == session.unit("device/position")
    assert data["contact/force"].shape == session["contact/force"].shape
    apart = session.dataset(["device/position", "proxy/position", "device/tip"])
    difference = apart["device/position"] - apart["proxy/position"]
    assert difference.dims == ("time", "joint"), difference.dims
    assert (difference.values == session["device/position"] - session["proxy/position"]).all()
    assert list(difference["joint"].values) == session.joints
    assert list(apart["axis"].values) == ["x", "y", "z"]
    touched = session.dataset(["contact/point", "device/tip"])
    assert touched["contact/point"].dims == ("time", "contact", "axis"), touched["contact/point"].dims
    assert (touched["contact/point"] - touched["device/tip"]).shape == session["contact/point"].shape
    assert list(session.frame(["contact/force"])) == [f"contact/force[{i}]" for i in range(12)]
    assert frame.attrs["units"] == {"device/position[0]": "rad", "device/position[1]": "rad",
                                    "device/position[2]": "rad", "hand/grip": session.unit("hand/grip")}
    assert (data["device/position"].sel(time=0.05, method="nearest").values == session["device/position"][50]).all()
    try:
        import netCDF4
    except ImportError:
        netCDF4 = None
    if netCDF4:
        data.rename({name: name.replace("/", "_") for name in data}).to_netcdf("saved.nc")
        with netCDF4.Dataset("saved.nc") as saved:
            assert (saved["device_position"][50] == session["device/position"][50]).all()
    print("tables")
except limpid.LimpidError as error:
    print(error)
""")
        if "is missing" in said:
            self.skipTest(said)
        self.assertEqual(said, "tables\n")

    def test_rows_of_a_running_loop_are_sent_over_udp(self) -> None:
        folder = self.directory / "run"
        folder.mkdir(mode=0o700, exist_ok=True)
        environment = {**self.environment(), "XDG_RUNTIME_DIR": str(folder)}
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as into:
            into.bind(("127.0.0.1", 0))
            into.settimeout(30)
            started = []
            try:
                started.append(subprocess.Popen([self.prefix / "bin/limpid", "serve", "lab"], env=environment,
                                                stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL))
                for _ in range(300):
                    if (folder / "limpid/lab.control").exists():
                        break
                    time.sleep(0.1)
                started.append(subprocess.Popen(
                    [PYTHON, "-m", "limpid", "stream", f"127.0.0.1:{into.getsockname()[1]}", "hand/grip",
                     "device/position", "--name", "lab", "--rate", "50"], env=environment))  # fmt: skip
                rows = [json.loads(into.recv(65536)) for _ in range(10)]
            finally:
                for program in reversed(started):
                    program.terminate()
                    program.wait(30)
        times = [row["time"] for row in rows]
        self.assertEqual(times, sorted(set(times)))
        self.assertEqual(len(rows[0]["device/position"]), 3)

    def test_python_without_the_module_says_so(self) -> None:
        bare = self.directory / "bare"
        shutil.copytree(self.modules() / "limpid", bare / "limpid", ignore=shutil.ignore_patterns("*.so"))
        said = must(PYTHON, "-c", """
import limpid
try:
    limpid.Loop()
except limpid.LimpidError as error:
    print(error)
""", env={"PATH": "/usr/bin:/bin", "PYTHONPATH": str(bare), "PYTHONDONTWRITEBYTECODE": "1"})
        self.assertIn("limpid._loop", said)

    def test_python_finds_its_own_scenes_where_there_is_no_program(self) -> None:
        """As `pip install` puts them."""
        prefix = self.directory / "pip"
        packages = prefix / "lib/python3/site-packages"
        shutil.copytree(self.modules() / "limpid", packages / "limpid")
        shutil.copytree(self.prefix / "share/limpid/assets", prefix / "share/limpid/assets")
        said = must(PYTHON, "-c", """
import limpid
print(len(limpid.Scene.read("cup.toml")), limpid.Arm.read("omni.urdf"))
try:
    limpid.Scene.read("cupp.toml")
except limpid.LimpidError as error:
    print(error)
""", env={"PATH": "/nowhere", "PYTHONPATH": str(packages), "PYTHONDONTWRITEBYTECODE": "1"})
        self.assertIn("4 Arm omni of 3 joints", said)
        self.assertIn("cupp.toml: ", said)


if __name__ == "__main__":
    unittest.main()
