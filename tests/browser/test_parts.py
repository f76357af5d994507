"""Parts of the model by their forms; a picture and a DXF drawing traced over; the ruler."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from playwright.sync_api import Locator, expect

from browser.live import NUMBER, Live
from support.chosen import few_together

MARKS = {"first": (100, 150), "second": (300, 150), "third": (200, 50)}
"""Centres of circles on a picture of 400 by 200, pixels."""
DRAWING = """
0 SECTION 2 HEADER 9 $INSUNITS 70 1 0 ENDSEC
0 SECTION 2 BLOCKS
0 BLOCK 8 0 2 ARM 70 0 10 0 20 0 3 ARM 1 .
0 LINE 8 0 10 0 20 0 11 1 21 0
0 ENDBLK 8 0
0 ENDSEC
0 SECTION 2 ENTITIES
0 LINE 8 0 10 -3 20 1 11 2 21 -2
0 CIRCLE 8 0 10 1 20 2 40 0.5
0 ARC 8 0 10 0 20 0 40 2 50 0 51 90
0 LWPOLYLINE 8 0 90 2 70 0 10 -4 20 0 42 1 10 -2 20 0
0 SPLINE 8 0 70 8 71 2 72 6 73 3 40 0 40 0 40 0 40 1 40 1 40 1 10 0 20 0 10 1 20 2 10 2 20 0
0 INSERT 8 0 2 ARM 10 5 20 5 41 2 42 2 50 90
0 ENDSEC
0 EOF
"""
"""A drawing in inches: codes and values in turn."""
BOXES = [
    (-3, -2, 2, 1),
    (0.5, 1.5, 1.5, 2.5),
    (0, 0, 2, 2),
    (-4, -1, -2, 0),
    (0, 0, 2, 1),
    (5, 5, 5, 7),
]
"""Of its lines: least x and y, largest x and y, inches."""


def part(live: Live, heading: str) -> Locator:
    return live.page.get_by_role("form", name=heading)


def add(live: Live, what: str) -> Locator:
    """Choose something to add, and return its form."""
    select = live.page.get_by_label("Add to the model")
    option = select.locator("option", has_text=re.compile(f"^{what}"))
    select.select_option(option.get_attribute("value"))
    return part(live, "New")


def press(form: Locator, name: str) -> None:
    form.get_by_role("button", name=name, exact=True).click()


def dxf() -> str:
    return "\n".join(DRAWING.split()) + "\n"


def boxes(path: str) -> list[tuple[float, ...]]:
    """Least and largest coordinates of each line of a path in m, inches."""
    actual = []
    for line in path.split("M")[1:]:
        places = [[float(item) / 0.0254 for item in place.split()] for place in line.split("L")]
        xs, ys = zip(*places, strict=True)
        actual.append((min(xs), min(ys), max(xs), max(ys)))
    return actual


@pytest.mark.exhaustive
def test_wheels_become_ellipses_and_circles_again(live: Live) -> None:
    page = live.page
    page.get_by_role("combobox", name="Example").select_option("elliptic-quick-return")
    rims = page.locator(".signs [data-what=gears] circle")
    expect(page.locator(".signs [data-what=gears]")).to_have_count(2)
    expect(rims).to_have_count(0)
    page.get_by_text("Parts of the model").click()
    page.get_by_role("button", name="Delete shape of gears 1").click()
    expect(rims).to_have_count(2)
    form = add(live, "shape of gears 1")
    assert page.evaluate("document.documentElement.scrollHeight <= innerHeight")  # columns scroll
    form.get_by_label("kind", exact=True).select_option("elliptic")
    form.get_by_label("eccentricity", exact=True).fill("0.2")
    press(form, "Save")
    expect(rims).to_have_count(0)


def test_what_is_typed_at_a_part_is_not_lost_when_another_is_opened(live: Live) -> None:
    page = live.page
    page.get_by_text("Parts of the model").click()
    page.get_by_title("Change crank", exact=True).click()
    part(live, "crank").get_by_label("mass", exact=True).fill("777 g")
    page.get_by_title("Change rocker", exact=True).click()
    asking = page.get_by_role("dialog", name="Question")
    expect(asking).to_contain_text("What was typed at “crank” is not saved.")
    press(asking, "Cancel")
    expect(part(live, "crank").get_by_label("mass", exact=True)).to_have_value("777 g")
    page.get_by_title("Change rocker", exact=True).click()
    press(asking, "Discard")
    expect(part(live, "rocker")).to_be_visible()
    page.get_by_title("Change crank", exact=True).click()  # nothing was typed
    expect(part(live, "crank")).to_be_visible()


def test_a_spring_and_a_body_are_added_changed_and_deleted(live: Live) -> None:
    page = live.page
    page.get_by_text("Parts of the model").click()
    form = add(live, "springs:")
    press(form, "Save")
    expect(form.locator("[data-key=link] .error")).to_have_text("Choose one.")
    expect(form.locator("[data-key=to] .error")).to_have_text("Choose one.")
    expect(form.get_by_label("link", exact=True)).to_be_focused()
    press(form, "Show point on the drawing")
    x, y = live.spot(live.joint("P"))
    page.mouse.click(x + 3, y - 2)
    expect(form.get_by_label("link", exact=True)).to_have_value("coupler")
    expect(form.get_by_label("point", exact=True)).to_have_value("P")
    form.get_by_label("other point", exact=True).select_option("D")
    stiffness = form.get_by_label("stiffness", exact=True)
    stiffness.fill("3 kg")
    press(form, "Save")
    expect(form.get_by_text("got '3 kg'; kg is the unit of a mass")).to_be_visible()
    expect(stiffness).to_be_focused()
    assert live.findings() == []
    stiffness.fill("40")  # in the unit that stands beside it
    stiffness.press("Enter")
    expect(form).to_be_hidden()
    expect(live.button("Undo")).to_have_attribute("title", "Undo: New: springs")
    (spring,) = live.machine().springs
    assert (spring.link, spring.point, spring.to, spring.stiffness) == ("coupler", "P", "D", 40.0)

    form = add(live, "gears:")
    expect(form.locator("[data-key=teeth]")).to_be_visible()
    form.get_by_label("ratio", exact=True).fill("-2")
    expect(form.locator("[data-key=teeth]")).to_be_hidden()  # one of both
    press(form, "Cancel")  # nothing moves below the mouse while it is pressed
    expect(form).to_be_hidden()

    form = add(live, "bodies of rocker")
    form.get_by_label("shape", exact=True).select_option("disc")
    expect(form.locator("[data-key=corners]")).to_be_hidden()  # has no place in a disc
    expect(form.locator("[data-key=radius] .needed")).to_be_visible()
    press(form, "Show centre on the drawing")
    page.keyboard.press("Escape")
    form.get_by_label("centre, point").select_option("C")
    for key, value in (("radius", "40 mm"), ("thickness", "10"), ("material", "steel")):
        form.get_by_label(key, exact=True).fill(value)
    press(form, "Save")
    expect(page.get_by_text("together 394.6 g")).to_be_visible()
    page.get_by_role("button", name="Delete springs 1").click()
    expect(page.get_by_role("button", name="Delete springs 1")).to_be_hidden()
    machine = live.machine()
    assert machine.springs == ()
    assert machine.links["rocker"].mass == pytest.approx(7850 * 3.14159265 * 0.04**2 * 0.01)
    live.button("Undo").click()
    expect(page.get_by_role("button", name="Delete springs 1")).to_be_visible()
    page.get_by_role("button", name=re.compile("^springs 1 ")).click()
    form = part(live, "springs 1")
    form.get_by_label("free length", exact=True).fill("5 cm")
    press(form, "Save")
    expect(form).to_be_hidden()
    assert live.machine().springs[0].free_length == 0.05
    page.get_by_role("button", name=re.compile("^springs 1 ")).click()
    length = form.get_by_label("free length", exact=True)
    expect(length).to_have_value("50 mm")
    live.button("Undo").click()  # an open form follows
    expect(length).to_have_value("")
    live.button("Redo").click()
    expect(length).to_have_value("50 mm")
    page.reload()  # what was done is done again
    expect(live.button("Undo")).to_have_attribute("title", "Undo: springs 1")
    assert live.machine().springs[0].free_length == 0.05


@pytest.mark.exhaustive
def test_a_picture_is_scaled_and_traced_over(live: Live, tmp_path: Path) -> None:
    page = live.page
    circles = "".join(f'<circle cx="{x}" cy="{y}" r="4"/>' for x, y in MARKS.values())
    svg = f'<svg xmlns="http://www.w3.org/2000/svg" width="400" height="200">{circles}</svg>'
    picture = tmp_path / "photo.svg"
    picture.write_text(svg, encoding="utf-8")
    live.drop("huge.jpg", "0123456789", 2_100_000)
    expect(live.status("huge.jpg has 21.0 MB; at most 20 MB are drawn")).to_be_visible()
    page.get_by_label("Picture or DXF drawing").set_input_files(picture)
    image = page.locator(".underlay image")

    def click(mark: str) -> None:
        box = image.bounding_box()
        assert box is not None
        across, down = MARKS[mark]
        place = box["x"] + across / 400 * box["width"], box["y"] + down / 200 * box["height"]
        expect(page.locator(".picking")).to_be_visible()
        page.mouse.click(*place)

    live.button("Scale by two places").click()
    click("first")
    expect(page.locator(".picking")).to_have_attribute("aria-label", "Click the second place.")
    click("second")
    distance = page.get_by_label("True distance of the two places")
    expect(distance).to_be_focused()
    live.type(distance, "8 cm")
    expect(distance).to_be_hidden()

    live.button("Measure").click()
    click("first")
    expect(page.locator(".picking")).to_have_attribute("aria-label", "Click where to measure to.")
    click("third")
    element = page.locator(".measured")
    expect(element).to_have_text(re.compile("along y$"))
    measured = [float(match) for match in NUMBER.findall(element.inner_text())]
    assert measured == pytest.approx([56.57, 45, 40, 40], abs=1)  # 0.4 mm a pixel

    page.get_by_text("Parts of the model").click()
    page.get_by_role("button", name=re.compile("^frame points")).click()
    form = part(live, "frame")
    for number, (name, mark) in enumerate((("E", "first"), ("F", "third")), 3):
        press(form, "One more")
        form.get_by_label(f"points {number}, name").fill(name)
        press(form, f"Show points {number} on the drawing")
        click(mark)
    press(form, "Save")
    expect(form).to_be_hidden()
    frame = live.machine().frame
    traced = complex(*frame["F"]) - complex(*frame["E"])
    assert abs(traced - (0.04 + 0.04j)) < 1e-3
    page.reload()
    expect(image).to_be_visible()


@pytest.mark.exhaustive
def test_a_dxf_drawing_is_snapped_to_by_keyboard_too(live: Live, tmp_path: Path) -> None:
    page = live.page
    file = tmp_path / "plan.dxf"
    file.write_text(dxf(), encoding="utf-8")
    page.get_by_text("Underlay and ruler").click()
    page.get_by_label("Picture or DXF drawing").set_input_files(file)
    lines = page.locator(".underlay path")
    expect(lines).to_be_attached()
    for actual, wanted in zip(boxes(lines.get_attribute("d") or ""), BOXES, strict=True):
        assert actual == pytest.approx(wanted, abs=1e-3)
    board, drawn = page.locator(".board").first.bounding_box(), lines.bounding_box()
    assert board is not None and drawn is not None
    assert drawn["y"] > board["y"]  # 180 mm up, and in sight
    live.button("Measure").click()
    aim = page.locator(".picking")
    expect(aim).to_be_focused()
    expect(live.status("Click where to measure from.")).to_be_visible()
    page.mouse.click(*live.spot(live.joint("A")))
    expect(aim).to_have_attribute("aria-label", "Click where to measure to.")
    for _ in range(200):  # to the centre of the circle, 25.4 mm to the right and 50.8 mm up
        hint = page.locator(".hint").inner_text()
        x, y = (float(match.replace("−", "-")) for match in NUMBER.findall(hint)[-2:])
        if "25.40, 50.80" in hint:
            break
        aim.press("ArrowRight" if x < 25 else "ArrowUp" if y < 50 else "ArrowLeft")
    aim.press("Enter")
    expect(page.locator(".measured")).to_contain_text("25.40 mm along x, 50.80 mm along y")
    assert live.findings() == []
    file.write_text("no drawing", encoding="utf-8")
    page.get_by_label("Picture or DXF drawing").set_input_files(file)
    expect(live.status("plan.dxf is no DXF drawing that can be read")).to_be_visible()
    live.button("Remove").click()
    expect(page.locator(".underlay path")).to_be_hidden()


@pytest.mark.exhaustive
@pytest.mark.parametrize(
    ("name", "part"),
    few_together(
        [("transplanter", "soil of planting"), ("balance-geared-a", "geared of balance")],
        {("balance-geared-a", "geared of balance")},
    ),
)
def test_forms_give_back_what_they_were_given(live: Live, name: str, part: str) -> None:
    """Whatever differed would be a step that could be taken back."""
    page = live.page
    page.get_by_role("combobox", name="Example", exact=True).select_option(name)
    page.get_by_text("Parts of the model").click()
    expect(page.locator(".groups")).to_contain_text(part)
    entries = page.locator(".groups .plain")
    for number in range(entries.count()):
        entries.nth(number).click()
        form = page.locator(".part-form")
        press(form, "Save")
        expect(form).to_have_count(0)
    assert entries.count() >= 8
    expect(live.button("Undo")).to_be_disabled()
