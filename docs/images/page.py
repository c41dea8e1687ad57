"""Take the picture of the assessment as one page, by Chromium: a vase on its pedestal, with the default motions.

.venv/bin/python docs/images/page.py [folder of fetched records]
"""

import base64
import sys
import time
from pathlib import Path
from tempfile import TemporaryDirectory

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))

from rockfrag.cli.main import main
from tests.end_to_end.browsers import ANSWERED, Chromium

OBJECT = ("--width", "22cm", "--height", "68cm", "--mass", "18kg")
PLACE = ("--pedestal", "40cm", "90cm", "--pga", "0.25g", "--return-period", "475")
LONGEST_WAIT_S = 240


def take(records: str, picture: Path) -> None:
    """Write the page, open it without a window, and keep what it shows when it has answered."""
    with TemporaryDirectory() as folder, Chromium() as browser:
        page = Path(folder) / "assess.html"
        call = ["app", "--name", "Vase", *OBJECT, *PLACE, "--records", records]
        if main([*call, "--output", str(page)]):
            raise SystemExit("the page could not be written")
        browser.open(page, 1280, 900)
        until = time.monotonic() + LONGEST_WAIT_S
        while not browser.run(ANSWERED) and time.monotonic() < until:
            time.sleep(0.5)
        time.sleep(2)
        shot = browser._ask("Page.captureScreenshot", format="png")
        picture.write_bytes(base64.b64decode(shot["data"]))


if __name__ == "__main__":
    folder = sys.argv[1] if len(sys.argv) > 1 else "resources/records"
    take(folder, Path(__file__).with_name("page.png"))
