"""UNAM "archivo estándar de aceleración" (Mexico), version 2: ``KEY : value`` lines, a column a channel.

Lists of channels are written ``/first/second/…``. Below ``DATOS DE ACELERACION`` stand the names and the
orientations of the channels between two rulers, which some files do not have, then one row a sample in the Fortran
format that the header gives (``3F10.3``). The total of samples is that of the nominal duration: up to a second of
samples more may follow.
"""

import re

from obspy import UTCDateTime

from rockfrag.records.parsing import format as form
from rockfrag.records.parsing.number_fields import are_numbers, numbers_of
from rockfrag.records.parsing.stated_peak import StatedPeak, with_checked_peak
from rockfrag.records.parsing.text_file import TextFile
from rockfrag.records.parsing.timestamps import time_of

_TITLE = re.compile(r"^\s*ARCHIVO\s+EST.NDAR\s+DE\s+ACELERACI.N", re.I)
_DATA = re.compile(r"^\s*DATOS DE ACELERACI", re.I)
_RULER = re.compile(r"^-+\+-+\+[-+]*$")
_MAX_HEADER = 200
_MAX_TITLES = 10
_HALF_A_DAY = 12 * 3600


def _interval_and_count(
    text: TextFile, facts: dict[str, str], channels: int
) -> tuple[float, int]:
    """Return interval [s] and number of samples, which the header states once for each channel.

    ``facts``: what the keys of the header state; ``channels``: their number.
    """
    intervals = _list(facts, "intervalo de muestreo")
    counts = _list(facts, "num. total de muestras")
    if len(set(intervals)) != 1 or not len(intervals) == len(counts) == channels:
        text.fail("the channels of the header have no common sampling interval")
    try:
        return float(intervals[0]), int(counts[0])
    except ValueError:
        text.fail("sampling interval or number of samples is not a number")


def _parse(text: TextFile) -> list[form.Channel]:
    """Channels of a file of this format, by its header as the head of the module says it."""
    at_data = text.find(_DATA, 0, _MAX_HEADER)
    if at_data < 0:
        text.fail("no line DATOS DE ACELERACION; the file is cut short")
    facts = form.header_keys(text.lines(0, at_data))
    orientations = _list(facts, "orientacion")
    dt, promised = _interval_and_count(text, facts, len(orientations))
    dt = text.interval(dt, at_data)
    width = next(
        (value for key, value in facts.items() if key.startswith("formato datos")), ""
    )
    start = _first_row(text, at_data + 1)
    values = text.numbers(start, None, form.field_width(f"({width})"))
    channels = len(orientations)
    if text.cut_short:
        values = values[: values.size // channels * channels]
    table = text.in_rows(values, channels, start)
    extra = table.shape[0] - promised
    if not 0 <= extra < 1 / dt:
        text.check_count(promised, table.shape[0], start)
    step = {"step": "read samples beyond the nominal duration", "samples": extra}
    sides = [orientation.partition(";") for orientation in orientations]
    steps = (step,) if extra > 0 else ()
    shared = form.Channel(max(table.shape[0], promised), dt, table, steps=steps).saying(
        _facts(facts)
    )
    # "rumbo;orientacion": the sense of a vertical stands behind it
    found = form.in_columns(shared, table, [side[0].strip() for side in sides])
    peaks = _list(facts, r"acel\. max\.(?!.*muestra)")
    peaks += [""] * (len(sides) - len(peaks))
    return [
        with_checked_peak(
            channel.saying({"sense": side[2].strip()}),
            StatedPeak(peak, "gal"),
            text.name,
            text.cut_short,
        )
        for channel, side, peak in zip(found, sides, peaks, strict=False)
    ]


def _first_row(text: TextFile, start: int) -> int:
    """Return the first line of numbers, below rulers and titles if there are any."""
    titles = text.lines(start, start + _MAX_TITLES)
    rulers = [start + i for i, line in enumerate(titles) if _RULER.match(line)]
    for line in range(max(rulers, default=start - 1) + 1, start + _MAX_TITLES):
        if are_numbers(numbers_of(text.line(line))):
            return line
    text.fail("no row of samples below this line; the file is cut short", start - 1)


def _list(facts: dict[str, str], key: str) -> list[str]:
    """Return the values ``/a/b/c`` of the first six channels, then those of the others; ``key`` is a pattern."""
    values = [value for name, value in facts.items() if re.match(key, name)]
    return [
        part.strip() for value in values for part in value.split("/") if part.strip()
    ]


def _start(facts: dict[str, str]) -> UTCDateTime | None:
    """Return the time of the first sample, on the day of the earthquake or the one beside it.

    Where the time of the earthquake is not known it is taken to be of that day.
    """
    day = facts["fecha del sismo"]
    start = time_of(f"{day} {facts['hora de la primera muestra']}")
    origin = time_of(f"{day} {facts['hora epicentro']}")
    if start is None or origin is None:
        return start
    late = start - origin
    return start + (
        86400 if late < -_HALF_A_DAY else -86400 if late > _HALF_A_DAY else 0
    )


def _facts(facts: dict[str, str]) -> dict[str, object]:
    """Coordinates, station and earthquake by the keys of the header."""
    stated = facts["coordenadas de la estacion"]
    coordinates = re.findall(r"(\d+(?:\.\d+)?)\s*(LAT|LONG)\.?\s*([NSEW])", stated)
    place = {
        "latitude" if axis == "LAT" else "longitude": float(value)
        * (-1 if side in "SW" else 1)
        for value, axis, side in coordinates
    }
    magnitudes = re.findall(
        r"M\w*\s*=\s*(\d+(?:\.\d+)?)", facts.get("magnitud(es)", "")
    )
    magnitudes = magnitudes or re.findall(r"=\s*(\d\.\d)", facts["magnitud"])
    return {
        "start_time": _start(facts),
        "unit": facts["unidades de los datos"].split("(")[0],
        "station": facts["clave de la estacion"],
        "station_name": facts["nombre de la estacion"],
        "earthquake": f"{facts['fecha del sismo']} {facts['hora epicentro']}".strip(),
        "magnitude": max(map(float, magnitudes), default=None),
        **place,
    }


FORMAT = form.Format(
    "UNAM", form.headed(None, _TITLE, within=30), _parse, encoding="latin-1"
)
