"""The page as a whole: moving, balancing, several at once, by keyboard alone, on a broken line."""

from __future__ import annotations

import json
import re
from collections.abc import Callable

import numpy as np
import pytest
from playwright.sync_api import Page, WebSocketRoute, expect

import equipoise as eq
from browser.live import OVER_A_SOCKET, Live

OF_RUNTIME = re.compile(r"/(runtime/|wheels/|worker\.js|service\.js|site\.json)")
"""What a page without a server loads to compute by itself."""


def test_the_page_is_small_and_moves_as_computed(
    new_page: Callable[..., Page], address: str
) -> None:
    page, sizes = new_page(reduced_motion="no-preference"), []
    page.on(
        "response",
        lambda answer: OF_RUNTIME.search(answer.url) or sizes.append(len(answer.body())),
    )
    live = Live.open(page, address)
    assert len(sizes) == 3  # page, script, style
    assert sum(sizes) < 400_000
    start = live.spot(live.joint("B"))
    page.wait_for_function(
        "y => y !== document.querySelector('[data-name=B]').getBoundingClientRect().y",
        arg=start[1] - 0.5,
    )
    live.button("Pause").click()
    motion = eq.analyze(eq.load("yamashita-1")).motion
    spots = {}
    for sample in (0, 100, 250):
        page.get_by_role("slider", name="Crank angle").fill(str(sample))
        spots[sample] = {name: complex(*live.spot(live.joint(name))) for name in "ADBCP"}
    scale = abs(spots[0]["A"] - spots[0]["D"]) / 0.088  # pixels per m
    for sample, shown in spots.items():
        for name in "BCP":
            seen = (shown[name] - shown["A"]).conjugate() / scale
            assert seen == pytest.approx(motion.points[name].place[sample], abs=1 / scale)


def test_balancing_and_taking_it_back(live: Live) -> None:
    live.page.get_by_role("combobox", name="Example").select_option("balance-crank")
    expect(live.page.get_by_role("heading", name=eq.load("balance-crank").title)).to_be_visible()
    live.button("Balance").click()
    panel = live.page.get_by_role("region", name="Balancing")
    row = panel.get_by_role("row").filter(has_text="Shaking force, RMS")
    expect(row).to_be_visible()
    before, after = (float(text) for text in row.get_by_role("cell").all_inner_texts()[:2])
    assert after < 0.95 * before
    live.button("Take back").click()
    expect(panel).to_be_hidden()
    assert live.machine() == eq.load("balance-crank")
    live.button("Balance").click()
    panel.get_by_role("button", name="Keep", exact=True).click()
    expect(panel).to_be_hidden()
    kept = live.machine()
    assert kept != eq.load("balance-crank")
    assert kept.balance == eq.load("balance-crank").balance


@pytest.mark.exhaustive
def test_name_title_and_drawing_are_of_one_machine(live: Live) -> None:
    """In every frame, while others are opened by name and from a file."""
    live.page.evaluate("""window.seen = new Set(); const look = () => {
        const handles = [...document.querySelectorAll(".grip")].map(one => one.dataset.name);
        const named = document.querySelector("[aria-label=Example]").value;
        seen.add(JSON.stringify([named, document.querySelector("h1").textContent, handles]));
        requestAnimationFrame(look);
    }; look()""")
    names = ("yamashita-1", "quick-return", "riding-transplanter", "class-three", "drag-link")
    for name in names[1:]:
        live.page.get_by_role("combobox", name="Example").select_option(name)
        expect(live.page.get_by_role("heading", name=eq.load(name).title)).to_be_visible()
        live.settled()
        live.painted()  # and is seen
    seen = [json.loads(item) for item in live.page.evaluate("[...seen]")]
    assert [item[:2] for item in seen] == [[name, eq.load(name).title] for name in names]


FOR = {
    "yamashita-rig": ("Path of P", "Response of"),
    "transplanter": ("P over ground", "Path of"),
    "stephenson-six-bar": ("Path of E", "Any output over crank angle"),
    "slider-crank-engine": ("Path of C", "Path of"),
}
"""Machines, the path that is drawn of each, and its first chart."""


