"""What one does with a machine, over each wire: a server's socket, and a worker of the browser."""

from __future__ import annotations

import re
from collections.abc import Iterator
from math import pi

import numpy as np
import pytest
from playwright.sync_api import Browser, Page, expect

import equipoise as eq
from browser.live import LONGEST, OVER_A_SOCKET, Live
from equipoise.mechanism.parts.run_plans import MOST_TURNS
from equipoise.mechanism.parts.support import FREEDOMS
from equipoise.present.cells import printed
from equipoise.running.run_results import DrivesRun
from equipoise.web.figures import CHARTS
from support.chosen import few
from surface.running import example_text

NAME = "balance-crank"
WIRES = ["socket", "worker"]


@pytest.fixture
def wired(browser: Browser, address: str) -> Iterator[Live]:
    """The page with a machine, over a wire of each kind."""
    context = browser.new_context(viewport={"width": 1280, "height": 900}, reduced_motion="reduce")
    context.set_default_timeout(LONGEST * 1000)
    page, wrong = context.new_page(), list[str]()
    page.on("pageerror", lambda error: wrong.append(str(error)))
    page.goto(f"{address.partition('#')[0]}#example={NAME}")
    expect(example(page)).to_have_value(NAME, timeout=LONGEST * 1000)
    live = Live(page)
    live.settled()
    yield live
    context.close()
    assert not wrong


def example(page: Page):
    return page.get_by_role("combobox", name="Example")


@pytest.mark.parametrize("address", WIRES, indirect=True)
def test_a_machine_is_changed_balanced_and_taken_along(wired: Live) -> None:
    """To the same numbers as those that are computed without a page."""
    page, own = wired.page, eq.load(NAME)
    wired.type(wired.field("crank mass"), "0.3 kg")
    assert wired.machine() == own.with_link("crank", mass=0.3)
    before = wired.place(wired.joint("B"))
    wired.drag(wired.joint("B"), (14, -9))
    assert wired.place(wired.joint("B")) != before
    moved = wired.machine().links["crank"].points["B"]
    assert moved != own.links["crank"].points["B"]
    wired.button("Undo").click()
    wired.comes_to(wired.joint("B"), before, 0.01)
    wired.button("Redo").click()
    wired.settled()
    assert wired.machine().links["crank"].points["B"] == moved
    wired.button("Undo").click()
    wired.settled()
    wired.button("Undo").click()
    wired.settled()
    page.get_by_role("button", name="Balance", exact=True).click()
    keep = page.get_by_role("button", name="Keep", exact=True)
    expect(keep).to_be_visible(timeout=LONGEST * 1000)
    keep.click()
    expect(keep).to_be_hidden()
    wired.settled()
    made, actual = wired.machine(), eq.balance(own).machine
    assert made.balance == own.balance
    for name, link in actual.links.items():
        assert made.links[name].mass == pytest.approx(link.mass, rel=1e-5)
        assert made.links[name].center_of_mass == pytest.approx(link.center_of_mass, abs=1e-6)


RUNS = "cutter-bar"


