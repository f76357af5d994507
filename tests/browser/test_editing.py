"""Moving joints and masses, typing numbers, sliders, undo: against the model that results."""

from __future__ import annotations

import json
import re
from collections import Counter
from collections.abc import Callable

import numpy as np
import pytest
from playwright.sync_api import Page, expect

import equipoise as eq
from browser.live import NUMBER, OVER_A_SOCKET, Live
from equipoise.quantities import number, typeset
from surface.running import example_text

SHOWN = 0.011
"""Places are shown to a hundredth of a millimetre."""


def others(live: Live) -> dict[str, tuple[float, float]]:
    return {name: live.place(live.joint(name)) for name in "ADCP"}


def at_start(machine: eq.Machine, point: str) -> tuple[float, float]:
    """Return the place of a point at crank angle 0, mm."""
    place = eq.analyze(machine).motion.points[point].place[0] * 1e3
    return place.real, place.imag


CHOICES = """() => {
    const choices = HTMLSelectElement.prototype;
    const { get, set } = Object.getOwnPropertyDescriptor(choices, "value");
    window.chosen = 0;
    const counted = function (value) { window.chosen += 1; set.call(this, value); };
    Object.defineProperty(choices, "value", { get, set: counted, configurable: true });
}"""
"""Count what is chosen by the page itself: after each choice Chromium looks through all forms."""


def test_a_joint_follows_the_mouse_and_all_others_stay(live: Live) -> None:
    joint, still = live.joint("B"), others(live)
    x, y = live.spot(joint)
    joint.focus()  # by which the chart of its force is chosen
    live.page.evaluate(CHOICES)
    live.drag(joint, (-20, -30))
    assert live.page.evaluate("window.chosen") == 0
    expect(live.button("Undo")).to_be_enabled()
    assert live.spot(joint) == pytest.approx((x - 20, y - 30), abs=1)
    for name, place in still.items():
        live.comes_to(live.joint(name), place, SHOWN)
    live.comes_to(joint, at_start(live.machine(), "B"), SHOWN)


INVALIDATIONS = "disabled-by-default-devtools.timeline.invalidationTracking"


@pytest.mark.exhaustive
def test_what_is_beside_a_drawing_has_it_laid_out_once(live: Live) -> None:
    joint, browser = live.joint("B"), live.page.context.browser
    assert browser is not None
    x, y = live.spot(joint)
    live.page.mouse.move(x, y)
    live.page.mouse.down()
    live.page.mouse.move(x - 5, y - 5)
    live.settled()
    browser.start_tracing(page=live.page, categories=[INVALIDATIONS])
    live.page.mouse.move(x - 20, y - 30, steps=8)
    live.settled()
    events = json.loads(browser.stop_tracing())["traceEvents"]
    live.page.mouse.up()
    seen = Counter[str]()
    for event in events:
        if event["name"] == "LayoutInvalidationTracking":
            seen[event["args"]["data"]["reason"]] += 1
    assert seen["SVG changed"] + seen["Text changed"] > 0  # it does tell of what it looks at
    assert not seen["Size changed"]


@pytest.mark.exhaustive
def test_charts_report_their_values_while_a_joint_is_held(live: Live) -> None:
    joint, readings = live.joint("B"), live.page.locator(".square .legend").first
    x, y = live.spot(joint)
    before = readings.inner_text()
    live.page.mouse.move(x, y)
    live.page.mouse.down()
    live.page.mouse.move(x - 20, y - 30, steps=4)
    expect(readings).not_to_have_text(before)
    live.settled()
    held = readings.inner_text()
    live.page.mouse.up()
    live.settled()
    assert readings.inner_text() == held


