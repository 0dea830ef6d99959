"""A recorded session with its channels by name.

Needs h5py and numpy (Debian: python3-h5py, python3-numpy).
"""

from __future__ import annotations

import contextlib
import os
from typing import TYPE_CHECKING, Any, Dict, Iterator, List, NamedTuple, Optional, Sequence, Tuple

from limpid.errors import LimpidError
from limpid.values import PathLike, names_of, no_channel, path_of

if TYPE_CHECKING:
    import numpy
    import pandas
    import xarray

# As /coupling/kind has them.
LAWS = ("standard", "proposed", "predictive", "tank", "direct", "eba", "popc", "wave", "tdpn", "sfa")
# The runs that a recording keeps, by what the names of their channels begin with.
MAIN, TWIN = "", "twin/"
LANES = (MAIN, TWIN, "lane3/")
BESIDE_ROWS = ("axis", "check", "events", "joint", "marks", "models")  # of each run
ONE_STATE = "objects/state"  # of the first row only
# The file has three numbers of each contact in one line; here they are x, y, z of each.
OF_CONTACTS = ("contact/force", "contact/point")
CONTACT_AXES = ["contact", "axis"]


class Contact(NamedTuple):
    """A time during which the proxy was touched."""

    begins: float  # [s]
    ends: float  # [s]
    force: float  # the largest total force in it [N]
    point: Tuple[float, float, float]  # of the hardest contact at that moment [m]


class _Lane(NamedTuple):
    """What stands beside the rows of one of the runs."""

    config: str
    law: str
    changes: List[Tuple[int, str]]  # from which row on, what


