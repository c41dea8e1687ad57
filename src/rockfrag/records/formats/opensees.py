"""OpenSees Path series in a Tcl script: ``timeSeries Path 1 -dt 0.02 -values {…} -factor 9.81``.

The values stand in the script, or in the file that ``-filePath`` names beside it. A comment such as ``#
acceleration in m/s2`` states the unit of the values times the factor; OpenSees itself knows none.
Older scripts say ``Series -dt .02 -filePath elcentro.txt -factor 1``.
"""

import re
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from rockfrag.base.errors import InputError
from rockfrag.records.parsing.format import Channel, Format, headed
from rockfrag.records.parsing.number_fields import NumberError, parse_separated
from rockfrag.records.parsing.quantities import TO_SI, canonical_unit
from rockfrag.records.parsing.text_file import TextFile, read_text
from rockfrag.records.parsing.writing import Written, text_writer

_SERIES = re.compile(r"^[^#]*?(?:\btimeSeries\s+[\"']?Path\b|[{\"]\s*Series\s+-)", re.I)
_UNIT = re.compile(
    rb"(?im)^[ \t]*#.*\bacceleration\b.*?\bin[ \t]+(?P<unit>[^\s,]+)(?:,[ \t]*(?P<count>\d+)[ \t]+samples)?"
)
_OPTION = r"-{name}\s+(?:\{{(?P<list>[^{{}}]*)\}}|\"(?P<quoted>[^\"]*)\"|(?P<word>[^\s{{}}\"]+))"


def _parse(text: TextFile) -> Iterator[Channel]:
    """Yield the Path time series of a script, in the unit that a comment states."""
    unit = _UNIT.search(text.data)
    stated = (
        canonical_unit(unit["unit"].decode("ascii", errors="replace")) if unit else ""
    )
    promised = int(unit["count"]) if unit and unit["count"] else None
    for first, stop in text.parts(_SERIES):
        yield _series(text, first, stop, stated, promised)


def _series(
    text: TextFile, line: int, stop: int, unit: str, promised: int | None
) -> Channel:
    """The channel of a Path time series of a script.

    Parameters
    ----------
    text : the script
    line, stop : where the series begins, and the next one
    unit : that a comment states, empty without one
    promised : number of samples that it states
    """
    script = _command(text, line, stop)
    tag = re.search(r"Path[\"']?\s+(\w+)", script, re.I)
    step = _number(text, line, script, "dt")
    if step is None:
        text.fail(
            "the Path series states no -dt; a series of -time or -fileTime is not read",
            line,
        )
    dt, factor = text.interval(step, line), _number(text, line, script, "factor")
    scale = 1.0 if factor is None else factor
    samples = scale * _values(text, line, script)
    if promised is not None and samples.size != promised:
        text.fail(
            f"the comment promises {promised} samples but {samples.size} follow; "
            "the file is cut short, or its comment is wrong",
            line,
        )
    known = {"component": tag[1] if tag else "", "factor": scale}
    return Channel(samples.size, dt, samples, unit if unit in TO_SI else "").saying(
        known
    )


def files_named(script: Path) -> list[Path]:
    """Return the files beside a script in which it says that values stand.

    Parameters
    ----------
    script : path of what may be a script

    Returns
    -------
    The paths, whether or not there are such files; none where nothing can be read.
    """
    try:
        words = read_text(script).data.decode("latin-1")
    except InputError:
        return []
    named = re.finditer(_OPTION.format(name="filePath"), words, re.I)
    return [script.parent / _said(match) for match in named]


def _command(text: TextFile, line: int, stop: int) -> str:
    """Return the whole command of a series: until braces close, with lines that a backslash joins."""
    ended = stop < len(text) or text.data.endswith(b"\n")
    script = text.body(line, stop).decode("latin-1") + ("\n" if ended else "")
    for end in re.finditer("\n", script):
        whole = script[: end.start()]
        if whole.count("{") <= whole.count("}") and not whole.endswith("\\"):
            return whole.replace("\\\n", " ")
    if not script.endswith("\n") or script.endswith("\\\n"):
        text.fail(
            "the Path series ends with the file and not with its line, and its -factor may be cut off; "
            "end the last line if the file is whole",
            line,
        )
    return script


def _values(text: TextFile, line: int, script: str) -> NDArray[np.float64]:
    """Samples that a script lists, or that a file beside it holds."""
    listed, file = _option(script, "values"), _option(script, "filePath")
    if listed is not None:
        body, where = listed.encode("latin-1"), text.name
        below = text.body(line)
        first = line + below.count(b"\n", 0, max(0, below.find(body)))
    elif file is not None:
        path = Path(text.name).parent / file
        body, where, first = read_text(path).data, str(path), 0
    else:
        text.fail("the Path series has neither -values nor -filePath", line)
    try:
        values = parse_separated(body)
    except NumberError as error:
        raise InputError(f"{where}, line {first + error.line + 1}: {error}.") from None
    if values.size == 0:
        text.fail("the Path series has no values; the file is cut short", line)
    return values


def _option(script: str, name: str) -> str | None:
    """What stands behind an option of a script, None if it is not there."""
    match = re.search(_OPTION.format(name=name), script, re.I)
    return _said(match) if match else None


def _said(option: re.Match[str]) -> str:
    """What stands behind an option that was found."""
    return next(group for group in option.groups() if group is not None)


def _number(text: TextFile, line: int, script: str, name: str) -> float | None:
    """The number behind an option of a script, None if it is not there; ``line``: of messages."""
    words = _option(script, name)
    if words is None:
        return None
    problem = f"-{name} is {words[:40]!r}, which is no number; write its value into the script"
    value = text.number(words, problem, line)
    return value if np.isfinite(value) else text.fail(problem, line)


FORMAT = Format("OPENSEES", headed(None, _SERIES, within=200), _parse)


def _text(trace: Written) -> str:
    """Text of a script with one Path time series."""
    header = [
        f"# acceleration in {trace.unit}, {len(trace.samples)} samples",
        f"timeSeries Path 1 -dt {trace.dt} -values {{",
    ]
    rows = [" ".join(map(str, row)) for row in trace.rows(5)]
    return "\n".join([*header, *rows, "}", ""])


write = text_writer(_text)
"""Write one trace as a Path series with its unit in a comment; OpenSees can ``source`` the file."""
