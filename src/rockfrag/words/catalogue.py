"""Catalogues of texts, one file a language, and what says a finding in one of them."""

import json
import math
import re
from collections.abc import Iterable, Mapping
from functools import lru_cache
from pathlib import Path
from typing import Any

from rockfrag.base.errors import InputError
from rockfrag.words.findings import Finding, Form, Listed, Number, Value
from rockfrag.words.numbers import limit_percent, significant, whole_number

TEXTS = Path(__file__).with_name("texts")
"""Folder of the catalogues; the name of a file is that of its language."""

FIRST = "en"
"""Language of a text that another catalogue lacks."""

_PLACE = re.compile(r"\{(\w+)\}")
_DIGITS = {Form.TWO: 2, Form.THREE: 3, Form.FOUR: 4}

SURE, LEAST = 0.995, 1e-5
"""Fractions from which, and up to which, no digits are said [-]."""


def languages() -> list[str]:
    """Languages that can be said, the first one first.

    Returns
    -------
    Names of the languages, such as ``en``.
    """
    found = sorted(path.stem for path in TEXTS.glob("*.json"))
    return sorted(found, key=lambda name: name != FIRST)


def formatter() -> str:
    """Return the script that says findings in a page, by the same texts and rules.

    Returns
    -------
    JavaScript.
    """
    return Path(__file__).with_name("catalogue.js").read_text(encoding="utf-8")


class Catalogue:
    """Texts of one language.

    Attributes
    ----------
    language : its name, such as ``en``
    texts : texts by their ids; a text with plural forms is a mapping of the forms
    """

    def __init__(self, language: str, texts: Mapping[str, Any]) -> None:
        self.language = language
        self.texts = texts

    def text(self, id: str, number: int | None = None) -> str:
        """Return a text; of one with plural forms the form of a number."""
        found = self.texts[id]
        if isinstance(found, str):
            return found
        forms: Mapping[str, str] = found
        return forms.get(self._form_of(number), forms["other"])

    def _form_of(self, number: int | None) -> str:
        forms: Mapping[str, list[int]] = self.texts["plural"]
        return next((name for name, of in forms.items() if number in of), "other")

    def say(self, value: Value) -> str:
        """Say a value as it stands within a sentence."""
        if isinstance(value, Finding):
            return self._said(value)
        if isinstance(value, Number):
            return self._number(value)
        if isinstance(value, Listed):
            return self._listed([self.say(inner) for inner in value.values])
        return str(value)

    def sentence(self, value: Value) -> str:
        """Say a value with a capital letter first."""
        words = self.say(value)
        return words[:1].upper() + words[1:]

    def lines(self, values: Iterable[Value]) -> list[str]:
        """Say each value in a line of its own."""
        return [self.sentence(value) for value in values]

    def paragraph(self, values: Iterable[Value]) -> str:
        """Say values as sentences, one after the other."""
        return " ".join(self.lines(values))

    def _said(self, found: Finding) -> str:
        """Words of a finding: its text with its values in their places."""
        values = dict(found.values)
        number = values.get("n")
        text = self.text(found.id, number if isinstance(number, int) else None)
        return _PLACE.sub(lambda place: self.say(values[place[1]]), text)

    def _listed(self, words: list[str]) -> str:
        """Words one after the other with commas, and "and" before the last."""
        if len(words) < 2:
            return "".join(words)
        return f"{', '.join(words[:-1])} {self.text('and')} {words[-1]}"

    def _number(self, number: Number) -> str:
        """A number in the language, in the form that it asks for."""
        value, form = number.value, number.form
        if not math.isfinite(value):
            return self.text("unknown")
        if form == Form.PERCENT:
            return self._percent(value)
        if form == Form.ORDINAL:
            return self._ordinal(int(value))
        if form == Form.WHOLE:
            return whole_number(value)
        if form == Form.LIMIT:
            return self._local(limit_percent(value))
        return self._local(significant(value, _DIGITS[form]))

    def _percent(self, value: float) -> str:
        """A probability [-] in per cent; next to nothing and nearly all are said so."""
        if 0 < value < LEAST:
            return self.text("less_than").format(value=self._local("0.001"))
        if SURE < value < 1:
            return self.text("more_than_99")
        return f"{self._local(significant(100 * value, 2 if value < 1 else 3))} %"

    def _ordinal(self, value: int) -> str:
        """An ordinal number in words, or in digits with its ending."""
        names, endings = self.texts["ordinals"], self.texts["ordinal_endings"]
        if value < len(names):
            return str(names[value])
        last = 0 if value % 100 in (11, 12, 13) else value % 10
        return f"{value}{endings[last] if last < len(endings) else endings[0]}"

    def _local(self, digits: str) -> str:
        return digits.replace("-", "−").replace(".", str(self.texts["decimal"]))


@lru_cache(maxsize=8)
def _read(folder: Path, language: str) -> Catalogue:
    """Texts of a language; those that it lacks are of the first language."""
    texts = json.loads((folder / f"{FIRST}.json").read_text(encoding="utf-8"))
    if language != FIRST:
        own = (folder / f"{language}.json").read_text(encoding="utf-8")
        texts |= json.loads(own)
    return Catalogue(language, texts)


def catalogue(language: str = FIRST) -> Catalogue:
    """Return the texts of a language; what its file lacks is said in the first language.

    Parameters
    ----------
    language : name of a file of texts, such as ``it``

    Returns
    -------
    The :class:`Catalogue`; a language without a file is an InputError.
    """
    if language not in languages():
        raise InputError(
            f"--language: there are no texts in {language[:20]!r}; known are {', '.join(languages())}."
        )
    return _read(TEXTS, language)
