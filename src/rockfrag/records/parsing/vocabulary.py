"""Words of records in the languages of networks and laboratories: one file a language, ``languages/es.json``.

A file lists, of each concept, the words that name it: ``*`` stands for any ending, a blank for blanks, hyphens
or underscores. Words are compared without accents and capitals.
"""

import json
import re
import unicodedata
from collections.abc import Mapping
from functools import cache
from importlib import resources

_LIKE = {"ı": "i", "−": "-", "‐": "-", "‑": "-", "–": "-", "—": "-", "’": "'", "′": "'"}
_LIKE |= {"⋅": "·", "∙": "·", "•": "·", "・": "·", "⁄": "/", "∕": "/", "✕": "×"}
_TABLE = str.maketrans(_LIKE)
OF_SPECTRA = re.compile(r"spe[ck]tr|spettr|спектр|谱|スヘクトル|\bfourier")
"""How words for spectra are spelled in all languages, to be searched in folded words."""
# scripts that are written without blanks between the words
_UNSPACED = re.compile(r"[\u1100-\u11ff\u3040-\u30ff\u3400-\u9fff\uac00-\ud7af]")


def folded(words: str) -> str:
    """Return words without accents, capitals, and signs that look alike: ``İvme (m/s²)`` is ``ivme (m/s2)``."""
    plain = unicodedata.normalize("NFKD", words.translate(_TABLE).lower())
    kept = "".join(c for c in plain if not unicodedata.combining(c))
    return kept.translate(_TABLE)


def spaced(words: str) -> str:
    """Return words with blanks for underscores and before inner capitals: ``accX_table`` is ``acc X table``."""
    return re.sub(r"(?<=[a-zа-я])(?=[A-ZА-Я])|_+", " ", words)


@cache
def languages() -> Mapping[str, Mapping[str, list[str]]]:
    """Return the words of each concept, by the name of the language in English."""
    folder = resources.files("rockfrag.records.parsing") / "languages"
    files = sorted(
        (file for file in folder.iterdir() if file.name.endswith(".json")),
        key=lambda file: file.name,
    )
    read = [json.loads(file.read_text(encoding="utf-8")) for file in files]
    return {words.pop("language"): words for words in read}


@cache
def alternatives(concept: str) -> str:
    """Return a pattern, without groups, of all words for a concept, to be searched in folded words."""
    known = {
        folded(word)
        for words in languages().values()
        for word in words.get(concept, ())
    }
    # of words that begin alike the longest is to be found
    found = sorted(known, key=lambda word: (-len(word), word))
    return f"(?:{'|'.join(map(_pattern_of, found))})"


def _pattern_of(word: str) -> str:
    """Pattern of a word of the vocabulary: ``*`` stands for any letters, a blank for none, one or a line."""
    letters = r"[\s_-]*".join(
        re.escape(part).replace(r"\*", r"[^\W\d_]*") for part in word.split()
    )
    if _UNSPACED.search(word):
        return letters
    return rf"(?<![^\W\d_]){letters}(?![^\W\d_])"


@cache
def words_for(concept: str) -> re.Pattern[str]:
    """Return the compiled pattern of the words for a concept."""
    return re.compile(alternatives(concept))


def without(concept: str, words: str) -> str:
    """Return words without the first that names a concept, in the spelling of the file."""
    for known in sorted(_unspaced_words(concept), key=len, reverse=True):
        if known in words:
            return words.replace(known, " ", 1)
    for part in words.split():
        if words_for(concept).fullmatch(folded(part).strip(".,:;-")):
            return words.replace(part, " ", 1)
    return words


@cache
def _unspaced_words(concept: str) -> list[str]:
    """Return the words for a concept in scripts without blanks."""
    every = (word for words in languages().values() for word in words.get(concept, ()))
    return [word for word in every if _UNSPACED.search(word)]
