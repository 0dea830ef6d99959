"""Loops in this process: a simulated arm in a simulated hand, or a device of your own.

Needs numpy and the module limpid._loop, which is built and installed with the program.
"""

from __future__ import annotations

import importlib.machinery
import importlib.util
import math
import os
import sys
import warnings
from pathlib import Path
from typing import TYPE_CHECKING, Any, Dict, Iterable, Iterator, List, Mapping, NamedTuple, Optional, Sequence, Tuple, Union

from limpid.errors import ArgumentError, LimpidError, ProgramError, RunWarning
from limpid.program import find_program
from limpid.values import PathLike, Value, hand_array, is_path, names_of, no_channel, number, path_of, settings_of, text_of
from limpid.worlds import Arm, Scene

if TYPE_CHECKING:
    import numpy

# The first of a channel's numbers in a row, and their shape there: () of a single number.
Place = Tuple[int, Tuple[int, ...]]


class NoChannel(ArgumentError, KeyError):
    """There is no channel of that name."""

    __str__ = Exception.__str__  # KeyError's has quotes


class Energy(NamedTuple):
    """Energies of the coupling since the loop, or its recording, began [J]."""

    controller: float  # E_c, what the coupling gave with the device's own damping; passive: <= 0
    commanded: float  # E_c of motors and proxy alone
    port: float  # what motors and own damping gave the human
    reserve: float  # what the law's account may still give the human; 0 without an account


class Setting(NamedTuple):
    """A setting, by its key, and what may be set."""

    key: str
    unit: str  # "-" for none
    least: float
    most: float
    words: List[str]  # of a choice, else empty
    live: bool  # may change while the loop runs
    meaning: str


class Channels(Mapping[str, Any]):
    """Numbers of a row, or of the rows of a run, by the names that recordings have for them. Of a row
    row["time"] is a float, row["device/position"] an array of a number for each joint, also of a
    single one, and row["contact/force"] one of 4 x 3; a run, like a session, has the rows before that."""

    def __init__(self, values: "numpy.ndarray", places: Mapping[str, Place]) -> None:
        self.values_of_all = values  # as one array: of a row all its numbers, of a run rows of them
        self._places = places

    def __getitem__(self, name: str) -> Any:
        known = name.lstrip("/") if isinstance(name, str) else name
        if known not in self._places:
            raise NoChannel(no_channel(name, self._places))
        offset, shape = self._places[known]
        part = self.values_of_all[..., offset : offset + math.prod(shape)]
        part = part.reshape(part.shape[:-1] + shape)
        return float(part) if part.ndim == 0 else part

    def __iter__(self) -> Iterator[str]:
        return iter(self._places)

    def __len__(self) -> int:
        return len(self._places)

    def __repr__(self) -> str:
        return f"{type(self).__name__} of {len(self)} channels: {', '.join(list(self)[:4])}, ..."


class Run(Channels):
    """The rows of a run, channel by channel: run["time"], run["device/position"]."""

    def __init__(self, values: "numpy.ndarray", places: Mapping[str, Place], why: str,
                 said: Sequence[str] = ()) -> None:  # fmt: skip
        super().__init__(values, places)
        self.why = why  # what was unstable, and when; else empty
        # What went wrong in the run, a sentence each, as limpid.Session has it.
        self.warnings: List[str] = [why] * bool(why) + list(said)

    @property
    def diverged(self) -> bool:
        """Whether the run was unstable."""
        return bool(self.why)

    @property
    def rows(self) -> int:
        return len(self.values_of_all)


