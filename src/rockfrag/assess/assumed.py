"""What was not given and had to be assumed, with what depends on it."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Assumption:
    """Something that was not given.

    Attributes
    ----------
    short
        What was assumed, in a few words that go into a list, such as ``its mass is 368 kg``.
    words
        The same in a sentence, with its reason.
    sources
        Names of the sources of uncertainty that stand for it; empty where the answer does not depend on it.
    """

    short: str
    words: str
    sources: tuple[str, ...] = ()
