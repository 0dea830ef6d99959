"""Tables of bad input: for each case the words of a command and what its complaint must name.

Every case changes one thing in input that is fine otherwise, so the complaint can only be about
that.
"""

from __future__ import annotations

from .case import Case, Good
from .device_urdf import URDF
from .hands import CSV, SESSIONS
from .options import OPTIONS
from .places import FILES, OUTPUT
from .toml_files import CONFIG, SCENE

TABLES: dict[str, list[Case]] = {
    "urdf": URDF,
    "csv": CSV,
    "sessions": SESSIONS,
    "config": CONFIG,
    "scene": SCENE,
    "options": OPTIONS,
    "files": FILES,
    "output": OUTPUT,
}

__all__ = ["TABLES", "Case", "Good"]
