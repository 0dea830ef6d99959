#!/usr/bin/python3
"""The tree keeps its rules: arrows one way, small files, short functions, headers, comments."""

from __future__ import annotations

import tempfile
import unittest
from pathlib import Path

import house

ROOT = Path(__file__).resolve().parents[2]
TABLE = Path(__file__).with_name("arrows.txt")


class TheHouse(unittest.TestCase):
    def assert_kept(self, broken: list[str]) -> None:
        if broken:
            self.fail("\n" + "\n".join(broken))

    def test_includes_follow_the_table(self) -> None:
        allowed = house.read_arrows(TABLE.read_text())
        found = house.found_arrows(ROOT)
        self.assert_kept(house.forbidden_arrows(found, allowed))
        self.assert_kept(house.unused_arrows(found, allowed))
        self.assert_kept(house.includes_of_nothing(ROOT))

    def test_no_folders_include_each_other(self) -> None:
        self.assert_kept(house.circles(house.found_arrows(ROOT)))

    def test_files_are_small(self) -> None:
        self.assert_kept(house.long_files(ROOT))

    def test_functions_are_short(self) -> None:
        self.assert_kept(house.long_functions(ROOT))

    def test_headers_are_guarded(self) -> None:
        self.assert_kept(house.headers_without_guard(ROOT))

    def test_files_have_titles_and_comments_have_subjects(self) -> None:
        self.assert_kept(house.careless_comments(ROOT))

    def test_rows_come_from_functions_that_are_the_same_everywhere(self) -> None:
        self.assert_kept(house.inexact_functions(ROOT))

    def test_programs_start_by_their_name(self) -> None:
        self.assert_kept(house.programs_that_do_not_start(ROOT))

    def test_pages_name_files_that_are_there(self) -> None:
        for page in house.pages(ROOT):
            self.assert_kept(house.named_files_that_are_missing(ROOT, page))

    def test_the_first_page_is_short(self) -> None:
        self.assertLessEqual(len((ROOT / "README.md").read_text().splitlines()), 130)


