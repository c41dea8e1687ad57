"""The report on paper: ``python -m rockfrag.report.pdf config/config.yaml`` prints a study's page as PDF.

A page is laid out by a browser, so a browser prints it: Chromium, Chrome or Edge without a window.
"""

import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from rockfrag.base.errors import InputError
from rockfrag.base.files import whole_file
from rockfrag.stages.running import results_folder
from rockfrag.study.loading import load_any

BROWSERS = (
    "chromium",
    "chromium-browser",
    "google-chrome",
    "google-chrome-stable",
    "msedge",
)
"""Programs that print without a window, the first one found is taken."""

_PATIENCE = 300.0  # seconds that a browser may take


def print_page(page: Path) -> Path:
    """Print a page to a PDF beside it; this needs a browser that prints.

    Parameters
    ----------
    page : path of the HTML file

    Returns
    -------
    Path of the PDF.
    """
    if not page.is_file():
        raise InputError(f"{page}: there is no report yet; run the study first.")
    browser = next((path for name in BROWSERS if (path := shutil.which(name))), None)
    if browser is None:
        raise InputError(
            f"No browser that prints was found ({', '.join(BROWSERS)}); open {page} in any browser and print it "
            "from there: every chapter will be on paper."
        )
    target = page.with_suffix(".pdf")
    with tempfile.TemporaryDirectory() as profile, whole_file(target) as part:
        command = [
            *(browser, "--headless=new", "--disable-gpu", "--no-pdf-header-footer"),
            *(f"--user-data-dir={profile}", f"--print-to-pdf={part}"),
            # Chromium has no sandbox for the administrator, as in a container
            *(["--no-sandbox"] if hasattr(os, "geteuid") and os.geteuid() == 0 else []),
            page.resolve().as_uri(),
        ]
        try:
            subprocess.run(command, capture_output=True, check=True, timeout=_PATIENCE)
        except (OSError, subprocess.SubprocessError):
            # what it left is no page
            part.write_bytes(b"")
        if not part.read_bytes().startswith(b"%PDF"):
            raise InputError(
                f"{browser} did not print {page}; open it in any browser and print it from there."
            )
    return target


def main() -> int:
    """Print the report of the study that is named."""
    try:
        if len(sys.argv) != 2:
            raise InputError("Name one study, such as config/config.yaml.")
        target = print_page(results_folder(load_any(sys.argv[1])) / "report.html")
    except InputError as error:
        print(error, file=sys.stderr)
        return 2
    print(f"printed: {target}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
