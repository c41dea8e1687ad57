"""How long a user of the assessment's page waits, in Chromium, and what it takes of memory.

``python benchmarks/app.py`` writes the page with the default motions, opens it from its file and types a width;
``make bench`` runs it too.  Seconds go from opening the file, and then from the key stroke.
"""

import sys
import tempfile
import time
from pathlib import Path

import psutil

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "tests"))

from end_to_end.browsers import BROWSERS, Chromium  # noqa: E402
from rockfrag.cli import main  # noqa: E402

STAGES = ("first", "complete")
"""The first figures, and all of the answer."""

TYPE = """(() => {
  const field = document.getElementById("field-width");
  field.value = "30 cm";
  field.dispatchEvent(new Event("input"));
})()"""


def app_seconds() -> dict[str, float]:
    """Return the seconds until each stage, of the first answer and of a further one, and the memory [MB]."""
    if BROWSERS["chromium"][1] is None:
        return {}
    found: dict[str, float] = {}
    with tempfile.TemporaryDirectory() as folder, Chromium() as browser:
        page = Path(folder) / "assess.html"
        main(["app", "--records", str(ROOT / "resources/records"), "--output", str(page)])
        browser.open(page)
        for name in ("first answer", "further answer"):
            _wait(browser)
            told = browser.run("({...document.body.dataset})")
            found |= {f"{name}: {stage}": float(told[stage]) / 1000 for stage in STAGES}
            browser.run(TYPE)
            time.sleep(0.5)
        family = psutil.Process(browser._process.pid).children(recursive=True)
        pages = [each for each in family if "--type=renderer" in each.cmdline()]
        found["memory of the page [MB]"] = max(each.memory_info().rss for each in pages) / 1e6
    return found


def _wait(browser: Chromium) -> None:
    while browser.run("document.body.dataset.stage") != "complete":
        time.sleep(0.02)


if __name__ == "__main__":
    for name, value in app_seconds().items():
        print(f"{name}: {value:.2f}")
