"""A session file in memory: the rows, the arm, and the settings in force at each row.

Everything comes from the file alone. SI and radians; N rows, n joints. But for joints that slide: the
equations of a coupling, whose gains are in N m/rad, take 0.1 m for 1 rad and 10 N for 1 N m. Files of
version 1 had them so; those of version 2 have m, m/s and N, and say it in each dataset's unit.
"""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from .urdf import SLIDE_UNIT, Array, Chain, parse_chain

# From a unit of a slide to that of the equations.
_OF_SLIDES: Mapping[str, float] = {"m": 1 / SLIDE_UNIT, "m/s": 1 / SLIDE_UNIT, "N": SLIDE_UNIT}

MOST_DELAY = 20  # of a device [ticks]

# dataset -> how many columns: 1 for shape N, 3 for N x 3, 0 for N x n
DATASETS: Mapping[str, int] = {
    "/time": 1,
    "/device/position": 0,
    "/device/velocity": 0,
    "/device/measured_position": 0,
    "/device/measured_velocity": 0,
    "/device/commanded_torque": 0,
    "/device/motor_torque": 0,
    "/proxy/position": 0,
    "/proxy/velocity": 0,
    "/proxy/torque": 0,
    "/proxy/contact_torque": 0,
    "/hand/target": 3,
    "/hand/torque": 0,
    "/hand/torque_estimate": 0,
    "/coupling/kind": 1,
    "/coupling/eta": 1,
    "/coupling/alpha": 1,
    "/energy/controller_total": 1,
    "/energy/controller_commanded": 1,
    "/energy/proxy_kinetic": 1,
    "/timing/wake_latency": 1,
    "/timing/compute": 1,
}

# What sessions older than these columns lack; the predictive coupling writes them.
_LATER = (
    "/device/force_wanted",
    "/coupling/governor",
    "/coupling/damping_governor",
    "/coupling/torque_governor",
    "/energy/port",
    "/energy/ledger",
    "/energy/contact_potential",
)

# Of sessions with compensation, with ticks solved in another way than the usual, and with objects that move; nothing
# where they lack it.
_OR_NOTHING = {"/device/compensation_torque": 0, "/energy/compensation": 1, "/coupling/solved": 1,
               "/energy/to_objects": 1, "/objects/held": 1, "/device/warmth": 0}

ATTRIBUTES = (
    "format", "version", "tick", "dof", "created", "app_version",
    "seed", "source", "config", "device_urdf", "scene",
)  # fmt: skip

# The contract's keys that the recomputations need, with its defaults. None: as the URDF, the preset
# or eta says.
_DEFAULTS: Mapping[str, Any] = {
    "coupling.k_vc": 10.0,
    "coupling.b_vc": 0.001,
    "coupling.b_v": 0.012,
    "observer.anti_windup": True,
    "observer.velocity": "raw",
    "proxy.inertia_ratio": 1e-4,
    "model.inertia_error": 1.0,
    "link.delay": 0,
    "link.jitter": 0,
    "link.loss": 0.0,
    "link.seed": 1,
    "tank.energy": 0.005,
    "tank.most": 0.1,
    "tank.share": 0.02,
    "tank.damping": 100.0,
    "model.delay": 0,
    "model.delay_most": None,
    "device.delay": 0,
    "coupling.damping": None,
    "coupling.band": 5.3,
    "predictor.p": None,
    "predictor.mu": None,
    "predictor.hand_mass": 0.2,
    "ledger.energy": 0.005,
    "device.encoder_step": 0.0,
    "device.friction": None,
    "device.damping": None,
    "device.torque_limit": None,
    "model.gravity": False,
    "model.springs": False,
    "device.gravity": False,
    "device.springs": False,
}


class SessionError(ValueError):
    """A file that breaks the contract's layout; says where."""


