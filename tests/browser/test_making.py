"""Machines made on the page, from nothing to the figures of their files: mouse, finger, keys."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
from playwright.sync_api import Page, expect

import equipoise as eq
from browser.live import NUMBER, Live
from unit.web.test_camming import SWUNG
from unit.web.test_sketch import GEARED, SAME, check_same, massed

TURNS = "1 degree of freedom; crank turns fully"


@dataclass
class Sheet:
    """The drawing of a page, by millimetres.  finger : whether a finger taps, and no mouse."""

    live: Live
    finger: bool = False

    def take(self, tool: str) -> None:
        self.live.page.get_by_role("button", name=tool, exact=True).click()

    def says(self, text: str) -> None:
        """Wait for what is told of the machine."""
        expect(self.live.page.locator(".making .status")).to_contain_text(text)

    @property
    def crosshair_place(self) -> tuple[float, float]:
        """Where the crosshair is, mm."""
        cross = self.live.page.get_by_role("slider", name="Crosshair")
        text = (cross.get_attribute("aria-valuetext") or "").replace("−", "-")
        x, y = map(float, NUMBER.findall(text))
        return x, y

    @property
    def crosshair(self) -> tuple[float, float, float, float]:
        """The same, and the pixels of the page."""
        x, y = self.crosshair_place
        cross = self.live.page.get_by_role("slider", name="Crosshair")
        px, py = map(float, NUMBER.findall(cross.get_attribute("transform") or ""))
        box = self.live.page.get_by_role("group", name="Linkage", exact=True).bounding_box()
        assert box is not None
        return x, y, box["x"] + px, box["y"] + py

    def pixel(self, x: float, y: float) -> tuple[float, float]:
        """Where a place (mm) is on the page."""
        x0, y0, px, py = self.crosshair
        self.live.page.get_by_role("slider", name="Crosshair").press("Shift+ArrowRight")
        x1, _, right, _ = self.crosshair
        scale = (right - px) / (x1 - x0)
        return px + (x - x0) * scale, py - (y - y0) * scale

    def click(self, *places: tuple[float, float]) -> None:
        """Click at places, mm."""
        for place in places:
            spot = self.pixel(*place)
            if self.finger:
                self.tap(*spot)
            else:
                self.live.page.mouse.click(*spot)

    def tap(self, x: float, y: float) -> None:
        """Tap at a place, px, for 50 ms by the browser's own clock.

        Playwright sends both ends of a tap one after the other; on a busy machine they come so far
        apart that the finger rests, which opens a menu.
        """
        page = self.live.page
        line = page.context.new_cdp_session(page)
        line.send("Input.synthesizeTapGesture", {"x": x, "y": y, "duration": 50})
        line.detach()

    def steer(self, x: float, y: float) -> None:
        """Bring the crosshair to a place (mm) by arrow keys, and press Enter there."""
        cross = self.live.page.get_by_role("slider", name="Crosshair")
        for axis, (more, less) in enumerate((("Right", "Left"), ("Up", "Down"))):
            for size in ("Shift+", "", "Alt+", "Alt+"):
                off = (x, y)[axis] - self.crosshair_place[axis]
                if abs(off) < 0.5:
                    break
                key = f"{size}Arrow{more if off > 0 else less}"
                cross.press(key)
                left = (x, y)[axis] - self.crosshair_place[axis]
                for _ in range(int(left / (off - left))):
                    cross.press(key)
        cross.press("Enter")

    def type(self, **texts: str) -> None:
        """Type lengths and angles of the machine, and wait for each."""
        for name, text in texts.items():
            field = self.live.field(name)
            self.live.type(field, text)
            expect(field).not_to_have_attribute("data-typed", "")
            field.blur()


@pytest.fixture
def sheet(live: Live) -> Sheet:
    live.button("New").click()
    balance = live.page.get_by_role("button", name="Balance", exact=True)
    expect(balance).to_have_attribute("aria-description", re.compile("^nothing moves yet: "))
    expect(balance).to_be_disabled()
    sheet = Sheet(live)
    sheet.says("nothing moves yet")
    return sheet


@pytest.mark.exhaustive
def test_a_new_machine_is_not_begun_with_delete(live: Live) -> None:
    sheet = Sheet(live)
    sheet.take("Delete")
    live.button("New").click()
    sheet.says("nothing moves yet")
    pressed = live.page.locator(".tools [aria-pressed=true]")
    expect(pressed).to_have_attribute("aria-label", "Select")


@pytest.mark.exhaustive
def test_tools_have_their_keys_while_a_button_has_the_focus(sheet: Sheet) -> None:
    page = sheet.live.page
    pressed = page.locator(".tools [aria-pressed=true]")
    sheet.live.button("Zoom in").focus()
    page.keyboard.press("l")
    expect(pressed).to_have_attribute("aria-label", "Link")
    page.locator("body").evaluate("() => document.activeElement.blur()")
    page.keyboard.press("p")
    expect(pressed).to_have_attribute("aria-label", "Point")
    sheet.live.page.get_by_role("combobox", name="Language", exact=True).focus()
    page.keyboard.press("l")  # which a list takes for its own
    expect(pressed).to_have_attribute("aria-label", "Point")


@pytest.mark.exhaustive
def test_a_place_is_reported_as_it_is_rounded(sheet: Sheet) -> None:
    sheet.take("Point")
    x, y = sheet.pixel(31.234, 7.891)
    sheet.live.page.mouse.move(x, y)
    hint = sheet.live.page.locator(".hint")
    expect(hint).to_have_text(re.compile(r"^[\d.]+, [\d.]+ mm$"))
    texts = [float(match) for match in NUMBER.findall(hint.inner_text())]
    sheet.live.page.mouse.click(x, y)
    sheet.live.comes_to(sheet.live.joint("A"), (texts[0], texts[1]), 0.006)


@pytest.mark.exhaustive
def test_what_is_traced_is_not_rounded_to_the_sheet(sheet: Sheet, tmp_path: Path) -> None:
    """Where an underlay is seen, its lines count, and none of the sheet draws places to itself."""
    picture = tmp_path / "photo.svg"
    box = '<svg xmlns="http://www.w3.org/2000/svg" width="400" height="200"/>'
    picture.write_text(box, encoding="utf-8")
    page = sheet.live.page
    sheet.take("Point")
    x, y = map(round, sheet.pixel(31.234, 7.891))
    hint = page.locator(".hint")

    def place_in_hint() -> complex:
        page.mouse.move(x + 9, y)
        page.mouse.move(x, y)
        return complex(*(float(match) for match in NUMBER.findall(hint.inner_text())))

    rounded = place_in_hint()
    page.get_by_label("Picture or DXF drawing").set_input_files(picture)
    expect(page.locator(".underlay image")).to_have_count(1)
    (x0, y0), (x1, _) = sheet.pixel(0, 0), sheet.pixel(100, 0)
    exact = complex(x - x0, y0 - y) * 100 / (x1 - x0)
    assert abs(place_in_hint() - exact) < 0.02
    assert abs(rounded - exact) > 0.05
    page.get_by_label("Hidden").check()
    assert place_in_hint() == rounded


def test_a_four_bar_is_made_by_mouse(sheet: Sheet) -> None:
    parts = sheet.live.page.get_by_text("Parts of the model")
    add = sheet.live.page.get_by_role("combobox", name="Add to the model")
    parts.click()
    expect(sheet.live.page.get_by_text("the machine has no links yet")).to_be_visible()
    expect(add).to_be_hidden()
    sheet.take("Point")
    sheet.click((0, 0), (11, -87))
    expect(sheet.live.joint("B")).to_be_visible()
    sheet.take("Link")
    sheet.click((0, 0), (33, 0))
    sheet.says("no drive: choose the driven link (crank)")
    expect(add).to_be_visible()
    parts.click()
    sheet.click((33, 0), (83, -52))
    sheet.says(
        "mobility is 2; expected 1; coupler is not connected: pin D to another link or the frame"
    )
    sheet.click((11, -87), (83, -52))
    sheet.says("no drive: choose the driven link (crank or rocker)")
    sheet.take("Drive")
    sheet.click((15, 0))
    sheet.says(TURNS)
    sheet.take("Point")
    sheet.click((60, -28))
    expect(sheet.live.field("coupler E, x")).to_be_visible()
    expect(sheet.live.page.get_by_role("combobox", name="Path of")).to_have_value("E")
    numbers = {"frame A to B": "88 mm", "frame A to B, direction": "-83 deg"}
    numbers |= {"crank A to C": "33.5 mm", "coupler C to D": "71.5 mm", "rocker B to D": "80 mm"}
    sheet.type(**numbers, **{"coupler E, x": "-160 mm", "coupler E, y": "-40 mm"})
    made, like = sheet.live.machine(), eq.load("yamashita-1")
    # the page keeps 12 digits of a place, and what of D is beyond is as small a part of a length
    check_same(massed(made, like, {name: name for name in like.links}), like, 10 * SAME)
    for _ in range(8):  # seven numbers and a point, then the drive
        sheet.live.button("Undo").click()
        sheet.says("1 degree of freedom")
    sheet.live.button("Undo").click()
    sheet.says("no drive: choose the driven link (crank or rocker)")
    sheet.live.page.reload()
    sheet.says("no drive: choose the driven link (crank or rocker)")
    sheet.live.button("Redo").click()
    sheet.says(TURNS)


def test_a_slider_crank_is_made_by_finger(new_page: Callable[..., Page], address: str) -> None:
    live = Live.open(new_page(has_touch=True, viewport={"width": 400, "height": 800}), address)
    live.button("New").tap()
    sheet = Sheet(live, finger=True)
    sheet.take("Point")
    sheet.click((0, 0))
    sheet.take("Link")
    sheet.click((0, 0), (25, 0), (25, 0), (0, 86))  # the second begins where the first will end
    sheet.says("coupler is not connected: pin C to another link or the frame")
    sheet.take("Slider")
    sheet.click((0, 86), (0, 0))
    sheet.take("Drive")
    sheet.click((12, 0))
    sheet.says(TURNS)
    sheet.type(**{"crank A to B": "25 mm", "coupler B to C": "90 mm"})
    made, like = live.machine(), eq.load("slider-crank-engine")
    check_same(massed(made, like, {"crank": "crank", "coupler": "rod", "slider": "piston"}), like)
    sheet.take("Link")
    sheet.click((-40, 40), (-40, 60))
    sheet.take("Pin")
    sheet.click((-40, 40), (-40, 40))
    sheet.take("Rack")
    sheet.click((0, 86), (-40, 50))
    sheet.says(TURNS)
    (rack,) = live.machine().racks
    assert (rack.drives, rack.radius) == ("rack", 0.04)


@pytest.mark.exhaustive
def test_a_geared_five_bar_is_made_by_keys(sheet: Sheet) -> None:
    keys = sheet.live.page.keyboard
    sheet.take("Point")
    sheet.steer(0, 0)
    sheet.steer(100, 0)
    keys.press("l")
    links = {"C": ((0, 0), (30, 0)), "D": ((30, 0), (91, 79)), "E": ((100, 0), (88, 22))}
    for ends in links.values():
        for place in ends:
            sheet.steer(*place)
    sheet.steer(88, 22)
    sheet.steer(91, 79)
    sheet.says("mobility is 2; expected 1")
    keys.press("d")
    sheet.steer(15, 0)
    keys.press("b")
    sheet.steer(15, 0)
    sheet.steer(94, 11)
    sheet.says(TURNS)
    keys.press("Delete")
    sheet.steer(-15, -15)  # on the wheel about A
    sheet.says("mobility is 2; expected 1")
    keys.press("g")
    sheet.live.field("Teeth of the driven link").fill("40")
    sheet.steer(15, 0)
    sheet.steer(94, 11)
    sheet.says(TURNS)
    numbers = {"crank A to C": "30 mm", "coupler C to D": "100 mm", "rocker B to E": "25 mm"}
    numbers |= {
        "link1 E to D": "90 mm",
        "gears crank to rocker, angle at the start": "120 deg",
    }
    sheet.type(**numbers)
    made, like = sheet.live.machine(), eq.loads(GEARED)
    check_same(massed(made, like, {name: name for name in like.links}), like)


@pytest.mark.exhaustive
def test_a_cam_and_its_follower_are_made_by_mouse(sheet: Sheet) -> None:
    sheet.take("Point")
    sheet.click((0, 0), (60, 0))
    sheet.take("Link")
    sheet.click((0, 0), (20, 0), (60, 0), (30, 40))
    sheet.take("Drive")
    sheet.click((10, 0))
    sheet.says(
        "mobility is 2; expected 1; rocker is not connected: pin D to another link or the frame"
    )
    sheet.take("Cam")
    live = sheet.live
    expect(live.page.locator(".making .next")).to_have_text("click the link that bears the cam")
    sheet.click((10, 0))
    expect(live.page.locator(".making .next")).to_contain_text("click the follower")
    sheet.click((30, 40))
    sheet.says(TURNS)
    made, like = live.machine(), eq.loads(SWUNG)
    check_same(massed(made, like, {name: name for name in like.links}), like)
    circle = live.page.get_by_role("slider", name="Base circle of crank to rocker")
    expect(circle).to_have_attribute("aria-valuetext", "40.00 mm")
    sheet.take("Select")
    x, y = live.spot(circle.locator(".knob"))
    ax, ay = live.spot(live.joint("A"))
    live.drag(circle.locator(".knob"), (0.25 * (ax - x), 0.25 * (ay - y)))
    assert live.machine().cams[0].base_radius == pytest.approx(0.03, abs=5e-4)
    circle.press("Shift+ArrowUp")
    live.settled()
    assert 0.031 < live.machine().cams[0].base_radius < 0.04
    for _ in range(3):  # both, and the cam
        live.button("Undo").click()
    sheet.says("mobility is 2; expected 1")


@pytest.mark.exhaustive
def test_a_cylinder_is_made_by_its_form(sheet: Sheet) -> None:
    sheet.take("Point")
    sheet.click((0, 0), (50, -100))
    sheet.take("Link")
    sheet.click((0, 0), (100, 20))
    page = sheet.live.page
    page.get_by_text("Parts of the model").click()
    page.get_by_role("button", name="drive link crank").click()
    form = page.get_by_role("form", name="drive")
    form.locator("[data-key=speed] input").fill("6 rpm")
    ends = form.locator("[data-key=between] select")
    for end, point in enumerate("BC"):  # the first is a point of the frame alone
        ends.nth(end).select_option(point)
    form.get_by_role("button", name="Save", exact=True).click()
    sheet.says("cylinder B to C from 130.0 to 143.0 mm and back")
    assert sheet.live.machine().drive.between == ("B", "C")


@pytest.mark.exhaustive
def test_a_cam_and_a_sliding_face_are_made_by_keys(sheet: Sheet) -> None:
    live, keys = sheet.live, sheet.live.page.keyboard
    sheet.take("Point")
    sheet.steer(0, 0)
    keys.press("l")
    for place in ((0, 0), (20, 0)):
        sheet.steer(*place)
    keys.press("s")
    for place in ((0, 30), (0, 0)):
        sheet.steer(*place)
    keys.press("c")
    live.page.get_by_role("combobox", name="What rides on the cam").select_option("flat face")
    for place in ((10, 0), (0, 30)):
        sheet.steer(*place)
    keys.press("d")
    sheet.steer(10, 0)
    sheet.says(TURNS)
    (cam,) = live.machine().cams
    assert (cam.rides, cam.driven, cam.base_radius) == ("flat", "slider", 0.03)
    sheet.take("Delete")
    sheet.steer(-15, 26)  # on the cam
    sheet.says("mobility is 2; expected 1")
    assert not live.findings()


@pytest.mark.exhaustive
def test_the_crank_turns_by_its_rim_and_grows_by_its_handle(live: Live) -> None:
    for _ in range(3):
        live.button("Zoom in").click()
    a, b = live.joint("A"), live.joint("B")
    (ax, ay), (bx, by) = live.spot(a), live.spot(b)
    reach = np.hypot(bx - ax, by - ay)
    mouse = live.page.mouse
    mouse.move(ax + 0.7 * (bx - ax), ay + 0.7 * (by - ay))
    mouse.down()
    mouse.move(ax + 0.4 * reach, ay - 0.4 * reach, steps=8)
    mouse.up()
    expect(live.button("Undo")).to_be_disabled()  # nothing of the machine has changed
    x, y = live.spot(b)
    assert (x - ax, ay - y) == pytest.approx((reach / 2**0.5, reach / 2**0.5), abs=2)
    mouse.move(ax - reach, ay)  # by the way of its end
    mouse.down()
    mouse.move(ax - reach, ay + 0.2 * reach, steps=4)
    mouse.up()
    turned = np.subtract(live.spot(b), (ax, ay))
    assert np.angle(complex(turned[0], -turned[1])) == pytest.approx(np.pi / 4 + 0.197, abs=0.03)
    live.button("Lock coupler B to C").click()
    live.drag(b, (20, -10))
    expect(live.button("Undo")).to_be_enabled()
    links = live.machine().links
    assert np.hypot(*links["coupler"].points["C"]) == pytest.approx(0.0715, rel=1e-6)
    assert np.hypot(*links["crank"].points["B"]) > 0.035


def test_parts_are_joined_renamed_and_deleted(live: Live) -> None:
    sheet = Sheet(live)
    sheet.take("Separate")
    live.joint("C").focus()
    live.page.keyboard.press("Enter")
    sheet.says(
        "mobility is 3; expected 1; coupler is not connected: pin C or P to another link "
        "or the frame"
    )
    expect(live.joint("E")).to_be_visible()
    live.page.keyboard.press("Escape")
    live.drag(live.joint("E"), (40, 30))
    sheet.take("Pin")
    x, y = live.spot(live.joint("E"))
    u, v = live.spot(live.joint("C"))
    live.page.mouse.move(x, y)
    live.page.mouse.down()
    live.page.mouse.move(u, v, steps=5)
    live.page.mouse.up()
    sheet.says(TURNS)
    sheet.take("Select")
    live.joint("P").focus()
    live.type(live.field("Name of P"), "tip")
    expect(live.joint("tip")).to_be_visible()
    live.joint("tip").focus()
    live.page.keyboard.press("Delete")
    expect(live.joint("tip")).to_have_count(0)
    assert [*live.machine().links["coupler"].points] == ["B", "C"]
    assert not live.findings()
    page = live.page
    page.get_by_role("combobox", name="Example").select_option("slider-crank-engine")
    page.get_by_role("dialog", name="Question").get_by_role("button", name="Open").click()
    title = eq.load("slider-crank-engine").title
    expect(page.get_by_role("heading", name=title)).to_be_visible()  # what opens gives Delete up
    sheet.says(TURNS)
    sheet.take("Delete")
    page.mouse.click(*live.spot(page.locator(".signs [data-what=slider]").last))  # its block
    sheet.says("the position of rod and piston is undetermined")
    expect(live.joint("C")).to_be_visible()
    live.button("Undo").click()
    sheet.says(TURNS)
    assert re.search("turns fully", live.page.locator(".making .status").inner_text())