@pytest.mark.parametrize("address", few(WIRES, {"socket"}), indirect=True)
def test_a_machine_runs_and_its_run_is_played_until_it_is_changed(wired: Live) -> None:
    """From rest to the standstill that is computed without a page; then the cycle, as before."""
    page, own = wired.page, eq.load(RUNS)
    run = eq.run(own)
    example(page).select_option(RUNS)
    wired.settled()
    cycle = page.get_by_role("slider", name="Crank angle", exact=True)
    cycle.fill("90")
    again = page.get_by_role("button", name="Run", exact=True)
    again.click()
    element = page.get_by_role("region", name="Result of the run", exact=True)
    expect(element).to_contain_text(printed(run.headline()[0].text), timeout=LONGEST * 1000)
    expect(element.get_by_role("table", name="Events")).to_contain_text("stands still")
    assert wired.findings() == []
    charts = page.get_by_role("group", name="Run over time", exact=True)
    expect(charts.get_by_role("figure")).to_have_count(2)
    why = charts.get_by_role("button", name="Crank speed: what does it show?")
    why.click()
    expect(charts.get_by_text(CHARTS["run.speed.0"])).to_be_visible()
    why.click()
    clock = page.get_by_role("slider", name="Time of the run", exact=True)
    expect(clock).to_have_attribute("aria-valuetext", "0.000 s after the start")
    joint, length = wired.joint("B"), 1000 * abs(complex(*own.links["crank"].points["B"]))
    for step, k in ((0, 0), (1000, -1)):
        before = joint.get_attribute("aria-valuetext")
        clock.fill(str(step))
        if step:
            expect(joint).not_to_have_attribute("aria-valuetext", str(before))
        wired.painted()
        place = eq.move(own, run.crank_angle[[k]]).points["B"].place[0]
        # Drawn at the nearest of 360 crank angles, and told in 0.01 mm.
        within = length * pi / 360 + 0.01
        wired.comes_to(joint, (1000 * place.real, 1000 * place.imag), within)
    expect(clock).to_have_attribute("aria-valuetext", f"{run.end.time:.3f} s after the start")
    element.get_by_role("button", name="Back to the cycle").click()
    expect(cycle).to_be_visible()
    element.get_by_role("button", name="Play the run").click()
    expect(clock).to_be_visible()
    element.get_by_role("button", name="Close").click()
    expect(element).to_be_hidden()
    expect(cycle).to_be_visible()
    expect(again).to_be_focused()
    again.click()
    expect(clock).to_be_visible(timeout=LONGEST * 1000)
    wired.type(wired.field("crank mass"), "9 kg")
    expect(element).to_be_hidden()
    expect(charts).to_be_hidden()
    expect(cycle).to_be_visible()


@pytest.mark.exhaustive
@OVER_A_SOCKET
def test_a_run_is_cancelled_and_the_page_goes_on(wired: Live) -> None:
    """Over a socket; in a worker `test_host` cancels a balance."""
    page = wired.page
    longest = f"{example_text('balance-rig')}\n[run]\nturns = {MOST_TURNS}\n"  # more than a minute
    wired.drop("long.toml", longest)
    wired.settled()
    run, cancel = wired.button("Run"), page.get_by_role("button", name="Cancel", exact=True)
    expect(cancel).to_be_hidden()
    run.click()
    expect(cancel).to_be_visible()
    wired.button("Open").click()
    gallery = page.get_by_role("dialog", name="Open a machine")
    card = gallery.locator(f"[data-name={NAME}]")
    expect(card).to_have_count(0)  # it waits for the run
    page.keyboard.press("Escape")
    cancel.click()
    expect(wired.status("cancelled; nothing was changed")).to_be_visible()
    wired.button("Open").click()
    expect(card).to_be_attached()
    page.keyboard.press("Escape")
    expect(cancel).to_be_hidden()
    expect(page.get_by_role("region", name="Result of the run", exact=True)).to_be_hidden()
    wired.type(wired.field("crank mass"), "9 kg")
    assert wired.machine().links["crank"].mass == 9.0


@pytest.mark.exhaustive
@OVER_A_SOCKET
def test_drives_that_go_their_own_ways_are_drawn_and_not_dragged(wired: Live) -> None:
    """Poses of such a run are none of the cycle, in which alone something can be moved."""
    page, own = wired.page, eq.load("two-motor-mixer")
    run = eq.run(own)
    example(page).select_option("two-motor-mixer")
    wired.settled()
    joint, of_cycle = wired.joint("B"), wired.place(wired.joint("B"))
    wired.button("Run").click()
    clock = page.get_by_role("slider", name="Time of the run", exact=True)
    expect(clock).to_be_visible(timeout=LONGEST * 1000)
    clock.fill("1000")
    expect(clock).to_have_attribute("aria-valuetext", "1.000 s after the start")
    turned = run.drives["left-crank"].angle[-1]
    end = 1000 * complex(*own.links["left-crank"].points["B"]) * np.exp(1j * turned)
    text = f"{end.real:.2f}".rstrip("0")
    expect(joint).to_have_attribute("aria-valuetext", re.compile(re.escape(text)))
    # Who moves the sheet takes hold of nothing.
    box = page.get_by_role("group", name="Linkage", exact=True).bounding_box()
    assert box is not None
    corner = box["x"] + 8, box["y"] + box["height"] - 8
    page.mouse.move(*corner)
    page.mouse.down()
    page.mouse.move(corner[0] + 30, corner[1] - 30, steps=4)
    page.mouse.up()
    expect(clock).to_be_visible()
    wired.drag(joint, (20, 20))
    expect(clock).to_be_hidden()
    wired.painted()
    wired.comes_to(joint, of_cycle, 0.01)
    assert wired.machine() == own


