"""What is compared in a study, in words: with and without a pedestal, or arrangements by their names."""

from dataclasses import dataclass

from rockfrag.study.study import Study


@dataclass(frozen=True)
class Sides:
    """Two sides of a comparison."""

    change: str = "the pedestal"  # Subject of a sentence about what the difference does
    ratio: str = "with/without pedestal"  # The ratio of amplitudes
    # An arrangement and its counterpart, after "amplitude"
    first: str = "with pedestal"
    second: str = "without pedestal"

    @property
    def divided(self) -> str:
        """The ratio in a sentence."""
        return f"Amplitude {self.first} divided by that {self.second.removesuffix(' pedestal')}"

    @property
    def both(self) -> str:
        """The two sides."""
        return f"{self.first.removesuffix(' pedestal')} and {self.second}"

    @property
    def axis(self) -> str:
        """Label of an axis of ratios."""
        if self == Sides():
            return "Amplitude with / without pedestal"
        return "Amplitude over the other's"


WITH_PEDESTAL = Sides()
"""What is compared unless arrangements name their counterparts."""


def sides_of(study: Study) -> Sides:
    """Return what is compared in a study."""
    named = study.counterparts
    if not named:
        return WITH_PEDESTAL
    ((name, other), *more) = named.items()
    if more or study.with_and_alone:
        return Sides(
            "an arrangement instead of the one it is compared with",
            "arrangement/the other",
            "of an arrangement",
            "of the other",
        )
    return Sides(f"{name} instead of {other}", f"{name}/{other}", f"of {name}", f"of {other}")
