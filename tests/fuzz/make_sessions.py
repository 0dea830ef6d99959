#!/usr/bin/python3
"""Makes the sessions that session_fuzz starts from: tests/fuzz/corpus/session.

They are as small as they can be. Those of HDF5's first edition have no checksums in their
bookkeeping, so that a changed byte gets as far as the reader. The first byte of an input is not of
the file: an odd one makes it the leftover of a recording.
"""

import pathlib
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
PACKED = ["time", "hand/target", "coupling/kind"]
ROWS = 2


def run(group, how):
    def put(path, data):
        group.create_dataset(path, data=data, **(how if path in PACKED else {}))

    put("time", np.arange(ROWS) * 1e-3)
    put("hand/target", np.zeros((ROWS, 3)))
    for path in OF_JOINTS:
        put(path, np.zeros((ROWS, 1)))
    for path in SINGLE:
        put(path, np.zeros(ROWS))
    for path in BYTES:
        put(path, np.zeros(ROWS, np.uint8))
    put("events/row", np.array([1], np.uint64))
    put("events/setting", np.array([b"coupling.eta = 0.5"], "S120"))


def session(libver, how, extras):
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "a.h5"
        with h5py.File(path, "w", libver=libver) as file:
            for name, value in {
                    "format": "limpid-session", "version": np.int64(1), "tick": 1e-3,
                    "dof": np.int64(1), "seed": np.uint64(1), "created": "", "app_version": "",
                    "source": "", "config": "coupling.eta = 0.6\n", "device_urdf": ARM,
                    "scene": SCENE}.items():
                file.attrs[name] = value
            run(file, how)
            if extras:
                file.create_dataset("models/0", data=np.frombuffer(b"glTF", np.uint8))
                file["models/0"].attrs["name"] = "a.glb"
                twin = file.create_group("twin")
                twin.attrs["config"] = "coupling.kind = \"standard\"\n"
                run(twin, how)
        return path.read_bytes()


def main():
    folder = pathlib.Path(__file__).parent / "corpus/session"
    folder.mkdir(exist_ok=True)
    packed = {"chunks": True, "compression": "gzip", "shuffle": True, "fletcher32": True}
    (folder / "plain").write_bytes(b"\0" + session("earliest", {}, False))
    (folder / "leftover").write_bytes(b"\1" + session("earliest", {}, False))
    (folder / "packed").write_bytes(b"\0" + session("earliest", packed, False))
    (folder / "twin").write_bytes(b"\0" + session("latest", {}, True))


main()
