"""Results of the two shapes that most statements have: a ratio with its interval, or no figure."""

from collections.abc import Callable

from rockfrag.pedestal.cluster_means import Estimate
from rockfrag.thesis.statements.ledger import ClaimResult
from rockfrag.thesis.statements.verdicts import remark


def ratio_result(
    number: int,
    test: str,
    figure: str,
    verdict: str,
    basis: str,
    estimate: Estimate,
    *,
    unit: str = "event",
    more: str = "",
) -> ClaimResult:
    """Result whose figure is the ratio of ``estimate`` with its interval.

    Parameters
    ----------
    number, test, figure, verdict, basis
        As for `ClaimResult`.
    estimate
        Mean log ratio; an undecided result says which power it would need.
    unit, more
        What was sampled, and what else there is to say: see `rockfrag.thesis.statements.verdicts.remark`.
    """
    return ClaimResult(
        number,
        test,
        figure,
        verdict,
        basis,
        estimate.ratio,
        estimate.ratio_lower,
        estimate.ratio_upper,
        remark=remark(verdict, estimate, unit, more),
    )


def not_decidable(
    number: int, test: Callable[..., ClaimResult], basis: str, reason: Exception
) -> ClaimResult:
    """Undecided result of a test that raised ``reason``; its docstring's first line names it."""
    return ClaimResult(
        number,
        (test.__doc__ or "").split("\n")[0],
        "no figure",
        "undecided",
        basis,
        remark=f"not decidable with these data: {reason}",
    )