MOVES = """([x, y]) => new Promise((done) => {
    const grip = document.querySelector("[data-kind=point][data-name=B]");
    const { send } = WebSocket.prototype, begun = grip.getAttribute("transform"), seen = [];
    WebSocket.prototype.send = function (text) {
        seen.push(grip.getAttribute("transform") === begun);
        if (seen.length === 2) {
            WebSocket.prototype.send = send;
            done(seen);
        }
        send.call(this, text);
    };
    for (const by of [10, 20]) {
        const at = { pointerId: 1, clientX: x - by, clientY: y };
        grip.dispatchEvent(new PointerEvent("pointermove", at));
    }
})"""
"""Two moves at once, and whether the first was drawn when either was asked of the server."""


@pytest.mark.exhaustive
@OVER_A_SOCKET
def test_the_next_move_is_asked_for_before_the_last_is_drawn(live: Live) -> None:
    x, y = live.spot(live.joint("B"))
    live.page.mouse.move(x, y)
    live.page.mouse.down()
    assert live.page.evaluate(MOVES, [x, y]) == [True, True]
    live.page.mouse.up()
    assert live.spot(live.joint("B")) == pytest.approx((x - 20, y), abs=1)


@pytest.mark.exhaustive
def test_a_drag_goes_on_where_a_plate_becomes_a_bar(live: Live) -> None:
    joint = live.joint("B")
    x, y = live.spot(joint)
    live.drag(joint, (-15, 15), (-30, 0), (-20, -10))  # across the line from P to C
    expect(live.button("Undo")).to_be_enabled()
    assert live.spot(joint) == pytest.approx((x - 20, y - 10), abs=1)


def test_a_joint_follows_a_finger(new_page: Callable[..., Page], address: str) -> None:
    live = Live.open(new_page(has_touch=True), address)
    joint = live.joint("C")
    x, y = live.spot(joint)
    fingers = live.page.context.new_cdp_session(live.page)
    ways = [("touchStart", 0), *(("touchMove", step) for step in range(1, 7)), ("touchEnd", None)]
    for kind, step in ways:
        points = [] if step is None else [{"x": x + 3 * step, "y": y + 2 * step}]
        fingers.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})
    expect(live.button("Undo")).to_be_enabled()
    assert live.spot(joint) == pytest.approx((x + 18, y + 12), abs=1)


KEYS = """() => {
    const grip = document.querySelector("[data-kind=point][data-name=B]");
    const press = (key, options) =>
        grip.dispatchEvent(new KeyboardEvent("keydown", { key, bubbles: true, ...options }));
    grip.focus();
    press("ArrowRight");
    press("ArrowRight");
    press("ArrowUp", { shiftKey: true });
    press("ArrowLeft", { altKey: true });
    press("Enter");
}"""
"""Keys without a pause, however busy the processor is, as a pause ends a move; so does Enter."""


def test_arrow_keys_move_by_steps_that_undo_takes_back_as_one(live: Live) -> None:
    joint = live.joint("B")
    x, y = live.place(joint)
    live.page.evaluate(KEYS)
    live.settled()
    moved = live.place(joint)
    step = (moved[1] - y) / 10
    assert 0 < step < 2
    assert moved[0] == pytest.approx(x + 1.9 * step, abs=2 * SHOWN)
    live.page.keyboard.press("Control+z")
    expect(live.button("Undo")).to_be_disabled()
    live.comes_to(joint, (x, y), SHOWN)
    live.page.keyboard.press("Control+Shift+z")
    expect(live.button("Redo")).to_be_disabled()
    live.comes_to(joint, moved, SHOWN)


@pytest.mark.exhaustive
def test_a_centre_of_mass_follows_the_mouse(live: Live) -> None:
    center = live.mass("coupler")
    still = others(live)
    live.drag(center, (25, 10))
    expect(live.button("Undo")).to_be_enabled()
    machine = live.machine()
    motion, own = eq.analyze(machine).motion, complex(*machine.links["coupler"].center_of_mass)
    turned = own * np.exp(1j * motion.links["coupler"].angle[0])
    place = 1e3 * (motion.points["B"].place[0] + turned)  # B is at the origin of its axes
    live.comes_to(center, (place.real, place.imag), SHOWN)
    assert others(live) == still


