"""Messages of the readers in the words of who asked: options of the command line, columns of a catalogue."""

import re

_OPTION = re.compile(r"\b(unit|dt|channel|force|cut_short)=(?:True\b)?")
_FORCED = " with force=True or in the file"


def for_command_line(message: object, force: bool = True) -> str:
    """Return a message that names arguments of functions with the options of ``rockfrag`` instead."""
    words = str(message) if force else str(message).replace(_FORCED, " in the file")
    return _OPTION.sub(lambda found: f"--{found[1].replace('_', '-')}", words)


def for_catalogue(message: object) -> str:
    """Return a message that names arguments of functions with the columns of a catalogue instead."""
    words = str(message).replace(_FORCED, " in the file")
    return _OPTION.sub(lambda found: f"the column {found[1]}", words)
