"""A maker's device in the window: chosen, armed by its own button, cut, and left without force."""

from __future__ import annotations

import time
import unittest

from vendor_link import environment, motors_in
from window import WindowTest

TOUCH = "openhaptics:Default Device"


class InTheWindow(WindowTest):
    LAW = None

    def prepare(self) -> None:
        changed = environment(str(self.home), "sway:0.3,button@6000")
        for name in ("LIMPID_STAND_IN", "LIMPID_STAND_IN_RECORD", "LD_LIBRARY_PATH"):
            self.environment[name] = changed[name]
        (self.home / "config/limpid/devices.toml").write_text(f'[device."{TOUCH}"]\nchecked = true\n')
        self.words = ["--device", TOUCH]

    def pushed(self) -> bool:
        return any(any(held.force) for held in motors_in(self.home))

    def test_is_armed_by_its_second_button_and_cut_by_escape(self) -> None:
        self.wait("the device in the loop", lambda s: s["arm"] == "openhaptics", 60)
        self.wait_for_notice("press F to arm the force")
        self.assertFalse(self.pushed())
        end = time.monotonic() + 60
        while not self.pushed() and time.monotonic() < end:
            time.sleep(0.1)
        self.assertTrue(self.pushed(), "its button arms it")
        self.key("Escape")
        self.wait("the force to be off", lambda s: not s["force"])
        before = len(motors_in(self.home))
        self.go_on(0.5)
        self.assertFalse([held for held in motors_in(self.home)[before:] if any(held.force)])
        self.app.terminate()
        self.app.wait(timeout=30)
        self.assertFalse(motors_in(self.home)[-1].on)


if __name__ == "__main__":
    unittest.main()
