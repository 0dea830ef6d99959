#!/usr/bin/python3
"""Plants small errors in the sources and says which of them no test notices.

    cmake --build --preset release
    tests/mutants/mutants.py --seed 1 --count 40 core devices      # 40 errors in each of these folders
    tests/mutants/mutants.py --change HEAD~3                       # in what was changed since then

All errors are compiled into the test programs at once, and a variable of the environment chooses one. Each test is
first run by itself, which shows which errors it reaches; an error is then only shown to the tests that reach it, those
of its own folder first. A failure, a crash and a hang are all noticed. System tests can be asked about the rest; what
they notice is counted by itself. The sources are put back in any case; the tree has to be clean, so that
`git checkout .` helps if even that is killed.

What this cannot plant: errors in initialisers of members, in constants, in statements that contain a lambda (but it
does in the lambda's own), and in what only the preprocessor sees.
"""

import argparse
import concurrent.futures
import contextlib
import json
import os
import random
import re
import signal
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass, field
from pathlib import Path

import operators
import source

TREE = Path(__file__).resolve().parents[2]
ERROR = re.compile(r"^(/[^\s:]+):(\d+):(?:\d+:)? (?:fatal )?error:", re.M)
PLACED = re.compile(r"^(?:In file included from |\s+from )?(/[^\s:]+):(\d+)[:,]", re.M)


@dataclass
class Mutant:
    file: str
    line: int
    what: str
    text: str
    place: source.Place = None
    number: int = 0
    first_line: int = 0  # of the whole statement
    last_line: int = 0
    result: str = ""  # noticed, unnoticed, unreached, or "no mutant": it does not compile
    by: str = ""
    system: str = ""  # which system test noticed what the test programs did not
    left_out: int = 0  # tests that reach it and were not run for want of time
    shown: list = field(default_factory=list)  # the statement before and after

    @property
    def room(self):
        return self.file.split("/")[0]

    def report(self):
        keep = ("number", "file", "line", "what", "result", "by", "system", "left_out", "shown")
        return {key: getattr(self, key) for key in keep}


# Which errors.


def git(*words):
    run = subprocess.run(["git", "-C", str(TREE), *words], capture_output=True, text=True, check=True)
    return run.stdout


def changed_lines(revision):
    """{file: lines} of what is different since then."""
    found, file = {}, None
    for line in git("diff", "--unified=0", revision, "--", "*.cpp", "*.h").splitlines():
        if line.startswith("+++ "):
            file = line[6:] if line.startswith("+++ b/") else None
        elif hunk := re.match(r"@@ -\S+ \+(\d+)(?:,(\d+))? @@", line):
            first, count = int(hunk[1]), int(hunk[2] or 1)
            if file and not file.startswith("tests/"):
                found.setdefault(file, set()).update(range(first, first + count))
    return found


def files_of(paths):
    found = []
    for path in paths:
        whole = TREE / path
        found += [whole] if whole.is_file() else sorted(whole.rglob("*.cpp"))
    return [str(each.relative_to(TREE)) for each in found]


def mutants_of(file, lines=None):
    """All errors that can be planted in a file, by line."""
    text = source.Source((TREE / file).read_text())
    found = {}
    for place in text.places:
        before = text.code(place.start, place.end)
        for change in operators.changes_of(text, place):
            line = text.line(change.start)
            if lines is None or line in lines:
                mutant = Mutant(file, line, change.what, change.text, place, shown=[before, change.text])
                found.setdefault(line, []).append(mutant)
    return found


def drawn(by_room, count, seed):
    """`count` of each room, all on different lines as long as there are any."""
    chosen = []
    for room in sorted(by_room):
        chance = random.Random(f"{seed} {room}")
        lines = [sorted(each, key=lambda m: (m.what, m.text)) for each in by_room[room]]
        for each in lines:
            chance.shuffle(each)
        chance.shuffle(lines)
        in_turn = [m for turn in range(max(map(len, lines), default=0)) for each in lines for m in each[turn : turn + 1]]
        chosen += in_turn[:count] if count else in_turn
    return sorted(chosen, key=lambda m: (m.file, m.line, m.what, m.text))


# In the sources, and out again.


class Planted:
    """While it lasts the sources hold the mutants."""

    def __init__(self):
        self.before = {}

    def __enter__(self):
        signal.signal(signal.SIGTERM, lambda *_: sys.exit(1))
        return self

    def plant(self, mutants):
        for file in {m.file for m in mutants} | set(self.before):
            path = TREE / file
            text = self.before.setdefault(file, path.read_text())
            own = [m for m in mutants if m.file == file]
            new = source.planted(source.Source(text), own, path) if own else text
            if path.read_text() != new:
                path.write_text(new)

    def __exit__(self, *_):
        for file, text in self.before.items():
            (TREE / file).write_text(text)


