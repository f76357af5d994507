"""Interactive files in a Chromium: opened from the disk, dragged and typed into."""

from __future__ import annotations

import json
import tomllib
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from playwright.sync_api import Browser, Locator, Page, ViewportSize, expect

import equipoise as eq
from browser.live import FITS, SCREENSHOTS, Live
from browser.test_looks import SCHEMES, WIDTHS
from equipoise.quantities import parse
from equipoise.schema.template import Template
from support.chosen import EXHAUSTIVE
from surface.running import equipoise

Open = Callable[..., Live]


@pytest.fixture
def open_file(browser: Browser, tmp_path: Path) -> Iterator[Open]:
    """Write the file of a bundled machine as a user does, and open it by its address.

    A page that reports an error, or asks for anything but its file, fails the test.
    """
    contexts, wrong = [], []

    def watch(url: str) -> None:
        if not url.startswith((tmp_path.as_uri(), "data:", "blob:")):
            wrong.append(url)

    def opened(name: str, *options: str) -> Live:
        path = tmp_path / f"{name}.html"
        done = equipoise("export", name, "-o", path, *options)
        assert done.status == 0, done.err
        size = ViewportSize(width=1280, height=900)
        context = browser.new_context(viewport=size, reduced_motion="reduce")
        contexts.append(context)
        context.on("request", lambda sent: watch(sent.url))
        context.on("weberror", lambda error: wrong.append(str(error.error)))
        context.on("console", lambda said: said.type == "error" and wrong.append(said.text))
        page = context.new_page()
        page.goto(path.as_uri())
        expect(page.get_by_role("slider", name="Crank angle")).to_be_visible()
        return Live(page)

    yield opened
    for context in contexts:
        context.close()
    assert wrong == []


def figure(page: Page, name: str) -> float:
    """A figure that the page shows, in SI units with all its digits."""
    return float(page.locator(f"[data-figure='{name}']").get_attribute("data-value") or "nan")


def figures(page: Page) -> dict[str, float]:
    cells = page.locator("[data-figure]")
    names = cells.evaluate_all("cells => cells.map(({ dataset }) => dataset.figure)")
    return {name: figure(page, name) for name in names}


def field(page: Page, label: str) -> Locator:
    """The field of a number, whose group is opened."""
    box = page.locator(f"input[aria-label='{label}']")
    box.evaluate("field => { field.closest('details').open = true; }")
    return box


def drag(live: Live, joint: str, dx: float, dy: float) -> None:
    """Drag a joint by so many pixels."""
    handle = live.joint(joint)
    handle.scroll_into_view_if_needed()
    box = handle.bounding_box()
    assert box is not None
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    live.page.mouse.move(x, y)
    live.page.mouse.down()
    live.page.mouse.move(x + dx / 2, y + dy / 2)
    live.page.mouse.move(x + dx, y + dy)
    live.page.mouse.up()


def tables_of(content: dict[str, Any], above: str = "") -> Iterator[tuple[str, dict[str, Any]]]:
    """Every table that has keys of its own, by its path."""
    own = {key: value for key, value in content.items() if not isinstance(value, dict)}
    if own:
        yield above, own
    for key, value in content.items():
        if isinstance(value, dict):
            yield from tables_of(value, f"{above}.{key}".removeprefix("."))


def changed(name: str, page: Page) -> eq.Machine:
    """The machine of a model with the lines of changed numbers that the page gives."""
    template, values = Template.of(eq.load(name)), {}
    for table, keys in tables_of(tomllib.loads(page.locator("textarea").input_value())):
        for key, given in keys.items():
            paths = [f"{table}.{key}"]
            if isinstance(given, list):
                paths = [f"{table}.{key}.{axis}" for axis in "xy"]
            for path, text in zip(
                paths, given if isinstance(given, list) else [given], strict=True
            ):
                dimension = template.number(path)[1]
                assert dimension is not None
                values[path] = parse(text, dimension)  # type: ignore[arg-type]
    made = template.machine(values)
    assert isinstance(made, eq.Machine)
    return made


def test_it_shows_what_analyze_prints(open_file: Open) -> None:
    page = open_file("yamashita-1").page
    printed = json.loads(equipoise("analyze", "yamashita-1", "--json").out)["summary"]
    shown = figures(page)
    assert {"shaking_force", "drive_torque", "joints.B"} <= {
        item.rpartition(".")[0] for item in shown
    }
    for name, value in shown.items():
        output, _, measure = name.rpartition(".")
        assert value == pytest.approx(printed[output][measure], rel=1e-12)


def test_a_dragged_joint_takes_forces_and_lengths_along(open_file: Open) -> None:
    live = open_file("yamashita-1")
    page, before = live.page, figures(live.page)
    length = field(page, "D to C")
    old = float(length.input_value())
    drag(live, "C", 40, 20)
    expect(live.status("changed: coupler, rocker")).to_be_visible()
    assert abs(float(length.input_value()) - old) > 1
    machine = changed("yamashita-1", page)
    place = complex(*machine.links["rocker"].points["C"]) - complex(
        *machine.links["rocker"].points["D"]
    )
    assert float(length.input_value()) == pytest.approx(1e3 * abs(place), rel=1e-6)
    analysis, now = eq.analyze(machine), figures(page)
    for name, value in now.items():
        output, _, measure = name.rpartition(".")
        assert value == pytest.approx(getattr(analysis.summary[output], measure), rel=1e-9)
        assert abs(value - before[name]) > 1e-3 * before[name]
    live.button("Undo").click()
    assert figures(page) == before


