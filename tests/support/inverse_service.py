#!/usr/bin/python3
"""Plays the Haply Inverse Service: its simulation channel, as docs.haply.co describes that of 3.1 to 3.5.

A WebSocket on a port of 127.0.0.1. On connecting it lists all devices; then it answers each message with
one of its own. A force is applied once and forgotten. The cursor stands where it is put, or gives way to
the force as a spring does.

    inverse_service.py [PORT]     default: a free one

It says on stdout what happens, a line each: "port N" once it listens; "session" and "end" of each
session that sends something; "force X Y Z" whenever the force that a session asks for is another one;
"messages N" as an answer. It is told on stdin: "move X Y Z", "spring N/M", "devices ID...",
"merge JSON" (into each device's entry), "grip JSON", "silent", "slow SECONDS", "say TEXT" (instead of each
answer), "repeat" (its last answer, again and again), "answer" (as usual again), "drop" (all connections, without a word), "count".
"""

from __future__ import annotations

import base64
import hashlib
import json
import selectors
import socket
import struct
import sys
import time
from typing import Any

_GUID = b"258EAFA5-E914-47DA-95CA-C5AB0DC85B11"  # of RFC 6455
_TEXT, _CLOSE, _PING, _PONG = 1, 8, 9, 10
_AXES = ("x", "y", "z")
_HOME = [0.0, -0.12, 0.16]  # [m]


def say(line: str) -> None:
    print(line, flush=True)


def vector(values: list[float]) -> dict[str, float]:
    return dict(zip(_AXES, values))


def merge(into: dict[str, Any], more: dict[str, Any]) -> None:
    for key, value in more.items():
        if isinstance(value, dict) and isinstance(into.get(key), dict):
            merge(into[key], value)
        else:
            into[key] = value


class Service:
    def __init__(self) -> None:
        self.ids = ["049D"]
        self.cursor, self.spring = list(_HOME), 0.0  # [m], [N/m]; 0: it stands still
        self.force = [0.0, 0.0, 0.0]  # [N]
        self.more: dict[str, Any] = {}
        self.grip: dict[str, Any] | None = None
        self.mode, self.delay, self.words = "answer", 0.0, ""
        self.messages = 0

    def message(self, whole: bool) -> str:
        place = list(self.cursor)
        if self.spring:
            place = [c + f / self.spring for c, f in zip(place, self.force)]
        devices = []
        for device_id in self.ids:
            entry: dict[str, Any] = {
                "device_id": device_id,
                "state": {
                    "cursor_position": vector(place),
                    "cursor_velocity": vector([0, 0, 0]),
                    "current_cursor_force": vector(self.force),
                    "angular_position": {"a0": -69.3, "a1": 137.6, "a2": 19.8},
                    "body_orientation": {"w": 1.0, "x": 0.0, "y": 0.0, "z": 0.0},
                    "mode": "idle",
                },
                "status": {"calibrated": True, "in_use": False, "power_supply": True,
                           "ready": True, "started": True},
            }  # fmt: skip
            if whole:
                entry["config"] = {
                    "type": "inverse3",
                    "device_info": {"major_version": 7, "minor_version": 1, "id": device_id},
                    "gravity_compensation": {"enabled": True, "scaling_factor": 1},
                    "handedness": "right",
                    "torque_scaling": {"enabled": True},
                }
            merge(entry, self.more)
            devices.append(entry)
        everything: dict[str, Any] = {"session_id": 7, "inverse3": devices}
        if self.grip is not None:
            everything["wireless_verse_grip"] = [{"device_id": "61548", "state": self.grip}]
        return json.dumps(everything)

    def take(self, text: str) -> bool:
        """Takes a message; whether it had a force on an existing device."""
        self.messages += 1
        try:
            for entry in json.loads(text)["inverse3"]:
                values = entry["commands"]["set_cursor_force"]["values"]
                force = [float(values[axis]) for axis in _AXES]
                if entry["device_id"] not in self.ids:
                    continue
                if force != self.force:
                    say("force {:g} {:g} {:g}".format(*force))
                self.force = force
                return True
        except (KeyError, TypeError, ValueError):
            say(f"nonsense {text}")
        return False


