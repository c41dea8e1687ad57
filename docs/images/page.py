"""Take the picture of the assessment as one page, by Chromium: a round vase, with the default motions.

.venv/bin/python docs/images/page.py [folder of fetched records]
"""

import shutil
import subprocess
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

from rockfrag.cli.main import main

OBJECT = ("--width", "22cm", "--height", "68cm", "--mass", "18kg")
PLACE = ("--pedestal", "40cm", "90cm", "--pga", "0.25g", "--return-period", "475")
WAIT_MS = 60_000  # of the page's own time: what it computes ends long before


def take(records: str, picture: Path) -> None:
    """Write the page, open it without a screen, and keep what it shows."""
    chromium = shutil.which("chromium") or shutil.which("google-chrome") or "chromium"
    with TemporaryDirectory() as folder:
        page = Path(folder) / "assess.html"
        call = ["app", "--name", "Vase", *OBJECT, *PLACE, "--records", records]
        if main([*call, "--output", str(page)]):
            raise SystemExit("the page could not be written")
        subprocess.run(
            [
                *(chromium, "--headless", "--no-sandbox", "--hide-scrollbars"),
                *("--window-size=1280,860", f"--virtual-time-budget={WAIT_MS}"),
                *(f"--screenshot={picture}", page.as_uri()),
            ],
            check=True,
            timeout=300,
            capture_output=True,
        )


if __name__ == "__main__":
    folder = sys.argv[1] if len(sys.argv) > 1 else "resources/records"
    take(folder, Path(__file__).with_name("page.png"))