@dataclass(frozen=True)
class Session:
    """Rows of a session. `data` is keyed by dataset path, `settings` by parameter key."""

    data: dict[str, Array]
    settings: dict[str, list[Any]]  # one value per row
    attributes: dict[str, Any]
    chain: Chain

    def __getitem__(self, path: str) -> Array:
        return self.data[path]

    def __len__(self) -> int:
        return len(self.data["/time"])

    def rows(self, part: slice) -> Session:
        """A session of these rows alone."""
        data = {path: values[part] for path, values in self.data.items()}
        settings = {key: values[part] for key, values in self.settings.items()}
        return Session(data, settings, self.attributes, self.chain)

    @property
    def tick(self) -> float:
        """T [s]."""
        return float(self.attributes["tick"])

    @property
    def dof(self) -> int:
        return self.chain.dof

    def number(self, key: str) -> Array:
        """A numeric setting at every row (N, 1)."""
        return np.array(self.settings[key], dtype=np.float64)[:, None]

    def joint_number(self, key: str, of_arm: list[float]) -> Array:
        """A setting at every row and joint (N, n), the arm's own value where none is given."""
        own = np.array(of_arm)
        given = self.settings[key]
        return np.array([own if value is None else np.full(self.dof, value) for value in given])

    @property
    def damping(self) -> Array:
        """b_d (N, n) [N m s/rad]."""
        return self.joint_number("device.damping", [j.damping for j in self.chain.joints])

    @property
    def friction(self) -> Array:
        """Coulomb friction (N, n) [N m]."""
        return self.joint_number("device.friction", [j.friction for j in self.chain.joints])

    @property
    def torque_limit(self) -> Array:
        """What the motors give at most (N, n) [N m]. From half of the warmth on its square falls in a
        straight line, down to that of what they bear for hours."""
        peak = self.joint_number("device.torque_limit", [j.effort for j in self.chain.joints])
        bears = np.array([j.continuous for j in self.chain.joints]) + np.zeros_like(peak)
        left = np.clip(2 * (1 - self["/device/warmth"]), 0, 1)
        warm = np.sqrt(bears**2 + left * (peak**2 - bears**2))
        return np.where((bears > 0) & (bears < peak), warm, peak)

    @property
    def late(self) -> Array:
        """By how many rows what was sent acts later (N,): the virtual arm's delay."""
        return self.number("device.delay")[:, 0].astype(int)

    @property
    def asked_torque(self) -> Array:
        """What the motors are asked for, within their limit (N, n) [N m]."""
        asked = self["/device/commanded_torque"] + self["/device/compensation_torque"]
        return np.clip(asked, -self.torque_limit, self.torque_limit)

    @property
    def sent_torque(self) -> Array:
        """As it left for the motors, which give it at `late` (N, n) [N m]; what acts after the last
        row is not known but by what was asked."""
        acts, after = np.arange(len(self)) + self.late, len(self) - 1
        acted = self["/device/motor_torque"][np.minimum(acts, after)]
        return np.where(acts[:, None] > after, self.asked_torque, acted)

    @property
    def possible_delays(self) -> tuple[Array, Array]:
        """Between command and motor of the virtual arm, the least and the most of every row (N,)
        [ticks]."""
        least, most = self.number("model.delay")[:, 0], self.number("model.delay_most")[:, 0]
        most = np.where(np.isnan(most), self.number("device.delay")[:, 0], np.ceil(most))
        return least.astype(int), np.clip(most, least, MOST_DELAY).astype(int)

    @property
    def law_torque(self) -> Array:
        """What of it was not for the device's own forces (N, n) [N m]."""
        return self.sent_torque - self["/device/compensation_torque"]

    @property
    def law_limit(self) -> Array:
        """What of the motors' limit is left to the law, a tenth at least (N, n) [N m]."""
        left = self.torque_limit - np.abs(self["/device/compensation_torque"])
        return np.maximum(left, 0.1 * self.torque_limit)


