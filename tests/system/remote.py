"""A program that listens, for tests that lead it, and clients that behave badly."""

from __future__ import annotations

import json
import os
import shutil
import socket
import stat
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

from support import ASSETS, LIMPID

sys.path.insert(0, str(ASSETS / "python"))
os.environ["LIMPID"] = str(LIMPID)

import limpid  # noqa: E402


class RemoteTest(unittest.TestCase):
    """Runs one `limpid serve` for each test, in folders of its own."""

    WORDS: list[str] = []

    def setUp(self) -> None:
        self.home = Path(tempfile.mkdtemp(prefix="limpid-remote-"))
        self.addCleanup(shutil.rmtree, self.home, ignore_errors=True)
        runtime = self.home / "run"
        runtime.mkdir(mode=0o700)
        before = os.environ.get("XDG_RUNTIME_DIR")
        os.environ["XDG_RUNTIME_DIR"] = str(runtime)
        self.addCleanup(self.restore, before)
        self.socket = runtime / "limpid" / "control.control"
        self.environment = {**os.environ, "XDG_DATA_HOME": str(self.home / "data"),
                            "XDG_CONFIG_HOME": str(self.home / "config")}
        self.start()

    @staticmethod
    def restore(before: str | None) -> None:
        if before is None:
            os.environ.pop("XDG_RUNTIME_DIR", None)
        else:
            os.environ["XDG_RUNTIME_DIR"] = before

    def start(self) -> None:
        self.process = subprocess.Popen([LIMPID, "serve", *self.WORDS], env=self.environment,
                                        stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                        stderr=subprocess.PIPE, text=True)
        self.addCleanup(self.end)
        line = self.process.stdout.readline()
        self.assertEqual(line.strip(), f"limpid listens on {self.socket}",
                         self.process.stderr.read() if not line else "")

    def end(self) -> None:
        if self.process.poll() is None:
            self.process.terminate()
        try:
            self.process.communicate(timeout=20)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.communicate()

    def connect(self) -> limpid.Client:
        client = limpid.connect()
        self.addCleanup(client.close)
        return client

    def raw(self) -> socket.socket:
        """A bare connection, which skips the client's checks."""
        connection = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
        connection.connect(str(self.socket))
        connection.settimeout(20)
        self.addCleanup(connection.close)
        return connection

    def say(self, connection: socket.socket, text: str) -> dict:
        """Sends a line and returns the answer."""
        connection.sendall(text.encode() + b"\n")
        return json.loads(self.line(connection))

    def line(self, connection: socket.socket) -> bytes:
        received = b""
        while not received.endswith(b"\n"):
            data = connection.recv(1)
            if not data:
                break
            received += data
        return received

    def wait(self, what: str, holds, seconds: float = 30) -> None:
        end = time.monotonic() + seconds
        while not holds():
            self.assertLess(time.monotonic(), end, f"waited {seconds} s for {what}")
            self.assertIsNone(self.process.poll(), f"limpid ended while waiting for {what}")
            time.sleep(0.02)

    def mode(self, path: Path) -> int:
        return stat.S_IMODE(path.lstat().st_mode)
