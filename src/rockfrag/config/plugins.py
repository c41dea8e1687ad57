"""What other distributions add to studies: keys of the configuration, rules of the workflow, parts of the report.

A distribution names its :class:`Plugin` under the entry point group ``rockfrag.study``. A study has the plugin if
its configuration holds one of the plugin's keys; without the distribution such a key is not known.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from importlib.metadata import entry_points
from pathlib import Path
from typing import Any

# Study, Part, Results and Answer stand in rooms that know this one, so they are of any type here
Parts = Sequence[Any]
FirstPage = Callable[[Any], Any]

GROUP = "rockfrag.study"  # group of entry points that name plugins


@dataclass(frozen=True)
class Plugin:
    """What a distribution adds to a study."""

    # Its keys of a study's configuration, each with its JSON schema
    schema: Mapping[str, Any]
    # Reads them out of the configuration, which has passed the schema, and checks them against the study
    settings: Callable[[Mapping[str, Any], Any], Any]
    # Its rules of the workflow, a file of Snakemake in the package's folder; what the report shows
    # of their outputs they append to the list ``ADDED``
    rules: Path
    # Returns the parts of the study's report, and what makes its first page, from those of any study
    report: Callable[[Any, Parts, FirstPage], tuple[Parts, FirstPage]]


@cache
def plugins() -> dict[str, Plugin]:
    """Return the installed plugins by name."""
    return {point.name: point.load() for point in sorted(entry_points(group=GROUP))}


def plugins_asked(content: Mapping[str, Any]) -> dict[str, Plugin]:
    """Return the plugins of which a study's configuration holds a key.

    Parameters
    ----------
    content : a study's configuration

    Returns
    -------
    The :class:`Plugin` of each name.
    """
    return {
        name: plugin
        for name, plugin in plugins().items()
        if any(content.get(key) is not None for key in plugin.schema)
    }


def plugins_of(study: Any) -> list[Plugin]:
    """Return the plugins that a study of any kind has.

    Parameters
    ----------
    study : of any kind

    Returns
    -------
    Its plugins, in the order of their names.
    """
    return [plugins()[name] for name in getattr(study, "added", ())]
