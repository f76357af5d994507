"""A monkey on the live page: whatever it clicks, drags and types, the page lives and answers.

What a page reports as an error fails the test by itself.  Set EQUIPOISE_MONKEY to a number of
actions to play longer.
"""

from __future__ import annotations

import os
import random
from collections.abc import Callable
from contextlib import suppress

import pytest
from playwright.sync_api import Error, Page, expect

from browser.live import Live

ACTIONS = int(os.environ.get("EQUIPOISE_MONKEY", "80"))
TEXTS = ("", "0", "-1 mm", "50 mm", "1e9 m", "12 deg", "abc", "1,5 mm", "\u0663", "x" * 300)
KEYS = ("Tab", "Enter", "Escape", "ArrowUp", "ArrowLeft", "Control+z", "Control+y", "Space", "End")
SIZES = ((400, 700), (1280, 900), (1920, 1000))
LONGEST = 1000
"""ms that the monkey waits for one thing."""


def played(page: Page, chance: random.Random) -> None:
    """Do one thing, somewhere; what cannot be done there is left."""
    width, height = page.viewport_size["width"], page.viewport_size["height"]  # type: ignore[index]
    what = chance.choice(
        ("click", "button", "drag", "drag", "type", "type", "key", "scroll", "size")
    )
    x, y = chance.uniform(0, width), chance.uniform(0, height)
    if what == "click":
        page.mouse.click(x, y)
    elif what in {"button", "type"}:
        role = "button" if what == "button" else "textbox"
        found = [one for one in page.get_by_role(role).all() if one.is_visible()]  # type: ignore[arg-type]
        if found and what == "button":
            chance.choice(found).click(timeout=LONGEST)
        elif found:
            field = chance.choice(found)
            field.fill(chance.choice(TEXTS), timeout=LONGEST)
            field.press("Enter", timeout=LONGEST)
    elif what == "drag":
        handles = page.get_by_role("slider").all()
        box = chance.choice(handles).bounding_box(timeout=LONGEST) if handles else None
        page.mouse.move(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2) if box else None
        page.mouse.down()
        page.mouse.move(x, y, steps=3)
        page.mouse.up()
    elif what == "key":
        page.keyboard.press(chance.choice(KEYS))
    elif what == "scroll":
        page.mouse.wheel(0, chance.choice((-400, 400)))
    else:
        w, h = chance.choice(SIZES)
        page.set_viewport_size({"width": w, "height": h})


@pytest.mark.parametrize("seed", range(2))
def test_a_monkey(new_page: Callable[..., Page], address: str, seed: int) -> None:
    live, chance = Live.open(new_page(accept_downloads=True), address), random.Random(seed)
    for _ in range(ACTIONS):
        with suppress(Error):  # what it reached for has gone meanwhile, or lies under another
            played(live.page, chance)
    live.page.set_viewport_size({"width": 1280, "height": 900})
    live.page.evaluate("sessionStorage.clear()")
    again = Live.open(live.page, address)
    again.type(again.field("drive speed"), "150 rpm")
    expect(again.field("drive speed")).to_have_value("150 rpm")
