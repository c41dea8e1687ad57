"""C1 to C24: what the thesis's second chapter and its Tables 3.1 and 4.1 say, computed again.

Most are exact or simulated and need no interval; where a figure is a share or a spread it has one.
"""

from collections.abc import Callable, Mapping, Sequence

from rockfrag.records.motion import Motion
from rockfrag.rocking.bodies import Body
from rockfrag.thesis.statements import theory_blocks, theory_spectra, theory_stacks
from rockfrag.thesis.statements.evidence import Undecidable
from rockfrag.thesis.statements.ledger import ClaimResult
from rockfrag.thesis.statements.results import not_decidable
from rockfrag.thesis.statements.theory_setting import FreeRocking, Setting, make_setting

Check = Callable[[Setting], ClaimResult]

CHECKS: Mapping[int, Check] = {
    1: theory_blocks.c1,
    2: theory_stacks.c2,
    3: theory_blocks.c3,
    4: theory_blocks.c4,
    5: theory_blocks.c5,
    6: theory_blocks.c6,
    7: theory_blocks.c7,
    8: theory_blocks.c8,
    9: theory_stacks.c9,
    10: theory_stacks.c10,
    11: theory_stacks.c11,
    12: theory_stacks.c12,
    13: theory_stacks.c13,
    14: theory_spectra.c14,
    15: theory_spectra.c15,
    16: theory_spectra.c16,
    17: theory_spectra.c17,
    18: theory_spectra.c18,
    19: theory_spectra.c19,
    20: theory_blocks.c20,
    21: theory_stacks.c21,
    22: theory_stacks.c22,
    23: theory_stacks.c23,
    24: theory_stacks.c24,
}
"""Check of each statement about theory."""


def theory_claims(
    specimens: Mapping[str, Body],
    motions: Sequence[Motion],
    *,
    seed: int,
    free_rocking: FreeRocking | None = None,
    threads: int | None = None,
) -> list[ClaimResult]:
    """Compute C1 to C24 for specimens and ground motions.

    A statement about which they cannot speak (no stack, no motion) is undecided, with the reason.

    Parameters
    ----------
    specimens
        Blocks and stacks by name.  A block named "P" is the pedestal: without stacks among the
        specimens each other block is put on it.
    motions
        Ground motions at their recorded amplitude.
    seed
        Of the perturbations and random geometries.
    free_rocking
        Measured free rocking by specimen: times [s] and rotations [rad] of a history (C5).
    threads
        Threads to use; the results do not depend on it.

    Raises
    ------
    InputError
        If a measured history cannot be used.
    """
    setting = make_setting(specimens, motions, seed, free_rocking, threads)
    results = []
    for number, check in CHECKS.items():
        try:
            results.append(check(setting))
        except Undecidable as reason:
            results.append(not_decidable(number, check, "simulated", reason))
    return results
