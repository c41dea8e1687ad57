"""Findings are said by one file a language, alike on the command line, on pages and in the one-file page."""

import json
import random
import re
import shutil
import subprocess
from pathlib import Path

import pytest

from rockfrag.assess.app.writing import page_of as app_of
from rockfrag.assess.motions import MotionSet
from rockfrag.assess.request import make_request
from rockfrag.assess.texts import Text
from rockfrag.base.errors import InputError
from rockfrag.cli.assess_commands import form_of
from rockfrag.cli.main import main
from rockfrag.web import driver_text
from rockfrag.words import catalogue as catalogues
from rockfrag.words.catalogue import TEXTS, catalogue, formatter, languages
from rockfrag.words.findings import Finding, Form, Number, as_data, finding, listed
from rockfrag.words.numbers import kept_together

SOURCE = Path(catalogues.__file__).parents[1]
PLACES = re.compile(r"\{(\w+)\}")
NODE = shutil.which("node")
FAMILIES = (
    r"(source|basis|measurement|assumed|why|word|meaning|shell|of|slide|live)_\w+"
    r"|\w+_usual"
)
"""Ids that are made of the name of what they are of."""


def own(language: str) -> dict:
    """Texts of a language's own file."""
    return json.loads((TEXTS / f"{language}.json").read_text(encoding="utf-8"))


def forms(text) -> list[str]:
    """The forms of a text."""
    return [text] if isinstance(text, str) else list(text.values())


@pytest.mark.parametrize("language", languages())
def test_every_language_has_every_text_with_the_same_places(language):
    english, texts = own("en"), own(language)
    faults = re.findall(r"^  \"(.+)\",$", driver_text(), re.MULTILINE)
    # why a body cannot stand is said by the module in English
    known = set(english) | {f"fault_{i}" for i in range(1, len(faults) + 1)}
    assert set(texts) | set(english) >= set(english) and set(texts) <= known
    assert language == "en" or set(texts) == known
    for id, text in english.items():
        if id in ("plural", "ordinals", "ordinal_endings"):
            continue
        places = [set(PLACES.findall(form)) for form in forms(text)]
        for form in forms(texts[id]):
            # a form may say a number in a word
            assert set(PLACES.findall(form)) | {"n"} == set.union(*places) | {"n"}, id


def test_every_id_has_a_text_and_every_text_an_id_that_something_names():
    english = own("en")
    assert {str(id) for id in Text} <= set(english)
    files = [path for end in ("py", "js", "j2") for path in SOURCE.rglob(f"*.{end}")]
    said = "\n".join(path.read_text(encoding="utf-8") for path in files)
    others = set(english) - {str(id) for id in Text}
    every = "|".join(sorted(others, key=lambda id: (-len(id), id)))
    named = {*re.findall(rf"(?<=[\"'`._])(?=({every})\b)", said)}
    named |= {*re.findall(rf"\b(?=({every}):)", said)}
    for id in others - named:
        assert re.fullmatch(FAMILIES, id) or id.endswith("_refused"), id
    for id in Text:
        assert f"Text.{id.name}" in said or re.fullmatch(FAMILIES, id), id


def test_a_text_knows_no_branches():
    for language in languages():
        for id, text in own(language).items():
            for form in forms(text) if isinstance(text, str | dict) else []:
                assert "{%" not in str(form) and "{{" not in str(form), id


def test_numbers_have_as_many_digits_as_they_deserve_and_no_exponent():
    def said(value: float, form: Form) -> str:
        return catalogue().say(Number(value, form))

    assert said(200, Form.TWO) == "200" and said(1080, Form.THREE) == "1080"
    assert said(0.0897, Form.TWO) == "0.09" and said(0.30, Form.TWO) == "0.3"
    assert said(0.99998, Form.LIMIT) == "100" and said(0.9963, Form.LIMIT) == "99.6"
    assert said(-0.25, Form.TWO) == "−0.25" and said(12.4, Form.WHOLE) == "12"
    assert catalogue("it").say(Number(0.25, Form.TWO)) == "0,25"
    assert said(float("nan"), Form.TWO) == "unknown"
    assert said(float("inf"), Form.PERCENT) == "unknown"


def test_only_the_space_before_a_unit_keeps_a_line_together():
    said = "PGA 0.3 g, 5 % of 20 motions, 3 m/s² over 12 storeys, 7 cm/s per g"
    kept = said.replace("0.3 g", "0.3\u00a0g").replace("5 %", "5\u00a0%")
    kept = kept.replace("3 m/s²", "3\u00a0m/s²").replace("7 cm/s", "7\u00a0cm/s")
    assert kept_together(said) == kept


def test_plural_forms_follow_the_number():
    one, two = (finding(Text.EARTHQUAKES, n=n) for n in (1, 2))
    assert [catalogue().say(each) for each in (one, two)] == [
        "one earthquake",
        "2 earthquakes",
    ]
    assert catalogue("it").say(two) == "2 terremoti"


