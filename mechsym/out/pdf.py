"""A page as PDF, printed by the Chromium of the machine."""

import shutil
import subprocess
import tempfile
from pathlib import Path

from mechsym.errors import BadInput
from mechsym.files import write_bytes

NAMES = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome", "msedge")
_LONGEST = 120  # that printing may take [s]


def chromium() -> str:
    """Path of a Chromium. Raises BadInput: None is installed."""
    browser = next((path for path in map(shutil.which, NAMES) if path), None)
    if browser is None:
        way = "install one (Debian: apt-get install chromium), or open the HTML report and print it from any browser"
        raise BadInput(f"--pdf needs a Chromium or Chrome, and none is found; {way}")
    return browser


def to_pdf(text: str, path: Path) -> Path:
    """Print a page of HTML. Raises BadInput: there is no Chromium, or it does not print."""
    program = chromium()
    with tempfile.TemporaryDirectory() as folder:
        page, printed = Path(folder) / "report.html", Path(folder) / "report.pdf"
        page.write_text(text, encoding="utf-8")
        command = [
            program, "--headless", "--no-sandbox", "--disable-gpu", "--no-pdf-header-footer",
            f"--user-data-dir={folder}/profile", f"--print-to-pdf={printed}", page.as_uri(),
        ]  # fmt: skip
        way = "print the HTML report from a browser"
        try:
            done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=_LONGEST)
        except subprocess.TimeoutExpired:
            raise BadInput(f"{program} did not print within {_LONGEST} s; {way}") from None
        if not printed.exists():
            raise BadInput(f"{program} did not print ({' '.join(done.stderr.split())[-200:]}); {way}")
        return write_bytes(path, printed.read_bytes())
