"""A running program, led through its control socket.

The protocol is one JSON object a line each way. A request has an id and a verb, its answer the same
id and either "ok" or "error"; rows that are followed come in between.
"""

from __future__ import annotations

import collections
import json
import os
import select
import socket
import subprocess
import tempfile
import time
from pathlib import Path
from types import TracebackType
from typing import IO, Any, Deque, Dict, List, Mapping, NamedTuple, Optional, Sequence, Type

from limpid.errors import ArgumentError, LimpidError, ProgramError, RecordingError, RequestError, in_python
from limpid.program import find_program, setting_words
from limpid.runs import hand_file
from limpid.values import SHORT, Hand, PathLike, names_of, number, path_of, plain, settings_of

PROTOCOL = 1
KEPT_MESSAGES = 10_000  # of rows that nobody has fetched; older ones are dropped and counted
STARTING = 20.0  # for a program to listen [s]
ENDING = 10.0  # for a program to complete its recording [s]


class Rows(NamedTuple):
    """Rows of the channels that are followed, as they came."""

    ticks: List[int]  # of each row, counted since the loop was opened
    # Of each row, in the order of the channels: a number, None where it is none, or a list of a vector.
    values: List[List[Any]]
    dropped: int  # rows that were due since follow() and found no room


class Answer(NamedTuple):
    """What a person has answered."""

    answer: str  # empty: none within the time that there was
    index: int  # -1: likewise
    seconds: float  # since the question was first seen
    tick: int


def control_path(name: str = "control") -> Path:
    """Where a program of that name listens. Raises LimpidError without XDG_RUNTIME_DIR."""
    folder = os.environ.get("XDG_RUNTIME_DIR")
    if not folder:
        raise LimpidError("XDG_RUNTIME_DIR is not set: there is no folder for sockets")
    return Path(folder, "limpid", f"{name}.control")