class Session:
    """One connection, from its HTTP upgrade on."""

    def __init__(self, service: Service, connection: socket.socket) -> None:
        self.service, self.connection = service, connection
        self.bytes, self.open, self.spoke = b"", False, False
        self.answers: list[float] = []  # answers with their due times
        self.busy_until = 0.0

    def send(self, kind: int, payload: bytes) -> None:
        size = len(payload)
        head = bytes([0x80 | kind])
        head += bytes([size]) if size < 126 else bytes([126]) + struct.pack(">H", size)
        self.connection.sendall(head + payload)

    def shake_hands(self) -> None:
        if b"\r\n\r\n" not in self.bytes:
            return
        head, self.bytes = self.bytes.split(b"\r\n\r\n", 1)
        fields = dict(line.split(b": ", 1) for line in head.split(b"\r\n")[1:])
        key = {name.lower(): value for name, value in fields.items()}[b"sec-websocket-key"]
        accept = base64.b64encode(hashlib.sha1(key + _GUID).digest())
        self.connection.sendall(
            b"HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
            b"Sec-WebSocket-Accept: " + accept + b"\r\n\r\n"
        )
        self.open = True
        if self.service.mode != "silent":
            self.send(_TEXT, self.service.message(whole=True).encode())

    def frame(self) -> tuple[int, bytes] | None:
        if len(self.bytes) < 2:
            return None
        kind, size, at = self.bytes[0] & 15, self.bytes[1] & 127, 2
        if not self.bytes[1] & 128:
            raise ConnectionError("a client's frame is masked")
        if size >= 126:
            wide = ">H" if size == 126 else ">Q"
            at += struct.calcsize(wide)
            if len(self.bytes) < at:
                return None
            size = struct.unpack(wide, self.bytes[2:at])[0]
        if len(self.bytes) < at + 4 + size:
            return None
        mask = self.bytes[at : at + 4]
        body = self.bytes[at + 4 : at + 4 + size]
        self.bytes = self.bytes[at + 4 + size :]
        return kind, bytes(b ^ mask[i % 4] for i, b in enumerate(body))

    def receive(self) -> None:
        got = self.connection.recv(65536)
        if not got:
            raise ConnectionError("hung up")
        self.bytes += got
        if not self.open:
            self.shake_hands()
        while self.open and (frame := self.frame()) is not None:
            kind, payload = frame
            if kind == _CLOSE:
                self.send(_CLOSE, payload[:2])
                raise ConnectionError("closed")
            if kind == _PING:
                self.send(_PONG, payload)
            if kind == _TEXT:
                if not self.spoke:
                    say("session")
                self.spoke = True
                self.service.take(payload.decode())
                # Answers come one after the other: a queue before a slow service grows.
                self.busy_until = max(self.busy_until, time.monotonic()) + self.service.delay
                self.answers.append(self.busy_until)

    def answer(self) -> None:
        while self.answers and self.answers[0] <= time.monotonic():
            self.answers.pop(0)
            if self.service.mode == "silent":
                continue
            words = self.service.words
            if self.service.mode == "answer":
                words = self.service.message(whole=False)
            self.send(_TEXT, words.encode())


class Server:
    def __init__(self, port: int) -> None:
        self.service, self.sessions = Service(), {}
        self.listener = socket.create_server(("127.0.0.1", port))
        self.ready = selectors.DefaultSelector()
        self.ready.register(self.listener, selectors.EVENT_READ)
        self.orders = open(0, "rb", buffering=0)  # what waits is not hidden from select
        self.ready.register(self.orders, selectors.EVENT_READ)
        say(f"port {self.listener.getsockname()[1]}")

    def end(self, session: Session) -> None:
        self.ready.unregister(session.connection)
        del self.sessions[session.connection]
        session.connection.close()
        if session.spoke:
            self.service.force = [0.0, 0.0, 0.0]
            say("end")

    def obey(self, line: str) -> None:
        word, _, rest = line.strip().partition(" ")
        service = self.service
        if word == "move":
            service.cursor = [float(x) for x in rest.split()]
        elif word == "spring":
            service.spring = float(rest)
        elif word == "devices":
            service.ids = rest.split()
        elif word == "merge":
            service.more = json.loads(rest)
        elif word == "grip":
            service.grip = json.loads(rest)
        elif word in ("silent", "say", "answer"):
            service.mode, service.words, service.delay = word, rest, 0.0
        elif word == "repeat":
            service.mode, service.words, service.delay = "say", service.message(whole=False), 0.0
        elif word == "slow":
            service.delay = float(rest)
        elif word == "drop":
            for session in list(self.sessions.values()):
                self.end(session)
        elif word == "count":
            say(f"messages {service.messages}")
        else:
            say(f"what? {line.strip()}")

    def serve(self) -> None:
        while True:
            pending = any(session.answers for session in self.sessions.values())
            for key, _ in self.ready.select(0.0005 if pending else None):
                if key.fileobj is self.listener:
                    connection = self.listener.accept()[0]
                    connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
                    self.sessions[connection] = Session(self.service, connection)
                    self.ready.register(connection, selectors.EVENT_READ)
                elif key.fileobj is self.orders:
                    line = self.orders.readline().decode()
                    if not line:
                        return
                    self.obey(line)
                elif key.fileobj in self.sessions:
                    self.serve_one(self.sessions[key.fileobj], Session.receive)
            for session in list(self.sessions.values()):
                self.serve_one(session, Session.answer)

    def serve_one(self, session: Session, what: Any) -> None:
        try:
            what(session)
        except (OSError, KeyError):
            self.end(session)


if __name__ == "__main__":
    Server(int(sys.argv[1]) if len(sys.argv) > 1 else 0).serve()