def flatten(table: Mapping[str, Any], prefix: str = "") -> dict[str, Any]:
    """TOML tables as dotted keys."""
    flat: dict[str, Any] = {}
    for key, value in table.items():
        if isinstance(value, Mapping):
            flat |= flatten(value, f"{prefix}{key}.")
        else:
            flat[prefix + key] = value
    return flat


def _text(value: Any) -> str:
    return value.decode() if isinstance(value, bytes) else str(value)


def _of_joints(dataset: h5py.Dataset) -> Array:
    """A dataset with a column for each joint, in the units of the equations."""
    units = dataset.attrs.get("unit", "")
    if isinstance(units, (str, bytes)):
        return dataset[()]
    return dataset[()] * np.array([_OF_SLIDES.get(_text(unit), 1.0) for unit in units])


def _read_rows(file: h5py.File, dof: int) -> dict[str, Array]:
    data: dict[str, Array] = {}
    rows: int | None = None
    for path, columns in DATASETS.items():
        if path not in file:
            raise SessionError(f"{path} is missing")
        values = file[path][()] if columns else _of_joints(file[path])
        rows = len(values) if rows is None else rows
        expected = (rows,) if columns == 1 else (rows, columns or dof)
        if values.shape != expected:
            raise SessionError(f"{path} has shape {values.shape}, expected {expected}")
        kind = np.uint8 if path == "/coupling/kind" else np.float64
        if values.dtype != kind:
            raise SessionError(f"{path} is {values.dtype}, expected {np.dtype(kind)}")
        data[path] = values
    for path, columns in _OR_NOTHING.items():
        nothing = np.zeros((rows,) if columns == 1 else (rows, dof))
        data[path] = _of_joints(file[path]) if path in file else nothing
        if data[path].shape != nothing.shape:
            raise SessionError(f"{path} has shape {data[path].shape}, expected {nothing.shape}")
    accounted = np.any(data["/coupling/kind"] >= 2)
    for path in _LATER:
        if path in file:
            data[path] = file[path][()]
            if len(data[path]) != rows:
                raise SessionError(f"{path} has {len(data[path])} rows, expected {rows}")
        elif accounted:
            raise SessionError(f"{path} is missing")
    return data


def _setting(text: str) -> dict[str, Any]:
    """'key = value' as a dotted key and its value; a bare word is a string."""
    try:
        return flatten(tomllib.loads(text))
    except tomllib.TOMLDecodeError:
        key, _, value = text.partition("=")
        return {key.strip(): value.strip()}


def _read_settings(file: h5py.File, config: str, rows: int) -> dict[str, list[Any]]:
    """Settings per row: the `config` attribute, then /events from their row on."""
    start = dict(_DEFAULTS) | flatten(tomllib.loads(config))
    settings = {key: [start[key]] * rows for key in _DEFAULTS}
    if "/events/row" in file:
        for row, raw in zip(file["/events/row"][()], file["/events/setting"][()]):
            for key, value in _setting(_text(raw)).items():
                if key in settings and int(row) < rows:
                    settings[key][int(row) :] = [value] * (rows - int(row))
    return settings


def read_session(path: Path) -> Session:
    """Reads FILE.h5. Raises SessionError where the layout is not the contract's."""
    with h5py.File(path, "r") as file:
        found = {name: file.attrs[name] for name in ATTRIBUTES if name in file.attrs}
        for name in ATTRIBUTES:
            if name not in found:
                raise SessionError(f"attribute {name} is missing")
        attributes = {k: _text(v) if isinstance(v, (bytes, str)) else v for k, v in found.items()}
        if attributes["format"] != "limpid-session" or int(attributes["version"]) not in (1, 2):
            raise SessionError("not a limpid-session of version 1 or 2")
        chain = parse_chain(attributes["device_urdf"])
        if chain.dof != int(attributes["dof"]):
            raise SessionError(f"dof is {attributes['dof']}, device_urdf has {chain.dof} joints")
        data = _read_rows(file, chain.dof)
        settings = _read_settings(file, attributes["config"], len(data["/time"]))
    return Session(data, settings, attributes, chain)