class ARuleIsSeenBroken(unittest.TestCase):
    """On a tree of two folders, app on core, with one fault each."""

    def setUp(self) -> None:
        place = tempfile.TemporaryDirectory()
        self.addCleanup(place.cleanup)
        self.root = Path(place.name)
        self.write("core/tick.h", "// The tick.\n#pragma once\n")
        self.write("app/run.cpp", '#include "core/tick.h"\n')
        self.allowed = house.read_arrows("core:\napp: core  # the loop\n")

    def write(self, name: str, text: str) -> None:
        path = self.root / name
        path.parent.mkdir(exist_ok=True)
        path.write_text(text)

    def broken(self) -> list[str]:
        found = house.found_arrows(self.root)
        return [
            *house.forbidden_arrows(found, self.allowed),
            *house.unused_arrows(found, self.allowed),
            *house.includes_of_nothing(self.root),
            *house.circles(found),
            *house.long_files(self.root),
            *house.long_functions(self.root),
            *house.headers_without_guard(self.root),
            *house.careless_comments(self.root),
            *house.inexact_functions(self.root),
        ]

    def assert_broken_once(self, words: str) -> None:
        broken = self.broken()
        self.assertEqual(len(broken), 1, broken)
        self.assertIn(words, broken[0])

    def test_none_is_when_all_are_kept(self) -> None:
        self.assertEqual(self.broken(), [])

    def test_the_table_that_is_printed_reads_as_what_was_found(self) -> None:
        found = house.found_arrows(self.root)
        self.assertEqual(house.table(found), "core:\napp: core\n")
        self.assertEqual(house.read_arrows(house.table(found)), found)

    def test_an_arrow_that_is_not_in_the_table(self) -> None:
        self.write("render/view.cpp", "")
        self.write("app/picture.cpp", '#include "core/tick.h"\n  #  include "render/view.cpp"\n')
        self.allowed["render"] = set()
        self.assert_broken_once("app -> render")

    def test_a_folder_that_is_not_in_the_table(self) -> None:
        self.write("render/view.cpp", "")
        self.assert_broken_once("render")

    def test_an_arrow_that_nobody_uses(self) -> None:
        self.write("app/run.cpp", '#include <vector>\n// core/tick.h\n#include "app/run.cpp"\n')
        self.assert_broken_once("app -> core")

    def test_a_circle(self) -> None:
        self.write("core/loop.cpp", '#include "app/run.cpp"\n')
        self.allowed["core"] = {"app"}
        self.assertEqual(len(self.broken()), 2)

    def test_an_include_that_hides_its_folder(self) -> None:
        self.write("app/run.cpp", '#include "core/tick.h"\n#include "app/../core/none.h"\n')
        self.allowed["app"] = {"core", "app/../core"}
        self.assert_broken_once("app/../core/none.h")

    def test_a_file_of_801_lines(self) -> None:
        self.write("core/long.cpp", 800 * "int x;\n")
        self.assertEqual(self.broken(), [])
        self.write("core/long.cpp", 801 * "int x;\n")
        self.assert_broken_once("801")

    def test_a_page_that_names_what_is_gone(self) -> None:
        self.write("page.md", "`core/tick.h`, `core/NAME.h`, `core/gone.h --fast`, `NAME.h5`")
        broken = house.named_files_that_are_missing(self.root, "page.md")
        self.assertEqual(broken, ["page.md: core/gone.h is no file of the tree"])

    def test_a_page_that_names_an_empty_folder(self) -> None:
        (self.root / "core/gone").mkdir()
        self.write("page.md", "`core/gone` and `core/`")
        broken = house.named_files_that_are_missing(self.root, "page.md")
        self.assertEqual(broken, ["page.md: core/gone is no file of the tree"])

    def test_a_program_that_may_not_be_executed(self) -> None:
        self.write("core/make.py", "#!/usr/bin/env python3\n")
        self.write("core/words.py", "WORDS = ()\n")
        broken = house.programs_that_do_not_start(self.root)
        self.assertEqual(len(broken), 1, broken)
        self.assertIn("core/make.py", broken[0])
        (self.root / "core/make.py").chmod(0o755)
        self.assertEqual(house.programs_that_do_not_start(self.root), [])

    def test_a_header_without_guard(self) -> None:
        self.write("core/none.h", "// #pragma twice\n")
        self.assert_broken_once("core/none.h")

    def test_a_header_without_title(self) -> None:
        self.write("core/none.h", "#pragma once\n// The tick.\nint x;\n")
        self.assert_broken_once("core/none.h:1: the header has no title")
        self.write("core/none.h", "// The tick.\n\n#pragma once\nint x;\n")
        self.assertEqual(self.broken(), [])

    def test_a_comment_that_no_code_follows(self) -> None:
        for blank in ("\n  \nint y;\n", "\n", ""):
            self.write("core/f.cpp", f"// The title.\n\nint x;\n\n  // A scar\n  // of two.{blank}")
            self.assert_broken_once("core/f.cpp:5: no code follows the comment")
        for kept in (
            "int x;\n// The number.\nint y;\n",
            "int x;  // of lines,\n        // and no more\n\nint y;\n",
            'auto s = R"(\n// In a text.\n\n)";\n',
        ):
            self.write("core/f.cpp", kept)
            self.assertEqual(self.broken(), [])

    def test_a_second_namespace_of_a_kind(self) -> None:
        for opening in ("namespace {", "namespace limpid {"):
            block = f"{opening}\nint x;\n}}\n"
            self.write("core/f.cpp", 2 * block)
            self.assert_broken_once(f"core/f.cpp:4: a second `{opening}`")
        other = "namespace limpid::a {\n}\n"
        self.write("core/f.cpp", "namespace limpid {\nnamespace {\n}\n}\n" + 2 * other)
        self.assertEqual(self.broken(), [])

    def test_a_comment_without_a_subject(self) -> None:
        for words in ("// What it is.\nint x;", "int x;\n  // As, there.\nint y;"):
            self.write("core/f.cpp", words)
            self.assert_broken_once("the comment begins with")
        self.write("core/f.cpp", "int x;\nint y;  // Of x.\n")
        self.assert_broken_once('core/f.cpp:2: the comment begins with "Of"')
        for kept in (
            "// Says\n// What it is.\n",
            "int x;  // Says\n        // What.\n",
            "// One-way.\n",
        ):
            self.write("core/f.cpp", kept + "int y;\n")
            self.assertEqual(self.broken(), [])

    def test_functions_of_81_lines(self) -> None:
        heads = (
            "void f() {{\n{}}}\n",
            "namespace a {{\nclass A {{\n  A(int b,\n    int c)\n      : b_(b) {{\n{}  }}\n}};\n}}\n",
            "struct A {{\n  auto f() const -> int {{\n{}  }}\n}};\n",
            "template <class T>\nvoid f(T) noexcept {{\n{}}}\n",
            "const auto f = [](int i) {{\n{}}};\n",
        )
        for head in heads:
            of_header = head.partition("{}")[0].split("{{\n")[-2].count("\n") + 1
            with self.subTest(head):
                body = (79 - of_header) * "    x();\n"
                self.write("core/f.cpp", head.format(body))
                self.assertEqual(self.broken(), [])
                self.write("core/f.cpp", head.format(body + "    x();\n"))
                self.assert_broken_once("81 lines")

    def test_a_brace_in_a_raw_string_ends_no_function(self) -> None:
        rows = 80 * "    x();\n"
        self.write("core/f.cpp", f'void f() {{\n  x(R"(\n}}\n)");\n{rows}}}\n')
        self.assert_broken_once("85 lines")

    def test_tables_and_classes_are_no_functions(self) -> None:
        rows = 100 * "    f(1),\n"
        self.write("core/table.cpp", f"const T kTable = make({{\n{rows}}});\n")
        members = 100 * "  int f();\n"
        self.write("core/class.cpp", f"class A final {{\n{members}}};\n")
        self.assertEqual(self.broken(), [])

    def test_a_function_of_the_library_where_rows_come_from(self) -> None:
        self.allowed["core/tick"] = set()
        for call in ("std::exp(x)", "each(d, std::sin)", "v.array().log()", "AngleAxisd(x, a)"):
            self.write("core/tick/tick.cpp", f"double f(double x) {{ return {call}; }}\n")
            self.assert_broken_once("core/tick/tick.cpp:1: ")
        self.write("core/tick/tick.cpp", "double f(double x) { return std::sqrt(x); }  // no exp()\n")
        self.assertEqual(self.broken(), [])


if __name__ == "__main__":
    unittest.main()
