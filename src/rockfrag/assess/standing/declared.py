"""A kind of standing by declaration: functions of the core on an object's numbers, and texts.

What it declares is all that both ``rockfrag assess`` and the one-file page know of it: a field of the page's form
offers it, and the same functions of :mod:`rockfrag.assess.core.bodies` make its blocks in both. It rocks in one
plane.

In: settings of a request. Out: an object (:mod:`rockfrag.assess.standing.contract`), sizes in m and kg. Docs:
``docs/app.md``, "A kind of standing of one's own".
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, ClassVar, Self

from rockfrag.assess.assumed import assume
from rockfrag.assess.standing.changes import changed_block
from rockfrag.assess.standing.contract import Foundation, Standing
from rockfrag.assess.standing.dimensions import (
    conserves_momentum,
    on_foundation,
    sizes_of,
)
from rockfrag.base.errors import InputError
from rockfrag.system.blocks import Block, Body, stacked
from rockfrag.words.findings import Finding, finding

Step = tuple[Callable[..., None], tuple[float, ...]]
"""A function of :mod:`rockfrag.assess.core.bodies`, and the numbers that it takes between two blocks."""


@dataclass(frozen=True)
class Way:
    """Another way in which an object of the kind can stand.

    Attributes
    ----------
    name : id of its text
    change : id of the text of what gives it, as a change that may help
    steps : from the block as it stands to the block in that way
    """

    name: str
    change: str
    steps: tuple[Step, ...]


class Declared(Standing):
    """An object that rocks in one plane on a block that steps make of its sizes."""

    # Id of the text of what was assumed of it, and of the plane in which it rocks
    assumption: ClassVar[str]
    plane_text: ClassVar[str]
    steps: ClassVar[tuple[Step, ...]] = ()
    others: ClassVar[tuple[Way, ...]] = ()

    @classmethod
    def takes(cls, settings: Mapping[str, Any]) -> bool:
        """Take what is said to stand so."""
        return settings.get("stands") == cls.option

    @classmethod
    def of(cls, settings: Mapping[str, Any], folder: Path, under: Foundation) -> Self:
        """Make the object of its sizes."""
        for key in ("round", "facing_deg"):
            if settings.get(key):
                raise InputError(f"key {key}: it rocks in one plane; leave it out.")
        sizes = sizes_of(settings)
        block = stepped(sizes.block, cls.steps)
        momentum = conserves_momentum(settings)
        first = (assume(cls.assumption), *momentum, *sizes.assumed)
        under = on_foundation(under, block, first, sizes.quality_flags)
        return cls(block, finding(cls.plane_text), under)

    def arrangements(self) -> dict[str, Body]:
        """The usual ways to stand, and those that are declared."""
        return super().arrangements() | {way.name: self._in(way) for way in self.others}

    def changes(self) -> dict[Finding, Body]:
        """The usual changes, and those that give a way that is declared."""
        own = {finding(way.change): self._in(way) for way in self.others}
        return super().changes() | own

    def _in(self, way: Way) -> Body:
        return stacked((*self.pedestals, stepped(self.block, way.steps)))


def stepped(block: Block, steps: Sequence[Step]) -> Block:
    """The block after steps in turn."""
    for change, numbers in steps:
        block = changed_block(block, change, *numbers)
    return block


def as_declared(kind: type[Standing]) -> dict[str, Any] | None:
    """What a page knows of a kind; None of one whose own code it has not.

    Parameters
    ----------
    kind : of standing

    Returns
    -------
    Names of functions with their numbers, and ids of texts.
    """
    if not issubclass(kind, Declared):
        return None
    others = [
        {"name": way.name, "change": way.change, "steps": _named(way.steps)}
        for way in kind.others
    ]
    return {
        "assumption": kind.assumption,
        "plane": kind.plane_text,
        "steps": _named(kind.steps),
        "others": others,
    }


def _named(steps: Sequence[Step]) -> list[list[Any]]:
    """Steps by the names of their functions."""
    return [[change.__name__, list(numbers)] for change, numbers in steps]
