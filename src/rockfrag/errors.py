"""The one exception that users are meant to see."""

LONGEST_MESSAGE = 500
"""Characters of a message; what a file holds may be quoted in it and be of any length."""


class InputError(ValueError):
    """Something the user gave cannot be used.

    The message is one sentence that says where (file, line, key or argument), what is wrong, and how
    to mend it. Command line and workflow print it without a traceback. A message longer than
    :data:`LONGEST_MESSAGE` loses its middle: its beginning says where, its end how to mend it.
    """

    def __init__(self, message: object) -> None:
        text = str(message)
        words = text if text.isprintable() else _on_one_line(text)
        if len(words) > LONGEST_MESSAGE:
            kept = (LONGEST_MESSAGE - 3) // 2
            words = f"{words[:kept]} … {words[-kept:]}"
        super().__init__(words)


def _on_one_line(text: str) -> str:
    """Escape what would break the line, such as a line feed in a name."""
    return "".join(c if c.isprintable() else repr(c)[1:-1] for c in text)