@pytest.mark.exhaustive
def test_what_a_machine_is_for_comes_first(live: Live) -> None:
    """The chart that tells it stands at the top, and of the paths none is the crank's circle."""
    for name, (path, first) in FOR.items():
        live.page.get_by_role("combobox", name="Example").select_option(name)
        expect(live.page.get_by_role("heading", name=eq.load(name).title)).to_be_visible()
        live.settled()
        drawn = live.page.get_by_role("combobox", name="Path of")
        expect(drawn.locator("option:checked")).to_have_text(path)
        heading = live.page.get_by_role("combobox", name=first)
        expect(heading).to_be_visible()
        spectrum = live.page.get_by_role("combobox", name="Spectrum of").bounding_box()
        top = heading.bounding_box()
        assert top and spectrum and top["y"] < spectrum["y"], name
        others = live.page.locator(".charts .heading, .charts .finder").all()
        boxes = [box for box in (other.bounding_box() for other in others) if box]
        assert top["y"] <= min(box["y"] for box in boxes) + 1, name
        shown = live.page.get_by_role("figure", name="Angle of output")
        expect(shown).to_have_count(int(first == "Any output over crank angle"))


@pytest.mark.exhaustive
def test_pages_do_not_disturb_each_other(new_page: Callable[..., Page], address: str) -> None:
    first, other = (Live.open(new_page(), address) for _ in range(2))
    first.type(first.field("crank mass"), "0.3 kg")
    other.type(other.field("drive speed"), "100 rpm")
    expect(first.button("Undo")).to_be_enabled()
    expect(other.button("Undo")).to_be_enabled()
    own = eq.load("yamashita-1")
    assert first.machine() == own.with_link("crank", mass=0.3)
    assert other.machine().links == own.links
    assert other.machine().drive.speed == pytest.approx(100 * np.pi / 30)


def test_by_keyboard_alone(live: Live) -> None:
    def go_to(name: str) -> None:
        for _ in range(300):  # the way around, past every number
            live.page.keyboard.press("Tab")
            if name == live.page.evaluate("document.activeElement.getAttribute('aria-label')"):
                return
        pytest.fail(f"Tab does not reach {name}")

    keyboard = live.page.keyboard
    go_to("Example")
    keyboard.type("watt-six-bar")
    expect(live.page.get_by_role("heading", name=eq.load("watt-six-bar").title)).to_be_visible()
    unfocused = live.joint("C").screenshot()
    go_to("Joint C")
    assert live.joint("C").screenshot() != unfocused  # the focus is seen
    keyboard.press("ArrowUp")
    keyboard.press("Enter")
    expect(live.button("Undo")).to_be_enabled()
    go_to("drive speed")
    keyboard.type("120 rpm\n")
    expect(live.field("drive speed")).to_have_value("120 rpm")
    go_to("drive speed slider")
    keyboard.press("?")
    expect(live.page.get_by_role("dialog", name="Keys")).to_be_visible()
    keyboard.press("Escape")
    expect(live.page.get_by_role("dialog", name="Keys")).to_be_hidden()


@OVER_A_SOCKET
def test_a_broken_line_is_reported_and_nothing_is_lost(
    new_page: Callable[..., Page], address: str
) -> None:
    page, lines = new_page(), []

    def join(line: WebSocketRoute) -> None:
        lines.append(line)
        line.connect_to_server()

    page.route_web_socket("**/live*", join)
    live = Live.open(page, address)
    live.type(live.field("crank mass"), "0.3 kg")
    expect(live.button("Undo")).to_be_enabled()
    lines[-1].close()
    expect(page.get_by_role("alert").filter(has_text="does not answer")).to_be_visible()
    expect(page.get_by_role("alert").filter(has_text="does not answer")).to_be_hidden()
    assert live.machine().links["crank"].mass == 0.3
