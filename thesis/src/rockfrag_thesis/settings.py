"""What the thesis's study asks for beyond any other: a comparison, other buildings, a sensitivity analysis."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from rockfrag.base.errors import InputError
from rockfrag.study.study import Study
from rockfrag.system.blocks import Block, Stack

NAME = "thesis"  # name of the plugin


@dataclass(frozen=True)
class Settings:
    """What a study asks for, under the keys that the plugin's schema describes; empty where it does not ask."""

    # Whether the study is compared with the thesis: printed tables, hypotheses, their order of
    # floors
    compares: bool = False
    # Values of the building's assumptions by name, see
    # :data:`rockfrag_thesis.building_sensitivity.AXES`
    sensitivity: Mapping[str, Sequence[Any]] | None = None
    # Levels of the factors that could produce a pedestal effect, and how perturbed copies are drawn
    sensitivity_analysis: Mapping[str, Any] = field(default_factory=dict)

    @property
    def wanted_percent(self) -> Mapping[str, float]:
        """Changes of P/NP that are asked for, on the ``ground`` and ``above`` it [%]; empty where none are."""
        wanted: Mapping[str, float] = self.sensitivity_analysis.get(
            "wanted_percent", {}
        )
        return wanted

    @property
    def friction(self) -> Mapping[str, Sequence[float]]:
        """Coefficients of friction at ``ground`` and ``interface`` of which all pairs are tried [-]; or empty."""
        tried: Mapping[str, Sequence[float]] = self.sensitivity_analysis.get(
            "friction", {}
        )
        return tried


def settings_of(study: Study) -> Settings:
    """Return what a study asks of the thesis's plugin, which may be nothing."""
    settings: Settings = study.added.get(NAME, Settings())
    return settings


def read_settings(content: Mapping[str, Any], study: Study) -> Settings:
    """Take the settings out of a study's checked configuration; refuse what the study cannot give."""
    settings = Settings(
        content.get("compare_with") is not None,
        content.get("building_sensitivity"),
        content.get("sensitivity_analysis", {}),
    )
    if settings.sensitivity_analysis and not study.has_pairs:
        raise InputError(
            f"{study.source}: key sensitivity_analysis: expected an object tested with and without a pedestal "
            "among the configurations."
        )
    if settings.sensitivity is not None:
        _check_varied_building(study, settings.sensitivity)
        if settings.compares:
            _check_compared_floors(study)
    _check_mechanics(study, settings)
    if settings.sensitivity_analysis:
        _check_perturbed_bodies(study, settings.sensitivity_analysis)
    return settings


def _check_perturbed_bodies(study: Study, levels: Mapping[str, Any]) -> None:
    """Raise where a level makes a body that cannot stand, or a restitution that adds energy."""
    from rockfrag_thesis.sensitivity_analysis.simulated import factor_cases

    for name, stack in tested_stacks(study).items():
        try:
            factor_cases(name, stack, levels)
        except InputError as error:
            raise InputError(f"{study.source}: key {error}") from error


def _check_mechanics(study: Study, settings: Settings) -> None:
    """Refuse what is not simulated with friction or with vertical motion."""
    where = f"{study.source}: key {'friction' if study.slides else 'vertical'}"
    if (study.slides or study.vertical) and settings.sensitivity_analysis:
        raise InputError(
            f"{where}: the perturbed parameters of the key sensitivity_analysis rock without sliding under "
            "horizontal motion; leave one of the two out (sensitivity_analysis.friction tries coefficients)."
        )
    if (study.slides or study.vertical) and settings.compares:
        raise InputError(
            f"{where}: what the key compare_with compares with rocks without sliding under horizontal motion; "
            "leave one of the two out."
        )
    if study.vertical and settings.sensitivity is not None:
        raise InputError(
            f"{study.source}: key vertical: the buildings of the key building_sensitivity are shaken "
            "horizontally; leave one of the two out."
        )


def _check_varied_building(study: Study, varied: Mapping[str, Sequence[Any]]) -> None:
    """Raise where the sensitivity has no building, or names floors or levels that it does not have."""
    where = f"{study.source}: key building_sensitivity"
    if study.building is None:
        raise InputError(f"{where}: expected the key building too, which it varies.")
    for i, levels in enumerate(varied.get("floors", ())):
        for label, level in levels.items():
            key = f"{where}.floors[{i}].{label}"
            if label not in study.floors:
                raise InputError(
                    f"{key}: expected a floor of the building, one of {', '.join(study.floors)}."
                )
            if level > study.building.storeys:
                raise InputError(
                    f"{key}: expected a level up to {study.building.storeys}, found {level}."
                )


def _check_compared_floors(study: Study) -> None:
    """Raise where varied buildings cannot be compared: the thesis orders its floors, by tests in pairs."""
    from rockfrag_thesis.hypotheses.floors import FLOORS

    if not study.has_pairs or not set(FLOORS) <= set(study.floors):
        raise InputError(
            f"{study.source}: key building_sensitivity: what the key compare_with compares are tests with and "
            f"without a pedestal on the floors {', '.join(FLOORS)}; leave one of the two out."
        )


def tested_blocks(study: Study) -> dict[str, Block]:
    """Blocks of the objects tested and, as ``P``, the first pedestal: the names of tables."""
    tested = study.configurations
    pedestals = [
        configuration.names[-2] for configuration in tested if configuration.count > 1
    ]
    blocks = {
        name: study.specimens[name] for name in (system.names[-1] for system in tested)
    }
    if pedestals:
        blocks["P"] = study.specimens[pedestals[0]]
    return blocks


def stacks_of(study: Study) -> dict[str, Stack]:
    """Stacks tested, by the name of their configuration."""
    return {
        pair.name: Stack(study.specimens[pair.names[0]], study.specimens[pair.names[1]])
        for pair in study.configurations
        if pair.count == 2
    }


def tested_stacks(study: Study) -> dict[str, Stack]:
    """Stack of each object that is tested with and without a pedestal; of several the first."""
    lone = {system.names[-1] for system in study.configurations if system.count == 1}
    stacks: dict[str, Stack] = {}
    for system in study.configurations:
        if system.count == 2 and system.names[-1] in lone:
            stacks.setdefault(system.names[-1], stacks_of(study)[system.name])
    return stacks
