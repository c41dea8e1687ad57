"""Fragility on each floor in the peak of that floor's own motion, for each limit state."""

from rockfrag.outcomes.limit_states import OVERTURNS, limit_states
from rockfrag.report.answer import has_one_record
from rockfrag.report.page import Column, table_html
from rockfrag.report.part import Part, Results, Section, section_of
from rockfrag.report.sections.words import sentences
from rockfrag.report.wording import estimates

_COLUMNS = (
    Column("configuration", "Configuration"),
    Column("floor", "Floor"),
    Column("state_text", "Limit state"),
    Column("im", "Measure"),
    Column("theta_text", "Median θ [g]", numeric=True),
    Column("beta_text", "Dispersion β", numeric=True),
)


def _section(results: Results) -> Section | None:
    if has_one_record(results):
        return None
    curves = results.table("fragility_floors")
    shown = curves[(curves["measure"] == "pga_g") & curves["theta"].notna()]
    # hidden files are the workflow's own marks
    names = (path.name for path in (results.folder / "exports").iterdir() if path.is_file())
    files = sorted(name for name in names if not name.startswith("."))
    if shown.empty:
        return None
    labels = {state.name: state.label for state in limit_states()}
    shown = shown.assign(
        state_text=shown["state"].map(labels),
        theta_text=estimates(shown, "theta"),
        beta_text=estimates(shown, "beta"),
    )
    fallen = shown[shown["state"] == OVERTURNS].to_dict("records")
    weakest = min(fallen, key=lambda row: float(row["theta"]), default=None)
    level = f"{100 * results.study.fragility.confidence:g} %"
    caption = f"Curves by floor, with {level} intervals where there are any."
    table = table_html(shown, _COLUMNS, caption)
    return section_of(sentences().floor_curves(weakest, files), "floor_curves", [table])


FLOOR_CURVES = Part(("fragility_floors",), _section)
