#!/usr/bin/python3
"""Completions offered by Tab in bash, zsh and fish."""

from __future__ import annotations

import os
import shutil
import subprocess
import unittest
from pathlib import Path

from support import ASSETS, LIMPID, SystemTest, limpid

SCRIPTS = ASSETS / "completions"

BASH = r"""
source "$1"
COMP_LINE=$2 COMP_POINT=${#2} COMP_WORDBREAKS=$' \t\n"\'><=;|&(:'
_limpid limpid
printf '%s\n' "${COMPREPLY[@]}"
"""

# A shell of its own at the end of a pseudo-terminal, as completion works nowhere else; what it
# offers is what compadd is given.
ZSH = r"""
zmodload zsh/zpty
zpty shell zsh -f -i
tell() { zpty -w shell "$1" }
tell "PS1= fpath=($1:h \$fpath) PATH=$PATH; cd $PWD"
tell 'autoload -Uz compinit; compinit -u -D'
tell 'compadd() { local -a found; builtin compadd -O found "$@"; print -rl -- "<"$^found">"; builtin compadd "$@" }'
tell 'zstyle ":completion:*" verbose no; bindkey "^I" complete-word; print R\EADY'
zpty -r shell answer '*READY*'
zpty -n -w shell "$2"$'\t'
sleep 0.1
zpty -n -w shell $'\C-u\C-n'
tell 'print D\ONE'
zpty -r shell answer '*DONE*'
print -r -- $answer
"""


class Tab(SystemTest):
    def setUp(self) -> None:
        self.folder = self.out("")
        self.folder.mkdir()
        for name in ("wall.toml", "one.h5", "arm.urdf", "notes.txt", "two words.toml"):
            (self.folder / name).write_text("")
        (self.folder / "inside").mkdir()
        self.environment = os.environ | {"PATH": f"{LIMPID.parent}:{os.environ['PATH']}"}

    def ask(self, *words: str | Path) -> list[str]:
        done = subprocess.run(words, cwd=self.folder, env=self.environment, capture_output=True,
                              text=True, timeout=60, stdin=subprocess.DEVNULL)  # fmt: skip
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout.splitlines()

    def offered(self, line: str) -> set[str]:
        raise unittest.SkipTest("of no shell")

    def test_commands(self) -> None:
        self.assertEqual(self.offered("limpid re"), {"recover"})
        offered = self.offered("limpid ")
        for command in ("run", "play", "doctor", "identify"):
            self.assertIn(command, offered)
        self.assertFalse({"share", "complete"} & offered, "not told of elsewhere")

    def test_options_of_the_command(self) -> None:
        self.assertEqual(self.offered("limpid run --rec"), {"--record"})
        self.assertEqual(self.offered("limpid analyze --rec"), set())

    def test_files_of_the_kind_that_the_option_takes(self) -> None:
        self.assertEqual(self.offered("limpid run --scene wa"), {"wall.toml"})
        self.assertEqual(self.offered("limpid run --device a"), {"arm.urdf"})
        self.assertEqual(self.offered("limpid info no"), set())
        self.assertEqual(self.offered("limpid info o"), {"one.h5"})

    def test_choices(self) -> None:
        self.assertEqual(self.offered("limpid run --coupling p"), {"proposed", "predictive", "popc"})
        self.assertEqual(self.offered("limpid experiment fr"), {"friction"})

    def test_keys_and_their_choices(self) -> None:
        self.assertEqual(self.offered("limpid run --set hand.st"), {"hand.stiffness="})


class Bash(Tab):
    def offered(self, line: str) -> set[str]:
        return {word for word in self.ask("bash", "-c", BASH, "-", SCRIPTS / "limpid.bash", line) if word}

    def test_values_behind_an_equals_sign(self) -> None:
        self.assertEqual(self.offered("limpid run --coupling=st"), {"standard"})
        # bash completes the part after the '='.
        self.assertEqual(self.offered("limpid run --set coupling.kind=st"), {"standard"})

    def test_names_with_spaces_and_folders(self) -> None:
        self.assertEqual(self.offered("limpid check two"), {"two words.toml"})
        self.assertEqual(self.offered("limpid sweep wall.toml --out in"), {"inside"})
        self.assertEqual(self.offered("limpid check in"), {"inside"})


@unittest.skipIf(shutil.which("fish") is None, "fish is not installed")
class Fish(Tab):
    def offered(self, line: str) -> set[str]:
        script = f"source {SCRIPTS / 'limpid.fish'}; complete -C '{line}'"
        return {answer.split("\t")[0] for answer in self.ask("fish", "--no-config", "-c", script)}

    def test_values_behind_an_equals_sign(self) -> None:
        self.assertEqual(self.offered("limpid run --coupling=st"), {"--coupling=standard"})

    def test_what_they_are(self) -> None:
        script = f"source {SCRIPTS / 'limpid.fish'}; complete -C 'limpid devi'"
        self.assertEqual(self.ask("fish", "--no-config", "-c", script),
                         ["devices\tlists connected devices and the drivers for them"])  # fmt: skip


@unittest.skipIf(shutil.which("zsh") is None, "zsh is not installed")
class Zsh(Tab):
    def offered(self, line: str) -> set[str]:
        said = "\n".join(self.ask("zsh", "-f", "-c", ZSH, "-", SCRIPTS / "_limpid", line))
        return {part.split(">")[0] for part in said.split("<")[1:]}


class Protocol(SystemTest):
    def test_nothing_is_said_of_what_is_unknown(self) -> None:
        for words in ([], ["nothing", "--what", ""], ["run", "--duration", ""]):
            result = limpid("complete", *words)
            self.assertEqual((result.status, result.out, result.err), (0, "", ""), words)

    def test_every_command_and_option_of_the_help_is_offered(self) -> None:
        for line in limpid("complete", "").out.splitlines():
            command = line.split("\t")[0]
            if not command:
                continue
            offered = {answer.split("\t")[0] for answer in limpid("complete", command, "-").out.splitlines()}
            for word in limpid(command, "--help").out.replace(",", " ").split():
                if word.startswith("--") and word.strip("-").isalpha() and "Needs" not in word:
                    self.assertIn(word, offered | {"--help"}, command)


del Tab  # a base for the three shells' tests, not a test itself

if __name__ == "__main__":
    unittest.main()