def say(text):
    print(text, flush=True)


class Build:
    def __init__(self, folder, jobs):
        self.folder, self.jobs = folder, jobs

    def ninja(self, *words):
        return subprocess.run(["ninja", "-C", str(self.folder), *words], capture_output=True, text=True)

    def make(self, *targets):
        """What went wrong; empty if nothing did."""
        if not targets:
            return ""  # ninja would build all there is
        run = self.ninja(f"-j{self.jobs}", "-k0", *targets)
        return "" if run.returncode == 0 else run.stdout + run.stderr

    def objects(self):
        """{file: [object]} of all that is compiled."""
        found = {}
        for each in json.loads((self.folder / "compile_commands.json").read_text()):
            name = each.get("output") or re.search(r" -o (\S+)", each["command"])[1]
            found.setdefault(os.path.relpath(each["file"], TREE), []).append(name)
        return found

    def inputs(self, program):
        return set(self.ninja("-t", "inputs", program).stdout.split())

    def test_programs(self):
        names = self.ninja("-t", "targets", "all").stdout
        return sorted(set(re.findall(r"^(tests/\w+_tests): ", names, re.M)))


def not_compiling(log, mutants):
    """The mutants to blame for what the compiler says: those of its lines, else those of its files."""
    root = str(TREE) + "/"
    errors = {(file.removeprefix(root), int(line)) for file, line in ERROR.findall(log)}
    blamed = [m for m in mutants if any(covers(m, file, line) for file, line in errors)]
    if not blamed:
        named = {(file.removeprefix(root), int(line)) for file, line in PLACED.findall(log)}
        blamed = [m for m in mutants if any(covers(m, file, line) for file, line in named)]
    files = {file for file, _ in errors}
    return blamed or [m for m in mutants if m.file in files]


def covers(mutant, file, line):
    return mutant.file == file and mutant.first_line <= line <= mutant.last_line


def compile_all(build, planted, mutants):
    """Leaves out what does not compile, until the rest does."""
    objects = build.objects()
    sources = [m.file for m in mutants if m.file in objects]
    targets = sorted({name for file in sources for name in objects[file]})
    if log := build.make(*targets):
        sys.exit("The tree does not build:\n" + log[-4000:])
    while mutants:
        planted.plant(mutants)
        log = build.make(*targets)
        if not log:
            return mutants
        blamed = not_compiling(log, mutants)
        if not blamed:
            sys.exit("Nobody knows why this does not build:\n" + log[-4000:])
        for mutant in blamed:
            mutant.result = "no mutant"
        mutants = [m for m in mutants if not m.result]
        say(f"{len(blamed)} do not compile; {len(mutants)} are left")
    return mutants


# Before the tests.


@dataclass
class Test:
    program: Path
    name: str
    seconds: float = 0
    reached: frozenset = frozenset()
    passed: bool = True

    @property
    def command(self):
        return [str(self.program), f"--gtest_filter={self.name}"]


class SystemTest(Test):
    """A module of tests/system, whose programs note together what they reach."""

    @property
    def command(self):
        limpid = f"LIMPID={self.program} PYTHONDONTWRITEBYTECODE=1"
        return ["sh", "-c", f"cd tests/system && {limpid} exec /usr/bin/python3 -m unittest {self.name}"]


def names_of_tests(listing):
    """Of what --gtest_list_tests prints."""
    found, suite = [], ""
    for line in listing.splitlines():
        name = line.split("#")[0].strip()
        if line.startswith("  "):
            found.append(suite + name)
        elif name.endswith("."):
            suite = name
    return found


def in_time(command, environment, seconds):
    """The exit status (None: it took too long) and the output; nothing of it goes on running.

    It has a home of its own: nobody knows which files a program with an error in it writes or removes.
    """
    with tempfile.TemporaryFile() as out, tempfile.TemporaryDirectory(prefix="limpid-home-") as home:
        own = {name: home for name in ("HOME", "XDG_CONFIG_HOME", "XDG_DATA_HOME", "XDG_CACHE_HOME", "XDG_STATE_HOME")}
        child = subprocess.Popen(command, env={**os.environ, **own, **environment}, stdout=out,
                                 stderr=subprocess.STDOUT, start_new_session=True, cwd=TREE)  # fmt: skip
        try:
            status = child.wait(seconds)
        except subprocess.TimeoutExpired:
            status = None
        finally:
            with contextlib.suppress(ProcessLookupError):  # what it has started may outlive it
                os.killpg(child.pid, signal.SIGKILL)
            child.wait()
        out.seek(0)
        return status, out.read().decode(errors="replace")


