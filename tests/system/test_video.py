#!/usr/bin/python3
"""`limpid play SESSION.h5 --video OUT`: a session as a film, without a display."""

from __future__ import annotations

import hashlib
import os
import re
import resource
import signal
import struct
import subprocess
import time
import unittest
from pathlib import Path

import h5py

from support import ASSETS, LIMPID, Result, Started, SystemTest, limpid

SESSION = ASSETS / "sessions" / "table.h5"  # 8.491 s
SMALL = ("--size", "320x180", "--no-plots")
TWO_CAMERAS = """title = "Two cameras"
scene = "table.toml"
seconds = 4
[[step]]
time = 0
caption = "From afar."
beside = false
camera = "iso"
hand = [[0, 0.19, 0, 0]]
[[step]]
time = 1
caption = "From near by."
beside = false
camera = { view = "side", target = [0.17, 0, -0.02], size = 0.1 }
"""


def boxes(file: Path) -> list[tuple[bytes, bytes]]:
    """Boxes at the top level of an MP4 file."""
    data, at, found = file.read_bytes(), 0, []
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at : at + 8])
        found.append((kind, data[at + 8 : at + length]))
        at += length
    return found


class Video(SystemTest):
    def video(self, out: Path, *options: str | Path) -> Result:
        result = limpid("play", SESSION, "--video", out, *options)
        self.assertEqual((result.status, result.err), (0, ""))
        self.assertEqual([p.name for p in out.parent.glob(f"{out.name}.*")], [], "something stays")
        return result

    def refused(self, *options: str | Path) -> str:
        before = sorted(self.directory.iterdir())
        result = limpid("play", SESSION, *options)
        self.assertEqual(result.status, 2, result.err)
        self.assertEqual(len(result.error_lines), 1, result.err)
        self.assertEqual(sorted(self.directory.iterdir()), before)
        return result.err

    def test_pictures_are_as_many_as_duration_times_rate_and_show_what_happens(self) -> None:
        out = self.out("")
        self.video(out, "--size", "480x400", "--from", "1", "--to", "2.5", "--speed", "1.5",
                   "--fps", "4")  # fmt: skip
        names = sorted(path.name for path in out.iterdir())
        self.assertEqual(names, [f"frame-{i:06}.png" for i in range(1, 5)])
        pictures = [(out / name).read_bytes() for name in names]
        for picture in pictures:
            self.assertEqual(struct.unpack(">8s4x4sII", picture[:24]),
                             (b"\x89PNG\r\n\x1a\n", b"IHDR", 480, 400))  # fmt: skip
        self.assertEqual(len(set(pictures)), 4, "it stands still")

    def test_a_rerun_and_the_lens_are_in_the_picture(self) -> None:
        whole = ("--size", "640x480", "--from", "3", "--to", "3.1", "--fps", "10")
        pictures = []
        for more in ((), ("--rerun", "coupling.kind=standard"), ("--lens",)):
            out = self.out("")
            self.video(out, *whole, *more)
            pictures.append((out / "frame-000001.png").read_bytes())
        self.assertEqual(len(set(pictures)), 3)
        self.assertIn("did you mean coupling.eta", self.refused(
            "--video", self.directory / "no.mp4", "--rerun", "coupling.etta=1"))

    def test_each_step_of_a_story_has_its_camera_wherever_the_video_begins(self) -> None:
        script = self.out(".toml")
        script.write_text(TWO_CAMERAS)

        def pictures(*options: str) -> list[str]:
            out = self.out("")
            result = limpid("story", script, "--video", out, *SMALL, "--fps", "5", *options)
            self.assertEqual((result.status, result.err), (0, ""))
            return [hashlib.sha256(path.read_bytes()).hexdigest() for path in sorted(out.iterdir())]

        whole, end = pictures(), pictures("--from", "3.6")
        self.assertEqual(whole[-2:], end, "the camera has long been where it goes")
        self.assertNotIn(end[0], whole[:5])

    def test_an_mp4_says_how_long_it_is_before_its_pictures_come(self) -> None:
        out = self.out(".mp4")
        result = self.video(out, *SMALL, "--to", "0.5", "--fps", "8")
        self.assertIn("4 pictures, 0.50 s, 320 x 180", result.out)
        kinds = [kind for kind, _ in boxes(out)]
        self.assertLess(kinds.index(b"moov"), kinds.index(b"mdat"))
        header = dict(boxes(out))[b"moov"]
        at = header.index(b"mvhd") + 4
        scale, duration = struct.unpack(">II", header[at + 12 : at + 20])
        self.assertAlmostEqual(duration / scale, 0.5, delta=1 / scale)

    def test_an_mp4_says_which_recording_it_is_of(self) -> None:
        out = self.out(".mp4")
        self.video(out, "--size", "160x120", "--fps", "5", "--to", "0.4")
        with h5py.File(SESSION) as file:
            version, seed = file.attrs["app_version"], file.attrs["seed"]
            day = str(file.attrs["created"])[:10]
        wanted = rf"limpid {re.escape(str(version))}, settings [0-9a-f]{{8}}, seed {seed}, {day}"
        self.assertRegex(out.read_bytes(), wanted.encode())

    def test_a_gif_has_its_size_and_runs_for_ever(self) -> None:
        out = self.out(".gif")
        self.video(out, *SMALL, "--to", "0.2")
        data = out.read_bytes()
        self.assertEqual(struct.unpack("<6sHH", data[:10]), (b"GIF89a", 320, 180))
        self.assertIn(b"NETSCAPE2.0\x03\x01\x00\x00", data)
        self.assertEqual(data.count(b"\x21\xf9\x04"), 3, "0.2 s at 15 pictures per second")

    def test_what_is_there_is_replaced_only_if_forced(self) -> None:
        out = self.out(".mp4")
        out.write_text("mine")
        self.assertIn(str(out), self.refused("--video", out))
        self.assertEqual(out.read_text(), "mine")
        self.video(out, *SMALL, "--to", "0.1", "--force")
        self.assertEqual(boxes(out)[0][0], b"ftyp")

    def test_what_cannot_be_is_refused_with_what_is_allowed(self) -> None:
        out = self.out(".mp4")
        for options, said in (
            (("--video", self.out(".avi")), "OUT.mp4"),
            (("--video", self.directory / "no/a.mp4"), "no such directory"),
            (("--video", "/proc/a.mp4"), "/proc/a.mp4"),
            (("--video", ""), "--video"),
            (("--video", out, "--size", "321x180"), "321 x 180"),
            (("--video", out, "--size", "wide"), "WIDTHxHEIGHT"),
            (("--video", out, "--size", "640x360x2"), "WIDTHxHEIGHT"),
            (("--video", out, "--size", "0x0"), "64"),
            (("--video", out, "--size", "99998x64"), "4096"),
            (("--video", out, "--fps", "0"), "1 to 240"),
            (("--video", out, "--fps", "2.5"), "--fps"),
            (("--video", self.out(".gif"), "--fps", "60"), "1 to 50"),
            (("--video", out, "--from", "-1"), "8.491"),
            (("--video", out, "--from", "3", "--to", "3"), "8.491"),
            (("--video", out, "--to", "9"), "8.491"),
            (("--video", out, "--to", "nan"), "8.491"),
            (("--video", out, "--speed", "0"), "--speed"),
            (("--video", out, "--eta", "0.5"), "recorded"),
            (("--size", "640x360"), "--video"),
            (("--force",), "--video"),
        ):
            with self.subTest(options=options):
                self.assertIn(said, self.refused(*options))

    def test_an_interrupted_video_leaves_nothing(self) -> None:
        for end in (".mp4", ".gif", ""):
            with self.subTest(end), Started("play", SESSION, "--video", out := self.out(end), *SMALL
                                            ) as started:  # fmt: skip
                until = time.monotonic() + 20
                while not list(self.directory.glob(f"{out.name}.part*")):
                    self.assertLess(time.monotonic(), until, "it does not begin")
                    time.sleep(0.01)
                self.assertEqual(started.stop(signal.SIGINT), 1)
                error = started.process.stderr.read().decode()
                self.assertRegex(error, rf"^limpid: stopped at .* {out} was not written\n$")
                self.assertEqual(list(self.directory.glob(f"{out.name}*")), [])

    def test_a_full_disk_ends_it_with_one_line_and_leaves_nothing(self) -> None:
        def limited() -> None:
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
            resource.setrlimit(resource.RLIMIT_FSIZE, (4096, 4096))

        for end in (".mp4", ".gif", ""):
            out = self.out(end)
            done = subprocess.run(
                [str(LIMPID), "play", SESSION, "--video", out, *SMALL, "--to", "0.3"],
                capture_output=True, text=True, timeout=60, preexec_fn=limited,
                env={**os.environ, "MESA_SHADER_CACHE_DISABLE": "true"},
            )  # fmt: skip
            with self.subTest(end):
                self.assertEqual(done.returncode, 1, done.stderr)
                self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
                self.assertIn(f"{out}", done.stderr)
                self.assertIn("File too large", done.stderr)
                self.assertEqual(list(self.directory.glob(f"{out.name}*")), [])


if __name__ == "__main__":
    unittest.main()