class Client:
    """A connection to a running program. All calls raise RequestError where the program refuses what
    is asked for, ArgumentError for what cannot be asked, and ProgramError where the program has ended,
    does not answer within `timeout` [s], or the connection is closed. Where a recording ends by
    itself, as on a full disk, the next call does what it is asked for and then raises
    RecordingError, once."""

    def __init__(self, path: PathLike, timeout: float = 30.0) -> None:
        """Connects to the socket `path`. Raises ProgramError where nobody listens there."""
        self.timeout = timeout
        self._socket = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
        try:
            self._socket.connect(os.fspath(path))
        except OSError as error:
            self._socket.close()
            raise ProgramError(f"{os.fspath(path)}: {error.strerror}; start `limpid --listen` or "
                               "`limpid serve`") from error  # fmt: skip
        self._socket.setblocking(False)
        self._received = b""
        self._next_id = 0
        self._answers: Dict[int, Dict[str, Any]] = {}
        self._rows: Deque[Dict[str, Any]] = collections.deque(maxlen=KEPT_MESSAGES)
        self._trouble: Optional[str] = None  # that nobody has heard of
        self._process: Optional["subprocess.Popen[bytes]"] = None
        try:
            self.about: Dict[str, Any] = self.request("hello")
            if self.about.get("protocol") != PROTOCOL:
                raise ProgramError(f"{os.fspath(path)}: speaks protocol {self.about.get('protocol')}, "
                                   f"this package {PROTOCOL}")  # fmt: skip
        except BaseException:
            self._socket.close()
            raise

    def __enter__(self) -> "Client":
        return self

    def __exit__(self, kind: Optional[Type[BaseException]], error: Optional[BaseException],
                 trace: Optional[TracebackType]) -> None:  # fmt: skip
        self.close()

    # What can be asked.

    def get(self, *keys: str) -> Dict[str, Any]:
        """The values of these settings, or of all; None stands for what is left to the arm."""
        asked = {"keys": [SHORT.get(key, key) for key in names_of("keys", keys)]} if keys else {}
        return dict(self.request("get", **asked)["values"])

    def state(self) -> Dict[str, Any]:
        """What is open and how the loop is: arm, scene, force, recording, ticks, late, missed;
        `trouble`: why the last recording ended by itself, or None."""
        return dict(self.request("get", keys=[])["state"])

    def set(self, values: Optional[Mapping[str, Any]] = None, twin: bool = False, reset: bool = False, lane: int = 0,
            **more: Any) -> Dict[str, Any]:  # fmt: skip
        """Sets all of these or, where one is refused, none. `twin`: those of the second run; `lane`: 1
        is the second run, too, and 2 the third. `reset`: all others have their usual values then, up
        to limits that a person has chosen. Settings are those of a dict, or keywords:
        coupling__eta=0.5. Those of hand, device and loop are the same for all runs: the first run's. Of
        a window they last as long as this connection; then those of its user come back."""
        asked: Dict[str, Any] = {"twin": True} if twin else {}
        if lane:
            asked["lane"] = lane
        if reset:
            asked["reset"] = True
        return dict(self.request("set", values=settings_of(values, more, "values"), **asked)["values"])

    def open(self, scene: Optional[PathLike] = None, arm: Optional[PathLike] = None,
             session: Optional[PathLike] = None, hand: Optional[Hand] = None,
             tip: Optional[str] = None, wait: bool = False, timeout: float = 120.0
             ) -> Dict[str, Any]:  # fmt: skip
        """Opens files, or things that came along by their bare names ("table.toml"); `hand` may be
        rows of time [s], x, y, z [m], too. With `wait` the hand stays at its first point until a
        recording begins. Returns the state."""
        asked: Dict[str, Any] = {}
        with hand_file(hand) as path:
            for key, what in (("scene", scene), ("arm", arm), ("session", session), ("hand", path)):
                if what is not None:
                    asked[key] = _named(key, what)
            if tip is not None:
                asked["tip"] = tip
            if wait:
                asked["wait"] = True
            return self._request("open", asked, timeout)

    def record(self, file: Optional[PathLike] = None, force: bool = False) -> str:
        """Records every tick into `file` or a new one; returns its name once rows are written. One
        that is there is replaced with `force` only."""
        asked: Dict[str, Any] = {} if file is None else {"file": os.path.abspath(path_of("file", file))}
        if force:
            asked["force"] = True
        return str(self.request("record", **asked)["file"])

    def stop(self) -> Dict[str, Any]:
        """Ends the recording: `file`, `rows`, and how many were `dropped` for want of room."""
        return self._request("stop", {}, max(self.timeout, 60.0))

    def start_over(self) -> Dict[str, Any]:
        """Puts device and proxy at rest; a hand's path begins again."""
        return self.request("start_over")

    def mark(self, text: str) -> int:
        """Marks this moment in the window's plots and in what is recorded; returns its tick."""
        return int(self.request("mark", text=text)["tick"])

    def row(self, channels: Optional[Sequence[str]] = None) -> Dict[str, Any]:
        """The newest row by names: these channels, or each number that plots have of the first run."""
        asked = {} if channels is None else {"channels": names_of("channels", channels)}
        return dict(self.request("row", **asked)["values"])

    def follow(self, channels: Sequence[str], rate: float = 100.0) -> List[str]:
        """From now on rows of these channels come, so many a second [Hz]; none ends it. Fetch them
        with rows(). Returns the channels' units."""
        if not channels:
            self.request("follow")
            return []
        return list(self.request("follow", channels=names_of("channels", channels),
                                 rate=plain("rate", rate))["units"])

    def rows(self, seconds: float = 0.0) -> Rows:
        """The rows that have come, and those that come within so long [s]."""
        if number("seconds", seconds) < 0:
            raise ArgumentError(f"seconds: {seconds:g} is not allowed; allowed: from 0 on")
        end = time.monotonic() + seconds
        while self._receive(max(0.0, end - time.monotonic())):
            pass
        self._raise_trouble()
        ticks: List[int] = []
        values: List[List[Optional[float]]] = []
        dropped = 0
        while self._rows:
            message = self._rows.popleft()
            dropped = max(dropped, int(message["dropped"]))
            for tick, *row in message["rows"]:
                ticks.append(int(tick))
                values.append(row)
        return Rows(ticks, values, dropped)

    def twin(self, values: Optional[Mapping[str, Any]] = None, on: bool = True, lane: int = 1) -> None:
        """A second run on the same hand, or a third one (`lane` 2), with these settings of its own; or
        neither it nor those behind it any more."""
        asked: Dict[str, Any] = {} if values is None else {"values": settings_of(values, name="values")}
        if lane != 1:
            asked["lane"] = lane
        self.request("twin", on=on, **asked)

    def blind(self, on: bool = True) -> None:
        """The window hides law, settings and plots until blind(False) or the end of this client."""
        self.request("blind", on=on)

    def ask(self, text: str, choices: Sequence[str] = (), timeout: float = 3600.0,
            beside: bool = False, seconds: Optional[float] = None) -> Answer:  # fmt: skip
        """Asks whoever is at the window; one of at most nine choices is the answer. `beside`: below
        the picture, which can be used meanwhile. `seconds`: it goes by itself after so long [s];
        without choices it only says something for that time."""
        asked: Dict[str, Any] = {"text": text}
        if choices:
            asked["choices"] = names_of("choices", choices)
        if beside:
            asked["beside"] = True
        if seconds is not None:
            asked["seconds"] = plain("seconds", seconds)
            timeout = max(timeout, seconds + self.timeout)
        found = self._request("ask", asked, timeout)
        none = found["index"] is None
        return Answer("" if none else str(found["answer"]), -1 if none else int(found["index"]),
                      float(found["seconds"]), int(found["tick"]))  # fmt: skip

    def picture(self, file: PathLike, replace: bool = False) -> str:
        """Saves a picture, a PNG; over one that is there only with `replace`."""
        asked: Dict[str, Any] = {"file": os.path.abspath(path_of("file", file))}
        if replace:
            asked["replace"] = True
        return str(self._request("picture", asked, max(self.timeout, 60.0))["file"])

    def cut(self) -> None:
        """No force, at once. On a real device only a person arms it again."""
        self.request("cut")

    def close(self) -> None:
        """Ends the connection, and the program where serve() has started it."""
        try:
            self.request("bye")
        except LimpidError:
            pass
        self._socket.close()
        process, self._process = self._process, None
        if process is not None:
            _end(process)

    # How it is asked.

    def request(self, verb: str, **keys: Any) -> Dict[str, Any]:
        """Asks for a verb with its keys, as the protocol has them, and returns what it answers."""
        return self._request(verb, keys, self.timeout)

    def _request(self, verb: str, keys: Mapping[str, Any], timeout: float) -> Dict[str, Any]:
        self._next_id += 1
        number = self._next_id
        try:
            line = json.dumps({"id": number, "do": verb, **keys}, allow_nan=False) + "\n"
        except (TypeError, ValueError) as error:
            raise ArgumentError(f"{verb}: cannot be asked for: {error}") from error
        end = time.monotonic() + timeout
        self._send(line.encode(), end)
        while number not in self._answers:
            left = end - time.monotonic()
            if left <= 0 or not self._receive(left):
                raise ProgramError(f"{verb}: no answer within {timeout:g} s")
        answer = self._answers.pop(number)
        self._raise_trouble()
        if "error" in answer:
            raise RequestError(in_python(str(answer["error"])))
        return dict(answer["ok"])

    def _raise_trouble(self) -> None:
        trouble, self._trouble = self._trouble, None
        if trouble is not None:
            raise RecordingError(trouble)

    def _send(self, data: bytes, end: float) -> None:
        self._stay_open()
        while data:
            _, ready, _ = select.select([], [self._socket], [], max(0.0, end - time.monotonic()))
            if not ready:
                raise ProgramError("the program takes nothing more")
            try:
                data = data[self._socket.send(data):]
            except BlockingIOError:
                continue
            except OSError as error:
                raise ProgramError(f"the program has ended: {error.strerror}") from error

    def _stay_open(self) -> None:
        if self._socket.fileno() < 0:
            raise ProgramError("this connection is closed")

    def _receive(self, seconds: float) -> bool:
        """Takes in what comes within so long; False where nothing does."""
        self._stay_open()
        ready, _, _ = select.select([self._socket], [], [], seconds)
        if not ready:
            return False
        try:
            data = self._socket.recv(1 << 16)
        except BlockingIOError:
            return True
        except OSError as error:
            raise ProgramError(f"the program has ended: {error.strerror}") from error
        if not data:
            raise ProgramError("the program has ended")
        *lines, self._received = (self._received + data).split(b"\n")
        for line in lines:
            self._take(json.loads(line))
        return True

    def _take(self, message: Dict[str, Any]) -> None:
        if "rows" in message:
            self._rows.append(message)
        elif message.get("event") == "trouble":
            self._trouble = in_python(str(message["error"]))
        elif "event" in message:
            pass  # of a newer program
        elif isinstance(message.get("id"), int):
            self._answers[message["id"]] = message
        else:
            raise RequestError(str(message.get("error", message)))