def look(test, seconds):
    """Runs it as it is; notes what it reaches."""
    with tempfile.NamedTemporaryFile() as file:
        file.truncate(source.MOST + 1)
        began = time.monotonic()
        status, _ = in_time(test.command, {"LIMPID_MUTANT": "0", "LIMPID_MUTANT_REACHED": file.name}, seconds)
        test.seconds = time.monotonic() - began
        test.passed = status == 0
        test.reached = frozenset(i for i, byte in enumerate(Path(file.name).read_bytes()) if byte)
    return test


def nearness(mutant, test):
    """0: tests of its own room come first."""
    name = test.program.name
    rooms = {"core": ["core_tests"], "devices": ["devices_tests", "hid_tests", "identify_tests", "files_tests"],
             "render": ["render_tests"]}  # fmt: skip
    return name not in rooms.get(mutant.room, []) and not (mutant.room == "app" and name == "app_tests")


def try_out(mutant, tests, budget):
    """Shows one mutant to the tests that reach it."""
    reaching = [t for t in tests if t.passed and mutant.number in t.reached]
    reaching.sort(key=lambda t: (nearness(mutant, t), t.seconds))
    if not reaching:
        mutant.result = "unreached"
        return mutant
    run, spent = [], 0.0
    for test in reaching:
        if spent + test.seconds <= budget or not run:
            run.append(test)
            spent += test.seconds
    mutant.left_out = len(reaching) - len(run)
    mutant.result = "unnoticed"
    for program in dict.fromkeys(t.program for t in run):
        own = [t for t in run if t.program == program]
        limit = 20 + 5 * sum(t.seconds for t in own)
        names = ":".join(t.name for t in own)
        flags = [f"--gtest_filter={names}", "--gtest_fail_fast"]
        status, out = in_time([str(program), *flags], {"LIMPID_MUTANT": str(mutant.number)}, limit)
        if status != 0:
            failed = re.search(r"\[  FAILED  \] (\S+?),? ", out)
            why = "the time limit" if status is None else failed[1] if failed else f"status {status}"
            mutant.result, mutant.by = "noticed", f"{program.name}: {why}"
            return mutant
    return mutant


def ask_system_tests(mutants, tests):
    """Shows what no test program notices to the system tests that reach it, one at a time: windows need the processor."""
    for test in tests:
        look(test, 1800)
        if not test.passed:
            say(f"{test.name} fails without an error, and is not asked")
    for mutant in (m for m in mutants if m.result in ("unnoticed", "unreached")):
        for test in (t for t in tests if t.passed and mutant.number in t.reached):
            if in_time(test.command, {"LIMPID_MUTANT": str(mutant.number)}, 60 + 5 * test.seconds)[0] != 0:
                mutant.system = test.name
                say(f"{mutant.number}: {mutant.file}:{mutant.line}: {mutant.what}: noticed by {test.name}")
                break


# What came of it.


def summary(mutants):
    lines = []
    for room in sorted({m.room for m in mutants}):
        own = [m for m in mutants if m.room == room]
        count = {each: sum(m.result == each for m in own) for each in ("noticed", "unnoticed", "unreached", "no mutant", "")}
        tried = count["noticed"] + count["unnoticed"] + count["unreached"]
        share = f"{100 * count['noticed'] / tried:.0f} %" if tried else "-"
        lines.append(
            f"{room}: {count['noticed']} of {tried} noticed ({share}); unnoticed {count['unnoticed']}, reached by no "
            f"test {count['unreached']}; {count['no mutant']} do not compile, {count['']} were not tried"
        )
        if system := sum(bool(m.system) for m in own):
            both = count["noticed"] + system
            lines.append(f"{room}, with system tests: {both} of {tried} noticed ({100 * both / tried:.0f} %)")
    return "\n".join(lines)


def as_diff(mutant):
    before, after = mutant.shown
    result = mutant.result + (f", but by {mutant.system}" if mutant.system else "")
    return f"{mutant.file}:{mutant.line}: {mutant.what} ({result})\n- {before}\n+ {after}\n"


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("paths", nargs="*", help="files or folders; of folders the .cpp, headers only by name")
    parser.add_argument("--change", metavar="REV", help="only in lines that changed since this revision of git")
    parser.add_argument("--build", type=Path, default=TREE / "build/release", help="a build folder of ninja")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--count", type=int, default=40, help="errors in each room; 0: all")
    parser.add_argument("--programs", default="", help="only these test programs: core_tests,app_tests")
    parser.add_argument("--budget", type=float, default=60, help="of tests for one error [s]")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--system", default="", help="system tests asked about the rest: test_cli,test_link")
    parser.add_argument("--report", type=Path, default=None, help="JSON; default mutants.json in the build folder")
    parser.add_argument("--resume", action="store_true", help="what the report knows already is not tried again")
    parser.add_argument("--list", action="store_true", help="only says which errors it would plant")
    return parser.parse_args()