class _AnyLoop:
    """What both kinds of loop have in common."""

    _loop: Any

    def _learn(self) -> None:
        columns = self._loop.columns()
        self._places: Dict[str, Place] = {path.lstrip("/"): (offset, shape) for path, _, _, offset, shape in columns}
        self._width = sum(math.prod(shape) for _, shape in self._places.values())
        self.units: Dict[str, str] = {path.lstrip("/"): unit for path, unit, _, _, _ in columns}
        self.about: Dict[str, str] = {path.lstrip("/"): what for path, _, what, _, _ in columns}

    @property
    def joints(self) -> int:
        return int(self._loop.joints)

    @property
    def period(self) -> float:
        return float(self._loop.period)

    @property
    def notes(self) -> List[str]:
        """Sentences on what was mended, guessed, fitted or left out of arm, scene and models."""
        return list(self._loop.notes)

    @property
    def not_passive(self) -> str:
        """Why the law with its present settings is not passive; empty if it is, or if no theory is known."""
        return str(self._loop.not_passive)

    @property
    def diverged(self) -> bool:
        """Whether the loop was unstable: its force is off, and stays off."""
        return bool(self._loop.diverged)

    def __setattr__(self, name: str, value: Any) -> None:
        if name not in ("units", "about") and not name.startswith("_"):
            raise ArgumentError(f"{name}: cannot be assigned to; settings change by loop.set({name}=...)")
        super().__setattr__(name, value)

    def __copy__(self) -> Any:
        raise ArgumentError("a loop cannot be copied, nor sent to another process; make another one there")

    def __reduce__(self) -> Any:
        return self.__copy__()

    def __deepcopy__(self, memo: Any) -> Any:
        return self.__copy__()

    @property
    def tip(self) -> Tuple[float, float, float]:
        """The device's tip [m]."""
        return tuple(self._loop.tip)  # type: ignore[return-value]

    @property
    def proxy_tip(self) -> Tuple[float, float, float]:
        """The proxy's tip; before the first tick the device's [m]."""
        return tuple(self._loop.proxy_tip)  # type: ignore[return-value]

    @property
    def row(self) -> Channels:
        """The row of the last tick."""
        return Channels(self._loop.row(), self._places)

    @property
    def energy(self) -> Energy:
        return Energy(*self._loop.energy())

    def set(self, settings: Optional[Mapping[str, Any]] = None, **more: Any) -> None:
        """Changes settings from the next tick on, all of them or none: loop.set(eta=0.5),
        loop.set({"coupling.k_vc": 8})."""
        self._loop.set([f"{key}={text_of(value)}" for key, value in settings_of(settings, more).items()])

    def get(self, key: str) -> Value:
        """A setting's present value; of a choice its word."""
        if not isinstance(key, str):
            raise ArgumentError(f"{key!s:.40} is no key; allowed: a text such as coupling.eta")
        whole = next(iter(settings_of({}, {key.replace(".", "__"): 0})))
        words = next((each.words for each in settings() if each.key == whole), [])
        found = self._loop.get(whole)
        if words == ["false", "true"]:
            return bool(found)
        return words[int(found)] if words else float(found)

    def record(self, file: PathLike, force: bool = False) -> None:
        """Records every row from the next tick on into a session, FILE.h5, in place of one that is there
        with `force`. Called while the force of real motors fades in, it begins at the fade's end."""
        try:
            self._loop.record(path_of("record", file), force)
        except LimpidError as error:
            raise type(error)(str(error).replace("`replace`", "`force`")) from None

    def finish_recording(self) -> int:
        """Ends the recording; returns the number of rows that found no room."""
        return int(self._loop.finish_recording())


class Loop(_AnyLoop):
    """A simulated arm in a simulated hand, tick by tick or along a path.

        loop = limpid.Loop(scene="table.toml", coupling="predictive", eta=0.5)
        row = loop.step((0.19, 0, -0.05))
        run = loop.run([(0, 0.19, 0, 0), (1, 0.19, 0, -0.05)])

    `arm`: an Arm, a URDF file, or the name of one that came along; `scene`: a Scene or a TOML file likewise. `arm_text`
    and `scene_text` are the same as text. Settings are as limpid.run() takes them: short words, keys,
    or keywords with two underscores for the dot. `period` [s] is the time of a tick. Raises
    LimpidError."""

    def __init__(self, arm: Union[None, PathLike, Arm] = None, scene: Union[None, PathLike, Scene] = None,
                 arm_text: str = "", scene_text: str = "", tip: str = "", period: float = 0.001,
                 config: Optional[PathLike] = None, settings: Optional[Mapping[str, Any]] = None,
                 **more: Any) -> None:  # fmt: skip
        options = _options(arm, scene, arm_text, scene_text, tip, period, config, settings, more)
        self._loop = _module().SimulatedLoop(options)
        self._learn()

    def start(self, target: Sequence[float]) -> None:
        """Begins anew, at rest, with the tip at `target`: x, y, z [m]."""
        self._loop.start(_point("target", target))

    def step(self, hand: Sequence[float], grip: float = 1, magnet: bool = False,
             torque: Sequence[float] = ()) -> Channels:  # fmt: skip
        """Runs a tick with the hand wanting the tip at `hand`: x, y, z [m]. `grip`: 1 holds, 0 has
        let go. `magnet` picks up objects that may be. `torque`: pushed on each joint besides [N m].
        Returns the row."""
        pushed = [number("torque", each) for each in _listed("torque", torque)]
        if len(pushed) not in (0, self.joints):
            raise ArgumentError(f"torque: has {len(pushed)} numbers; needed: {self.joints}, one a joint")
        row = self._loop.step(_point("hand", hand), number("grip", grip), bool(magnet), pushed)
        return Channels(row, self._places)

    def run(self, hand: Any, duration: Optional[float] = None,
            channels: Optional[Sequence[str]] = None) -> Run:  # fmt: skip
        """Leads a hand along a path as fast as it goes, from rest, with the present settings: the rows
        of limpid.run(), bit for bit. `hand`: rows of time [s], x, y, z [m]. `channels`: only these are
        kept, and the time, which takes less memory and less time. The loop itself stays as
        it is, and other threads go on meanwhile: loops run in as many threads as there are
        processors. A run that gave energy, became unstable, or moved as no hand does warns of it
        (RunWarning; run.warnings)."""
        if is_path(hand):
            raise ArgumentError("hand: is a file; needed: rows of time [s], x, y, z [m] (limpid.run reads files)")
        seconds = 0.0 if duration is None else _seconds("duration", duration)
        places, kept = self._places, list(range(self._width))
        if channels is not None:
            places, kept = {}, []
            for name in dict.fromkeys(["time", *(each.lstrip("/") for each in names_of("channels", channels))]):
                if name not in self._places:
                    raise ArgumentError(no_channel(name, self._places))
                offset, shape = self._places[name]
                places[name] = (len(kept), shape)
                kept += range(offset, offset + math.prod(shape))
        try:
            values, _, why, said = self._loop.run(hand_array(hand), seconds, kept)
        except MemoryError as error:
            raise LimpidError(f"run: rows of {len(kept)} numbers for so long do not fit into memory; "
                              "`channels` keeps fewer of them") from error  # fmt: skip
        for warning in [why] * bool(why) + said:
            warnings.warn(warning, RunWarning, stacklevel=2)
        return Run(values, places, why, said)


