"""How long a user of the assessment's page waits in Chromium, and of the command; and the memory of the page.

``python benchmarks/app.py`` writes the page with the default motions, opens it from its file and types a width,
then a pedestal, a depth and a round base; ``make bench`` runs it too.  Seconds go from opening the file, and then
from the key stroke; those of the command from its start to its end.
"""

import json
import subprocess
import sys
import tempfile
import time
from functools import cache
from pathlib import Path

import psutil

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))

from rockfrag.cli.main import main  # noqa: E402
from tests.end_to_end.browsers import BROWSERS, Chromium  # noqa: E402

STAGES = ("first", "interval", "complete")
"""The first figures, with their interval, and all of the answer."""

OBJECT = ("--width=30cm", "--height=1.2m", "--pga=0.4g", "--return-period=475")
PEDESTAL = {"pedestal_width": "50 cm", "pedestal_height": "90 cm"}
WAITS = {
    "first answer": {},
    "further answer": {"width": "30 cm"},
    "on a pedestal": PEDESTAL,
    "in space": dict.fromkeys(PEDESTAL, "") | {"depth": "40 cm"},
    "round": {"depth": "", "round": True},
    "round on a pedestal": PEDESTAL,
}
"""What is typed before each answer."""

TYPE = """for (const [name, text] of Object.entries({fields})) {{
  const field = document.getElementById(`field-${{name}}`);
  if (text === true) field.checked = true;
  else field.value = text;
  field.dispatchEvent(new Event("input"));
}}"""


@cache
def app_seconds() -> dict[str, float]:
    """Return the seconds until each stage, of the first answer and of a further one, and the memory [MB]."""
    if BROWSERS["chromium"][1] is None:
        return {}
    found: dict[str, float] = {}
    with tempfile.TemporaryDirectory() as folder, Chromium() as browser:
        page = Path(folder) / "assess.html"
        main(
            ["app", "--records", str(ROOT / "resources/records"), "--output", str(page)]
        )
        browser.open(page)
        for name, fields in WAITS.items():
            browser.run(TYPE.format(fields=json.dumps(fields)))
            time.sleep(0.5)
            _wait(browser)
            told = browser.run("({...document.body.dataset})")
            found |= {f"{name}: {stage}": float(told[stage]) / 1000 for stage in STAGES}
        family = psutil.Process(browser._process.pid).children(recursive=True)
        pages = [each for each in family if "--type=renderer" in each.cmdline()]
        found["memory of the page [MB]"] = (
            max(each.memory_info().rss for each in pages) / 1e6
        )
        program = Path(sys.executable).with_name("rockfrag")
        command: list[str | Path] = [program, "assess", *OBJECT, "--output", folder]
        more: list[str]
        for name, more in (
            ("command", []),
            ("command, on a pedestal", ["--pedestal", "50cm", "90cm"]),
            ("command, in space", ["--depth", "40cm"]),
            ("command, round", ["--round"]),
            ("command, round on a pedestal", ["--round", "--pedestal", "50cm", "90cm"]),
        ):
            start = time.perf_counter()
            subprocess.run([*command, *more], cwd=ROOT, capture_output=True, check=True)
            found[name] = time.perf_counter() - start
    return found


def _wait(browser: Chromium) -> None:
    while browser.run("document.body.dataset.stage") != "complete":
        time.sleep(0.02)


if __name__ == "__main__":
    for name, value in app_seconds().items():
        print(f"{name}: {value:.2f}")
