"""What the parts of a report say, a macro of ``sections.j2`` by their anchors, and names with ``_figure``."""

from rockfrag.report.wording import Macros

says = Macros("rockfrag.report.sections", "sections.j2")
