"""A window under Xvfb that tests drive with xdotool, as a person would."""

import ctypes
import json
import os
import shutil
import subprocess
import tempfile
import time
import unittest
from pathlib import Path

from support import LIMPID

NEEDED = ("Xvfb", "xdotool")
WIDTH, HEIGHT = 1280, 720
MODIFIERS = {"ctrl", "shift", "alt", "super"}
WHEEL = {"4", "5"}  # as buttons


def counted(words: tuple[str, ...]) -> dict[str, int]:
    """Number of events that a window takes of these words of xdotool: presses of keys, presses and
    releases of buttons."""
    counts = {"keys": 0, "buttons": 0}
    verb, options, left = "", {}, list(words)
    while left:
        word = left.pop(0)
        if word.startswith("--"):
            options[word] = left.pop(0)
        elif word in ("key", "keydown", "keyup", "click", "mousedown", "mouseup", "mousemove", "type"):
            verb, options = word, {}
        elif verb in ("key", "keydown"):
            counts["keys"] += word.split("+")[-1] not in MODIFIERS
        elif verb == "type":
            counts["keys"] += len(word)
        elif verb == "click" and word not in WHEEL:
            counts["buttons"] += 2 * int(options.get("--repeat", 1))
        elif verb in ("mousedown", "mouseup"):
            counts["buttons"] += 1
    return counts


