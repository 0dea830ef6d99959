"""Drops files on a window as a file manager does: the XDND protocol, version 5."""

import sys
import time
from pathlib import Path

from Xlib import X, Xatom
from Xlib.display import Display
from Xlib.protocol import event

VERSION = 5


class Drag:
    """One drag of files from a window of its own."""

    def __init__(self, display: str, target: int, files: list[Path]) -> None:
        self.display = Display(display)
        self.root = self.display.screen().root
        self.source = self.root.create_window(0, 0, 1, 1, 0, X.CopyFromParent)
        self.target = self.display.create_resource_object("window", target)
        self.data = "".join(f"{Path(f).absolute().as_uri()}\r\n" for f in files).encode()
        self.source.set_selection_owner(self.atom("XdndSelection"), X.CurrentTime)
        self.display.flush()

    def atom(self, name: str) -> int:
        return self.display.intern_atom(name)

    def send(self, kind: str, *data: int) -> None:
        words = [self.source.id, *data] + [0] * (4 - len(data))
        self.target.send_event(event.ClientMessage(
            window=self.target, client_type=self.atom(kind), data=(32, words)))
        self.display.flush()

    def wait_for(self, kind: str, seconds: float = 20) -> tuple[int, ...]:
        """Waits for the target's answer; meanwhile it may ask for the dragged files."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            if not self.display.pending_events():
                time.sleep(0.02)
                continue
            got = self.display.next_event()
            if got.type == X.SelectionRequest:
                self.hand_over(got)
            elif got.type == X.ClientMessage and got.client_type == self.atom(kind):
                return tuple(got.data[1])
        raise TimeoutError(f"no {kind} within {seconds} s")

    def hand_over(self, request: event.SelectionRequest) -> None:
        known = request.target == self.atom("text/uri-list")
        if known:
            request.requestor.change_property(request.property, request.target, 8, self.data)
        request.requestor.send_event(event.SelectionNotify(
            time=request.time, requestor=request.requestor, selection=request.selection,
            target=request.target, property=request.property if known else X.NONE))
        self.display.flush()

    def drop(self) -> None:
        """Enters the window, answers its position, drops, and waits until the window has taken all.
        """
        aware = self.target.get_full_property(self.atom("XdndAware"), Xatom.ATOM)
        if aware is None:
            raise RuntimeError("the window takes no drops")
        place = self.target.translate_coords(self.root, 0, 0)
        x, y = 300 - place.x, 300 - place.y
        self.send("XdndEnter", VERSION << 24, self.atom("text/uri-list"))
        self.send("XdndPosition", 0, x << 16 | y, X.CurrentTime, self.atom("XdndActionCopy"))
        if not self.wait_for("XdndStatus")[1] & 1:
            raise RuntimeError("the window refuses the drop")
        self.send("XdndDrop", 0, X.CurrentTime)
        self.wait_for("XdndFinished")


def drop(display: str, target: int, files: list[Path]) -> None:
    Drag(display, target, files).drop()


if __name__ == "__main__":  # DISPLAY WINDOW FILE...
    drop(sys.argv[1], int(sys.argv[2]), [Path(f) for f in sys.argv[3:]])
