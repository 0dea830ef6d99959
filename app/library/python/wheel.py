"""Makes a wheel of the Python package with its module: `pip install .` calls this (PEP 517).

Nothing is asked of a network. The wheel has the loops (limpid.Loop, limpid.DeviceLoop), the arms,
scenes and hands that came along, and the programs that read models and sessions; the program
`limpid` itself, which limpid.run and limpid.serve start, is installed by the .deb or by CMake.
"""

import base64
import hashlib
import os
import re
import subprocess
import sys
import sysconfig
import zipfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
BUILD = ROOT / "build/release"
PROGRAMS = ("limpid-model", "limpid-session")
ASSETS = ("devices", "scenes", "hands")


def version():
    return re.search(r"project\(limpid VERSION ([\d.]+)", (ROOT / "CMakeLists.txt").read_text())[1]


def build():
    """Builds the module and its programs; returns the module's file."""
    if not (BUILD / "build.ninja").exists():
        subprocess.run(["cmake", "--preset", "release"], cwd=ROOT, check=True)
    subprocess.run(["cmake", "--build", BUILD, "--target", "limpid_loop", *PROGRAMS], check=True)
    module = BUILD / "app" / f"_loop{sysconfig.get_config_var('EXT_SUFFIX')}"
    if not module.exists():
        sys.exit(f"{BUILD} builds the module for another Python than {sys.version.split()[0]}: "
                 f"cmake --preset release -DPython_EXECUTABLE={sys.executable}")
    return module


def files(module):
    """What is in the wheel: its name there, and the file."""
    package = ROOT / "assets/python/limpid"
    for file in sorted(package.rglob("*")):
        if file.is_file() and "__pycache__" not in file.parts:
            yield f"limpid/{file.relative_to(package)}", file
    yield f"limpid/{module.name}", module
    data = f"limpid-{version()}.data/data"
    for kind in ASSETS:
        for file in sorted((ROOT / "assets" / kind).iterdir()):
            if file.is_file() and file.suffix != ".py":
                yield f"{data}/share/limpid/assets/{kind}/{file.name}", file
    for name in PROGRAMS:
        yield f"{data}/libexec/limpid/{name}", next(BUILD.glob(f"*/**/{name}"))


def metadata():
    about = "Limpid from Python: haptic loops, sessions, and the leading of a running program"
    return f"Metadata-Version: 2.1\nName: limpid\nVersion: {version()}\nSummary: {about}\nRequires-Python: >=3.8\n"


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    module = build()
    tag = f"cp{sys.version_info[0]}{sys.version_info[1]}"
    platform = re.sub(r"[-.]", "_", sysconfig.get_platform())
    name = f"limpid-{version()}-{tag}-{tag}-{platform}.whl"
    info = f"limpid-{version()}.dist-info"
    record = []
    with zipfile.ZipFile(Path(wheel_directory, name), "w", zipfile.ZIP_DEFLATED) as wheel:

        def add(where, data, mode=0o644):
            entry = zipfile.ZipInfo(where)
            entry.external_attr = (0o100000 | mode) << 16
            wheel.writestr(entry, data, zipfile.ZIP_DEFLATED)
            digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
            record.append(f"{where},sha256={digest},{len(data)}\n")

        for where, file in files(module):
            add(where, file.read_bytes(), 0o755 if os.access(file, os.X_OK) else 0o644)
        add(f"{info}/METADATA", metadata().encode())
        add(f"{info}/WHEEL", f"Wheel-Version: 1.0\nGenerator: limpid\nRoot-Is-Purelib: false\n"
                             f"Tag: {tag}-{tag}-{platform}\n".encode())
        add(f"{info}/RECORD", "".join(record + [f"{info}/RECORD,,\n"]).encode())
    return name