def choose(options):
    if options.change:
        files = changed_lines(options.change)
        inside = [p.rstrip("/") for p in options.paths]
        if inside:
            files = {f: lines for f, lines in files.items() if any(f == p or f.startswith(p + "/") for p in inside)}
    else:
        files = {file: None for file in files_of(options.paths)}
    by_room = {}
    for file, lines in sorted(files.items()):
        by_room.setdefault(file.split("/")[0], []).extend(mutants_of(file, lines).values())
    mutants = drawn(by_room, options.count, options.seed)[: source.MOST]
    for number, mutant in enumerate(mutants, 1):
        mutant.number = number
        text = (TREE / mutant.file).read_text()
        mutant.first_line = text.count("\n", 0, mutant.place.start) + 1
        mutant.last_line = text.count("\n", 0, mutant.place.end) + 1
    return mutants


def take_results(mutants, report):
    """Of an earlier call with the same errors."""
    known = {(m["file"], m["line"], m["what"], m["shown"][1]): m for m in json.loads(report.read_text())["mutants"]}
    for mutant in mutants:
        before = known.get((mutant.file, mutant.line, mutant.what, mutant.text))
        if before:
            mutant.result, mutant.by, mutant.left_out = before["result"], before["by"], before["left_out"]
            mutant.system = before["system"]


def carry_out(options, mutants, report):
    build = Build(options.build, options.jobs)

    def write():
        report.write_text(json.dumps({"seed": options.seed, "mutants": [m.report() for m in mutants]}, indent=1) + "\n")

    with Planted() as planted:
        open_ = compile_all(build, planted, [m for m in mutants if not m.result])
        objects = build.objects()
        headers = any(m.file not in objects for m in open_)
        of_mutants = {name for m in open_ for name in objects.get(m.file, [])}
        programs = [p for p in build.test_programs() if headers or of_mutants & build.inputs(p)]
        if options.programs:
            programs = [p for p in programs if Path(p).name in options.programs.split(",")]
        system = [SystemTest(options.build.absolute() / "app/limpid", name) for name in filter(None, options.system.split(","))]
        while open_ and (log := build.make(*programs, *(["limpid"] if system else []))):
            blamed = not_compiling(log, open_)
            if not blamed:
                sys.exit("The test programs do not build:\n" + log[-4000:])
            for mutant in blamed:
                mutant.result = "no mutant"
            open_ = [m for m in open_ if not m.result]
            planted.plant(open_)
        write()
        say(f"{len(open_)} errors in {', '.join(Path(p).name for p in programs)}; what do the tests reach?")
        tests = []
        for program in programs:
            path = options.build / program
            _, listing = in_time([str(path), "--gtest_list_tests"], {}, 60)
            tests += [Test(path, name) for name in names_of_tests(listing)]
        with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
            for test in pool.map(lambda t: look(t, 600), tests):
                if not test.passed:
                    say(f"{test.program.name}: {test.name} fails without an error, and is not asked")
            say(f"{len(tests)} tests, {sum(t.seconds for t in tests):.0f} s")
            for mutant in pool.map(lambda m: try_out(m, tests, options.budget), open_):
                say(f"{mutant.number}: {mutant.file}:{mutant.line}: {mutant.what}: {mutant.result} {mutant.by}")
                write()
        ask_system_tests(open_, system)
        write()


def main():
    options = arguments()
    if not options.paths and not options.change:
        sys.exit("Name files or folders, or a revision with --change.")
    mutants = choose(options)
    if options.list:
        print("\n".join(as_diff(m) for m in mutants))
        return
    if dirty := git("status", "--porcelain", "--untracked-files=no").strip():
        sys.exit(f"The tree has to be clean, as its files are changed and put back; git status says:\n{dirty}")
    report = options.report or options.build / "mutants.json"
    if options.resume and report.exists():
        take_results(mutants, report)
    try:
        if any(not m.result for m in mutants):
            carry_out(options, mutants, report)
    finally:
        print()
        for mutant in mutants:
            if mutant.result in ("unnoticed", "unreached"):
                print(as_diff(mutant))
        print(summary(mutants))
        print(f"All of it is in {report}.")


if __name__ == "__main__":
    main()