class _Recording:
    """A file and what was read of it. Rows are read channel by channel, when somebody asks for them;
    there are as many as when it was opened, also where the recording goes on."""

    def __init__(self, file: PathLike, wanted: Optional[Sequence[str]]) -> None:
        try:
            import h5py  # noqa: F401
            import numpy  # noqa: F401
        except ImportError as error:
            raise LimpidError(f"{file}: sessions are read with h5py and numpy; "
                              f"{error.name} is missing") from error  # fmt: skip
        self.file = path_of("session", file)
        self.units: Dict[str, str] = {}
        self.about: Dict[str, str] = {}
        self.axes: Dict[str, List[str]] = {}  # names of the dimensions behind the time
        self.places: Dict[str, List[str]] = {}  # names of the places along them, as joints have
        self._read: Dict[str, Any] = {}
        self._opened_as: Optional[Tuple[int, ...]] = None
        lengths: List[int] = []

        def take(name: str, item: Any) -> None:
            bare = name[len(_lane_of(name)):]
            rows = hasattr(item, "shape") and bare.split("/")[0] not in BESIDE_ROWS and bare != ONE_STATE
            if rows and item.ndim > 0 and item.attrs.get("unit") is not None:
                self.units[name] = _words(item.attrs["unit"])
                self.axes[name] = [_dimension(item.dims[i], f"{bare.replace('/', '_')}_{i}") for i in range(1, item.ndim)]
                if bare in OF_CONTACTS and item.ndim == 2 and item.shape[1] % 3 == 0:
                    self.axes[name] = CONTACT_AXES
                self.about[name] = str(item.attrs.get("what", ""))
                lengths.append(len(item))

        with self.opened() as opened:
            if opened.attrs.get("format") != "limpid-session":
                raise LimpidError(f"{self.file}: is no session of Limpid")
            self.attributes: Dict[str, Any] = dict(opened.attrs)
            opened.visititems(take)
            for axis in {axis for axes in self.axes.values() for axis in axes} & set(opened):
                if hasattr(opened[axis], "shape"):  # a group has none
                    self.places[axis] = [_text(value) for value in opened[axis]]
            self.rows = min(lengths, default=0)
            self.lanes = {name: self._lane(opened[name] if name else opened) for name in LANES
                          if not name or name in opened}  # fmt: skip
            self.marks = sorted(_pairs(opened, "marks/tick", "marks/text"), key=lambda mark: mark[0])
        self._choose(wanted)

    @contextlib.contextmanager
    def opened(self) -> Iterator[Any]:
        """The file, as long as somebody reads it. Raises LimpidError where it cannot be read, or is
        another one by now."""
        import h5py

        file = self.file
        if self._opened_as and file.endswith(".part") and not os.path.exists(file):
            file = file[: -len(".part")]  # the recording is complete by now
        if not os.path.exists(file):
            file += ".part"  # the recording still goes on
            if not os.path.exists(file):
                raise LimpidError(f"{self.file}: no such file")
        try:
            with h5py.File(file, "r", swmr=file.endswith(".part")) as opened:
                found = os.stat(file)
                known = (found.st_dev, found.st_ino)
                if self._opened_as not in (None, known):
                    raise LimpidError(f"{self.file}: is another file than when it was opened; open it again")
                self._opened_as = known
                yield opened
        except (OSError, RuntimeError, KeyError) as error:
            raise LimpidError(f"{self.file}: cannot be read as a session: {error}") from error

    @staticmethod
    def _lane(group: Any) -> _Lane:
        kind = group["coupling/kind"] if "coupling/kind" in group else ()
        law = int(kind[0]) if len(kind) else -1
        return _Lane(str(group.attrs.get("config", "")),
                     LAWS[law] if 0 <= law < len(LAWS) else "",
                     _pairs(group, "events/row", "events/setting"))  # fmt: skip

    def _choose(self, wanted: Optional[Sequence[str]]) -> None:
        if wanted is None:
            return
        names = [self.known(name) for name in names_of("channels", wanted)]
        names += [name for name in [lane + "time" for lane in LANES] if name in self.units and name not in names]
        self.units = {name: self.units[name] for name in names}
        self.about = {name: self.about[name] for name in names}

    def known(self, name: str) -> str:
        name = name.lstrip("/")
        if name in self.units:
            return name
        raise LimpidError(f"{self.file}: {no_channel(name, self.units)}")

    def channel(self, name: str) -> "numpy.ndarray":
        name = self.known(name)
        if name not in self._read:
            with self.opened() as opened:
                self._read[name] = self._rows_of(opened, name)
        return self._read[name]

    def _rows_of(self, opened: Any, name: str) -> "numpy.ndarray":
        import numpy

        values = numpy.asarray(opened[name][: self.rows])
        if self.axes[name] == CONTACT_AXES:
            return values.reshape(len(values), values.shape[1] // 3, 3)
        return values

    def keep(self) -> None:
        """All channels are in memory from now on, and the file may go."""
        with self.opened() as opened:
            for name in self.units:
                if name not in self._read:
                    self._read[name] = self._rows_of(opened, name)


def _text(value: Any) -> str:
    return value.decode(errors="replace") if isinstance(value, bytes) else str(value)


def _words(unit: Any) -> str:
    """A unit as a text; where joints differ, one of each."""
    import numpy

    units = [str(each) for each in numpy.atleast_1d(unit)]
    return units[0] if len(set(units)) == 1 else ", ".join(units)


def _dimension(dim: Any, otherwise: str) -> str:
    """Its name in the file."""
    names = [name for name in dim.keys() if name]
    return names[0] if names else otherwise


def _lane_of(channel: str) -> str:
    return next((lane for lane in LANES if lane and channel.startswith(lane)), MAIN)


def _pairs(group: Any, numbers: str, texts: str) -> List[Tuple[int, str]]:
    if numbers not in group or texts not in group:
        return []
    return [(int(number), bytes(text).decode(errors="replace"))
            for number, text in zip(group[numbers], group[texts])]  # fmt: skip


class Session:
    """Row k holds the state at time[k] and the torques held until time[k + 1]; SI units, radians.
    Channels are read from the file when they are asked for, and then kept; the session has the rows
    that were there when it was opened."""

    def __init__(self, file: PathLike, channels: Optional[Sequence[str]] = None) -> None:
        """Opens FILE.h5, or its FILE.h5.part while the recording goes on; `channels`: only these, and
        the time. Raises LimpidError for anything else, and where there is no channel of such a name."""
        self._recording = _Recording(file, channels)
        self._lane = MAIN

    @property
    def file(self) -> str:
        """Its name, as it was opened."""
        return self._recording.file

    def __fspath__(self) -> str:
        """The same: a session stands for its file, as a hand does."""
        return self.file

    @property
    def attributes(self) -> Dict[str, Any]:
        """Of the file, for all runs in it: version, seed, source of the hand, and others."""
        return self._recording.attributes

    @property
    def lanes(self) -> "List[Session]":
        """All runs on the same hand, this one first; each with its own channels, law, settings and
        changes. Of a further run: that run alone."""
        if self._lane != MAIN:
            return [self]
        return [self, *(self._of(lane) for lane in self._recording.lanes if lane)]

    @property
    def twin(self) -> "Optional[Session]":
        """The second run on the same hand; None where there is none."""
        return self._of(TWIN) if self._lane == MAIN and TWIN in self._recording.lanes else None

    def _of(self, lane: str) -> "Session":
        run = Session.__new__(Session)
        run._recording, run._lane = self._recording, lane
        return run

    def __len__(self) -> int:
        return self._recording.rows

    def __repr__(self) -> str:
        which = f", {self._lane[:-1]}" * bool(self._lane)
        return f"<limpid.Session {self.file}{which}: {len(self)} rows, {len(self) * self.tick:.3f} s>"

    @property
    def channels(self) -> List[str]:
        """Names of all channels; those of further runs begin with "twin/" and "lane3/", and are those
        of lanes[1] and lanes[2] without that."""
        names = [name for name in self._recording.units if name.startswith(self._lane)]
        return [name[len(self._lane):] for name in names]

    def channel(self, name: str) -> "numpy.ndarray":
        """Values, a row each: N of a number, N x n of joints, N x 3 of x y z, N x bodies x 7 or 6 of
        objects; `contact/force` and `contact/point` are N x 4 x 3: x y z of up to four contacts. Raises
        LimpidError for a name that there is not."""
        return self._recording.channel(self._named(name))

    __getitem__ = channel

    def unit(self, name: str) -> str:
        """The channel's unit, "-" for none; where joints differ, one of each: "rad, rad, m"."""
        return self._recording.units[self._recording.known(self._named(name))]

    def about(self, name: str) -> str:
        """What the channel is, in words."""
        return self._recording.about[self._recording.known(self._named(name))]

    def _named(self, name: str) -> str:
        return self._lane + str(name).lstrip("/")

    def keep(self) -> None:
        """Reads all channels into memory; the file may go then."""
        self._recording.keep()

    @property
    def time(self) -> "numpy.ndarray":
        """[s], from 0."""
        return self.channel("time")

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
        return self._recording.lanes[self._lane].config

    @property
    def law(self) -> str:
        """The coupling at the first row; empty where there is no row, or this package does not know
        the law."""
        return self._recording.lanes[self._lane].law

    @property
    def warnings(self) -> List[str]:
        """What went wrong in the run, a sentence each: it gave energy, became unstable, or moved as no
        hand does. Those of further runs begin with "the second run: " or the like."""
        return str(self.attributes.get("warnings", "")).splitlines()

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
            x, y, z = (float(each) for each in points[hardest][0])
            found.append(Contact(float(self.time[first]), float(self.time[end - 1]) + self.tick,
                                 float(size[hardest]), (x, y, z)))  # fmt: skip
        return found

    def frame(self, channels: Optional[Sequence[str]] = None) -> "pandas.DataFrame":
        """The channels as a table of pandas, a row for each tick and the time as its index; those of
        several numbers have columns "device/position[0]", .... attrs["units"] has the unit of each
        column. Needs pandas (Debian: python3-pandas)."""
        try:
            import pandas
        except ImportError as error:
            raise LimpidError(f"{self.file}: tables need pandas, which is missing") from error

        columns, units = {}, {}
        for name in self._chosen(channels):
            values = self.channel(name).reshape(len(self), -1)
            several = self.channel(name).ndim > 1
            of_each = self.unit(name).split(", ")
            for i in range(values.shape[1]):
                column = f"{name}[{i}]" if several else name
                columns[column] = values[:, i]
                units[column] = of_each[i % len(of_each)]
        frame = pandas.DataFrame(columns, index=pandas.Index(self.time, name="time"))
        frame.attrs["units"] = units
        return frame

    def dataset(self, channels: Optional[Sequence[str]] = None) -> "xarray.Dataset":
        """The channels as a dataset of xarray, over the time and joint, axis, contact and others, so
        that channels of one kind can be subtracted. Units and words are attributes.
        netCDF takes no / in a name: dataset.rename({name: name.replace("/", "_") for name in dataset})
        can be saved with to_netcdf(). Needs xarray (Debian: python3-xarray)."""
        try:
            import xarray
        except ImportError as error:
            raise LimpidError(f"{self.file}: datasets need xarray, which is missing") from error

        found, coordinates = {}, {"time": self.time}
        for name in self._chosen(channels):
            values = self.channel(name)
            axes = self._recording.axes[self._recording.known(self._named(name))]
            for axis, count in zip(axes, values.shape[1:]):
                if len(self._recording.places.get(axis, ())) == count:
                    coordinates[axis] = self._recording.places[axis]
            found[name] = (["time", *axes], values, {"units": self.unit(name), "long_name": self.about(name)})
        return xarray.Dataset(found, coords=coordinates, attrs={"law": self.law, "file": self.file})

    def _chosen(self, channels: Optional[Sequence[str]]) -> List[str]:
        names = self.channels if channels is None else names_of("channels", channels)
        return [name.lstrip("/") for name in names if name.lstrip("/") != "time"]

    @property
    def changes(self) -> List[Tuple[float, str]]:
        """When a setting of this run changed while recording [s], and to what: "coupling.eta = 0.5"."""
        last = len(self) - 1
        changes = self._recording.lanes[self._lane].changes if last >= 0 else []
        return [(float(self.time[min(row, last)]), text) for row, text in changes]

    @property
    def marks(self) -> List[Tuple[float, str]]:
        """What people noted, and when [s]: with T in the window, or a program with mark()."""
        marks = self._recording.marks
        return [(float(self.time[tick]), text) for tick, text in marks if tick < len(self)]


def session(file: PathLike, channels: Optional[Sequence[str]] = None) -> Session:
    """Opens a recorded session; `channels`: only these, and the time."""
    return Session(file, channels)