def _named(key: str, what: Any) -> str:
    """A path from / on; a bare name that is no file here is left to the program."""
    text = path_of(key, what)
    bare = os.sep not in text and not os.path.exists(text)
    return text if bare else os.path.abspath(text)


def connect(name: str = "control", timeout: float = 30.0) -> Client:
    """Connects to a program that listens: `limpid --listen NAME` or `limpid serve NAME`."""
    return Client(control_path(name), timeout)


def serve(scene: Optional[PathLike] = None, hand: Optional[Hand] = None,
          arm: Optional[PathLike] = None, settings: Optional[Mapping[str, Any]] = None,
          live: Optional[str] = None, window: bool = False, name: Optional[str] = None,
          timeout: float = 30.0, **more: Any) -> Client:  # fmt: skip
    """Starts a program and connects to it; it ends with the connection, or with this process.

    `hand`: a file, a recorded session, or rows of time [s], x, y, z [m]; a window runs it and plays
    what came of it. `settings`: by their keys, or as keywords: coupling__k_vc=8, eta=0.5.
    `live`: the id of a real device, or "" for the one in use. `window`: with a window, which a person
    may also close. Raises ProgramError with what the program says where it does not start."""
    name = name or f"python-{os.getpid()}-{time.monotonic_ns() % 1_000_000}"
    words: List[str] = [find_program()]
    words += ["--listen", name] if window else ["serve", name]
    words += ["--until-eof"]
    if live is not None:
        words += ["--live", live] if live else ["--live"]
    words += setting_words(settings_of(settings, more))
    path = control_path(name)
    with hand_file(hand) as file, tempfile.TemporaryFile("w+", errors="replace") as said:
        for key, option, what in (("scene", "--scene", scene), ("arm", "--device", arm),
                                  ("hand", "--hand", None if window else file)):  # fmt: skip
            if what is not None:
                words += [option, path_of(key, what)]
        try:
            process = subprocess.Popen(words, stdin=subprocess.PIPE, stdout=subprocess.DEVNULL, stderr=said)
        except OSError as error:
            raise ProgramError(f"{words[0]}: cannot be started: {error.strerror}") from error
        try:
            client = _reach(path, process, said, timeout)
            if window and file is not None:
                client.open(hand=file)
        except BaseException:
            _end(process)
            raise
    client._process = process
    return client


def _reach(path: Path, process: "subprocess.Popen[bytes]", errors: IO[str], timeout: float) -> Client:
    end = time.monotonic() + STARTING
    while True:
        if process.poll() is not None:
            errors.seek(0)
            said = errors.read().strip()
            raise ProgramError(said or f"limpid ended with status {process.returncode}")
        try:
            return Client(path, timeout)
        except ProgramError:
            if time.monotonic() > end:
                raise
            time.sleep(0.02)


def _end(process: "subprocess.Popen[bytes]") -> None:
    """As Ctrl-C does: what is recorded is complete then."""
    process.terminate()
    try:
        process.communicate(timeout=ENDING)
    except subprocess.TimeoutExpired:
        process.kill()
        process.communicate()
