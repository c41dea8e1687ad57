"""The documentation's site as browsers show it: for every reader, on a desk and on a phone, light and dark."""

from pathlib import Path

import pytest

from .browsers import barriers

pytestmark = pytest.mark.slow


def pages_of(site: Path) -> list[Path]:
    pages = sorted(page for page in site.rglob("*.html") if "_static" not in page.parts)
    assert len(pages) > 60
    return pages


@pytest.mark.parametrize(
    ("width", "dark"), [(1400, False), (1400, True), (390, False), (390, True)]
)
def test_readers_of_every_kind_can_use_the_site(browser, site, width, dark):
    for page in pages_of(site):
        browser.open(page, width, 900, dark=dark)
        assert barriers(browser) == [], page.name
        assert browser.run("document.documentElement.scrollWidth <= innerWidth"), page.name
