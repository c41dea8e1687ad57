"""Tables of non-structural components: an import of NIST's NED, and pelicun's fragility table.

NED (usnistgov/NED, ``import_fragility``) takes a CSV with a row a damage state, whose measure is a peak velocity
[m/s] or acceleration [g] of the floor, and a reference that is imported before (``import_model --model
Reference``). pelicun takes SimCenter's damage model (:func:`rockfrag.fragility.exports.write_simcenter`). Both
are of the motion of what an object stands on.
"""

from collections.abc import Sequence

import pandas as pd

from rockfrag import __version__
from rockfrag.aftermath.object_fragility import ObjectFragility
from rockfrag.assess.standing.holders import Fastener, Isolator, Putty
from rockfrag.fragility.exports import identifiers
from rockfrag.outcomes.limit_states import limit_state_named

LABEL, YEAR = "rockfrag", 2026  # Of the reference that goes with the curves
NED_METRIC = {
    "PGA": ("Peak Floor Acceleration, horizontal", "g", 1.0),
    "PGV": ("Peak Floor Velocity", "Meters Per Second", 0.01),
}
"""Measure and unit as NED has them, with the factor to that unit."""

ON_FLOOR = {"PGA": "PFA", "PGV": "PFV"}


def _attachment(fragility: ObjectFragility) -> str:
    """How an object is attached, in the words of NED; a wall beside it and casters attach nothing."""
    holders = fragility.request.objects.under.holders
    said = []
    if any(isinstance(each, Putty | Fastener) for each in holders):
        said.append("Anchored")
    if any(isinstance(each, Isolator) for each in holders):
        said.append("Isolated")
    return ", ".join(said) or "Unanchored"


def _description(fragility: ObjectFragility) -> str:
    """What it is, such as ``Object with wax or putty, urn, 0.15 × 0.6 m``."""
    held = fragility.held_by
    kind = f"Object with {held}" if held else "Free-standing object"
    return f"{kind}, {fragility.request.name}, {fragility.size}"


def ned_table(
    fragilities: Sequence[ObjectFragility], components: str = ""
) -> pd.DataFrame:
    """Fragility models and curves as NED's ``import_fragility`` takes them.

    Parameters
    ----------
    fragilities : of the objects, in a measure of the floor
    components : identifiers of NED's components that they are of, with semicolons between them, such as
        ``E.20.2.2.D`` for bookcases; empty to link none

    Returns
    -------
    A row an object and damage state.
    """
    rows = []
    names = identifiers((each.request.name for each in fragilities), "-_.")
    for each in fragilities:
        metric, unit, factor = NED_METRIC[each.measure.imt]
        for rank, (state, curve) in enumerate(each.states.items(), start=1):
            reached = limit_state_named(state)
            rows.append(
                {
                    "reference": f"{LABEL}-{YEAR}",
                    "model_id": names[each.request.name],
                    "p58_fragility": "",
                    "comp_detail": _attachment(each),
                    "material": "",
                    "size_class": each.size,
                    "comp_description": _description(each),
                    "reviewer": "",
                    "source": f"rockfrag {__version__}",
                    "edp_metric": metric,
                    "edp_unit": unit,
                    "component_ids": components,
                    "ds_rank": rank,
                    "ds_description": reached.damage or reached.label,
                    "median": f"{factor * curve.median:.4f}",
                    "beta": f"{curve.beta:.3f}",
                    "probability": "1.0",
                    "basis": "Analytical Study",
                    "num_observations": each.motions,
                }
            )
    return pd.DataFrame(rows)


def ned_reference() -> pd.DataFrame:
    """Return the reference of the curves, as NED's ``import_model --model Reference`` takes it.

    Returns
    -------
    One row.
    """
    return pd.DataFrame(
        [
            {
                "reference_label": LABEL,
                "study_type": "Analytical Study",
                "comp_type": "Contents",
                "pdf_saved": "False",
                "csl_type": "software",
                "csl_title": f"rockfrag {__version__}: rocking and overturning of free-standing objects",
                "csl_year": YEAR,
                "csl_authors": "rockfrag contributors",
                "csl_doi": "",
                "csl_url": "",
                "csl_journal": "",
                "csl_volume": "",
                "csl_issue": "",
                "csl_page": "",
                "csl_publisher": "",
            }
        ]
    )


def fragility_rows(fragilities: Sequence[ObjectFragility]) -> pd.DataFrame:
    """Curves as :func:`rockfrag.fragility.exports.write_simcenter` takes them.

    Parameters
    ----------
    fragilities : of the objects, in a measure of the floor

    Returns
    -------
    A row an object and limit state.
    """
    rows = []
    for each in fragilities:
        for state, curve in each.states.items():
            rows.append(
                {
                    "configuration": each.request.name,
                    "held_by": each.held_by,
                    "state": state,
                    "im": ON_FLOOR[each.measure.imt],
                    "unit": each.measure.unit,
                    "theta": curve.median,
                    "beta": curve.beta,
                    "beta_holds_all": True,
                    "warnings": f"{each.motions} motions of {each.earthquakes} earthquakes; beta holds all that "
                    "is not known.",
                }
            )
    return pd.DataFrame(rows)
