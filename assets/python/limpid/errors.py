"""What can go wrong, each with a message for people."""


class LimpidError(Exception):
    """Anything that this package refuses or that the program cannot do."""


def in_python(said: str) -> str:
    """A program's message, with what this package has for words of the command line and the socket."""
    return said.replace("--force", "force=True").replace('"replace": true', "replace=True")


class ArgumentError(LimpidError, ValueError):
    """What was given to a function cannot be: the message names it and says what is allowed."""


class RequestError(LimpidError):
    """The program refused what was asked for: the message names the key, what was found and what is
    allowed."""


class RecordingError(LimpidError):
    """A recording has ended by itself, as on a full disk: the message says why, and what saves what
    was recorded until then."""


class RunWarning(UserWarning):
    """A run gave energy, or moved as no hand does: its numbers are those of a run that went wrong."""


class ProgramError(LimpidError):
    """The program is missing, did not start, refused its input or has ended."""
