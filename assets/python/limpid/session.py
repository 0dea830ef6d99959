"""A recorded session with its channels by name.

Needs h5py and numpy (Debian: python3-h5py, python3-numpy).
"""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any, Dict, List, NamedTuple, Tuple

from limpid.errors import LimpidError
from limpid.program import PathLike

if TYPE_CHECKING:
    import numpy

# As /coupling/kind has them.
LAWS = ("standard", "proposed", "predictive", "tank")


class Contact(NamedTuple):
    """A time during which the proxy was touched."""

    begins: float  # [s]
    ends: float  # [s]
    force: float  # the largest total force in it [N]
    point: Tuple[float, float, float]  # of the hardest contact at that moment [m]


class Session:
    """Row k holds the state at time[k] and the torques held until time[k + 1]; SI units, radians.
    The file is read whole when the session is opened, and stays as it is."""

    def __init__(self, file: PathLike) -> None:
        """Reads FILE.h5, or the FILE.h5.part of a recording. Raises LimpidError for anything else."""
        try:
            import h5py
            import numpy
        except ImportError as error:
            raise LimpidError(f"{os.fspath(file)}: sessions are read with h5py and numpy; "
                              f"{error.name} is missing") from error  # fmt: skip
        self.file = os.fspath(file)
        self._channels: Dict[str, Any] = {}
        self._units: Dict[str, str] = {}
        self._about: Dict[str, str] = {}
        self._changes: List[Tuple[int, str]] = []
        self._marks: List[Tuple[int, str]] = []
        try:
            with h5py.File(self.file, "r", swmr=self.file.endswith(".part")) as opened:
                if opened.attrs.get("format") != "limpid-session":
                    raise LimpidError(f"{self.file}: is no session of Limpid")
                self.attributes: Dict[str, Any] = dict(opened.attrs)
                opened.visititems(self._take)
                if "events/row" in opened:
                    texts = (bytes(text).decode(errors="replace") for text in opened["events/setting"])
                    self._changes = [(int(row), text) for row, text in zip(opened["events/row"], texts)]
                if "marks/tick" in opened:
                    texts = (bytes(text).decode(errors="replace") for text in opened["marks/text"])
                    self._marks = sorted(((int(tick), text) for tick, text in
                                          zip(opened["marks/tick"], texts)), key=lambda mark: mark[0])  # fmt: skip
        except OSError as error:
            raise LimpidError(f"{self.file}: cannot be read as a session: {error}") from error
        rows = min(len(data) for data in self._channels.values())
        self._channels = {name: numpy.asarray(data[:rows]) for name, data in self._channels.items()}

    def _take(self, name: str, item: Any) -> None:
        if not hasattr(item, "shape") or name.split("/")[0] in ("check", "events", "marks", "axis", "joint"):
            return
        if item.ndim < 1 or item.attrs.get("unit") is None:
            return
        if name.endswith("objects/state"):
            return
        self._channels[name] = item[()]
        self._units[name] = str(item.attrs["unit"])
        self._about[name] = str(item.attrs.get("what", ""))

    def __len__(self) -> int:
        return len(self.time)

    def __repr__(self) -> str:
        return f"<limpid.Session {self.file}: {len(self)} rows, {len(self) * self.tick:.3f} s>"

    @property
    def channels(self) -> List[str]:
        """Names of all channels; those of a second run begin with "twin/"."""
        return list(self._channels)

    def channel(self, name: str) -> "numpy.ndarray":
        """Values, a row each; of several numbers a row (joints, or x y z) a matrix. Raises
        LimpidError for a name that there is not."""
        return self._channels[self._known(name)]

    __getitem__ = channel

    def unit(self, name: str) -> str:
        """The channel's unit, "-" for none; of joints that slide see the attribute joint_types."""
        return self._units[self._known(name)]

    def about(self, name: str) -> str:
        """What the channel is, in words."""
        return self._about[self._known(name)]

    def _known(self, name: str) -> str:
        name = name.lstrip("/")
        if name in self._channels:
            return name
        raise LimpidError(f"{self.file}: {name} is no channel; there are {', '.join(self.channels)}")

    @property
    def time(self) -> "numpy.ndarray":
        """[s], from 0."""
        return self._channels["time"]

    @property
    def tick(self) -> float:
        """T [s]."""
        return float(self.attributes["tick"])

    @property
    def joints(self) -> List[str]:
        """Their names."""
        return [str(name) for name in self.attributes.get("joints", [])]

    @property
    def config(self) -> str:
        """All settings at the first row, as TOML."""
        return str(self.attributes["config"])

    @property
    def law(self) -> str:
        """The coupling at the first row."""
        return LAWS[int(self._channels["coupling/kind"][0])]

    @property
    def device_tip(self) -> "numpy.ndarray":
        """N x 3, where the device's tip is [m]."""
        return self.channel("device/tip")

    @property
    def proxy_tip(self) -> "numpy.ndarray":
        """N x 3, where the proxy's tip is [m]."""
        return self.channel("proxy/tip")

    @property
    def contact_force(self) -> "numpy.ndarray":
        """N x 3, all that the scene puts on the proxy [N]; zeros mean no contact."""
        return self.channel("contact/total_force")

    @property
    def contacts(self) -> List[Contact]:
        """When the proxy was touched, one after the other."""
        import numpy

        size = numpy.linalg.norm(self.contact_force, axis=1)
        touched = numpy.flatnonzero(numpy.diff(numpy.concatenate(([0], size > 0, [0])).astype(int)))
        points = self.channel("contact/point")
        found = []
        for first, end in zip(touched[::2], touched[1::2]):
            hardest = first + int(numpy.argmax(size[first:end]))
            point = tuple(float(x) for x in points[hardest][:3])
            found.append(Contact(float(self.time[first]), float(self.time[end - 1]) + self.tick,
                                 float(size[hardest]), point))  # fmt: skip
        return found

    @property
    def changes(self) -> List[Tuple[float, str]]:
        """When a setting changed while recording [s], and to what: "coupling.eta = 0.5"."""
        last = len(self) - 1
        return [(float(self.time[min(row, last)]), text) for row, text in self._changes]

    @property
    def marks(self) -> List[Tuple[float, str]]:
        """What people noted, and when [s]: with T in the window, or a program with mark()."""
        return [(float(self.time[tick]), text) for tick, text in self._marks if tick < len(self)]


def session(file: PathLike) -> Session:
    """Opens a recorded session."""
    return Session(file)
