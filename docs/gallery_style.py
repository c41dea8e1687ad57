"""How pictures of the gallery look: as a journal prints them, and told apart without colours."""

from typing import Any

import matplotlib.pyplot as plt
from matplotlib.figure import Figure
from sphinx_gallery.scrapers import figure_rst

OKABE_ITO = ("#0072B2", "#E69F00", "#009E73", "#D55E00", "#56B4E9", "#CC79A7")


def journal(gallery: dict[str, Any], script: str) -> None:
    """Set the style before each script of the gallery."""
    plt.rcdefaults()
    plt.rcParams.update(
        {
            "axes.prop_cycle": plt.cycler(color=OKABE_ITO),
            "axes.spines.top": False,
            "axes.spines.right": False,
            "figure.constrained_layout.use": True,
            "figure.dpi": 110,
        }
    )


def kept_figures(block: Any, variables: dict[str, Any], gallery: dict[str, Any]) -> str:
    """Save figures that a script keeps in a variable, such as what ``Response.plot`` returns (a scraper)."""
    shown = []
    for value in variables["example_globals"].values():
        if (
            isinstance(value, Figure)
            and value.canvas.manager is None
            and not hasattr(value, "saved_for_gallery")
        ):
            value.saved_for_gallery = True
            shown.append(next(variables["image_path_iterator"]))
            value.savefig(shown[-1], dpi=150)
    return figure_rst(shown, gallery["src_dir"])
