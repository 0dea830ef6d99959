"""What can be planted, where, and that the rest of the file stays as it was."""

import argparse
import json
import shutil
import tempfile
import unittest
from pathlib import Path

import mutants
import operators
import source

FILE = """// A comment with a + b.
#include <cmath>
#define TWICE(x) ((x) + (x))
namespace limpid {
namespace {
constexpr double kPi = 3.0 + 0.14;
enum class Kind { one = 1, two = 2 };
}  // namespace

struct Point {
  double x = 0;
  double sum(double other) const { return x + other; }
};

Reader::Reader(int a, int b) : a_(a + 1), b_{b - 1} { check(a, b); }

constexpr int fixed(int a) { return a + 1; }

double angle(const std::vector<double>& all, std::size_t i) {
  const double first = all[i] - 1.5;
  const std::array<double, 3> three{1, 2, 3};
  auto each = [&](double x) {
    return x < first ? -x : x;
  };
  if (i == 0 && !all.empty()) throw std::invalid_argument("i + 1");
  for (std::size_t k = 0; k < all.size(); ++k) {
    total += std::min(all[k],
                      first);  // not a - b
  }
  switch (i) {
    case 1: stop(); break;
    default: break;
  }
  return R"(a + b)" == text ? 'a' : f(first, three);
}
}  // namespace limpid
"""


def places(text=FILE):
    read = source.Source(text)
    return {read.code(p.start, p.end): p for p in read.places}


def whats(code, text=FILE):
    read = source.Source(text)
    place = places(text)[code]
    return [change.what for change in operators.changes_of(read, place)]


class Places(unittest.TestCase):
    def test_are_statements_and_conditions_in_the_bodies_of_functions(self) -> None:
        self.assertEqual(list(places()), [
            "return x + other;", "check(a, b);", "all[i] - 1.5", "return x < first ? -x : x;",
            "i == 0 && !all.empty()", "k < all.size()", "total += std::min(all[k], first);", "stop();",
            """return R"(a + b)" == text ? 'a' : f(first, three);""",
        ])  # fmt: skip

    def test_know_the_type_that_a_value_is_to_have(self) -> None:
        self.assertEqual(places()["all[i] - 1.5"].type, "double")
        self.assertEqual(places("void f() { auto x = a + b; }")["a + b"].type, "")
        self.assertEqual(places("void f() { const Vec3 x = a + b; }")["a + b"].type, "Vec3")

    def test_tell_a_product_that_is_added_from_a_pointer_that_is_declared(self) -> None:
        self.assertEqual(places("void f() { sum += a * b; }")["sum += a * b;"].kind, "expression")
        self.assertEqual(list(places("void f() { int* p; }")), [])

    def test_do_not_trip_over_brackets_that_do_not_match(self) -> None:
        with self.assertRaisesRegex(ValueError, "line 2"):
            source.Source("void f() {\n g(]); }")

    def test_are_found_in_every_source_of_the_tree(self) -> None:
        for room in ("core", "devices", "app", "render"):
            for file in sorted((mutants.TREE / room).rglob("*.cpp")):
                read = source.Source(file.read_text())
                with self.subTest(file):
                    ends = [p.end for p in sorted(read.places, key=lambda p: p.start)]
                    starts = [p.start for p in sorted(read.places, key=lambda p: p.start)]
                    self.assertTrue(all(e <= s for e, s in zip(ends, starts[1:])), "places do not overlap")


