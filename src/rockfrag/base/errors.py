"""The one exception that users are meant to see."""

from collections.abc import Iterator
from contextlib import contextmanager

# characters: what a file holds may be quoted and be of any length
LONGEST_MESSAGE = 500


class InputError(ValueError):
    """Something the user gave cannot be used.

    The message is one sentence that says where (file, line, key or argument), what is wrong, and how
    to mend it. Command line and workflow print it without a traceback. A message longer than
    :data:`LONGEST_MESSAGE` loses its middle: its beginning says where, its end how to mend it.
    """

    def __init__(self, message: object) -> None:
        text = str(message)
        # what would break the line, such as a line feed in a name, is escaped
        words = text
        if not text.isprintable():
            words = "".join(c if c.isprintable() else repr(c)[1:-1] for c in text)
        if len(words) > LONGEST_MESSAGE:
            kept = (LONGEST_MESSAGE - 3) // 2
            words = f"{words[:kept]} … {words[-kept:]}"
        super().__init__(words)


@contextmanager
def errors_of(where: str) -> Iterator[None]:
    """Begin the messages that come from inside this block with where it is.

    Parameters
    ----------
    where : file, line, key or argument, without a colon

    Returns
    -------
    A context in which each :class:`InputError` is raised anew with ``where`` in front.
    """
    try:
        yield
    except InputError as error:
        raise InputError(f"{where}: {error}") from error
