"""The manual as one page, and the command that opens it."""

from __future__ import annotations

import base64
import os
import re
import stat
import subprocess
import unittest
from html.parser import HTMLParser
from pathlib import Path

from support import LIMPID, ROOT, SystemTest, limpid

KINDS = {".gif": "image/gif", ".png": "image/png", ".svg": "image/svg+xml"}


class Page(HTMLParser):
    """Ids, links and pictures of a page, and whether each element is closed."""

    ALONE = {"meta", "br", "hr", "img", "input", "col"}

    def __init__(self, text: str) -> None:
        super().__init__()
        self.ids: list[str] = []
        self.links: list[str] = []
        self.pictures: list[tuple[str, str]] = []  # address, words
        self.open: list[str] = []
        self.wrong: list[str] = []
        self.feed(text)

    def handle_starttag(self, tag: str, attributes: list) -> None:
        found = dict(attributes)
        if "id" in found:
            self.ids.append(found["id"])
        if tag == "a" and "href" in found:
            self.links.append(found["href"])
        if tag == "img":
            self.pictures.append((found["src"], found["alt"]))
        if tag not in self.ALONE:
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        if not self.open or self.open.pop() != tag:
            self.wrong.append(f"</{tag}> at {self.getpos()}")


class Manual(SystemTest):
    @classmethod
    def setUpClass(cls) -> None:
        super().setUpClass()
        cls.file = Path(limpid("manual", "--path").out.strip())
        cls.text = cls.file.read_text()
        cls.page = Page(cls.text)

    def chapters(self) -> list[Path]:
        """READMEs that the page has, in its order."""
        rooms = ("app", "assets", "core", "devices", "render")
        found = [ROOT / "README.md", *(file for room in rooms for file in (ROOT / room).rglob("*.md"))]
        by_id = {str(file.relative_to(ROOT)).replace("/", "-"): file for file in found}
        return [by_id[each] for each in self.page.ids if each in by_id]

    def test_its_links_lead_somewhere(self) -> None:
        within = [link[1:] for link in self.page.links if link.startswith("#")]
        self.assertGreater(len(within), 40)
        self.assertEqual([link for link in within if link not in self.page.ids], [])
        others = [link for link in self.page.links if not link.startswith(("#", "http"))]
        self.assertEqual(others, [])

    def test_it_has_every_page_that_the_first_one_links(self) -> None:
        for link in re.findall(r"\]\(([^)#]*\.md)", (ROOT / "README.md").read_text()):
            if link not in ("CHANGELOG.md", "CONTRIBUTING.md"):  # for those who work on Limpid
                self.assertIn(ROOT / link, self.chapters())

    def test_it_has_the_pictures_of_its_chapters(self) -> None:
        shown = [(chapter.parent / file, words) for chapter in self.chapters()
                 for words, file in re.findall(r"!\[([^]]*)\]\(([^)]*)\)", chapter.read_text())]  # fmt: skip
        self.assertGreater(len(shown), 20)
        self.assertEqual([words for _, words in self.page.pictures], [words for _, words in shown])
        for (address, words), (file, _) in zip(self.page.pictures, shown):
            with self.subTest(file):
                self.assertTrue(words.strip())
                kind, data = address.split(";base64,")
                self.assertEqual(kind, f"data:{KINDS[file.suffix]}")
                self.assertTrue(base64.b64decode(data, validate=True) == file.read_bytes(), "other bytes")
        self.assertRegex(self.text, r"\nimg \{ max-width: 100%;")
        self.assertLess(len(self.text.encode()), 6 << 20, "too much to open at once: leave a picture out")

    def test_it_is_the_same_from_the_same_sources(self) -> None:
        made = self.out("")
        self.assertEqual(limpid("share", made).status, 0)
        self.assertTrue((made / "manual.html").read_text() == self.text, "the page is another one")

    def test_it_is_well_formed(self) -> None:
        self.assertEqual((self.page.wrong, self.page.open), ([], []))
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
