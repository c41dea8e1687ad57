"""What was not given and had to be assumed, with what depends on it."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Assumption:
    """Something that was not given."""

    # What was assumed, in a few words that go into a list, such as ``its mass is 368 kg``
    short: str
    words: str  # The same in a sentence, with its reason
    # Names of the sources of uncertainty that stand for it; empty where the answer does not depend on it
    sources: tuple[str, ...] = ()
