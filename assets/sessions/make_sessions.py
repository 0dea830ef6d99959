#!/usr/bin/env python3
"""Records a session of every scene in the gallery beside this file, and draws each scene's
thumbnail (../scenes/thumbnails). Those that were led by the mouse are run again with their own hand
and settings. Run after the scenes, the hands or the program have changed, for a session fed back in
gives the same rows bit for bit only in the program that made it (tests/system/test_same_rows.py):

    python3 assets/sessions/make_sessions.py [--sessions] [PROGRAM] [SCENE ...]

--sessions draws no thumbnails. PROGRAM is build/release/app/limpid if not given. Needs numpy and h5py."""

import os
import subprocess
import sys
import tempfile
from pathlib import Path

import h5py
import numpy as np

HERE = Path(__file__).resolve().parent
ASSETS = HERE.parent
sys.path.insert(0, str(ASSETS))
import png  # noqa: E402

SCENES = {  # scene: hand, seconds recorded (0: the session was led by the mouse)
    "table": ("touch", 0), "free": ("free", 0), "obstacles": ("touch", 4.6),
    "proximal": ("proximal", 4.4), "spheres": ("spheres", 4.2), "relief": ("relief", 4.6),
    "gears": ("gears", 4), "leaf": ("leaf", 5.2),
}
STIFF = {"spheres", "relief", "gears", "leaf"}  # with materials that ask for the predictive coupling
SIZE, TIMES = (320, 200), 3   # of a thumbnail; so many pixels of the picture make one of it
PART = (300, 138)             # of the picture: its left upper corner


def limpid(program, *arguments):
    """From the project's folder, so that a session names its hand the same on every computer.
    Pictures are drawn without a display."""
    environment = {k: v for k, v in os.environ.items() if k not in ("DISPLAY", "WAYLAND_DISPLAY")}
    subprocess.run([program, "run", *map(str, arguments)], env=environment, check=True,
                   cwd=ASSETS.parent)


def thumbnail(picture, out):
    pixels = png.decode(picture.read_bytes())[..., :3]
    (width, height), (x, y) = SIZE, PART
    part = pixels[y:y + TIMES * height, x:x + TIMES * width]
    small = part.reshape(height, TIMES, width, TIMES, 3).mean(axis=(1, 3))
    out.parent.mkdir(exist_ok=True)
    out.write_bytes(png.encode(np.round(small)))


# Dimension scales refer to places in the file that they stand in.
SCALES = ("CLASS", "NAME", "DIMENSION_LIST", "REFERENCE_LIST")


def pack(source, into):
    """Copies a group and all in it but its scales, compressed as far as it goes."""
    for name in source.attrs:
        into.attrs.create(name, source.attrs[name], dtype=source.attrs.get_id(name).dtype)
    for name, item in source.items():
        if isinstance(item, h5py.Group):
            pack(item, into.create_group(name))
            continue
        how = {"compression": 9, "shuffle": True, "maxshape": item.maxshape} if item.shape else {}
        copy = into.create_dataset(name, data=item[()], dtype=item.dtype, **how)
        for attribute in (name for name in item.attrs if name not in SCALES):
            copy.attrs.create(attribute, item.attrs[attribute],
                              dtype=item.attrs.get_id(attribute).dtype)


def attach_scales(source, into):
    """The scales of each dataset of a file, as its copy has them."""

    def attach(name, item):
        if not isinstance(item, h5py.Dataset) or h5py.h5ds.is_scale(item.id):
            return
        for i, dimension in enumerate(item.dims):
            for scale in dimension.values():
                own = into[scale.name]
                if not h5py.h5ds.is_scale(own.id):
                    own.make_scale(scale.attrs["NAME"])
                into[name].dims[i].attach_scale(own)

    source.visititems(attach)


def options(scene):
    """What a session is run with from the start."""
    hand, seconds = SCENES[scene]
    world = ["--scene", f"assets/scenes/{scene}.toml", "--hand", f"assets/hands/{hand}.csv",
             "--eta", "0.6"]
    if scene in STIFF:
        world += ["--coupling", "predictive"]
    if scene == "gears":  # a light hand: the teeth are of brass, and the motors of an Omni
        world += ["--set", "hand.stiffness=50"]
    return world, seconds


def make(program, scene, folder, draws):
    world, seconds = options(scene)
    print(f"-- {scene}", flush=True)
    if draws:
        picture = folder / f"{scene}.png"
        limpid(program, *world, "--picture", picture)
        thumbnail(picture, ASSETS / f"scenes/thumbnails/{scene}.png")
    recording, session = folder / f"{scene}.h5", HERE / f"{scene}.h5"
    again = ["--hand", f"assets/sessions/{scene}.h5"]
    limpid(program, *([*world, "--duration", seconds] if seconds else again), "--record", recording)
    with h5py.File(recording) as whole, h5py.File(session, "w", libver=("v108", "v108")) as small:
        pack(whole, small)
        attach_scales(whole, small)
    print(f"{session.name}: {session.stat().st_size / 1e6:.2f} MB", flush=True)


if __name__ == "__main__":
    wanted = sys.argv[1:]
    draws = "--sessions" not in wanted
    wanted = [word for word in wanted if word != "--sessions"]
    program = ASSETS.parent / "build/release/app/limpid"
    if wanted and wanted[0] not in SCENES:
        program = Path(wanted.pop(0)).resolve()
    with tempfile.TemporaryDirectory() as temporary:
        for name in wanted or SCENES:
            make(program, name, Path(temporary), draws)