class DeviceLoop(_AnyLoop):
    """A loop round a device of your own: positions in, torques out.

        loop = limpid.DeviceLoop(device.positions(), arm="my_arm.urdf", coupling="predictive")
        loop.arm()  # as soon as a person holds the device
        while True:
            device.push(loop.tick(device.positions()))

    Joints that turn have rad and N m, joints that slide m and N. `motors`: "real", then force is
    armed, fades in, and `limits` hold; or "simulated". `limits`: joint_speed, tip_speed, tip_force,
    energy, range, which can be lowered only. Python keeps 1 kHz on a quiet computer, and no promise
    of it: what leaves while it is late is the device's own watchdog's matter. Raises LimpidError."""

    def __init__(self, position: Sequence[float], arm: Union[None, PathLike, Arm] = None,
                 scene: Union[None, PathLike, Scene] = None, motors: str = "real",
                 limits: Optional[Mapping[str, float]] = None, arm_text: str = "",
                 scene_text: str = "", tip: str = "", period: float = 0.001,
                 config: Optional[PathLike] = None, settings: Optional[Mapping[str, Any]] = None,
                 **more: Any) -> None:  # fmt: skip
        options = _options(arm, scene, arm_text, scene_text, tip, period, config, settings, more)
        if motors not in ("real", "simulated"):
            raise ArgumentError(f'motors: {motors!r} is not allowed; allowed: "real", "simulated"')
        options.motors = getattr(_module().Motors, motors)
        self._real = motors == "real"
        allowed = options.limits
        if not isinstance(limits, (Mapping, type(None))):
            raise ArgumentError(f"limits: {limits!s:.40} is not allowed; allowed: a dict of names and numbers")
        for name, value in (limits or {}).items():
            if not hasattr(allowed, name):
                raise ArgumentError(f"limits: {name} is none; there are joint_speed, tip_speed, tip_force, "
                                    "energy, range")  # fmt: skip
            setattr(allowed, name, number(f"limits: {name}", value))
        self._loop = _module().DeviceLoop(options, [number("position", each) for each in _listed("position", position)])
        self._learn()

    def tick(self, position: Sequence[float], fresh: bool = True, hand: bool = True,
             fault: bool = False, elapsed: float = 0) -> "numpy.ndarray":  # fmt: skip
        """Runs the tick on a reading of each joint; returns the torques to be held until the next
        one. `fresh`: not the same reading as at the last tick; one that is not may be empty. `hand`: the
        dead-man switch is closed. `fault`: the device is not well. `elapsed`: time since the last tick
        [s]; 0: measured here. With real motors whatever is no reading trips the force and returns
        zeros, and `force_text` says it; with simulated ones it raises ArgumentError."""
        try:
            if self._real or len(position) == self.joints and 0 <= elapsed < math.inf:
                return self._loop.tick(position, bool(fresh), bool(hand), bool(fault), elapsed)
        except TypeError:
            if self._real:
                return self._loop.tick((), True, bool(hand), True, 0)
        if not isinstance(elapsed, (int, float)) or not 0 <= elapsed < math.inf:
            _seconds("elapsed", elapsed)
        count = len(_listed("position", position))
        if count == self.joints:
            raise ArgumentError(f"position: {position!s:.60} is not allowed; allowed: a number for each joint")
        raise ArgumentError(f"position: has {count} numbers; needed: {self.joints}, one a joint")

    def arm(self) -> None:
        """Asks for force; whoever does so answers for a person who holds the device."""
        self._loop.arm()

    def cut(self) -> None:
        """Ends all force with the next tick."""
        self._loop.cut()

    @property
    def armed(self) -> bool:
        return bool(self._loop.armed)

    @property
    def force_share(self) -> float:
        """Part of the torque that leaves, 0 to 1."""
        return float(self._loop.force_share)

    @property
    def force_text(self) -> str:
        """Why there is no force, or less of it, also while it fades in or the law's account holds walls
        back; empty while all of it is on."""
        return str(self._loop.force_text)


