"""The rules of the tree, each as a function that lists what breaks it in words."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

ROOMS = ("core", "devices", "render", "app")
MOST_LINES = 800
MOST_FUNCTION_LINES = 80

Arrows = dict[str, set[str]]  # folder: the folders that it includes from

_INCLUDE = re.compile(r'^\s*#\s*include\s*"([^"]+)"', re.M)
_RAW_STRING = re.compile(r'R"(\w*)\(.*?\)\1"', re.S)
# What the system's mathematical library reckons otherwise on another processor.
_INEXACT = re.compile(r"std::(?:a?(?:sin|cos|tan)h?|atan2|exp2?|expm1|log(?:2|10|1p)?|pow|cbrt|hypot|polar)\b"
                  r"|\.(?:sin|cos|exp|log|pow|tanh)\(|AngleAxis")  # fmt: skip
# Where rows come from.
ROW_MAKERS = (
    "core/coupling", "core/dynamics", "core/math", "core/tick", "core/touch",
    "devices", "devices/simulated", "devices/files", "devices/files/scene", "app/run", "app/story",
)  # fmt: skip
# What they find is told to people only.
NO_ROW = ("core/coupling/felt.cpp", "core/coupling/walls.cpp", "core/dynamics/farthest_tip.cpp",
          "devices/files/rpy.cpp")

# First words that leave a comment without a subject of its own.
_NO_SUBJECT = set("What Where Who Of That It One As Those And But Which Its They Them".split())
_COMMENT = re.compile(r"(?<!\S)//+ *([^\s,.:;]*)")
_NAMESPACE = re.compile(r"^(namespace (?:limpid )?\{)", re.M)

_FUNCTION_END = re.compile(r"(\)|\}|\bconst|\bnoexcept|\boverride|\bfinal|\bmutable|-> [^()]*)$")


def sources(root: Path, rooms: tuple[str, ...] = ROOMS) -> list[Path]:
    found = [path for room in rooms for path in (root / room).rglob("*")]
    return sorted(path for path in found if path.suffix in (".h", ".cpp"))


def read_arrows(text: str) -> Arrows:
    arrows: Arrows = {}
    for line in text.splitlines():
        line = line.partition("#")[0].strip()
        if line:
            folder, _, seen = line.partition(":")
            arrows[folder] = set(seen.split())
    return arrows


def found_arrows(root: Path) -> Arrows:
    """What the files of each folder include of other folders."""
    arrows: Arrows = {}
    for path in sources(root):
        folder = str(path.parent.relative_to(root))
        seen = {str(Path(name).parent) for name in _INCLUDE.findall(path.read_text())}
        arrows.setdefault(folder, set()).update(seen - {folder})
    return arrows


def includes_of_nothing(root: Path) -> list[str]:
    """Includes are written from the root of the tree, so that their folder can be read."""
    return [
        f'{path.relative_to(root)}: "{name}" is no file of the tree'
        for path in sources(root)
        for name in _INCLUDE.findall(path.read_text())
        if not (root / name).is_file()
    ]


def forbidden_arrows(found: Arrows, allowed: Arrows) -> list[str]:
    return _missing(found, allowed, "is included, and arrows.txt does not allow it")


def unused_arrows(found: Arrows, allowed: Arrows) -> list[str]:
    return _missing(allowed, found, "is allowed by arrows.txt, and nobody includes it")


def _missing(these: Arrows, those: Arrows, what: str) -> list[str]:
    broken = [f"{folder}: the folder {what}" for folder in sorted(these.keys() - those.keys())]
    for folder in sorted(these.keys() & those.keys()):
        broken += [f"{folder} -> {seen} {what}" for seen in sorted(these[folder] - those[folder])]
    return broken


def circles(arrows: Arrows) -> list[str]:
    return [
        f"{folder} includes itself by way of others"
        for folder in sorted(arrows)
        if folder in _within_reach(arrows, folder)
    ]


def _within_reach(arrows: Arrows, start: str) -> set[str]:
    reached: set[str] = set()
    ahead = set(arrows[start])
    while ahead:
        folder = ahead.pop()
        reached.add(folder)
        ahead |= arrows.get(folder, set()) - reached
    return reached


def long_files(root: Path) -> list[str]:
    lengths = ((path, len(path.read_text().splitlines())) for path in sources(root))
    return [
        f"{path.relative_to(root)}: {lines} lines, allowed are {MOST_LINES}"
        for path, lines in lengths
        if lines > MOST_LINES
    ]


def long_functions(root: Path) -> list[str]:
    return [
        f"{path.relative_to(root)}:{line}: a function of {lines} lines, "
        f"allowed are {MOST_FUNCTION_LINES}"
        for path in sources(root)
        for line, lines in functions(path.read_text())
        if lines > MOST_FUNCTION_LINES
    ]


def functions(text: str) -> Iterator[tuple[int, int]]:
    """First line (from 1) and number of lines of each function, in code as clang-format leaves it:
    a body's last line starts with a brace, as far in as the line that opens it or its first line.
    """
    lines = [line.partition("//")[0].rstrip() for line in _without_raw_strings(text).splitlines()]
    at = 0
    while at < len(lines):
        first = _header_start(lines, at)
        header = " ".join(line.strip() for line in lines[first : at + 1])
        indent = len(lines[first]) - len(lines[first].lstrip())
        if indent > 4 or not _opens_function(header):
            at += 1
            continue
        end = " " * indent + "}"
        last = next((i for i in range(at + 1, len(lines)) if lines[i].startswith(end)), at)
        yield first + 1, last - first + 1
        at = last + 1


def _without_raw_strings(text: str) -> str:
    return _RAW_STRING.sub(lambda match: "\n" * match[0].count("\n"), text)


def _header_start(lines: list[str], at: int) -> int:
    while at > 0 and lines[at - 1] and lines[at - 1][-1] not in ";{}:" and lines[at - 1][0] != "#":
        at -= 1
    return at


def _opens_function(header: str) -> bool:
    before = header.removesuffix("{").rstrip()
    if before == header or "(" not in before:
        return False
    return bool(_FUNCTION_END.search(before))


def headers_without_guard(root: Path) -> list[str]:
    return [
        f"{path.relative_to(root)}: no #pragma once"
        for path in sources(root)
        if path.suffix == ".h" and "#pragma once\n" not in path.read_text()
    ]


def careless_comments(root: Path) -> list[str]:
    """Titles, comments and namespaces of all sources, those of tests as well."""
    return [
        f"{path.relative_to(root)}:{number}: {what}"
        for path in sources(root, (*ROOMS, "tests"))
        for number, what in _careless(path.read_text(), is_header=path.suffix == ".h")
    ]


def _careless(text: str, *, is_header: bool) -> Iterator[tuple[int, str]]:
    """Lines (from 1), and what to do there."""
    text = _without_raw_strings(text)
    if is_header and not text.startswith("// "):
        yield 1, "the header has no title: begin it with a comment, its subject in a few words"
    opened: set[str] = set()
    for found in _NAMESPACE.finditer(text):
        if found[1] in opened:
            number = text.count("\n", 0, found.start()) + 1
            yield number, f"a second `{found[1]}`: join it with the file's first"
        opened.add(found[1])
    lines = text.splitlines()
    for first, last, word in _comments(lines):
        below = lines[last + 1].strip() if last + 1 < len(lines) else ""
        if first > 0 and lines[first].lstrip().startswith("//") and not below:
            yield first + 1, "no code follows the comment: put it directly above what it is about"
        if word in _NO_SUBJECT:
            yield first + 1, f'the comment begins with "{word}": begin it with its subject'


def _comments(lines: list[str]) -> Iterator[tuple[int, int, str]]:
    """First and last line (from 0) of each comment, and its first word. A comment goes on as long
    as the lines below it begin with one in its column; it may have begun beside code."""
    at = 0
    while at < len(lines):
        first, found = at, _COMMENT.search(lines[at])
        at += 1
        if found:
            start = " " * found.start() + "//"
            while at < len(lines) and lines[at].startswith(start):
                at += 1
            yield first, at - 1, found[1]


def inexact_functions(root: Path) -> list[str]:
    """Rows come again bit for bit on every processor: core/math/elementary.h has what they need."""
    return [
        f"{path.relative_to(root)}:{number}: {found[0]} differs between processors; "
        "core/math/elementary.h has one that does not"
        for path in sources(root)
        if str(path.parent.relative_to(root)) in ROW_MAKERS
        and str(path.relative_to(root)) not in NO_ROW
        for number, line in enumerate(path.read_text().splitlines(), 1)
        if (found := _INEXACT.search(line.partition("//")[0]))
    ]


def programs_that_do_not_start(root: Path) -> list[str]:
    """A file that names its interpreter is a program: people start it by its name."""
    return [
        f"{path.relative_to(root)}: it starts with #!, and may not be executed (chmod +x)"
        for path in _scripts(root)
        if path.is_file() and _starts_as_program(path) and not path.stat().st_mode & 0o100
    ]


def _scripts(root: Path) -> Iterator[Path]:
    yield from root.glob("*")
    for folder in (*ROOMS, "assets", "tests", ".ci"):
        yield from sorted((root / folder).rglob("*"))


def _starts_as_program(path: Path) -> bool:
    with path.open("rb") as file:
        return file.read(2) == b"#!"


def pages(root: Path) -> list[str]:
    """Texts for people, those of rooms as well."""
    own = [page for room in (*ROOMS, "assets") for page in (root / room).rglob("README.md")]
    return ["README.md", "CONTRIBUTING.md", *(str(page.relative_to(root)) for page in own)]


def named_files_that_are_missing(root: Path, page: str) -> list[str]:
    """Of a page of text: what it quotes as a path of the tree; NAME stands for any name."""
    text = (root / page).read_text()
    named = re.findall(rf"`((?:{'|'.join(ROOMS)}|assets|tests|\.ci)/[^`\s]*)", text)
    return [
        f"{page}: {name} is no file of the tree"
        for name in named
        if "NAME" not in name and not any(map(_holds_a_file, root.glob(name)))
    ]


def _holds_a_file(path: Path) -> bool:
    """Git keeps no empty folders, so a tree that was just cloned has none."""
    return path.is_file() or any(inner.is_file() for inner in path.rglob("*"))


def table(arrows: Arrows) -> str:
    """As arrows.txt has it, room by room."""
    folders = sorted(arrows, key=lambda folder: (ROOMS.index(folder.split("/")[0]), folder))
    lines = (f"{folder}: {' '.join(sorted(arrows[folder]))}".rstrip() for folder in folders)
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    print(table(found_arrows(Path(__file__).resolve().parents[2])), end="")
