"""Builds a scene in the window: adds models, changes, undoes, saves and opens it again."""

import json
import struct
import unittest
from pathlib import Path

from support import ASSETS
from window import WindowTest

# A pyramid, counter-clockwise from outside; glTF's y is up.
CORNERS = [(-30, 0, -30), (30, 0, -30), (30, 0, 30), (-30, 0, 30), (0, 40, 0)]
FACES = [(0, 1, 2), (0, 2, 3), (0, 4, 1), (1, 4, 2), (2, 4, 3), (3, 4, 0)]


def write_pyramid(path: Path) -> None:
    """Writes a model as a CAD program would: large, in any unit."""
    points = b"".join(struct.pack("<3f", *corner) for corner in CORNERS)
    indices = b"".join(struct.pack("<3H", *face) for face in FACES)
    low = [min(c[k] for c in CORNERS) for k in range(3)]
    high = [max(c[k] for c in CORNERS) for k in range(3)]
    text = json.dumps({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "buffers": [{"byteLength": len(points) + len(indices)}],
        "bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": len(points)},
                        {"buffer": 0, "byteOffset": len(points), "byteLength": len(indices)}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": len(CORNERS),
                       "type": "VEC3", "min": low, "max": high},
                      {"bufferView": 1, "componentType": 5123, "count": 3 * len(FACES),
                       "type": "SCALAR"}],
    }).encode()
    text += b" " * (-len(text) % 4)
    body = points + indices
    body += b"\0" * (-len(body) % 4)
    path.write_bytes(struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(body))
                     + struct.pack("<I4s", len(text), b"JSON") + text
                     + struct.pack("<I4s", len(body), b"BIN\0") + body)


class SceneWindow(WindowTest):
    def answer(self, text: str = "") -> None:
        """Types over the text in the dialog that opens, and enters it."""
        self.wait("the dialog", lambda s: s["asking"] and s["typing"])
        if text:
            self.key("ctrl+a")
            self.type(text)
        self.key("Return")
        self.wait("the dialog to close", lambda s: not s["asking"])

    def add_model(self, path: Path) -> None:
        self.key("ctrl+m")
        self.answer(str(path))

    def add_pyramid(self) -> dict:
        model = self.home / "pyramid.glb"
        write_pyramid(model)
        self.add_model(model)
        return self.wait("the model", lambda s: s["objects"] == 2 and not s["loading"]
                         and s["selected"] == "pyramid")

    def save_as(self, path: Path) -> None:
        self.key("ctrl+shift+s")
        self.answer(str(path))
        self.wait("the scene to be saved",
                  lambda s: not s["dirty"] and s["file"] == str(path) and path.exists())

    def test_a_model_is_added_undone_copied_removed_saved_and_opened_again(self) -> None:
        self.assertFalse(self.state()["dirty"])
        self.assertTrue(self.add_pyramid()["dirty"])

        self.key("c")
        self.wait("the proposed coupling", lambda s: s["kind"] == 1)
        self.key("ctrl+z")
        self.wait("the standard coupling", lambda s: s["kind"] == 0 and s["objects"] == 2)
        self.key("ctrl+z")
        self.wait("the scene as it was", lambda s: s["objects"] == 1 and not s["dirty"])
        self.key("ctrl+y")
        self.wait("the model again", lambda s: s["objects"] == 2 and s["dirty"])

        self.key("Tab")
        self.wait("the next object", lambda s: s["selected"] == "table top")
        self.key("Tab")
        self.key("ctrl+d")
        self.wait("a second one", lambda s: s["selected"] == "pyramid 2" and s["objects"] == 3)
        self.key("Delete")
        self.wait("one less", lambda s: s["objects"] == 2 and s["selected"] is None)
        self.key("ctrl+z")
        self.wait("it again", lambda s: s["objects"] == 3)

        # A scene that came with Limpid is saved as one's own, its models beside it.
        self.key("ctrl+s")
        self.answer()
        own = self.home / "data/limpid/scenes/table.toml"
        self.wait("the scene to be saved", lambda s: not s["dirty"] and s["file"] == str(own))
        self.assertTrue((own.parent / "pyramid.glb").exists())
        self.assertEqual(own.read_text().count('file = "pyramid.glb"'), 2)

        (self.home / "pyramid.glb").unlink()
        self.key("ctrl+q", closes=True)
        self.assertEqual(self.app.wait(30), 0)
        self.start()
        self.wait("the scene of last time", lambda s: s["objects"] == 3 and not s["loading"])
        self.assertFalse(self.state()["dirty"])

    def test_a_recording_keeps_the_scene_and_the_scene_stays_as_it_is(self) -> None:
        self.add_pyramid()
        self.key("ctrl+r")  # R turns what is selected
        self.wait("recording", lambda s: s["recording"])
        self.key("Delete")
        self.key("ctrl+z")
        self.press_onto_table()
        self.go_on(0.5)
        self.xdotool("mouseup", "1")
        self.assertEqual(self.settled()["objects"], 2, "not changed while recording")
        self.key("ctrl+r")
        self.wait("the end of the recording", lambda s: not s["recording"])
        (self.home / "pyramid.glb").unlink()
        sessions = self.home / "data/limpid/sessions"
        self.wait_until("the file", lambda: any(sessions.glob("*.h5")))
        recordings = list(sessions.glob("*.h5"))
        self.assertEqual(len(recordings), 1)
        self.check_rerun_is_the_same(recordings[0])

        self.key("p")
        self.wait("playback", lambda s: s["playing"])
        self.key("Delete")
        self.assertEqual(self.settled()["objects"], 2, "not changed during playback")
        self.key("e")
        self.wait("the re-run", lambda s: s["rerun"])

    def test_unsaved_changes_are_asked_about(self) -> None:
        self.add_pyramid()
        self.key("ctrl+q")
        self.wait("the question", lambda s: s["asking"])
        self.key("Escape")
        self.wait("the window to stay", lambda s: s["dirty"] and not s["asking"])
        path = self.home / "mine.toml"
        self.save_as(path)
        self.key("Tab")
        self.key("Delete")
        self.wait("a change", lambda s: s["dirty"])
        self.key("ctrl+q")
        self.wait("the question", lambda s: s["asking"])
        self.key("d", closes=True)
        self.assertEqual(self.app.wait(30), 0)
        self.assertEqual(path.read_text().count("[[plane]]"), 1, "discarded")

    def test_what_cannot_be_used_changes_nothing(self) -> None:
        broken = self.home / "broken.glb"
        broken.write_bytes((ASSETS / "scenes/table.glb").read_bytes()[:1000])
        self.add_model(broken)
        self.wait_for_notice("broken.glb")
        state = self.wait("the end of loading", lambda s: not s["loading"])
        self.assertEqual(state["objects"], 1)
        self.assertFalse(state["dirty"])

    def test_a_scene_that_came_without_its_models_is_not_written_over(self) -> None:
        self.add_pyramid()
        path = self.home / "mine.toml"
        self.save_as(path)
        self.key("ctrl+q", closes=True)
        self.assertEqual(self.app.wait(30), 0)
        (self.home / "pyramid.glb").write_bytes(b"glTF")
        text = path.read_text()
        self.start()
        self.wait_for_notice("pyramid.glb")
        self.assertEqual(self.state()["objects"], 1)
        self.key("ctrl+s")
        self.wait("the question for a name", lambda s: s["asking"] and s["typing"])
        self.key("Escape")
        self.wait("the dialog to close", lambda s: not s["asking"])
        self.assertEqual(path.read_text(), text)


if __name__ == "__main__":
    unittest.main()
