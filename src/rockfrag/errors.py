"""The one exception that users are meant to see."""


class InputError(ValueError):
    """Something the user gave cannot be used.

    The message is one sentence that says where (file, line, key or argument), what is wrong, and how
    to mend it. Command line and workflow print it without a traceback.
    """
