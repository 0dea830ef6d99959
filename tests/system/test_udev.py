#!/usr/bin/python3
"""Access to devices: the shipped udev rules, taken literally."""

from __future__ import annotations

import fnmatch
import re
import unittest

from support import ROOT

RULES = ROOT / "assets/udev/70-limpid.rules"
_KEY = re.compile(r'([A-Z]+)(?:\{(\w+)\})?(==|!=|\+=|=)"([^"]*)"')


def rules() -> list[list[tuple[str, str, str, str]]]:
    """Keys of each rule: name, attribute, operator, value."""
    found = []
    for line in RULES.read_text().splitlines():
        text = line.split("#")[0].strip()
        if text:
            found.append(_KEY.findall(text))
    return found


def readable(vendor: str, product: str, protocol: str = "00") -> bool:
    """Whether the seat may read a hidraw node of this product, by the rules from top to bottom."""
    attributes = {"idVendor": vendor, "idProduct": product, "bInterfaceProtocol": protocol}
    known = {"ACTION": "add", "SUBSYSTEM": "hidraw"}
    allowed, skip = False, ""
    for rule in rules():
        if skip:
            skip = "" if ("LABEL", "", "=", skip) in rule else skip
            continue
        holds = True
        for name, attribute, operator, value in rule:
            if operator not in ("==", "!="):
                continue
            actual = attributes[attribute] if name == "ATTRS" else known[name]
            holds = holds and fnmatch.fnmatchcase(actual, value) == (operator == "==")
        if holds:
            allowed = allowed or ("TAG", "", "+=", "uaccess") in rule
            skip = next((value for name, _, _, value in rule if name == "GOTO"), "")
    return allowed


class Rules(unittest.TestCase):
    def test_each_that_gives_a_device_names_its_vendor_and_its_product(self) -> None:
        giving = [rule for rule in rules() if any(key[0] == "TAG" for key in rule)]
        self.assertGreater(len(giving), 10)
        for rule in giving:
            named = {attribute: value for _, attribute, operator, value in rule if operator == "=="}
            with self.subTest(rule=rule):
                self.assertRegex(named.get("idVendor", ""), r"^[0-9a-f]{4}$")
                # Products are digits, or a few of them in one place: no star, no question mark, no
                # range.
                self.assertRegex(named.get("idProduct", ""), r"^([0-9a-f]|\[[0-9a-f]+\]){4}$")

    def test_every_line_is_understood(self) -> None:
        for line in RULES.read_text().splitlines():
            text = line.split("#")[0].strip()
            left = _KEY.sub("", text).replace(",", "").strip()
            self.assertEqual(left, "", line)

    def test_space_mice_can_be_read(self) -> None:
        # Products as spacenavd lists them, and the two with Bluetooth.
        own = "c62e c62f c631 c632 c633 c635 c636 c638 c63a c652"
        older = "c603 c605 c606 c621 c623 c625 c626 c627 c628 c629 c62b"
        for vendor, products in (("256f", own), ("046d", older)):
            for product in products.split():
                self.assertTrue(readable(vendor, product), f"{vendor}:{product}")

    def test_keyboards_mice_and_number_pads_cannot(self) -> None:
        # 3Dconnexion's CadMouse, Keyboard Pro and Numpad Pro; a keyboard and a receiver of Logitech's.
        for name in ("256f:c650", "256f:c651", "256f:c654", "256f:c655", "256f:c656", "256f:c657",
                     "256f:c664", "256f:c668", "256f:c62c", "256f:0000", "046d:c31c", "046d:c52b",
                     "046d:c622", "046d:c62a"):  # fmt: skip
            self.assertFalse(readable(*name.split(":")), name)

    def test_a_receivers_part_that_is_a_keyboard_or_a_mouse_cannot(self) -> None:
        self.assertTrue(readable("256f", "c652", "00"))
        self.assertFalse(readable("256f", "c652", "01"))
        self.assertFalse(readable("256f", "c652", "02"))

    def test_devices_with_motors_can(self) -> None:
        for name in ("045e:001b", "ffff:2055", "346e:0000", "346e:0016", "346e:0004", "16d0:0d5a", "16d0:0d5f",
                     "16d0:0d60", "16d0:0d61", "1209:ffb0", "1209:4c50"):  # fmt: skip
            self.assertTrue(readable(*name.split(":")), name)


if __name__ == "__main__":
    unittest.main()