def some_value(rng: random.Random, depth: int = 0):
    """A random value of every kind, nested."""
    kind = rng.randrange(3 if depth > 2 else 5)
    if kind == 0:
        return rng.choice(["Venus <i>", "a {b}", "", "è"])
    if kind == 1:
        return rng.randrange(4)
    if kind == 2:
        size = 10 ** rng.uniform(-7, 5) * rng.choice([1, 1, 1, -1])
        form = rng.choice(list(Form))
        if form in (Form.PERCENT, Form.LIMIT):
            return Number(rng.choice([0.0, 1.0, rng.random(), rng.random() ** 9]), form)
        if form == Form.ORDINAL:
            return Number(rng.randrange(130), form)
        return Number(rng.choice([size, round(size, 2), 0.5, 2.5, 12.5]), form)
    if kind == 3:
        return listed([some_value(rng, depth + 1) for _ in range(rng.randrange(4))])
    about = {"what": some_value(rng, depth + 1), "cases": some_value(rng, depth + 1)}
    return Finding(Text.MEASURE_FIRST, tuple(about.items()))


@pytest.mark.skipif(NODE is None, reason="Node is not installed")
@pytest.mark.parametrize("language", languages())
def test_the_page_says_every_finding_as_the_package_does(language, tmp_path):
    rng = random.Random(3)
    values = [some_value(rng) for _ in range(2000)]
    data = {"texts": catalogue(language).texts, "values": [as_data(v) for v in values]}
    (tmp_path / "in.json").write_text(json.dumps(data))
    (tmp_path / "run.cjs").write_text(
        formatter()
        + "const { texts, values } = JSON.parse(require('fs').readFileSync(process.argv[2]));"
        "console.log(JSON.stringify(values.map(catalogue(texts).sentence)));"
    )
    command = [NODE, tmp_path / "run.cjs", tmp_path / "in.json"]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    assert json.loads(done.stdout) == catalogue(language).lines(values)


def test_a_language_that_is_one_more_file_reaches_command_line_page_and_report(
    own_records, tmp_path, monkeypatch, capsys
):
    """A third language, made of the first by marking every text."""
    folder = tmp_path / "texts"
    shutil.copytree(TEXTS, folder)
    plain = ("plural", "decimal", "ordinals", "ordinal_endings")
    third = {
        id: text if id in plain else {k: f"¿{v}" for k, v in text.items()}
        if isinstance(text, dict) else f"¿{text}"
        for id, text in own("en").items()
    }  # fmt: skip
    (folder / "xx.json").write_text(json.dumps(third), encoding="utf-8")
    assert "xx" not in languages()
    monkeypatch.setattr(catalogues, "TEXTS", folder)
    assert languages() == ["en", "it", "xx"]
    records = ["--record", str(own_records / "catalogue.csv")]
    shaking = ["--pga", "0.4g", "--return-period", "475", "--language", "xx"]
    options = ["assess", "--width", "30cm", "--height", "1m", *shaking, *records]
    assert main([*options, "--details", "--output", str(tmp_path / "out")]) == 0
    lines = [line for line in capsys.readouterr().out.splitlines() if line]
    assert len(lines) >= 8 and all(line.startswith("¿") for line in lines)
    # the report of one object: its title, its headings, its tables and what every page says
    report = (tmp_path / "out" / "the-object.html").read_text(encoding="utf-8")
    assert '<html lang="xx">' in report
    for words in ("¿What helps", "¿At other levels", "¿The answer", "¿Change", "¿PGA"):
        assert words in report, words
    # a gallery
    rows = "name,width,height\na,30 cm,1 m\nb,25 cm,1 m\n"
    (tmp_path / "gallery.csv").write_text(rows)
    gallery = ["assess", str(tmp_path / "gallery.csv"), *shaking, *records]
    assert main([*gallery, "--output", str(tmp_path / "out")]) == 0
    assert capsys.readouterr().out.startswith("¿2 objects")
    page = (tmp_path / "out" / "inventory.html").read_text(encoding="utf-8")
    assert "¿What ¿2 objects" in page or "¿What 2 objects risk together" in page


def test_the_one_file_page_has_every_language(made_motions, tmp_path, monkeypatch):
    folder = tmp_path / "texts"
    shutil.copytree(TEXTS, folder)
    third = {"language": "Third", "title": "¿Does it topple?"}
    (folder / "xx.json").write_text(json.dumps(third), encoding="utf-8")
    monkeypatch.setattr(catalogues, "TEXTS", folder)
    settings = {"width": "30 cm", "height": "1 m", "pga": "0.4 g"}
    made = made_motions(2)
    few = MotionSet(made, made, (), "made motions")
    page = app_of(few, form_of(settings, make_request(settings, "form")), made=True)
    data = json.loads(page.partition('id="data">')[2].partition("</script>")[0])
    assert list(data["texts"]) == ["en", "it", "xx"]
    # what it lacks is said in the first language
    assert data["texts"]["xx"]["title"] == "¿Does it topple?"
    assert data["texts"]["xx"]["width"] == "Width"


def test_a_language_without_a_file_is_refused_in_a_sentence(capsys):
    with pytest.raises(InputError, match="no texts in 'tlh'; known are en, it"):
        catalogue("tlh")
