#!/usr/bin/python3
"""File dialogs of the window: the desktop's own if its portal answers, otherwise Limpid's."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
import time
import unittest
from pathlib import Path
from urllib.parse import quote

from support import ASSETS, LIMPID
from window import WindowTest

PYTHON = "/usr/bin/python3"  # has the distribution's modules
STAND_IN = Path(__file__).with_name("desktop_portal.py")
# The bus starts no service, whatever is installed here.
BUS = """<!DOCTYPE busconfig PUBLIC "-//freedesktop//DTD D-Bus Bus Configuration 1.0//EN"
 "http://www.freedesktop.org/standards/dbus/1.0/busconfig.dtd">
<busconfig><type>session</type><listen>unix:path={}</listen><policy context="default">
<allow send_destination="*"/><allow receive_sender="*"/><allow own="*"/></policy></busconfig>"""
SESSION = ASSETS / "sessions/gears.h5"
SCENE = """[[sphere]]
name = "ball"
center = [0.2, 0.0, 0.0]
radius = 0.03
stiffness = 600.0
"""


def has_gio() -> bool:
    return subprocess.run([PYTHON, "-c", "from gi.repository import Gio"], capture_output=True,
                          check=False).returncode == 0


@unittest.skipUnless(shutil.which("dbus-daemon") and has_gio(), "needs dbus-daemon and python3-gi")
class WithABus(WindowTest):
    def prepare(self) -> None:
        bus = self.home / "bus"
        (self.home / "bus.conf").write_text(BUS.format(bus))
        self.daemon = subprocess.Popen(["dbus-daemon", f"--config-file={self.home}/bus.conf", "--nofork"],
                                       stderr=subprocess.DEVNULL)
        self.addCleanup(self.stop, self.daemon)
        end = time.monotonic() + 20
        while not bus.exists():
            self.assertLess(time.monotonic(), end, "no bus")
            time.sleep(0.05)
        self.environment["DBUS_SESSION_BUS_ADDRESS"] = f"unix:path={bus}"
        self.order_file, self.log = self.home / "order", self.home / "log"
        self.files = self.home / "the user's files"
        self.files.mkdir()

    def portal(self, **order) -> None:
        """Starts the portal."""
        self.log.write_text("")
        self.order(**order)
        self.server = subprocess.Popen([PYTHON, STAND_IN, self.order_file, self.log],
                                       env=self.environment)
        self.addCleanup(self.stop, self.server)
        self.wait_until("the portal", lambda: self.said("there"))

    def order(self, **order) -> None:
        self.order_file.write_text(json.dumps(order))

    def said(self, what: str) -> list[dict]:
        lines = [json.loads(line) for line in self.log.read_text().splitlines() if line]
        return [line for line in lines if line["what"] == what]

    def own_dialog(self, name: str) -> dict:
        return self.wait("Limpid's own dialog", lambda s: s["dialog"] == name and s["typing"])

    def closed(self) -> None:
        self.wait("no dialog", lambda s: s["dialog"] == "" and s["closing"] is None)


class Answers(WithABus):
    def test_a_scene_is_opened_whatever_is_in_its_name(self) -> None:
        self.portal()
        for name in ("a scene.toml", "Tür 100%25 & größer.toml", "#1?.TOML"):
            with self.subTest(name):
                file = self.files / name
                file.write_text(SCENE)
                self.order(how="choose", uri=f"file://{quote(str(file))}")
                self.key("ctrl+shift+o")
                self.wait("the scene", lambda s: s["file"] == str(file) and s["dialog"] == "")
                self.assertEqual(self.state()["objects"], 1)
        first, *_, last = self.said("OpenFile")
        self.assertEqual(first["parent"], f"x11:{int(self.window):x}")
        self.assertEqual(first["title"], "Open scene")
        options = first["options"]
        self.assertEqual(options["accept_label"], "Open")
        self.assertEqual(options["filters"], [["*.toml", [[0, "*.[tT][oO][mM][lL]"]]]])
        self.assertRegex(options["handle_token"], r"^[A-Za-z0-9_]+$")
        self.assertTrue(options["current_folder"].endswith("/assets/scenes\0"), options)
        self.assertEqual(last["options"]["current_folder"], f"{self.files}\0", "the last folder")
        tokens = {call["options"]["handle_token"] for call in self.said("OpenFile")}
        self.assertEqual(len(tokens), 3, "each time another one")

    def test_a_session_is_found_elsewhere(self) -> None:
        file = self.files / "gears 1.h5"
        shutil.copy(SESSION, file)
        self.portal(how="choose", uri=f"file://{quote(str(file))}")
        self.key("ctrl+o")
        self.wait("the sessions", lambda s: s["dialog"] == "open session" and s["closing"])
        x, y = self.settled()["closing"]["button"]
        self.click(x + 110, y)  # "Elsewhere..."
        self.wait("playback", lambda s: s["playing"] and s["dialog"] == "")
        (call,) = self.said("OpenFile")
        self.assertEqual(call["options"]["filters"], [["*.h5", [[0, "*.[hH]5"]]]])
        self.assertTrue(call["options"]["current_folder"].endswith("/limpid/sessions\0"))

    def test_a_portal_of_old_chooses_its_handle(self) -> None:
        file = self.files / "scene.toml"
        file.write_text(SCENE)
        self.portal(how="choose", uri=f"file://{quote(str(file))}", older=True)
        self.key("ctrl+shift+o")
        self.wait("the scene", lambda s: s["file"] == str(file) and s["dialog"] == "")

    def test_a_scene_is_saved_with_its_ending_and_over_no_file_that_nobody_asked_about(self) -> None:
        self.portal(how="choose", uri=f"file://{quote(str(self.files / 'new one'))}")
        self.key("ctrl+shift+s")
        file = self.files / "new one.toml"
        self.wait_until("the scene", file.exists)
        self.closed()
        (call,) = self.said("SaveFile")
        self.assertEqual(call["title"], "Save scene as")
        self.assertRegex(call["options"]["current_name"], r"^[^/]+\.toml$")
        self.assertTrue(call["options"]["current_folder"].endswith("/limpid/scenes\0"))

        # The desktop has asked about "new one", which is absent, and not about "new one.toml".
        before = file.stat().st_mtime_ns
        self.key("ctrl+shift+s")
        self.own_dialog("save scene")
        self.settled()
        self.assertEqual(file.stat().st_mtime_ns, before)
        self.key("Return")  # Replace it
        self.wait_until("it to be replaced", lambda: file.stat().st_mtime_ns != before)
        self.closed()

        # The desktop has asked about this file.
        before = file.stat().st_mtime_ns
        self.order(how="choose", uri=f"file://{quote(str(file))}")
        self.key("ctrl+shift+s")
        self.wait_until("it to be replaced", lambda: file.stat().st_mtime_ns != before)
        self.closed()

    def test_giving_up_there_closes_here_and_the_other_way_round(self) -> None:
        self.portal(how="give up")
        scene = self.state()["file"]
        self.key("ctrl+shift+o")
        self.wait_until("it to be asked", lambda: self.said("OpenFile"))
        self.closed()
        self.order(how="wait")
        for way in ("Escape", "button"):
            self.key("ctrl+shift+o")
            state = self.wait("the desktop's", lambda s: s["dialog"] == "open scene" and s["closing"])
            self.assertFalse(state["typing"], "it is not Limpid's own")
            closed = len(self.said("Close"))
            self.key("Escape") if way == "Escape" else self.click(*state["closing"]["button"])
            self.closed()
            self.wait_until("the desktop's to be closed", lambda: len(self.said("Close")) == closed + 1)
        self.assertEqual(self.state()["file"], scene)
        self.assertTrue(self.state()["force"])

    def test_limpids_own_is_there_for_who_wants_it(self) -> None:
        self.portal(how="wait")
        self.key("ctrl+shift+o")
        state = self.wait("the desktop's", lambda s: s["dialog"] == "open scene" and s["closing"])
        x, y = state["closing"]["button"]
        self.click(x - 130, y)  # "Ask here instead"
        self.own_dialog("open scene")
        self.wait_until("the desktop's to be closed", lambda: len(self.said("Close")) == 1)
        self.key("Escape")
        self.closed()

    def test_an_answer_that_cannot_be_opened_is_said_in_limpids_own(self) -> None:
        self.portal(how="choose", uri=f"file://{quote(str(self.files / 'gone.toml'))}")
        self.key("ctrl+shift+o")
        self.own_dialog("open scene")
        file = self.files / "gone.toml"  # the file comes back, under the name in the dialog
        file.write_text(SCENE)
        self.key("Return")
        self.wait("the scene", lambda s: s["file"] == str(file))


class ShowsInItsFolder(WithABus):
    def prepare(self) -> None:
        super().prepare()
        self.environment["XDG_DATA_HOME"] = str(self.files / "100% of it")

    def test_what_was_exported_in_the_desktops_file_manager(self) -> None:
        self.portal(how="wait")
        self.go_on(1)
        self.key("ctrl+e")
        self.wait("the dialog", lambda s: s["dialog"] == "export")
        self.key("Return")
        self.wait("it to be said", lambda s: any("Show in folder" in b["buttons"] for b in s["banners"]))
        banners = self.settled()["banners"]
        self.click(*next(b["buttons"]["Show in folder"] for b in banners if "Show in folder" in b["buttons"]))
        self.wait_until("the file manager to be asked", lambda: self.said("ShowItems"))
        (file,) = (self.files / "100% of it").glob("limpid/sessions/*.png")
        self.assertEqual(self.said("ShowItems")[0]["items"], [f"file://{quote(str(file))}"])


class DoesNotAnswer(WithABus):
    def test_limpids_own_opens_where_the_desktops_fails(self) -> None:
        self.key("ctrl+shift+o")  # there is a bus, but no portal on it
        self.own_dialog("open scene")
        self.key("Escape")
        self.closed()
        self.portal(how="refuse")
        for order in ({"how": "refuse"}, {"how": "fail"}, {"how": "choose", "uri": "sftp://host/a.toml"},
                      {"how": "die"}):  # fmt: skip
            with self.subTest(order["how"]):
                self.order(**order)
                self.key("ctrl+shift+o")
                self.own_dialog("open scene")
                self.assertEqual(self.notices(), "")
                self.key("Escape")
                self.closed()
        self.assertEqual(len(self.said("OpenFile")), 4)

    def test_one_that_comes_late_is_closed_and_disturbs_nobody(self) -> None:
        self.portal(how="slow", after=3)
        self.key("ctrl+shift+o")
        began = self.state()["ticks"]
        self.own_dialog("open scene")
        self.assertEqual(self.said("Close"), [])
        self.wait_until("the late one to be closed", lambda: self.said("Close"))
        self.assertTrue(self.own_dialog("open scene"))
        self.assertGreater(self.state()["ticks"], began + 1000, "nothing has waited for it")

    def test_a_bus_that_hangs_opens_limpids_own(self) -> None:
        self.daemon.send_signal(19)  # SIGSTOP
        self.addCleanup(self.daemon.send_signal, 18)
        frames = self.state()["frames"]
        self.key("ctrl+shift+o")
        self.own_dialog("open scene")
        self.assertGreater(self.state()["frames"], frames)


class Preferred(WithABus):
    def prepare(self) -> None:
        super().prepare()
        settings = self.home / "config/limpid/settings.toml"
        settings.write_text(settings.read_text().replace("[window]", "[window]\nown_file_dialogs = true"))

    def test_limpids_own_opens_where_that_is_wanted(self) -> None:
        self.portal(how="wait")
        self.key("ctrl+m")
        self.own_dialog("add model")
        self.assertEqual(self.said("OpenFile"), [])


class Doctor(WithABus):
    def found(self) -> str:
        done = subprocess.run([LIMPID, "doctor", "--json"], env=self.environment, capture_output=True,
                              text=True, timeout=120, check=False)  # fmt: skip
        findings = json.loads(done.stdout)["findings"]
        return next(f["found"] for f in findings if f["what"] == "file dialog")

    def test_says_which_dialog_opens(self) -> None:
        self.assertIn("Limpid's own dialog: the desktop has no portal", self.found())
        self.portal(how="wait")
        self.assertTrue(re.search(r"the desktop environment.*FileChooser 4", self.found()))
        del self.environment["DBUS_SESSION_BUS_ADDRESS"]
        self.assertIn("Limpid's own dialog: no session bus", self.found())


if __name__ == "__main__":
    unittest.main()
