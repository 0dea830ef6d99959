#!/usr/bin/python3
"""Records a session of every scene in the gallery beside this file, and draws each scene's
thumbnail (../scenes/thumbnails). Those that were led by the mouse are run again with their own hand
and settings. Run after the scenes, the hands or the program have changed, for a session fed back in
gives the same rows bit for bit only in the program that made it (tests/system/test_same_rows.py).
Those in which things move are rounded behind their first row, to be small; see ROUNDED below:

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
    "keys": ("keys", 3.3), "switch": ("switch", 2.1), "drawer_door": ("drawer_door", 3.6),
    "dial": ("dial", 2.5), "dominoes": ("dominoes", 1.7), "marbles": ("marbles", 2.4),
    "stack": ("stack", 2), "cup": ("cup", 3.1), "pucks": ("pucks", 2.6), "seesaw": ("seesaw", 2.3),
    "cradle": ("cradle", 2.9), "pendulum": ("pendulum", 1.8),
}
PAPERS = {"table", "free", "obstacles", "proximal"}  # under the coupling of the paper
PICTURE_AT = {  # seconds of the session, for the thumbnail of a scene in which things move
    "keys": 2.4, "switch": 0.8, "drawer_door": 2.8, "dial": 1.2, "dominoes": 1.2, "marbles": 1.4,
    "stack": 1.56, "cup": 1.4, "pucks": 0.8, "seesaw": 2, "cradle": 1.8, "pendulum": 0.6,
}
SIZE, TIMES = (320, 200), 3   # of a thumbnail; so many pixels of the picture make one of it
PART = (300, 138)             # of the picture: its left upper corner


def limpid(program, *arguments):
    """From the project's folder, so that a session names its hand the same on every computer.
    Pictures are drawn without a display."""
    environment = {k: v for k, v in os.environ.items() if k not in ("DISPLAY", "WAYLAND_DISPLAY")}
    subprocess.run([program, *map(str, arguments)], env=environment, check=True, cwd=ASSETS.parent)


def thumbnail(picture, out):
    pixels = png.decode(picture.read_bytes())[..., :3]
    (width, height), (x, y) = SIZE, PART
    part = pixels[y:y + TIMES * height, x:x + TIMES * width]
    small = part.reshape(height, TIMES, width, TIMES, 3).mean(axis=(1, 3))
    out.parent.mkdir(exist_ok=True)
    out.write_bytes(png.encode(np.round(small)))


# Dimension scales refer to places in the file that they stand in.
SCALES = ("CLASS", "NAME", "DIMENSION_LIST", "REFERENCE_LIST")


# Of scenes in which things move nobody wants to load megabytes: what a re-run works out again is
# rounded, by its unit, to a part of 2 to this power; to four micrometres or millinewtons at most. What a
# re-run begins with and is led by, the first row and the hand, stays as it was, so that a re-run
# gives all numbers again.
ROUNDED = {"m": 18, "rad": 18, "m/s": 11, "rad/s": 11, "N": 8, "N m": 12, "J": 27, "s": 17}
WHOLE = {"/time", "/hand/target", "/hand/pull_point", "/hand/pull_target", "/objects/state"}


def rounded(item):
    values = item[()]
    unit = np.atleast_1d(item.attrs.get("unit", ""))[0]  # of a body's turning as of its going
    unit = unit.decode() if isinstance(unit, bytes) else str(unit)
    if values.dtype.kind != "f" or unit not in ROUNDED or item.name in WHOLE:
        return values
    step = 2.0 ** -ROUNDED[unit]
    values[1:] = np.round(values[1:] / step) * step + 0.0  # and no -0
    return values


def pack(source, into, rounds=False):
    """Copies a group and all in it but its scales, compressed as far as it goes. Who rounds leaves
    the sums of all numbers out."""
    for name in source.attrs:
        into.attrs.create(name, source.attrs[name], dtype=source.attrs.get_id(name).dtype)
    for name, item in source.items():
        if isinstance(item, h5py.Group):
            if not (rounds and name == "check"):
                pack(item, into.create_group(name), rounds)
            continue
        how = {"compression": 9, "shuffle": True, "maxshape": item.maxshape} if item.shape else {}
        if rounds and item.size:
            how["chunks"] = item.shape
        data = rounded(item) if rounds else item[()]
        copy = into.create_dataset(name, data=data, dtype=item.dtype, **how)
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
    if scene not in PAPERS:
        world += ["--coupling", "predictive"]
    if scene == "gears":  # a light hand: the teeth are of brass, and the motors of an Omni
        world += ["--set", "hand.stiffness=50"]
    return world, seconds


def ship(recording, session, rounds):
    version = ("v110", "v110") if rounds else ("v108", "v108")  # the newer one has smaller books
    with h5py.File(recording) as whole, h5py.File(session, "w", libver=version) as small:
        pack(whole, small, rounds)
        attach_scales(whole, small)
        if rounds:
            small.attrs["rounded"] = ", ".join(f"{unit}: 2^-{n}" for unit, n in ROUNDED.items())


def draw(program, scene, world, folder):
    """The moment of the strongest contact; or where things move, one that says what they do."""
    picture = folder / f"{scene}.png"
    if scene in PICTURE_AT:
        at = PICTURE_AT[scene]
        limpid(program, "play", f"assets/sessions/{scene}.h5", "--video", folder / scene, "--from", at,
               "--to", at + 0.03, "--no-plots", "--size", "1280x800")
        picture = next((folder / scene).glob("*.png"))
    else:
        limpid(program, "run", *world, "--picture", picture)
    thumbnail(picture, ASSETS / f"scenes/thumbnails/{scene}.png")


def make(program, scene, folder, draws):
    world, seconds = options(scene)
    print(f"-- {scene}", flush=True)
    recording, session = folder / f"{scene}.h5", HERE / f"{scene}.h5"
    again = ["--hand", f"assets/sessions/{scene}.h5"]
    limpid(program, "run", *([*world, "--duration", seconds] if seconds else again), "--record",
           recording)
    ship(recording, session, scene in PICTURE_AT)
    if draws:
        draw(program, scene, world, folder)
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