class Changes(unittest.TestCase):
    def test_are_of_signs_comparisons_indices_and_numbers(self) -> None:
        self.assertEqual(whats("all[i] - 1.5"), ["the next index", "- to +", "1.5 to (2 * 1.5)"])
        self.assertEqual(whats("return x < first ? -x : x;"), ["< to <=", "< to >", "the sign dropped"])
        self.assertEqual(
            whats("i == 0 && !all.empty()"),
            ["== to !=", "0 to 1", "&& to ||", "the negation dropped", "the condition negated"],
        )

    def test_are_of_calls(self) -> None:
        self.assertEqual(whats("check(a, b);"), ["arguments of check() swapped", "the statement dropped"])
        self.assertEqual(
            whats("total += std::min(all[k], first);"),
            ["+= to -=", "min to max", "arguments of min() swapped", "the next index", "the statement dropped"],
        )

    def test_leave_words_for_people_and_arguments_of_templates_alone(self) -> None:
        text = 'void f() { say(fmt::format("{}", a + 1)); g(v.head<2>()); }'
        self.assertEqual(whats('say(fmt::format("{}", a + 1));', text), ["the statement dropped"])
        self.assertEqual(whats("g(v.head<2>());", text), ["the statement dropped"])

    def test_say_what_the_whole_statement_is_then(self) -> None:
        read = source.Source("void f() { const bool b = min(a, 2) <= c; }")
        texts = {c.what: c.text for c in operators.changes_of(read, read.places[0])}
        self.assertEqual(texts["<= to <"].replace(" ", ""), "min(a,2)<c")
        self.assertEqual(texts["arguments of min() swapped"].replace(" ", ""), "min(2,a)<=c")
        self.assertEqual(texts["min to max"].replace(" ", ""), "max(a,2)<=c")


class Planted(unittest.TestCase):
    def planted(self, text):
        read = source.Source(text)
        found = []
        for place in read.places:
            for change in operators.changes_of(read, place):
                found.append(mutants.Mutant("f.cpp", 1, change.what, change.text, place, len(found) + 1))
        return source.planted(read, found, "f.cpp").split('#line 1 "f.cpp"\n')[1]

    def test_leaves_every_line_where_it_was(self) -> None:
        before, after = FILE.splitlines(), self.planted(FILE).splitlines()
        self.assertEqual(len(before), len(after))
        for number in (0, 5, 6, 15, 17, 20, 28, 32):
            self.assertEqual(before[number], after[number])

    def test_chooses_among_values_of_one_type(self) -> None:
        self.assertEqual(
            self.planted("void f() { const Vec3 x = -a; }"),
            "void f() { const Vec3 x = (limpid_mutant(1) ? static_cast<Vec3>(a) : static_cast<Vec3>(-a)); }",
        )

    def test_keeps_the_else_of_an_if(self) -> None:
        self.assertEqual(
            self.planted("void f() { if (b) g(); else h(); }"),
            "void f() { if ((limpid_mutant(1) ? static_cast<bool>(!(b)) : static_cast<bool>(b))) "
            "{ if (limpid_mutant(2)) { ; } else { g(); } } else { if (limpid_mutant(3)) { ; } else { h(); } } }",
        )


class Drawing(unittest.TestCase):
    def lines(self, count):
        return [[mutants.Mutant("core/a.cpp", line, what, what) for what in "xy"] for line in range(count)]

    def test_takes_one_of_each_line_before_it_takes_two(self) -> None:
        chosen = mutants.drawn({"core": self.lines(10)}, 10, 5)
        self.assertEqual([m.line for m in chosen], list(range(10)))
        self.assertEqual(len(mutants.drawn({"core": self.lines(10)}, 0, 5)), 20)

    def test_is_the_same_for_one_seed(self) -> None:
        one, two, other = ([(m.line, m.what) for m in mutants.drawn({"core": self.lines(50)}, 9, seed)] for seed in (1, 1, 2))
        self.assertEqual(one, two)
        self.assertNotEqual(one, other)


class Blame(unittest.TestCase):
    def mutant(self, number, first, last):
        return mutants.Mutant("core/a.cpp", first, "", "", None, number, first, last)

    def test_is_of_the_lines_that_the_compiler_names(self) -> None:
        one, two = self.mutant(1, 5, 5), self.mutant(2, 9, 11)
        log = f"{mutants.TREE}/core/a.cpp:10:3: error: no match for 'operator-'\n"
        self.assertEqual(mutants.not_compiling(log, [one, two]), [two])

    def test_is_of_the_line_that_asked_for_a_template(self) -> None:
        one, two = self.mutant(1, 5, 5), self.mutant(2, 9, 11)
        log = (f"{mutants.TREE}/core/a.cpp:5:9:   required from here\n"
               "/usr/include/eigen3/Eigen/Core:10:3: error: static assertion failed\n")  # fmt: skip
        self.assertEqual(mutants.not_compiling(log, [one, two]), [one])

    def test_is_of_the_whole_file_where_nobody_knows_better(self) -> None:
        one = self.mutant(1, 5, 5)
        log = f"{mutants.TREE}/core/a.cpp:99:3: error: expected '}}'\n"
        self.assertEqual(mutants.not_compiling(log, [one]), [one])


