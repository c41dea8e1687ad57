"""How a fact and its value are written in words: ``Sampling interval (s): 0.01``, ``dt=1/200 s``."""

import re

VALUE = r"(?:\d+[.,]\d+|\d+\.?|[.,]\d+)(?:[ed][+-]?\d+)?"
IS = (
    r"(?:[\s_]+(?P<behind>m?s|m?sec|[uμ]s|k?hz)(?![^\W\d_]))?[\s\"']*(?:\((?P<note>[^)]*)\)|\[(?P<note2>[^\]]*)\])?"
    r"[\s\"',]*(?P<sign>[=:]|\bis\b|\bes\b|\best\b)?[\s\"',]*"
)
# one part of a second, as in 1/200; no time of day and no other ratio
FRACTION = rf"(?>(?:1\s*/\s*)?{VALUE})(?!\s*[:/]\s*\d)"
UNIT_BEHIND_VALUE = r"\s*(?P<unit>°|[^\W\d_]+(?:\s*/\s*s\w*|\s+p[eo]r\s+s\w*)?)?"
NUMBER = re.compile(VALUE)
