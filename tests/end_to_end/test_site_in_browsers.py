"""The documentation's site as browsers show it: for every reader, on a desk and on a phone, light and dark."""

from importlib.util import find_spec
from pathlib import Path

import pytest

pytestmark = pytest.mark.slow


def pages_of(site: Path) -> list[Path]:
    pages = sorted(page for page in site.rglob("*.html") if "_static" not in page.parts)
    assert len(pages) > 60
    return pages


@pytest.mark.parametrize(
    ("width", "dark"), [(1400, False), (1400, True), (390, False), (390, True)]
)
def test_readers_of_every_kind_can_use_the_site(browser, site, width, dark):
    axe = find_spec("axe_core_python")
    if axe is None or axe.origin is None:
        pytest.skip("axe-core-python is not installed")
    script = (Path(axe.origin).parent / "axe.min.js").read_text(encoding="utf-8")
    for page in pages_of(site):
        browser.open(page, width, 900, dark=dark)
        browser.run(f"(() => {{ {script} }})() || 1")
        found = browser.run(
            "axe.run().then(found => found.violations.map(one => [one.id, one.nodes[0].html]))"
        )
        assert found == [], page.name
        assert browser.run("document.documentElement.scrollWidth <= innerWidth"), page.name
