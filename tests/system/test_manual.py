"""The manual as one page, and the command that opens it."""

from __future__ import annotations

import os
import re
import stat
import subprocess
import unittest
from html.parser import HTMLParser
from pathlib import Path

from support import LIMPID, SystemTest, limpid


class Page(HTMLParser):
    """Ids, links and texts of a page, and whether each element is closed."""

    ALONE = {"meta", "br", "hr", "input", "col"}

    def __init__(self, text: str) -> None:
        super().__init__()
        self.ids: list[str] = []
        self.links: list[str] = []
        self.open: list[str] = []
        self.wrong: list[str] = []
        self.feed(text)

    def handle_starttag(self, tag: str, attributes: list) -> None:
        found = dict(attributes)
        if "id" in found:
            self.ids.append(found["id"])
        if tag == "a" and "href" in found:
            self.links.append(found["href"])
        if tag not in self.ALONE:
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        if not self.open or self.open.pop() != tag:
            self.wrong.append(f"</{tag}> at {self.getpos()}")


class Manual(SystemTest):
    def setUp(self) -> None:
        self.file = Path(limpid("manual", "--path").out.strip())
        self.text = self.file.read_text()
        self.page = Page(self.text)

    def test_its_links_lead_somewhere(self) -> None:
        within = [link[1:] for link in self.page.links if link.startswith("#")]
        self.assertGreater(len(within), 40)
        self.assertEqual([link for link in within if link not in self.page.ids], [])
        others = [link for link in self.page.links if not link.startswith(("#", "http"))]
        self.assertEqual(others, [])

    def test_it_is_well_formed(self) -> None:
        self.assertEqual((self.page.wrong, self.page.open), ([], []))
        self.assertNotIn("<img", self.text)
        repeated = {each for each in self.page.ids if self.page.ids.count(each) > 1}
        self.assertEqual(repeated, set())

    def test_it_has_every_setting_and_key(self) -> None:
        for key in re.findall(r"^  ([a-z_]+\.[a-z_]+)", limpid("run", "--help").out, re.M):
            self.assertIn(f"<code>{key}</code>", self.text)
        keys = {key for each in re.findall(r"<kbd>(.*?)</kbd>", self.text) for key in each.split(", ")}
        self.assertLessEqual({"Esc", "Ctrl+E", "F5", "F6", "Space"}, keys)

    def test_it_is_opened_by_the_desktop(self) -> None:
        tools = self.out("")
        tools.mkdir()
        opened = tools / "opened"
        program = tools / "xdg-open"
        program.write_text(f'#!/bin/sh\necho "$1" > {opened}.new\nmv {opened}.new {opened}\n')
        program.chmod(program.stat().st_mode | stat.S_IXUSR)
        subprocess.run([LIMPID, "manual"], check=True, env={**os.environ, "PATH": f"{tools}:{os.environ['PATH']}"})
        for _ in range(200):
            if opened.exists():
                break
            subprocess.run(["sleep", "0.05"], check=True)
        self.assertEqual(opened.read_text().strip(), str(self.file))


if __name__ == "__main__":
    unittest.main()
