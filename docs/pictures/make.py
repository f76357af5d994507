"""Make the pictures of README, and screenshots for other pages of the documentation.

    make pictures

A linkage that moves and a force before and after are what `equipoise animate` and `equipoise
balance --plot` write.  The live page, a report, an interactive file and a notebook's cell are
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
EXPORTED = IN_NOTEBOOK = "yamashita-1"
"""Examples that are shown."""
AS_NOTEBOOKS = """<!doctype html><style>
body{font:13px/1.4 system-ui,sans-serif;margin:12px} table{font-size:12px;border-spacing:0}
th,td{padding:3px 6px}
</style>"""
"""As a notebook sets tables."""
COLORS = 128
"""Of a screenshot: enough for lines and text, at a quarter of the bytes."""


WRITTEN = {"animate": "out.svg", "export": "out.html", "report": "out.html"}


def written(command: str, *words: str) -> str:
    """The file that a command writes, as text."""
    with TemporaryDirectory() as folder:
        out = Path(folder) / WRITTEN[command]
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


def in_notebook() -> str:
    """What a notebook shows of a machine, as HTML."""
    import equipoise as eq

    html: str = eq.load(IN_NOTEBOOK)._repr_html_()
    return html


def sources() -> dict[str, str]:
    """A digest of what each screenshot shows: the words of report, interactive file and notebook,
    the sources of the live page.
    """
    files = sorted((ROOT / "page" / "src").rglob("*.*"))
    shown = (file for file in files if "interactive" not in file.parts)  # another page than this
    pages = {
        "report.png": written("report", REPORTED),
        "interactive.png": written("export", EXPORTED),
        "notebook.png": in_notebook(),
    }
    return {
        **{name: _digest(" ".join(_Words(page).found)) for name, page in pages.items()},
        "page.png": _digest("".join(file.read_text(encoding="utf-8") for file in shown)),
    }


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


def _interactive(browser: Browser) -> bytes:
    view = browser.new_page(viewport={"width": 1100, "height": 640}, reduced_motion="reduce")
    view.set_content(written("export", EXPORTED))
    view.wait_for_timeout(2000)
    return view.screenshot()


def _notebook(browser: Browser) -> bytes:
    view = browser.new_page(viewport={"width": 480, "height": 400}, reduced_motion="reduce")
    view.set_content(f"{AS_NOTEBOOKS}{in_notebook()}")
    view.wait_for_timeout(500)
    return view.screenshot(full_page=True)


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
        (HERE / "interactive.png").write_bytes(_reduced(_interactive(browser)))
        (HERE / "notebook.png").write_bytes(_reduced(_notebook(browser)))
    SOURCES.write_text(json.dumps(sources(), indent=2) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