def settings() -> List[Setting]:
    """All settings that loops, runs and sweeps have."""
    return [Setting(*each) for each in _module().settings()]


def _options(arm: Union[None, PathLike, Arm], scene: Union[None, PathLike, Scene], arm_text: str, scene_text: str, tip: str,
             period: float, config: Optional[PathLike], given: Optional[Mapping[str, Any]],
             more: Mapping[str, Any]) -> Any:  # fmt: skip
    if isinstance(arm, Arm):
        arm, arm_text = None, arm.text()
    if isinstance(scene, Scene):
        scene, scene_text = None, scene.text()
    options = _module().LoopOptions()
    for name, file in (("arm", arm), ("scene", scene), ("config", config)):
        if file is not None:
            setattr(options, name, path_of(name, file))
    for name, text in (("arm_text", arm_text), ("scene_text", scene_text), ("tip", tip)):
        if not isinstance(text, str):
            raise ArgumentError(f"{name}: {text!s:.40} is not allowed; allowed: a text")
        setattr(options, name, text)
    options.period = number("period", period)
    options.settings = [f"{key}={text_of(value)}" for key, value in settings_of(given, more).items()]
    return options


def _listed(name: str, given: Any) -> List[Any]:
    if isinstance(given, (str, bytes, Mapping)) or not isinstance(given, Iterable):
        raise ArgumentError(f"{name}: {given!s:.40} is not allowed; allowed: a list of numbers")
    return list(given)


def _seconds(name: str, given: Any) -> float:
    seconds = number(name, given)
    if seconds < 0:
        raise ArgumentError(f"{name}: {seconds:g} is not allowed; allowed: 0 s or more")
    return seconds


def _point(name: str, given: Iterable[float]) -> Tuple[float, float, float]:
    point = [number(name, each) for each in _listed(name, given)]
    if len(point) != 3:
        raise ArgumentError(f"{name}: has {len(point)} numbers; needed: x, y, z [m]")
    return point[0], point[1], point[2]


def _module() -> Any:
    """The module limpid._loop: of this package, else the one that was built beside the program."""
    if "limpid._loop" in sys.modules:
        return sys.modules["limpid._loop"]
    try:
        import numpy  # noqa: F401
    except ImportError as error:
        raise LimpidError("loops in this process need numpy (Debian: python3-numpy)") from error
    spec = importlib.util.find_spec("limpid._loop")
    if spec is None:
        spec = _built()
    if spec is None or spec.loader is None:
        raise LimpidError("limpid._loop, which loops in this process need, is neither in this package nor beside "
                          "the program; build Limpid with pybind11-dev, for this Python "
                          f"{sys.version_info[0]}.{sys.version_info[1]}")  # fmt: skip
    try:
        module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)
    except ImportError as error:
        raise LimpidError(f"{spec.origin}: cannot be loaded: {error}") from error
    sys.modules["limpid._loop"] = module
    return module


def _built() -> Any:
    try:
        folder = Path(os.path.realpath(find_program())).parent
    except ProgramError:
        return None
    for suffix in importlib.machinery.EXTENSION_SUFFIXES:
        file = folder / f"_loop{suffix}"
        if file.exists():
            return importlib.util.spec_from_file_location("limpid._loop", file)
    return None