# On every change `unit/web/test_runs.py` holds what is sent of the support's movement.
@pytest.mark.exhaustive
@pytest.mark.parametrize("address", WIRES, indirect=True)
def test_a_machine_moves_on_its_mounts_while_its_run_is_played(wired: Live) -> None:
    """All that the support carries turns by its pitch, at the end as much as in the run."""
    page = wired.page
    text = f"{example_text('balance-rig')}\n[run]\nsupport = true\nturns = 3\n"
    run = eq.run(eq.loads(text))
    assert isinstance(run, DrivesRun) and run.support is not None
    wired.drop("rig.toml", text)
    wired.settled()
    wired.button("Run").click()
    clock = page.get_by_role("slider", name="Time of the run", exact=True)
    expect(clock).to_be_visible(timeout=LONGEST * 1000)
    element = page.get_by_role("region", name="Result of the run", exact=True)
    expect(element).to_contain_text("movement of the support to scale")
    clock.fill("1000")
    expect(clock).to_have_attribute("aria-valuetext", f"{run.end.time:.3f} s after the start")
    wired.painted()
    turned = page.locator("svg g[transform*=rotate]").first.get_attribute("transform")
    angle = re.search(r"rotate\((\S+) ", turned or "")
    assert angle is not None
    assert float(angle[1]) == pytest.approx(
        -np.degrees(run.support.place[FREEDOMS.index("pitch"), -1]), abs=1e-3
    )
    element.get_by_role("button", name="Close").click()
    expect(clock).to_be_hidden()


@pytest.mark.exhaustive
@OVER_A_SOCKET
def test_a_tool_makes_nothing_in_poses_of_a_run(wired: Live) -> None:
    """A run that is played puts it away; a tool that is taken then shows the cycle first."""
    page, own = wired.page, eq.load("two-motor-mixer")
    example(page).select_option("two-motor-mixer")
    wired.settled()
    of_cycle = wired.place(wired.joint("B"))
    point = page.get_by_role("button", name="Point", exact=True)
    point.click()
    expect(point).to_have_attribute("aria-pressed", "true")
    wired.button("Run").click()
    clock = page.get_by_role("slider", name="Time of the run", exact=True)
    expect(clock).to_be_visible(timeout=LONGEST * 1000)
    expect(point).to_have_attribute("aria-pressed", "false")
    clock.fill("700")
    box = page.get_by_role("group", name="Linkage", exact=True).bounding_box()
    assert box is not None
    page.mouse.click(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
    expect(clock).to_be_visible()
    point.click()
    expect(clock).to_be_hidden()
    wired.painted()
    wired.comes_to(wired.joint("B"), of_cycle, 0.01)
    assert wired.machine() == own


@pytest.mark.exhaustive
@pytest.mark.parametrize("address", few(WIRES, {"socket"}), indirect=True)
def test_what_cannot_be_is_reported_and_the_last_good_state_stays(wired: Live) -> None:
    field = wired.field("crank mass")
    field.fill("3 mm")
    field.press("Enter")
    wired.settled()
    expect(wired.page.get_by_text("mm is the unit of a length").first).to_be_visible()
    field.press("Escape")
    assert wired.machine() == eq.load(NAME)