class Results(unittest.TestCase):
    def test_of_a_listing_are_the_names_of_tests(self) -> None:
        listing = "Running main()\nTick.\n  Runs\n  Stops\nArms/Joints.\n  Turn/0  # GetParam() = 1\n"
        self.assertEqual(mutants.names_of_tests(listing), ["Tick.Runs", "Tick.Stops", "Arms/Joints.Turn/0"])

    def test_count_what_no_test_reaches_as_missed_and_what_does_not_compile_not_at_all(self) -> None:
        tried = [mutants.Mutant("core/a.cpp", 1, "", "", result=result)
                 for result in ("noticed", "noticed", "unnoticed", "unreached", "no mutant", "")]  # fmt: skip
        self.assertIn("core: 2 of 4 noticed (50 %)", mutants.summary(tried))
        self.assertIn("1 do not compile, 1 were not tried", mutants.summary(tried))

    def test_of_system_tests_are_counted_by_themselves(self) -> None:
        tried = [mutants.Mutant("app/a.cpp", 1, "", "", result=result) for result in ("noticed", "unnoticed", "unreached")]
        self.assertNotIn("system", mutants.summary(tried))
        tried[2].system = "test_cli"
        self.assertIn("app: 1 of 3 noticed (33 %)", mutants.summary(tried))
        self.assertIn("app, with system tests: 2 of 3 noticed (67 %)", mutants.summary(tried))

    def test_of_system_tests_come_from_those_that_reach_the_line_and_pass_without_an_error(self) -> None:
        class Asked(mutants.SystemTest):
            @property
            def command(self):
                return ["sh", "-c", SYSTEM_TESTS[self.name]]

        tried = [mutants.Mutant("app/a.cpp", 1, "", "", number=n, result=result)
                 for n, result in ((1, "noticed"), (2, "unnoticed"), (3, "unreached"), (4, "unreached"))]  # fmt: skip
        before, mutants.say = mutants.say, lambda text: None
        self.addCleanup(setattr, mutants, "say", before)
        mutants.ask_system_tests(tried, [Asked(Path("limpid"), name) for name in SYSTEM_TESTS])
        self.assertEqual([m.system for m in tried], ["", "", "second", ""])

    def test_of_a_command_that_hangs_come_in_time(self) -> None:
        status, out = mutants.in_time(["sh", "-c", "echo begun; sleep 60"], {}, 0.3)
        self.assertIsNone(status)
        self.assertEqual(out, "begun\n")

    def test_of_a_command_are_its_status_and_what_it_says(self) -> None:
        status, out = mutants.in_time(["sh", "-c", "echo $LIMPID_MUTANT; exit 3"], {"LIMPID_MUTANT": "7"}, 10)
        self.assertEqual((status, out), (3, "7\n"))


# Each notes the lines that it reaches, and fails with some errors.
REACHES = "printf {} | dd of=$LIMPID_MUTANT_REACHED bs=1 seek={} conv=notrunc 2>/dev/null; "
SYSTEM_TESTS = {
    "first": REACHES.format("11", 2) + "true",
    "broken": REACHES.format("111", 2) + "false",
    "second": REACHES.format("1", 3) + "test $LIMPID_MUTANT -ne 3 -a $LIMPID_MUTANT -ne 4",
}
PROGRAM = """#include "core/sum.h"
#include <cstdio>
#include <cstring>
int main(int count, char** words) {
  const char* filter = "";
  for (int i = 1; i < count; ++i) {
    if (std::strcmp(words[i], "--gtest_list_tests") == 0) return std::puts("Sum.\\n  OfTwo\\n  OfNone\\n  Fails"), 0;
    if (std::strncmp(words[i], "--gtest_filter=", 15) == 0) filter = words[i] + 15;
  }
  bool good = true;
  if (std::strstr(filter, "OfTwo")) good = good && sum(2) == 3;
  if (std::strstr(filter, "OfNone")) good = good && sum(0) == 0;
  if (std::strstr(filter, "Fails")) good = false;
  if (!good) std::puts("[  FAILED  ] Sum.OfTwo (0 ms)");
  return good ? 0 : 1;
}
"""
SUM = """int sum(int n) {
  int all = 0;
  for (int i = 1; i <= n; ++i) {
    all += i;
  }
  return all;
}
int nobody_asks(int n) { return n - 1; }
const char* word(int n) {
  return n == 0 ? "no" : "some";
}
const char* swapped(const char* a, int n) { return first(a, n); }
"""
NINJA = """rule cc
  command = c++ -std=c++20 -I. -c $in -o $out
rule link
  command = c++ $in -o $out
build core/sum.o: cc TREE/core/sum.cpp | TREE/core/sum.h
build tests/main.o: cc TREE/tests/main.cpp
build tests/sum_tests: link core/sum.o tests/main.o
"""