def test_a_typed_number_is_what_is_computed(live: Live) -> None:
    """A wrong unit is told beside it, and changes nothing."""
    field = live.field("crank mass")
    before = field.input_value()
    live.type(field, "300 mm")
    expect(field).to_have_attribute("aria-invalid", "true")
    expect(field).to_have_accessible_description(
        re.compile("mm is the unit of a length; a mass is wanted")
    )
    field.press("Escape")
    expect(field).not_to_have_attribute("aria-invalid", "true")
    expect(field).to_have_value(before)
    expect(live.button("Undo")).to_be_disabled()
    live.type(field, "0.45 kg")
    expect(live.button("Undo")).to_be_enabled()
    expected = eq.analyze(eq.load("yamashita-1").with_link("crank", mass=0.45))
    force = expected.forces.shaking_force
    rms = np.sqrt(np.mean(force.x**2 + force.y**2))
    shown = live.page.get_by_role("row").filter(has_text="haking force").first.get_by_role("cell")
    live.settled()
    assert float(shown.first.locator(".value").inner_text()) == pytest.approx(rms, rel=1e-3)
    assert live.machine().links["crank"].mass == 0.45


ANSWERED = """() => {
    const last = (name) => performance.getEntriesByName(name).at(-1)?.detail.seq;
    return last("equipoise:painted") === last("equipoise:input");
}"""
"""What was tried last has been painted, as it stands or as it cannot."""


def test_what_cannot_turn_is_reported_and_the_last_good_state_stays(live: Live) -> None:
    joint, still = live.joint("B"), others(live)
    x, y = live.spot(joint)
    live.page.mouse.move(x, y)
    live.page.mouse.down()
    live.page.mouse.move(x, y - 30, steps=5)
    expect(joint).not_to_have_attribute("aria-valuetext", "x 33.50 mm, y 0.00 mm")
    live.page.mouse.move(x, y - 150, steps=5)
    expect(live.status("cannot")).to_be_visible()
    live.page.wait_for_function(ANSWERED)
    expect(live.page.locator(".tried")).to_have_count(1)
    live.page.mouse.up()
    expect(live.button("Undo")).to_be_enabled()
    expect(live.page.locator(".tried")).to_have_count(0)
    assert others(live) == still
    live.comes_to(joint, at_start(live.machine(), "B"), SHOWN)
    live.button("Undo").click()
    expect(live.button("Undo")).to_be_disabled()


def test_a_field_and_a_slider_change_the_speed(live: Live) -> None:
    """Enter and leaving the field at once, before there is an answer, are one step."""
    speed = live.field("drive speed")
    speed.fill("150 rpm")
    enter = "new KeyboardEvent('keydown', { key: 'Enter', bubbles: true })"
    speed.evaluate(f"field => {{ field.dispatchEvent({enter}); field.blur(); }}")
    expect(live.button("Undo")).to_be_enabled()
    live.button("Undo").click()
    expect(speed).to_have_value("193 rpm")
    expect(live.button("Undo")).to_be_disabled()
    slider = live.page.get_by_role("slider", name="drive speed")
    before = live.machine().drive.speed
    slider.press("PageUp")
    expect(live.button("Undo")).to_be_enabled()
    after = live.machine().drive.speed
    assert after > 1.02 * before
    expect(speed).to_have_value(f"{after * 30 / np.pi:.5g} rpm")


RUBBING = """
[[joints]]
joint = "joints.piston on frame"
friction = 0.08
"""


