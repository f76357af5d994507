"""The live page as a user sees it: handles, fields, buttons, by role and name."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

import pytest
from playwright.sync_api import Locator, Page, expect

import equipoise as eq
from equipoise import Machine

ROOT = Path(__file__).parents[2]
SCREENSHOTS = ROOT / "build" / "screenshots"
AXE = ROOT / "page" / "node_modules" / "axe-core" / "axe.min.js"
FITS = "document.documentElement.scrollWidth <= document.documentElement.clientWidth"
"""Nothing is to be moved from side to side."""
TWO_FRAMES = "new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))"
"""The first may be under way already."""
LONGEST = 60
"""s that an answer may take on a processor that others keep busy."""
OVER_A_SOCKET = pytest.mark.parametrize("address", ["socket"], indirect=True)
"""Of a test of the line between page and server, or of what a worker loads from elsewhere."""
PUBLISHED = "https://cdn.jsdelivr.net/pyodide/"
"""Where a worker looks for packages that its site lacks: Clarabel, without which it can do."""
NUMBER = re.compile(r"[-−]?\d+(?:\.\d+)?")


@dataclass(frozen=True)
class Live:
    """A live page.  Lengths in mm, places on the screen in pixels."""

    page: Page

    @classmethod
    def open(cls, page: Page, address: str) -> Live:
        """Open the address and wait for the machine, and for everything to be in its place."""
        page.goto(address)
        live = cls(page)
        joint = page.locator("[data-kind=point]").first  # whatever its language calls it
        expect(joint).to_have_attribute("aria-valuetext", re.compile("mm"), timeout=LONGEST * 1000)
        live.settled()
        page.evaluate("new Promise(done => setTimeout(() => requestAnimationFrame(done), 50))")
        return live

    def settled(self) -> None:
        """Wait until the page shows all that there is to what was done last."""
        root = self.page.locator(".equipoise")
        expect(root).to_have_attribute("data-settled", "", timeout=LONGEST * 1000)

    def painted(self) -> None:
        """Wait until a frame shows what was turned or sized before, for which nothing is asked."""
        self.page.evaluate(TWO_FRAMES)

    # -- parts of it -------------------------------------------------------------------------------

    def button(self, name: str) -> Locator:
        return self.page.get_by_role("button", name=name)

    def joint(self, name: str) -> Locator:
        return self.page.get_by_role("slider", name=f"Joint {name}", exact=True)

    def mass(self, link: str) -> Locator:
        return self.page.get_by_role("slider", name=f"Centre of mass of {link}", exact=True)

    def field(self, name: str) -> Locator:
        return self.page.get_by_role("textbox", name=name, exact=True)

    def status(self, text: str) -> Locator:
        """Return what is said of the last question, if the text is in it."""
        return self.page.get_by_role("status").filter(has_text=text)

    # -- what is read from it ----------------------------------------------------------------------

    def place(self, handle: Locator) -> tuple[float, float]:
        """Return where the page says that a handle is, mm."""
        self.settled()
        x, y = NUMBER.findall((handle.get_attribute("aria-valuetext") or "").replace("−", "-"))
        return float(x), float(y)

    def comes_to(self, handle: Locator, place: tuple[float, float], within: float) -> None:
        """The page says that a handle is at a place, mm."""
        assert self.place(handle) == pytest.approx(place, abs=within)

    def spot(self, handle: Locator) -> tuple[float, float]:
        """Return where a handle is on the screen, pixels."""
        self.settled()
        box = handle.bounding_box()
        assert box is not None
        return box["x"] + box["width"] / 2, box["y"] + box["height"] / 2

    def findings(self) -> list[str]:
        """Return what axe finds, of a report too."""
        if self.page.locator(".equipoise").count():
            self.settled()
        self.page.evaluate(AXE.read_text(encoding="utf-8"))
        options = "{resultTypes: ['violations'], preload: false}"
        result = self.page.evaluate(f"axe.run(document, {options})")
        return [
            f"{item['id']}: {item['help']}: {[node['html'][:200] for node in item['nodes'][:3]]}"
            for item in result["violations"]
        ]

    def download(self, name: str) -> tuple[str, str]:
        """Choose one of the downloads, and return its file's name and text."""
        self.settled()
        self.page.get_by_title("Download", exact=True).click()
        with self.page.expect_download() as coming:
            self.button(name).click()
        return coming.value.suggested_filename, coming.value.path().read_text(encoding="utf-8")

    def machine(self) -> Machine:
        """Return the machine of the model that the page gives as a file."""
        return eq.loads(self.download("Download model")[1])

    # -- what is done to it ------------------------------------------------------------------------

    def type(self, field: Locator, text: str) -> None:
        field.fill(text)
        field.press("Enter")
        self.settled()

    def drag(self, handle: Locator, *ways: tuple[float, float]) -> None:
        """Drag a handle with the mouse by each of the ways from where it was, and let it go."""
        handle.scroll_into_view_if_needed()
        x, y = self.spot(handle)
        mouse = self.page.mouse
        mouse.move(x, y)
        mouse.down()
        for dx, dy in ways:
            mouse.move(x + dx, y + dy, steps=10)
            self.page.wait_for_timeout(100)
        mouse.up()
        self.settled()

    def drop(
        self, name: str, text: str, times: int = 1, beside: tuple[str, str] = ("", "")
    ) -> None:
        """Drop a file on the page, of a text that is repeated, and another one beside it."""
        make = """([name, text, times, [other, more]]) => {
            const files = new DataTransfer();
            if (other) files.items.add(new File([more], other, { type: "text/csv" }));
            files.items.add(new File([text.repeat(times)], name, { type: "application/toml" }));
            return files;
        }"""
        files = self.page.evaluate_handle(make, [name, text, times, beside])
        for event in ("dragenter", "dragover", "drop"):
            self.page.locator(".equipoise").dispatch_event(event, {"dataTransfer": files})
