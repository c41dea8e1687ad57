"""ShakeMap grids as the USGS writes them, of shaking that is a formula."""

from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np

LONGITUDES = np.round(np.arange(134.5, 136.01, 0.1), 4)
LATITUDES = np.round(np.arange(35.5, 34.49, -0.1), 4)  # from north to south
FIELDS = (
    *("LON dd", "LAT dd", "PGA pctg", "PGV cms", "MMI intensity", "PSA03 pctg"),
    *("PSA10 pctg", "PSA30 pctg", "STDPGA ln(pctg)", "URAT ", "SVEL ms"),
)
SPREADS = ("LON dd", "LAT dd", "STDPGA ln(pctg)", "STDPGV ln(cms)", "STDMMI intensity")


def logs(longitude: float, latitude: float) -> tuple[float, float]:
    """Return ln PGA [ln %g] and ln PGV [ln cm/s] that fall linearly with both coordinates."""
    return 3.0 - 0.8 * (longitude - 135) - (latitude - 35), 3.4 - (longitude - 135)


def of_grid(longitude: float, latitude: float) -> list[float]:
    pga, pgv = np.exp(logs(longitude, latitude))
    return [pga, pgv, 7.0, 2 * pga, pga, pga / 3, 0.4, 1.0, 300.0]


def of_uncertainty(longitude: float, latitude: float) -> list[float]:
    return [0.3 + 0.1 * (longitude - 135), 0.35, 0.5]


def grid_text(
    fields: Sequence[str] = FIELDS,
    values: Callable[[float, float], list[float]] = of_grid,
    event: str = "made1",
    kind: str = "ACTUAL",
) -> str:
    """Text of a grid.xml."""
    rows = []
    for latitude in LATITUDES:
        for longitude in LONGITUDES:
            numbers = [longitude, latitude, *values(longitude, latitude)]
            rows.append(" ".join(f"{number:.6g}" for number in numbers))
    named = [field.partition(" ") for field in fields]
    columns = "\n".join(
        f'<grid_field index="{i}" name="{name}" units="{unit}" />'
        for i, (name, _, unit) in enumerate(named, start=1)
    )
    place = (
        f'lon_min="{LONGITUDES[0]}" lat_min="{LATITUDES[-1]}" '
        f'lon_max="{LONGITUDES[-1]}" lat_max="{LATITUDES[0]}"'
    )
    body = "\n".join(rows)
    return f"""<?xml version="1.0" encoding="UTF-8" standalone="yes"?>
<shakemap_grid xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"
 xmlns="http://earthquake.usgs.gov/eqcenter/shakemap" event_id="{event}" shakemap_id="{event}"
 shakemap_version="3" code_version="4.1" process_timestamp="2026-01-01T00:00:00Z"
 shakemap_originator="us" map_status="RELEASED" shakemap_event_type="{kind}">
<event event_id="{event}" magnitude="6.6" depth="12" lat="35.0" lon="135.0"
 event_timestamp="2026-01-01T00:00:00UTC" event_network="us" event_description="5 km N of A &amp; B" />
<grid_specification {place} nominal_lon_spacing="0.1" nominal_lat_spacing="0.1"
 nlon="{LONGITUDES.size}" nlat="{LATITUDES.size}" />
<event_specific_uncertainty name="pga" value="0.45" numsta="12" />
<event_specific_uncertainty name="pgv" value="0.5" numsta="12" />
<event_specific_uncertainty name="psa03" value="-1" numsta="0" />
{columns}
<grid_data>
{body}
</grid_data>
</shakemap_grid>
"""


def write_grids(folder: Path) -> tuple[Path, Path]:
    """Write grid.xml and uncertainty.xml of one map."""
    grid, spread = folder / "grid.xml", folder / "uncertainty.xml"
    grid.write_text(grid_text())
    spread.write_text(grid_text(SPREADS, of_uncertainty))
    return grid, spread


AFTERSHOCK = "made1-aftershock"


def write_aftershock(folder: Path, spread: float = 0.5) -> tuple[Path, Path]:
    """Write both grids of a second shock, half as strong everywhere."""

    def weaker(longitude: float, latitude: float) -> list[float]:
        pga, pgv, *others = of_grid(longitude, latitude)
        return [pga / 2, pgv / 2, *others]

    def of_spread(longitude: float, latitude: float) -> list[float]:
        return [spread, spread, 0.5]

    grid, other = folder / "then.xml", folder / "then-uncertainty.xml"
    text = grid_text(values=weaker, event=AFTERSHOCK)
    grid.write_text(text.replace('magnitude="6.6"', 'magnitude="5.4"'))
    other.write_text(grid_text(SPREADS, of_spread, event=AFTERSHOCK))
    return grid, other
