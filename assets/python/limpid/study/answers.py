"""The file of a participant's answers, a row each, which one study at a time writes to."""

from __future__ import annotations

import csv
import errno
import fcntl
import io
import os
import warnings
import weakref
from pathlib import Path
from typing import Callable, Dict, List, Sequence, Tuple

from limpid.errors import LimpidError

# Of file systems that know no locks.
NO_LOCKS = (errno.ENOLCK, errno.ENOTSUP, errno.EOPNOTSUPP, errno.ENOSYS, errno.EINVAL)


class StudyError(LimpidError):
    """A study that cannot begin, or go on where it stopped."""


class Answers:
    """A CSV whose rows are on the disk before append() returns. It is locked for as long as this
    object lives; the lock ends with the process, however that ends. The newest object of a process
    takes the file over from those before it."""

    _of_this_process: "weakref.WeakValueDictionary[Tuple[int, int], Answers]" = weakref.WeakValueDictionary()

    def __init__(self, file: Path, columns: Sequence[str], who_has_it: Callable[[], str]) -> None:
        """Opens the file, or makes it. `who_has_it`: in words, where another process has locked it.
        Raises StudyError for a file that is locked, has other columns, or cannot be written."""
        self.file = file
        try:
            self._descriptor = self._locked(who_has_it)
        except OSError as error:
            raise StudyError(f"{file}: answers cannot be written there: {error.strerror}") from error
        self._close = weakref.finalize(self, os.close, self._descriptor)
        found = os.fstat(self._descriptor)
        self._of_this_process[found.st_dev, found.st_ino] = self
        self._size = 0
        self.rows = self._read(columns)

    def _locked(self, who_has_it: Callable[[], str]) -> int:
        while True:
            descriptor = os.open(self.file, os.O_RDWR | os.O_CREAT | os.O_APPEND | os.O_CLOEXEC, 0o666)
            try:
                found = os.fstat(descriptor)
                before = self._of_this_process.get((found.st_dev, found.st_ino))
                if before is not None:
                    before.give_up()
                self._lock(descriptor, who_has_it)
                if self._is_at_its_place(descriptor):
                    return descriptor
                os.close(descriptor)  # it was replaced meanwhile
            except BaseException:
                os.close(descriptor)
                raise

    def _lock(self, descriptor: int, who_has_it: Callable[[], str]) -> None:
        try:
            fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError as error:
            if error.errno in NO_LOCKS:
                warnings.warn(f"{self.file}: this folder knows no locks ({error.strerror}). Nobody else may "
                              "run this participant meanwhile; rows of somebody else are noticed only "
                              "when the next answer is written.", RuntimeWarning, stacklevel=4)  # fmt: skip
                return
            if error.errno not in (errno.EWOULDBLOCK, errno.EACCES):
                raise
            raise StudyError(f"{self.file}: {who_has_it()} is writing to it. End that one, or choose "
                             "another participant or folder") from error  # fmt: skip

    def _is_at_its_place(self, descriptor: int) -> bool:
        try:
            there, here = os.stat(self.file), os.fstat(descriptor)
        except FileNotFoundError:
            return False
        return (there.st_dev, there.st_ino) == (here.st_dev, here.st_ino)

    def give_up(self) -> None:
        """The lock goes, and nothing can be appended any more."""
        self._close()

    def _read(self, columns: Sequence[str]) -> List[Dict[str, str]]:
        """Half a row, as a crash may leave it, was no answer yet."""
        with open(self.file, "rb") as opened:
            data = opened.read()
        whole = data[: data.rfind(b"\n") + 1]
        if whole and not whole.startswith(",".join(columns).encode()):
            raise StudyError(f"{self.file}: has other columns than this study's")
        if len(whole) < len(data):
            os.ftruncate(self._descriptor, len(whole))
        self._size = len(whole)
        try:
            return list(csv.DictReader(io.StringIO(whole.decode())))
        except (UnicodeDecodeError, csv.Error) as error:
            raise StudyError(f"{self.file}: is no CSV of answers: {error}") from error

    @property
    def empty(self) -> bool:
        """It has not even its header yet."""
        return self._size == 0

    def append(self, cells: Sequence[str]) -> None:
        """Raises OSError where that cannot be, and StudyError where the file is not this study's any
        more; it is as it was before then."""
        if not self._close.alive:
            raise StudyError(f"{self.file}: another study of this program has taken it over")
        if not self._is_at_its_place(self._descriptor):
            raise StudyError(f"{self.file}: somebody has removed or replaced it since this study began; the last "
                             "answer is not in it. Put it back and start the study again")  # fmt: skip
        if os.fstat(self._descriptor).st_size != self._size:
            raise StudyError(f"{self.file}: somebody else has written to it since this study began; the last "
                             "answer is not in it. Take their rows out and start the study again")  # fmt: skip
        line = io.StringIO()
        csv.writer(line, lineterminator="\n").writerow(cells)
        data = line.getvalue().encode()
        try:
            if os.write(self._descriptor, data) < len(data):
                raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
            os.fsync(self._descriptor)
        except OSError:
            os.ftruncate(self._descriptor, self._size)
            raise
        self._size += len(data)
