"""Options of the window before a command and behind it."""

import signal
import subprocess
import tomllib
import unittest

from support import ASSETS, SystemTest, limpid
from window import LIMPID, WindowTest

SESSION = ASSETS / "sessions" / "table.h5"


class BeforeTheCommand(WindowTest):
    SAID = ("--print-state", "--ui-scale", "1.5", "--eta", "0.77", "--set", "coupling.k_vc=8",
            "play", SESSION, "--set", "observer.alpha=0.02", "--eta", "0.66")  # fmt: skip

    def start(self) -> None:
        self.states.truncate(0)
        self.states.seek(0)
        self.app = subprocess.Popen([LIMPID, *self.SAID], env=self.environment,
                                    stdout=self.states)  # fmt: skip
        self.addCleanup(self.stop, self.app)

    def test_they_hold_for_play_unless_they_are_said_again_behind_it(self) -> None:
        state = self.wait("the session", lambda s: s.get("playing") or s.get("rerun"), 60)
        self.assertEqual(state["eta"], 0.66, "said behind the command")
        self.assertEqual(self.app.poll(), None)


class OneSetting(WindowTest):
    """Options take precedence over the last start's settings."""

    LAW = None

    def prepare(self) -> None:
        settings = self.home / "config/limpid/settings.toml"
        settings.write_text(settings.read_text() + '[parameters]\ncoupling.kind = "proposed"\n'
                            'coupling.eta = 0.75\ncoupling.k_vc = 7.0\n')

    def start(self) -> None:
        self.app = subprocess.Popen([LIMPID, "--print-state", "--set", "hand.damping=3"],
                                    env=self.environment, stdout=self.states)
        self.addCleanup(self.stop, self.app)

    def test_changes_that_one_alone(self) -> None:
        state = self.wait("the loop", lambda s: s.get("ticks", 0) > 10, 60)
        self.assertEqual((state["kind"], state["eta"]), (1, 0.75))
        self.app.send_signal(signal.SIGTERM)
        self.app.wait(60)
        kept = tomllib.loads((self.home / "config/limpid/settings.toml").read_text())["parameters"]
        self.assertEqual((kept["coupling"]["kind"], kept["coupling"]["eta"], kept["coupling"]["k_vc"],
                          kept["hand"]["damping"]), ("proposed", 0.75, 7, 3))  # fmt: skip


class Refusals(SystemTest):
    def refused(self, *words: str) -> str:
        result = limpid(*words)
        self.assertEqual((result.status, result.out), (2, ""))
        self.assertEqual(len(result.error_lines), 1, result.err)
        return result.err

    def test_a_wrong_value_before_the_command_is_refused_as_behind_it(self) -> None:
        for words in (["--eta", "zz", "play", SESSION], ["play", SESSION, "--eta", "zz"]):
            self.assertIn("coupling.eta", self.refused(*words))
        self.assertIn("no.urdf", self.refused("--device", "/no.urdf", "play", SESSION))
        for first, second in (("coupling.eta=zz", "observer.alpha=0.02"),
                              ("observer.alpha=0.02", "coupling.eta=zz")):  # both count
            error = self.refused("--set", first, "play", SESSION, "--set", second)
            self.assertIn("coupling.eta", error)

    def test_the_windows_options_before_other_commands_are_named(self) -> None:
        for command in ("run", "analyze", "info", "experiment", "devices", "recover"):
            needed = {"info": ["x.h5"], "recover": ["x.h5.part"],
                      "experiment": ["inertia", "--out", self.directory / "x"]}.get(command, [])  # fmt: skip
            error = self.refused("--ui-scale", "1.5", command, *needed)
            self.assertIn("--ui-scale", error)
            self.assertIn(f"limpid {command} opens no window", error)
        error = self.refused("--eta", "0.5", "run")
        self.assertIn("limpid run --eta", error)
        self.assertFalse((self.directory / "x").exists())

    def test_play_lists_them_in_its_help(self) -> None:
        for words in (["--help"], ["play", "--help"]):
            text = limpid(*words).out
            for option in ("--ui-scale", "--print-state", "--device", "--scene", "--set"):
                self.assertIn(option, text)


if __name__ == "__main__":
    unittest.main()