@unittest.skipUnless(all(shutil.which(tool) for tool in NEEDED), f"needs {' and '.join(NEEDED)}")
class WindowTest(unittest.TestCase):
    """One window for all of a test; its state comes as a line of JSON ten times a second."""

    SIZE = (WIDTH, HEIGHT)  # size of the window, as the last time left it
    LAW = "standard"  # coupling of the last time; none: a first start's
    REPEATS = False  # whether held keys repeat; a slow machine may hold a test's key for long

    def setUp(self) -> None:
        self.home = Path(tempfile.mkdtemp(prefix="limpid-window-"))
        self.addCleanup(shutil.rmtree, self.home, ignore_errors=True)
        settings = self.home / "config/limpid/settings.toml"
        settings.parent.mkdir(parents=True)
        settings.write_text(f"[window]\nwidth = {self.SIZE[0]}\nheight = {self.SIZE[1]}\n"
                            + (f'[parameters]\ncoupling.kind = "{self.LAW}"\n' if self.LAW else ""))
        read, write = os.pipe()
        self.xvfb = subprocess.Popen(
            ["Xvfb", "-displayfd", str(write), "-screen", "0", "1600x900x24", "-nolisten", "tcp",
             "-ac", "-noreset", "+extension", "GLX", *([] if self.REPEATS else ["-r"])],
            pass_fds=[write], stderr=subprocess.DEVNULL)
        self.addCleanup(self.stop, self.xvfb)
        os.close(write)
        with os.fdopen(read) as pipe:
            display = f":{pipe.readline().strip()}"
        self.environment = {**os.environ, "DISPLAY": display,
                            "XDG_CONFIG_HOME": str(self.home / "config"),
                            "XDG_DATA_HOME": str(self.home / "data"),
                            "XDG_CACHE_HOME": str(self.home / "cache"),
                            "XDG_RUNTIME_DIR": str(self.home / "run")}
        (self.home / "run").mkdir(mode=0o700)
        # No test asks the desktop of the person who runs it.
        self.environment.pop("DBUS_SESSION_BUS_ADDRESS", None)
        self.states = (self.home / "states").open("w")
        self.addCleanup(self.states.close)
        self.words: list[str] = []  # on the command line
        self.prepare()
        self.start()

    def prepare(self) -> None:
        """Prepares files before the first start."""

    def start(self) -> None:
        """Starts the program; forgets its former states."""
        self.states.truncate(0)
        self.states.seek(0)
        self.app = subprocess.Popen([LIMPID, "--print-state", *self.words], env=self.environment,
                                    stdout=self.states)
        self.addCleanup(self.stop, self.app)
        self.sent = {"keys": 0, "buttons": 0}
        self.wait("the first ticks and frames", lambda s: s["ticks"] > 200 and s["frames"] > 5, 60)
        self.window = self.xdotool("search", "--onlyvisible", "--name", "^Limpid").split()[0]
        self.xdotool("windowfocus", self.window)

    def stop(self, process: subprocess.Popen) -> None:
        process.terminate()
        try:
            process.wait(20)
        except subprocess.TimeoutExpired:
            process.kill()

    def xdotool(self, *words: str, check: bool = True) -> str:
        """Runs xdotool, and counts the events that the window has to take."""
        for what, count in counted(words).items():
            self.sent[what] += count
        return subprocess.run(["xdotool", *words], env=self.environment, check=check,
                              capture_output=True, text=True).stdout

    def taken(self) -> dict:
        """First state in which frames have taken all keys and clicks that were sent. Otherwise an
        early event may reach a frame that shows something else."""
        return self.wait("the window to take what was sent", lambda s: all(
            s["taken"][what] >= count for what, count in self.sent.items()) and not s["input_waits"], 60)

    def key(self, name: str, closes: bool = False) -> None:
        """A key press; one that closes the window leaves none for its release."""
        self.xdotool("key", "--window", self.window, "--delay", "120", name, check=not closes)
        if closes:
            self.xdotool("keyup", name)  # otherwise it repeats into the next window
        else:
            self.taken()

    def close_by_cross(self) -> None:
        """Closes the window as a window manager does for a person."""
        x11 = ctypes.CDLL("libX11.so.6")
        x11.XOpenDisplay.restype = ctypes.c_void_p
        x11.XInternAtom.argtypes = [ctypes.c_void_p, ctypes.c_char_p, ctypes.c_int]
        x11.XInternAtom.restype = ctypes.c_ulong
        x11.XSendEvent.argtypes = [ctypes.c_void_p, ctypes.c_ulong, ctypes.c_int, ctypes.c_long, ctypes.c_void_p]
        x11.XCloseDisplay.argtypes = [ctypes.c_void_p]
        display = x11.XOpenDisplay(self.environment["DISPLAY"].encode())
        protocols, close = (x11.XInternAtom(display, name, 0) for name in (b"WM_PROTOCOLS", b"WM_DELETE_WINDOW"))
        # XClientMessageEvent, in the room of an XEvent: type, serial, send_event, display, window,
        # message_type, format, data.
        event = (ctypes.c_long * 24)(33, 0, 1, 0, int(self.window), protocols, 32, close)
        x11.XSendEvent(display, int(self.window), 0, 0, event)
        x11.XCloseDisplay(display)

    def type(self, text: str) -> None:
        self.xdotool("type", "--window", self.window, "--delay", "60", text)
        self.taken()

    def notices(self) -> str:
        return "\n".join(self.state()["notices"])

    def wait_for_notice(self, text: str) -> None:
        self.wait(f"a notice with '{text}'", lambda s: any(text in n for n in s["notices"]))

    def click(self, x: float, y: float, times: int = 1, button: int = 1) -> None:
        """Clicks where the frames that all earlier actions need have drawn."""
        self.move(x, y)
        self.settled()
        self.xdotool("click", "--repeat", str(times), "--delay", "20", str(button))
        self.taken()

    def noted(self, window: str, label: str) -> tuple[float, float]:
        """Place of a noted item, of a frame that shows it."""
        return self.wait(f"{label} in {window}", lambda s: label in s["noted"].get(window, {})
                         )["noted"][window][label]

    def click_on(self, window: str, label: str, times: int = 1) -> None:
        """Clicks a noted item where it is drawn."""
        self.settled()
        self.click(*self.noted(window, label), times=times)

    def move(self, x: float, y: float) -> None:
        self.xdotool("mousemove", "--window", self.window, str(int(x)), str(int(y)))

    def state(self) -> dict:
        lines = Path(self.states.name).read_text().splitlines()
        for line in reversed(lines):
            try:
                return json.loads(line)
            except json.JSONDecodeError:
                continue  # an incomplete line
        return {"ticks": 0, "frames": 0}

    def wait(self, what: str, holds, seconds: float = 30) -> dict:
        """First state for which `holds`; slow machines get their time."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            state = self.state()
            if holds(state):
                return state
            self.assertIsNone(self.app.poll(), f"limpid ended while waiting for {what}")
            time.sleep(0.1)
        self.fail(f"waited {seconds} s for {what}; the state is {self.state()}")

    def wait_until(self, what: str, holds) -> None:
        """Waits for a condition that the state does not show."""
        self.wait(what, lambda _: holds())

    def settled(self) -> dict:
        """State after the effects of all actions so far: a frame may be under way, the next one
        takes them, and opened things need some more."""
        self.taken()
        time.sleep(0.2)  # a state is never older, unless a frame takes longer
        frames = self.state()["frames"]
        return self.wait("some frames", lambda s: s["frames"] >= frames + 5
                         and not s["input_waits"])

    def go_on(self, seconds: float) -> dict:
        """State after so many seconds of the loop, however long they take."""
        ticks = self.state()["ticks"]
        return self.wait(f"{seconds} s", lambda s: s["ticks"] > ticks + 1000 * seconds)

    def hold_tip(self) -> tuple[float, float]:
        """Holds the tip by the mouse; returns the mouse's place."""
        x, y = self.state()["places"]["tip"]
        while True:  # the view and the arm may still be moving
            before = x, y
            x, y = self.go_on(0.3)["places"]["tip"]
            if max(abs(x - before[0]), abs(y - before[1])) < 1:
                break
        self.move(x, y)
        self.settled()
        self.xdotool("mousedown", "1")
        self.wait("the hand to hold", lambda s: s["grip"] == 1)
        return x, y

    def press_onto_table(self) -> None:
        """Drags the tip down onto the table."""
        x, y = self.hold_tip()
        for step in range(1, 31):
            self.move(x - step, y + 5 * step)
            time.sleep(0.04)

    def check_rerun_is_the_same(self, session: Path) -> None:
        """A live recording, run again without a window: the same rows, bit for bit."""
        import h5py
        import numpy

        again = self.home / "again.h5"
        subprocess.run([LIMPID, "run", "--hand", str(session), "--record", str(again)], check=True,
                       stdout=subprocess.DEVNULL)
        with h5py.File(session) as a, h5py.File(again) as b:
            self.assertGreater(len(a["time"]), 500)
            parts = ("device", "proxy", "hand", "coupling", "energy")
            runs = [run for run in ("", "twin/", "lane3/") if not run or run in a]
            for group in (run + part for run in runs for part in parts):
                for name in a[group]:
                    self.assertTrue(numpy.array_equal(a[group][name][...], b[group][name][...], equal_nan=True),
                                    f"/{group}/{name}")
