"""What was not given and had to be assumed, with what depends on it; the words stand in ``assumed.j2``."""

from dataclasses import dataclass

from rockfrag.report.wording import PART, Macros, one_line


@dataclass(frozen=True)
class Assumption:
    """Something that was not given."""

    # What was assumed, in a few words that go into a list, such as ``its mass is 368 kg``
    short: str
    words: str  # The same in a sentence, with its reason
    # Names of the sources of uncertainty that stand for it; empty where the answer does not depend on it
    sources: tuple[str, ...] = ()


_says = Macros("rockfrag.assess", "assumed.j2")


def assume(what: str, *sources: str, **about: object) -> Assumption:
    """Return an assumption as a macro says it, shortly and in a sentence; see :class:`Assumption`."""
    short, words = getattr(_says, what)(**about).split(PART)
    return Assumption(one_line(short), one_line(words), sources)