@unittest.skipUnless(shutil.which("ninja") and shutil.which("c++"), "needs ninja and a compiler")
class AWholeCall(unittest.TestCase):
    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.tree = Path(folder.name) / "tree"
        self.build = Path(folder.name) / "build"
        for path in (self.tree / "core", self.tree / "tests", self.build):
            path.mkdir(parents=True)
        header = "int sum(int n);\nconst char* first(const char* a, int n);\n"
        (self.tree / "core/sum.h").write_text("#pragma once\n" + header)
        self.file = self.tree / "core/sum.cpp"
        self.text = '#include "sum.h"\nconst char* first(const char* a, int) { return a; }\n' + SUM
        self.file.write_text(self.text)
        (self.tree / "tests/main.cpp").write_text(PROGRAM)
        (self.build / "build.ninja").write_text(NINJA.replace("TREE", str(self.tree)).replace("-I.", f"-I{self.tree}"))
        commands = [{"file": str(self.file), "command": "", "output": "core/sum.o"}]
        (self.build / "compile_commands.json").write_text(json.dumps(commands))
        before = mutants.TREE, mutants.say
        mutants.TREE, mutants.say = self.tree, lambda text: None
        self.addCleanup(lambda: (setattr(mutants, "TREE", before[0]), setattr(mutants, "say", before[1])))
        self.options = argparse.Namespace(
            build=self.build, jobs=2, programs="", system="", budget=10, seed=1, count=0, change=None,
            paths=["core"], report=None, resume=False,
        )  # fmt: skip

    def test_says_what_was_noticed_what_was_not_and_what_nobody_reaches(self) -> None:
        found = mutants.choose(self.options)
        report = self.build / "mutants.json"
        mutants.carry_out(self.options, found, report)
        self.assertEqual(self.file.read_text(), self.text, "the source is put back")
        result = {(m.line, m.what): m.result for m in found}
        self.assertEqual(result[4, "0 to 1"], "noticed")  # all = 0
        self.assertEqual(result[5, "<= to <"], "noticed")
        self.assertEqual(result[5, "the condition negated"], "noticed")
        self.assertEqual(result[6, "+= to -="], "noticed")
        self.assertEqual(result[10, "- to +"], "unreached")
        self.assertEqual(result[14, "arguments of first() swapped"], "no mutant")
        self.assertEqual(json.loads(report.read_text())["mutants"][0]["file"], "core/sum.cpp")
        again = mutants.choose(self.options)
        mutants.take_results(again, report)
        self.assertEqual([m.result for m in again], [m.result for m in found])

    def test_is_worth_nothing_where_the_tree_does_not_build(self) -> None:
        self.file.write_text(self.text + "error;\n")
        with self.assertRaises(SystemExit):
            mutants.carry_out(self.options, mutants.choose(self.options), self.build / "mutants.json")
        self.assertEqual(self.file.read_text(), self.text + "error;\n")


class PutBack(unittest.TestCase):
    def test_is_what_was_there_whatever_happens(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            tree, mutants.TREE = mutants.TREE, Path(folder)
            self.addCleanup(setattr, mutants, "TREE", tree)
            file = Path(folder) / "a.cpp"
            file.write_text(FILE)
            one = next(iter(mutants.mutants_of("a.cpp").values()))[0]
            one.number = 1
            with self.assertRaises(KeyboardInterrupt), mutants.Planted() as planted:
                planted.plant([one])
                self.assertIn("limpid_mutant(1)", file.read_text())
                raise KeyboardInterrupt
            self.assertEqual(file.read_text(), FILE)


if __name__ == "__main__":
    unittest.main()
