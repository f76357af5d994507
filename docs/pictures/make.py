"""Make the pictures of README: a linkage that moves, a force before and after, page and report.

    make pictures

The first two are what `equipoise animate` and `equipoise balance --plot` write.  The others are
screenshots, for which Chromium is needed; `sources.json` keeps what they were taken of, so that a
test can say when they are stale.
"""

from __future__ import annotations

import json
import re
import subprocess
import sys
from hashlib import sha256
from html.parser import HTMLParser
from io import BytesIO
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from playwright.sync_api import Browser

HERE = Path(__file__).parent
ROOT = HERE.parents[1]
SOURCES = HERE / "sources.json"

MOVING, BALANCED, SERVED = "transplanter", "balance-crank", "yamashita-rig"
REPORTED = BALANCED
"""Examples that are shown."""
COLORS = 128
"""Of a screenshot: enough for lines and text, at a quarter of the bytes."""


def written(command: str, *words: str) -> str:
    """The file that a command writes, as text."""
    with TemporaryDirectory() as folder:
        out = Path(folder) / ("out.svg" if command == "animate" else "out.html")
        run = [sys.executable, "-m", "equipoise", command, *words, "-o", str(out)]
        subprocess.run(run, check=True, capture_output=True)
        return out.read_text(encoding="utf-8")


def linkage() -> str:
    """The linkage that moves, as SVG."""
    return written("animate", MOVING, "--force")


def balanced() -> str:
    """The shaking force before and after, as SVG."""
    with TemporaryDirectory() as folder:
        run = [sys.executable, "-m", "equipoise", "balance", BALANCED, "--plot", folder]
        subprocess.run(run, check=True, capture_output=True)
        return (Path(folder) / "force.svg").read_text(encoding="utf-8")


# -- what the screenshots were taken of ------------------------------------------------------------


class _Words(HTMLParser):
    """The words of a page, without its pictures' and without numbers."""

    def __init__(self, page: str) -> None:
        super().__init__()
        self.found: list[str] = []
        self.within = 0
        self.feed(page)

    def handle_starttag(self, tag: str, attrs: object) -> None:
        self.within += tag in ("svg", "style", "script")

    def handle_endtag(self, tag: str) -> None:
        self.within -= tag in ("svg", "style", "script")

    def handle_data(self, data: str) -> None:
        if not self.within:
            self.found += re.findall(r"[^\W\d_]{2,}", data)


def sources() -> dict[str, str]:
    """A digest of what each screenshot shows: the words of the report, the sources of the page."""
    words = " ".join(_Words(written("report", REPORTED)).found)
    files = sorted((ROOT / "page" / "src").rglob("*.*"))
    shown = (file for file in files if "interactive" not in file.parts)  # another page than this
    page = "".join(file.read_text(encoding="utf-8") for file in shown)
    return {"report.png": _digest(words), "page.png": _digest(page)}


def _digest(text: str) -> str:
    return sha256(text.encode()).hexdigest()[:16]


# -- making them -----------------------------------------------------------------------------------


def _reduced(shot: bytes) -> bytes:
    """A screenshot in few colours."""
    from PIL import Image

    image = Image.open(BytesIO(shot)).convert("RGB").quantize(COLORS, dither=Image.Dither.NONE)
    out = BytesIO()
    image.save(out, "png", optimize=True)
    return out.getvalue()


def _page(browser: Browser) -> bytes:
    from support.chromium import serving

    view = browser.new_page(viewport={"width": 1280, "height": 800}, reduced_motion="reduce")
    with serving(SERVED) as address:
        view.goto(address)
        view.wait_for_timeout(4000)
        return view.screenshot()


def _report(browser: Browser) -> bytes:
    view = browser.new_page(viewport={"width": 1000, "height": 1150}, reduced_motion="reduce")
    view.set_content(written("report", REPORTED))
    view.wait_for_timeout(500)
    return view.screenshot()


def main() -> None:
    sys.path.insert(0, str(ROOT / "tests"))
    from support.chromium import chromium, path_of_chromium

    (HERE / "linkage.svg").write_text(linkage(), encoding="utf-8")
    (HERE / "balanced.svg").write_text(balanced(), encoding="utf-8")
    if path_of_chromium() is None:
        sys.exit("pictures: made linkage.svg and balanced.svg only; the screenshots need Chromium")
    with chromium() as browser:
        (HERE / "page.png").write_bytes(_reduced(_page(browser)))
        (HERE / "report.png").write_bytes(_reduced(_report(browser)))
    SOURCES.write_text(json.dumps(sources(), indent=2) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