def test_typed_numbers_and_keys(open_file: Open) -> None:
    live = open_file("yamashita-1")
    page, before = live.page, figures(live.page)
    speed = field(page, "speed of the drive")
    speed.fill("386 rpm")
    speed.press("Enter")
    assert figure(page, "shaking_force.rms") == pytest.approx(4 * before["shaking_force.rms"])
    live.button("reset speed of the drive").click()
    assert figures(page) == before
    mass = field(page, "mass of the crank")
    mass.fill("-3")
    mass.press("Enter")
    expect(live.status("mass of the crank: got -3 g; give 0 g or more")).to_be_visible()
    assert figures(page) == before
    joint = live.joint("B")
    joint.focus()
    page.keyboard.press("Shift+ArrowRight")
    expect(live.status("changed: crank, coupler")).to_be_visible()
    live.button("Reset all").click()
    assert figures(page) == before


@pytest.mark.exhaustive
def test_curves_of_forces_that_jump_at_the_beginning_go_from_left_to_right(open_file: Open) -> None:
    """The side before the jump is the end of the cycle."""
    page = open_file("plunger-pump").page
    paths = page.locator(".plot .curves path").evaluate_all(
        "paths => paths.map((path) => path.getAttribute('d'))"
    )
    assert paths
    for path in paths:
        across = [float(point.partition(" ")[0]) for point in path[1:].split("L")]
        assert len(across) > 360
        assert across == sorted(across)


def test_it_begins_at_a_crank_angle(open_file: Open) -> None:
    live = open_file("yamashita-1", "--at", "30 deg")
    expect(live.page.locator(".transport .angle")).to_have_text("30.0°")
    live.page.get_by_role("slider", name="Crank angle").press("ArrowRight")
    expect(live.page.locator(".transport .angle")).to_have_text("31.0°")
    live.button("Play").click()
    expect(live.page.locator(".transport .angle")).not_to_have_text("31.0°")
    live.button("Pause").click()


@pytest.mark.exhaustive
def test_what_cannot_turn_is_refused_in_words(open_file: Open) -> None:
    live = open_file("yamashita-1")
    page, before = live.page, figures(live.page)
    length = field(page, "A to B")
    length.fill("90")
    length.press("Enter")
    sentence = "the crank cannot turn fully: 'coupler' and 'rocker' reach each other only from"
    expect(live.status(sentence)).to_be_visible()
    assert figures(page) == before
    length.press("Escape")
    drag(live, "B", 200, 0)
    expect(live.status("the crank cannot turn fully")).to_be_visible()
    assert figures(page) == before


@pytest.mark.exhaustive
@pytest.mark.parametrize(("name", "joint"), [
    ("yamashita-1", "B"),
    pytest.param("planetary-planting-arm", "Q", marks=EXHAUSTIVE),
    pytest.param("slider-crank-engine", "B", marks=EXHAUSTIVE),
    pytest.param("quick-return", "B", marks=EXHAUSTIVE),
])  # fmt: skip
def test_it_fits_every_width(open_file: Open, name: str, joint: str) -> None:
    live = open_file(name)
    page = live.page
    for width, scheme in zip(WIDTHS, SCHEMES, strict=True):
        page.emulate_media(color_scheme=scheme)
        page.set_viewport_size({"width": width, "height": 900})
        assert page.evaluate(FITS)
        assert live.findings() == []
        page.screenshot(
            path=SCREENSHOTS / f"interactive-{name}-{scheme}-{width}.png", full_page=True
        )
    if live.joint(joint).count():
        drag(live, joint, 8, -6)
        expect(live.status("changed")).to_be_visible()


@pytest.mark.exhaustive
def test_a_cam_is_left_out_where_its_numbers_are_others(open_file: Open) -> None:
    """Nothing that is not computed is drawn, and what was there comes back."""
    live = open_file("cam-pusher")
    page = live.page
    drawn = "all => all.map(one => one.getAttribute('d') ?? one.getAttribute('r')).join()"
    before = page.locator(".piece *").evaluate_all(drawn)
    drag(live, "R", 10, 10)
    expect(live.status("changed: pusher")).to_be_visible()
    assert page.locator(".piece *").evaluate_all(drawn) != before
    live.button("Undo").click()
    assert page.locator(".piece *").evaluate_all(drawn) == before


@pytest.mark.exhaustive
def test_a_drawing_of_changed_numbers_is_that_of_the_changed_machine(open_file: Open) -> None:
    """Every joint, after another length, stands where the analysis has it."""
    live = open_file("slider-crank-engine")
    length = field(live.page, "length B–C of the rod")
    length.fill("120 mm")
    length.press("Enter")
    machine = changed("slider-crank-engine", live.page)
    places = eq.analyze(machine).motion.points
    for name in ("B", "C"):
        text = live.joint(name).get_attribute("aria-valuetext") or ""
        x, y = (float(part.split()[1].replace("−", "-")) for part in text.split(", "))
        assert complex(x, y) == pytest.approx(1e3 * complex(places[name].place[0]), abs=6e-3)
    assert np.isfinite(figure(live.page, "shaking_force.rms"))
