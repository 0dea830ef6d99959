"""Limpid from Python: lead a running program, run hands through a coupling, read what was recorded.

    import limpid

    with limpid.serve(scene="table.toml") as loop:      # starts a program and ends with it
        loop.set({"coupling.kind": "predictive", "coupling.eta": 0.5})
        print(loop.row(["coupling/eta", "hand/torque_norm"]))

    session = limpid.run(hand=[(0, 0.19, 0, 0), (1, 0.19, 0, -0.05)], coupling="standard")
    print(session.channel("proxy/tip"), session.unit("proxy/tip"))

    loop = limpid.Loop(coupling="predictive", eta=0.5)   # in this process
    row = loop.step((0.19, 0, -0.05))

All quantities are SI units and radians. The standard library alone is needed to lead a program;
sessions are read with h5py and numpy. Documentation: README.md beside this file.
"""

from limpid.client import Answer, Client, Rows, connect, serve
from limpid.errors import ArgumentError, LimpidError, ProgramError, RecordingError, RequestError, RunWarning
from limpid.loop import Channels, DeviceLoop, Energy, Loop, Run, Setting, settings
from limpid.runs import run, sweep
from limpid.session import Contact, Session, session
from limpid.worlds import Arm, Scene

__version__ = "0.2.0"

__all__ = [
    "Answer", "Arm", "ArgumentError", "Channels", "Client", "Contact", "DeviceLoop", "Energy", "LimpidError",
    "Loop", "ProgramError", "RecordingError", "RequestError", "Rows", "Run", "RunWarning", "Scene", "Session",
    "Setting", "connect", "run", "serve", "session", "settings", "sweep",
]  # fmt: skip
