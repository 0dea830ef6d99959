#!/usr/bin/python3
"""A stand-in for the desktop's file dialogs (org.freedesktop.portal.FileChooser) on a session bus, and
for its file manager (org.freedesktop.FileManager1).

    desktop_portal.py ORDER LOG

How it answers each call is read from the file ORDER, one JSON object:
    {"how": "choose", "uri": "file:///a.toml"}   what somebody chooses at once
    {"how": "give up"}, {"how": "fail"}          the responses 1 and 2
    {"how": "wait"}                              shown until the program closes it
    {"how": "slow", "after": 2.5}                the method's reply comes so many seconds late
    {"how": "die"}                               the portal ends once the dialog is shown
    {"how": "refuse"}                            there is no such method
"older": true chooses a handle of its own, as portals before 0.9 did. What was asked is in LOG, one
JSON object a line.
"""

from __future__ import annotations

import json
import os
import sys
from pathlib import Path

import gi

gi.require_version("Gio", "2.0")
from gi.repository import Gio, GLib  # noqa: E402

NAME, PATH = "org.freedesktop.portal.Desktop", "/org/freedesktop/portal/desktop"
REQUEST = "org.freedesktop.portal.Request"
METHOD = """<method name="{}"><arg type="s" direction="in"/><arg type="s" direction="in"/>
<arg type="a{{sv}}" direction="in"/><arg type="o" direction="out"/></method>"""
CHOOSER_XML = f"""<node><interface name="org.freedesktop.portal.FileChooser">{METHOD.format("OpenFile")}
{METHOD.format("SaveFile")}<property name="version" type="u" access="read"/></interface></node>"""
MANAGER = "org.freedesktop.FileManager1"
MANAGER_XML = f"""<node><interface name="{MANAGER}"><method name="ShowItems">
<arg type="as" direction="in"/><arg type="s" direction="in"/></method></interface></node>"""
REQUEST_XML = f'<node><interface name="{REQUEST}"><method name="Close"/></interface></node>'


class Portal:
    def __init__(self, order: Path, log: Path) -> None:
        self.order, self.log, self.requests = order, log, 0
        self.bus = Gio.bus_get_sync(Gio.BusType.SESSION)
        chooser = Gio.DBusNodeInfo.new_for_xml(CHOOSER_XML).interfaces[0]
        self.bus.register_object(PATH, chooser, self.asked, lambda *_: GLib.Variant("u", 4), None)
        manager = Gio.DBusNodeInfo.new_for_xml(MANAGER_XML).interfaces[0]
        self.bus.register_object(f"/{MANAGER.replace('.', '/')}", manager, self.show, None, None)
        Gio.bus_own_name_on_connection(self.bus, MANAGER, Gio.BusNameOwnerFlags.NONE, None, None)
        Gio.bus_own_name_on_connection(self.bus, NAME, Gio.BusNameOwnerFlags.NONE,
                                       lambda *_: self.note({"what": "there"}), None)

    def note(self, what: dict) -> None:
        with self.log.open("a") as log:
            log.write(json.dumps(what) + "\n")

    def show(self, _bus, _sender, _path, _interface, _method, words, call) -> None:
        self.note({"what": "ShowItems", "items": words.unpack()[0]})
        call.return_value(None)

    def asked(self, _bus, sender, _path, _interface, method, words, call) -> None:
        parent, title, options = words.unpack()
        order = json.loads(self.order.read_text())
        for name in ("current_folder", "current_name"):
            if isinstance(options.get(name), list):
                options[name] = os.fsdecode(bytes(options[name]))
        self.note({"what": method, "parent": parent, "title": title, "options": options})
        if order["how"] == "refuse":
            return call.return_dbus_error("org.freedesktop.DBus.Error.UnknownMethod", "no such method")
        self.requests += 1
        token = f"own{self.requests}" if order.get("older") else options["handle_token"]
        handle = f"{PATH}/request/{sender[1:].replace('.', '_')}/{token}"
        GLib.timeout_add(int(1000 * order.get("after", 0)), self.answer, order, sender, handle, call)

    def answer(self, order: dict, sender: str, handle: str, call) -> bool:
        request = Gio.DBusNodeInfo.new_for_xml(REQUEST_XML).interfaces[0]

        def close(*_words) -> None:
            self.note({"what": "Close", "handle": handle})
            _words[-1].return_value(None)

        self.bus.register_object(handle, request, close, None, None)
        call.return_value(GLib.Variant("(o)", (handle,)))
        self.bus.flush_sync()
        how = order["how"]
        if how == "die":
            GLib.timeout_add(300, os._exit, 0)
        ends = {"choose": 0, "give up": 1, "fail": 2}
        if how in ends:
            results = {"uris": GLib.Variant("as", [order["uri"]])} if how == "choose" else {}
            # The answer takes a moment, as a person's does.
            GLib.timeout_add(300, self.respond, sender, handle, ends[how], results)
        return False

    def respond(self, sender: str, handle: str, how: int, results: dict) -> bool:
        self.bus.emit_signal(sender, handle, REQUEST, "Response", GLib.Variant("(ua{sv})", (how, results)))
        return False


if __name__ == "__main__":
    portal = Portal(Path(sys.argv[1]), Path(sys.argv[2]))
    GLib.MainLoop().run()
