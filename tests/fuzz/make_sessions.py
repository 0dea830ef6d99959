#!/usr/bin/python3
"""Makes what session_fuzz starts from, tests/fuzz/corpus/session: limpid-session's answers.

    tests/fuzz/make_sessions.py PATH_OF_LIMPID_SESSION

They are as small as they can be, and to be made again when a row gets another number. The first
byte of an input is not of the answer: an odd one asks for a table.
"""

import pathlib
import subprocess
import sys
import tempfile

import h5py
import numpy as np

ARM = """<robot name='r'><link name='a'/><joint name='j' type='revolute'><parent link='a'/>
<child link='b'/><axis xyz='0 0 1'/><limit lower='-1' upper='1' effort='2' velocity='1'/></joint>
<link name='b'><inertial><origin xyz='.1 0 0'/><mass value='1'/>
<inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/></inertial></link></robot>
"""
SCENE = """[[plane]]
name = "t"
point = [0.0, 0.0, 0.0]
normal = [0.0, 0.0, 1.0]
stiffness = 9.0
"""
OF_JOINTS = [
    "device/position", "device/velocity", "device/measured_position", "device/measured_velocity",
    "device/commanded_torque", "device/motor_torque", "proxy/position", "proxy/velocity",
    "proxy/torque", "proxy/contact_torque", "hand/torque", "hand/torque_estimate"]
SINGLE = [
    "coupling/eta", "coupling/alpha", "energy/controller_total", "energy/controller_commanded",
    "energy/port", "energy/proxy_kinetic", "timing/wake_latency", "timing/compute"]
BYTES = ["device/force_wanted", "device/force_state", "coupling/kind"]
ROWS = 2


def run(group):
    group["time"] = np.arange(ROWS) * 1e-3
    group["hand/target"] = np.zeros((ROWS, 3))
    for path in OF_JOINTS:
        group[path] = np.zeros((ROWS, 1))
    for path in SINGLE:
        group[path] = np.zeros(ROWS)
    for path in BYTES:
        group[path] = np.zeros(ROWS, np.uint8)
    group["events/row"] = np.array([1], np.uint64)
    group["events/setting"] = np.array([b"coupling.eta = 0.5"], "S120")


def session(file, twin):
    for name, value in {
            "format": "limpid-session", "version": np.int64(1), "tick": 1e-3,
            "dof": np.int64(1), "seed": np.uint64(1), "created": "", "app_version": "",
            "source": "", "config": "coupling.eta = 0.6\n", "device_urdf": ARM,
            "scene": SCENE}.items():
        file.attrs[name] = value
    run(file)
    if twin:
        file.create_dataset("models/0", data=np.frombuffer(b"glTF", np.uint8))
        file["models/0"].attrs["name"] = "a.glb"
        group = file.create_group("twin")
        group.attrs["config"] = "coupling.kind = \"standard\"\n"
        run(group)


def table(file):
    file.attrs["format"] = "limpid-sweep"
    file.attrs["points"] = np.uint64(ROWS)
    file["done"] = np.ones(ROWS, np.uint8)
    file["measure/energy"] = np.zeros(ROWS)


def answer(what, fill):
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "a.h5"
        with h5py.File(path, "w") as file:
            fill(file)
        return subprocess.run([sys.argv[1], what, path], check=True, capture_output=True).stdout


def main():
    folder = pathlib.Path(__file__).parent / "corpus/session"
    folder.mkdir(exist_ok=True)
    plain = answer("session", lambda file: session(file, False))
    (folder / "plain").write_bytes(b"\0" + plain)
    (folder / "cut").write_bytes(b"\0" + plain[:len(plain) // 2])
    (folder / "twin").write_bytes(b"\0" + answer("session", lambda file: session(file, True)))
    (folder / "refused").write_bytes(b"\0" + answer("session", table))
    (folder / "table").write_bytes(b"\1" + answer("table", table))


main()
