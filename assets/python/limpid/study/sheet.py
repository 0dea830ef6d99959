"""Under what a participant's answers were given: a file beside them."""

from __future__ import annotations

import functools
import hashlib
import json
import os
import platform
import sys
from datetime import datetime, timezone
from pathlib import Path
from typing import Any, Dict, List, Mapping, Optional

from limpid.errors import LimpidError
from limpid.program import carry_out
from limpid.study.answers import StudyError


@functools.lru_cache(maxsize=None)
def program_version() -> str:
    """Of the program that runs are made with; "unknown" without one."""
    try:
        return carry_out(["--version"]).split()[-1]
    except (LimpidError, IndexError):
        return "unknown"


def provenance(version: str, settings: Mapping[str, Any], seed: int, date: str) -> str:
    """Where numbers come from, in a line: the same settings have the same eight digits."""
    text = json.dumps(dict(settings), sort_keys=True)
    digits = hashlib.sha256(text.encode()).hexdigest()[:8]
    return f"limpid {version}, settings {digits}, seed {seed}, {date}"


class Sheet:
    """FOLDER/NAME-PARTICIPANT.json: all settings, the seed, the questions, the truth of a simulated
    participant, and each time that the study was started: when, with which version, on which
    computer. It is written when the study begins, and again when that is more than before."""

    def __init__(self, file: Path) -> None:
        """Reads it, if it is there. Raises StudyError for one that cannot be read."""
        self.file = file
        self.has: Dict[str, Any] = {}
        try:
            found = json.loads(file.read_text(encoding="utf-8"))
            if not isinstance(found, dict):
                raise ValueError("is no sheet of a study")
            self.has = found
        except FileNotFoundError:
            pass
        except (OSError, ValueError) as error:
            raise StudyError(f"{file}: cannot be read: {error}; it says under what the answers beside it were "
                             "given. Put it right, or choose another folder") from error  # fmt: skip

    def who_has_it(self) -> str:
        """The last one that was started, in words."""
        for last in self.sittings[-1:]:
            return f"process {last.get('process')} on {last.get('computer')}, since {last.get('began')},"
        return "another program"

    @property
    def sittings(self) -> List[Dict[str, Any]]:
        found = self.has.get("sittings", [])
        return found if isinstance(found, list) else []

    def begin(self, study: str, participant: int, known: Mapping[str, Any], version: str,
              answers: int) -> None:  # fmt: skip
        """Another start, behind so many answers, with what is `known`: `settings`, `truth`, `arm`.
        Raises StudyError where something of that is otherwise than the answers were given under."""
        if answers > 0:
            self._compare(known)
        else:
            self.has = {}
        now = datetime.now(timezone.utc).isoformat(timespec="seconds")
        sitting = {"began": now, "version": version, "computer": platform.node(), "process": os.getpid(),
                   "system": platform.platform(), "python": platform.python_version(),
                   "words": sys.argv[1:], "answers": answers}  # fmt: skip
        if "settings" not in self.has:
            line = provenance(version, known["settings"], participant, now)
            self.has = {"provenance": line, "study": study, "participant": participant, "seed": participant,
                        **known, "questions": {}}  # fmt: skip
        self.has["sittings"] = [*self.sittings, sitting]
        self._write()

    def _compare(self, known: Mapping[str, Any]) -> None:
        before, now = dict(self.has.get("settings") or {}), dict(known["settings"])
        if "settings" in self.has and before != now:
            key = next(key for key in [*before, *now] if before.get(key) != now.get(key))
            raise StudyError(f"{self.file}: the answers that are there were given with {key} = "
                             f"{_shown(before, key)}; now it is {_shown(now, key)}. Start the study with the "
                             "settings that it began with, or another participant")  # fmt: skip
        for key in ("truth", "arm"):
            if key in self.has and self.has[key] != known.get(key):
                raise StudyError(f"{self.file}: {key} was {json.dumps(self.has[key])}; now it is "
                                 f"{json.dumps(known.get(key))}. Start the study as it began, or another "
                                 "participant")  # fmt: skip

    def ask(self, condition: str, question: str) -> None:
        """The question of a condition's trials. Raises StudyError where it was another one."""
        questions = self.has.setdefault("questions", {})
        if questions.get(condition, question) != question:
            raise StudyError(f'{self.file}: condition {condition}: the question was "{questions[condition]}"; now '
                             f'it is "{question}". Ask as before, or another participant')  # fmt: skip
        if condition not in questions:
            questions[condition] = question
            self._write()

    def words(self) -> Optional[str]:
        """What the study was first started with, on the command line."""
        for first in self.sittings[:1]:
            return " ".join(str(word) for word in first.get("words", []))
        return None

    def _write(self) -> None:
        """Whole, or not at all."""
        beside = self.file.with_name(self.file.name + ".new")
        try:
            with open(beside, "w", encoding="utf-8") as out:
                json.dump(self.has, out, indent=1, ensure_ascii=False)
                out.write("\n")
                out.flush()
                os.fsync(out.fileno())
            os.replace(beside, self.file)
        except OSError as error:
            try:
                beside.unlink()
            except OSError:
                pass
            raise StudyError(f"{self.file}: {error.strerror}; it says under what the answers beside it are "
                             "given. Make room for it and start the study again with the same words"
                             ) from error  # fmt: skip


def _shown(settings: Mapping[str, Any], key: str) -> str:
    return json.dumps(settings[key]) if key in settings else "not set"
