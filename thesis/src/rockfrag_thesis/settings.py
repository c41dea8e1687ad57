"""What the thesis's study asks for beyond any other: a comparison, other buildings, a sensitivity analysis."""

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field
from typing import Any

from rockfrag.errors import InputError
from rockfrag.study.study import Study

NAME = "thesis"
"""Name of the plugin."""


@dataclass(frozen=True)
class SensitivityAnalysis:
    """Levels of the factors that could produce a pedestal effect."""

    # Factors on the restitution that conserves momentum: of the object wherever it stands, of the
    # object on the pedestal only, of the pedestal on the ground [-]
    statue_restitution: tuple[float, ...]
    interface_restitution: tuple[float, ...]
    ground_restitution: tuple[float, ...]
    # Imperfections: lean of the pedestal, object off its middle, centre of gravity of the object
    # off its middle, on the pedestal and on the ground alike
    pedestal_lean_deg: tuple[float, ...]
    statue_offset_mm: tuple[float, ...]
    statue_cg_offset_mm: tuple[float, ...]
    pedestal_width_cm: tuple[float, ...]  # Widths of the pedestal
    # Moved masses of the table that enter the two ways of miscounting mass
    table_mass_kg: tuple[float, ...]
    step_percent: tuple[float, ...]  # Steps of the protocol [%]
    # Standard deviations of every length and restitution in perturbed copies
    tolerance_percent: float
    tolerance_restitution: float
    replicates: int  # Number of perturbed copies
    # Effect that is asked for, changes of P/NP on the ``ground`` and ``above`` it [%]; empty where
    # none is
    wanted_percent: Mapping[str, float] = field(default_factory=dict)
    # Coefficients of friction at the ``ground`` and at the ``interface``, all pairs of which are
    # tried beside infinite ones [-]; empty where surfaces are taken as rough enough
    friction: Mapping[str, Sequence[float]] = field(default_factory=dict)


@dataclass(frozen=True)
class Settings:
    """What a study asks for; each is empty where the configuration does not ask for it."""

    # Whether the study is compared with the thesis: printed tables, hypotheses, their order of
    # floors
    compares: bool = False
    # Values of the building's assumptions by name, see
    # :data:`rockfrag_thesis.building_sensitivity.AXES`
    sensitivity: Mapping[str, Sequence[Any]] | None = None
    # Factors that could produce a pedestal effect
    sensitivity_analysis: SensitivityAnalysis | None = None


def settings_of(study: Study) -> Settings:
    """Return what a study asks of the thesis's plugin, which may be nothing."""
    settings: Settings = study.added.get(NAME, Settings())
    return settings


def read_settings(content: Mapping[str, Any], study: Study) -> Settings:
    """Take the settings out of a study's checked configuration; refuse what the study cannot give."""
    sensitivity_analysis = content.get("sensitivity_analysis")
    if sensitivity_analysis is not None:
        lists = {k: tuple(v) for k, v in sensitivity_analysis.items() if isinstance(v, list)}
        sensitivity_analysis = SensitivityAnalysis(**{**sensitivity_analysis, **lists})
    compares = content.get("compare_with") is not None
    settings = Settings(compares, content.get("building_sensitivity"), sensitivity_analysis)
    if sensitivity_analysis is not None and not study.has_pairs:
        raise InputError(
            f"{study.source}: key sensitivity_analysis: expected an object tested with and without a pedestal "
            "among the configurations."
        )
    if settings.sensitivity is not None:
        _check_varied_building(study, settings.sensitivity)
    _check_mechanics(study, settings)
    if sensitivity_analysis is not None:
        _check_perturbed_bodies(study, sensitivity_analysis)
    return settings


def _check_perturbed_bodies(study: Study, levels: SensitivityAnalysis) -> None:
    """Raise where a level makes a body that cannot stand, or a restitution that adds energy."""
    from rockfrag_thesis.sensitivity_analysis.simulated import factor_cases
    from rockfrag_thesis.stages.sensitivity_analysis import tested_stacks

    for name, stack in tested_stacks(study).items():
        try:
            factor_cases(name, stack, asdict(levels))
        except InputError as error:
            raise InputError(f"{study.source}: key {error}") from error


def _check_mechanics(study: Study, settings: Settings) -> None:
    """Refuse what is not simulated with friction or with vertical motion."""
    where = f"{study.source}: key {'friction' if study.slides else 'vertical'}"
    if (study.slides or study.vertical) and settings.sensitivity_analysis is not None:
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