@pytest.mark.exhaustive
def test_a_coefficient_of_friction_is_slid_and_its_losses_follow(live: Live) -> None:
    live.drop("engine.toml", example_text("slider-crank-engine") + RUBBING)
    of_joint = live.page.get_by_role("row", name=re.compile("^Piston on frame: mean loss"))
    everything = live.page.get_by_role("row", name=re.compile("^All joints: mean loss"))
    expect(everything).to_contain_text("W")
    field = live.page.get_by_role("textbox", name=re.compile("piston on frame, friction"))
    expect(field).to_have_value("0.08")
    slider = live.page.get_by_role("slider", name=re.compile("piston on frame, friction"))
    slider.press("PageUp")
    expect(live.button("Undo")).to_be_enabled()
    live.settled()
    machine = live.machine()
    assert machine.joints[0].friction > 0.08
    expect(field).to_have_value(f"{machine.joints[0].friction:.5g}")
    losses = eq.analyze(machine).losses
    assert losses is not None and losses.efficiency is not None
    expect(everything).to_contain_text(typeset(number(losses.loss)))
    expect(of_joint).to_contain_text(typeset(number(losses.loss)))
    efficiency = live.page.get_by_role("row", name=re.compile("^Efficiency"))
    expect(efficiency).to_contain_text(typeset(number(losses.efficiency)))
    live.type(field, "much")
    expect(live.page.get_by_text("give a plain number")).to_be_visible()


@pytest.mark.exhaustive
def test_a_phase_of_a_row_changes_the_forces_of_all_rows(live: Live) -> None:
    live.page.get_by_role("combobox", name="Example").select_option("four-row-transplanter")
    live.type(live.page.get_by_role("textbox", name=re.compile("row 2.*phase")), "90 deg")
    expect(live.button("Undo")).to_be_enabled()
    machine = live.machine()
    forces = eq.analyze(machine).forces
    force, torque = forces.shaking_force, forces.drive_torque
    ahead = [round(np.degrees(row.phase)) for row in machine.rows]  # samples
    every = sum(np.roll(force.x + 1j * force.y, -samples) for samples in ahead)
    row = live.page.get_by_role("row").filter(has_text="All rows: shaking force")
    shown = [float(text) for text in row.locator(".value").all_inner_texts()[:2]]
    rms, peak = np.sqrt(np.mean(np.abs(every) ** 2)), np.max(np.abs(every))
    assert shown == pytest.approx([rms, peak], rel=2e-3)
    chart = live.page.get_by_role("figure", name=re.compile("drive torque: ", re.IGNORECASE))
    together = sum(np.roll(torque, -samples) for samples in ahead)
    for whose, drawn in (("rows.", together), ("", torque)):
        live.page.get_by_role("combobox", name="Forces of").select_option(whose)
        said = (chart.get_attribute("aria-label") or "").replace("−", "-")
        spectrum = live.page.get_by_role("combobox", name="Spectrum of").locator("option").first
        expect(spectrum).to_contain_text("All rows" if whose else "One row")
        limits = [float(text) for text in NUMBER.findall(said)]
        assert limits == pytest.approx([drawn.min(), drawn.max()], rel=5e-3)


def test_what_was_done_outlives_a_reload(live: Live) -> None:
    """The machine is there after the page is loaded anew, with what can be undone and redone."""
    live.type(live.field("drive speed"), "150 rpm")
    live.type(live.field("crank mass"), "333 g")
    expect(live.button("Undo")).to_be_enabled()
    live.button("Undo").click()
    expect(live.field("crank mass")).not_to_have_value("333 g")
    live.page.reload()
    expect(live.field("drive speed")).to_have_value("150 rpm")
    live.button("Redo").click()
    expect(live.field("crank mass")).to_have_value("333 g")
    live.button("Undo").click()
    live.button("Undo").click()
    expect(live.field("drive speed")).to_have_value("193 rpm")
    expect(live.button("Undo")).to_be_disabled()


@pytest.mark.exhaustive
def test_a_balance_outlives_a_reload(live: Live) -> None:
    live.page.get_by_role("combobox", name="Example").select_option("balance-crank")
    expect(live.page.get_by_role("heading", name=eq.load("balance-crank").title)).to_be_visible()
    live.button("Balance").click()
    live.page.get_by_role("button", name="Keep", exact=True).click()
    live.type(live.field("drive speed"), "150 rpm")
    expect(live.button("Undo")).to_be_enabled()
    balanced = live.machine()
    live.page.reload()
    expect(live.field("drive speed")).to_have_value("150 rpm")
    assert live.machine() == balanced
