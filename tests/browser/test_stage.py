"""The sheet as the stage: room for the drawing, a sheet that stays, menus, pinned figures."""

from __future__ import annotations

from collections.abc import Callable
from itertools import product

import pytest
from playwright.sync_api import Locator, Page, expect

import equipoise as eq
from browser.live import FITS, ROOT, SCREENSHOTS, Live
from support.chosen import few_together


def box(part: Locator) -> tuple[float, float, float, float]:
    """Left, top, width and height on the screen, pixels."""
    result = part.bounding_box()
    assert result is not None
    return result["x"], result["y"], result["width"], result["height"]


def board(live: Live) -> Locator:
    return live.page.locator(".board").first


def begun(live: Live) -> None:
    """Begin a machine from nothing."""
    live.page.get_by_role("button", name="New", exact=True).click()
    expect(live.page.locator(".equipoise.unfinished")).to_be_attached()
    live.settled()


@pytest.mark.exhaustive
def test_the_drawing_has_most_of_the_window_while_one_draws(live: Live) -> None:
    begun(live)
    _, _, width, height = box(board(live))
    assert width * height > 0.5 * 1280 * 900
    live.page.screenshot(path=SCREENSHOTS / "drawing-1280.png")
    assert live.findings() == []


@pytest.mark.exhaustive
@pytest.mark.parametrize(
    ("width", "language"),
    few_together(product([400, 1280], ["en", "ja", "ko"]), {(400, "ja")}),
)
def test_sentences_that_come_and_go_leave_the_sheet_where_it_is(
    new_page: Callable[..., Page], address: str, width: int, language: str
) -> None:
    """Every tool tells at length what to do; the sheet stays at the same pixel."""
    options = {"viewport": {"width": width, "height": 900}, "locale": language}
    live = Live.open(new_page(**options), address)
    live.page.locator(".making .tools button").first.click()
    expect(live.page.locator(".equipoise.unfinished")).to_be_attached()
    live.settled()
    tops = set()
    for tool in live.page.locator(".making .tools button[aria-pressed]").all():
        tool.click()
        tops.add(box(board(live))[1])
        x, y, w, h = box(board(live))
        live.page.mouse.click(x + 0.3 * w, y + 0.7 * h)
        live.settled()
        tops.add(box(board(live))[1])
    assert len(tops) == 1
    assert live.page.evaluate(FITS)


@pytest.mark.exhaustive
def test_tools_have_names_that_are_seen(live: Live) -> None:
    tools = live.page.get_by_role("toolbar", name="Tools")
    for name in ("Select", "Link", "Pin", "Separate", "Slider", "Cam", "Drive", "Delete"):
        word = tools.get_by_role("button", name=name, exact=True).locator(".name")
        expect(word).to_have_text(name)
        expect(word).to_be_visible()


@pytest.mark.exhaustive
def test_the_border_is_dragged_and_remembered(live: Live) -> None:
    page = live.page
    border = page.get_by_role("separator", name="Border between drawing and charts")
    before = box(board(live))[2]
    live.drag(border, (150.0, 0.0))
    wider = box(board(live))[2]
    assert wider - before == pytest.approx(150, abs=3)
    border.press("ArrowLeft")
    narrower = box(board(live))[2]
    assert narrower < wider - 30
    page.reload()
    live.settled()
    assert box(board(live))[2] == pytest.approx(narrower, abs=1)


@pytest.mark.exhaustive
def test_charts_go_below_the_drawing(live: Live) -> None:
    page = live.page
    border = page.get_by_role("separator", name="Border between drawing and charts")
    before = box(board(live))[2]
    live.drag(border, (410.0, 0.0))  # out of the window on the right
    assert border.get_attribute("aria-orientation") == "horizontal"
    assert box(board(live))[2] > before + 380
    charts = page.get_by_role("region", name="Charts")
    assert box(charts)[1] > box(board(live))[1] + 300
    page.screenshot(path=SCREENSHOTS / "charts-below-1280.png")
    assert live.findings() == []
    border.press("Enter")
    assert box(board(live))[2] == pytest.approx(before, abs=1)


# -- menus -----------------------------------------------------------------------------------------


JOINTS = "[data-kind=point][data-name]"


def menu(live: Live, of: str) -> Locator:
    return live.page.get_by_role("menu", name=of, exact=True)


def items(result: Locator) -> list[str]:
    return result.get_by_role("menuitem").all_inner_texts()


def test_a_joint_has_a_menu_by_the_right_button(live: Live) -> None:
    live.joint("C").click(button="right")
    result = menu(live, "C")
    assert items(result) == [
        "Cylinder …", "Load …", "Spring …", "Pin to the frame", "Separate", "Delete",
        "Mount of the support …", "Gauge of the support …",
    ]  # fmt: skip
    live.page.screenshot(path=SCREENSHOTS / "menu-1280.png")
    assert live.findings() == []
    result.get_by_role("menuitem", name="Spring …").click()
    form = live.page.get_by_role("form", name="New: springs")
    expect(form.get_by_label("link", exact=True)).to_have_value("coupler")
    expect(form.get_by_label("point", exact=True)).to_have_value("C")
    form.get_by_role("button", name="Cancel").click()
    live.joint("D").click(button="right")  # where a spring ends
    menu(live, "D").get_by_role("menuitem", name="Spring …").click()
    expect(form.get_by_label("other point", exact=True)).to_have_value("D")
    expect(form.get_by_label("point", exact=True)).to_have_value("")


@pytest.mark.exhaustive
def test_a_link_has_a_menu_that_leads_to_its_counterweight_and_mass(live: Live) -> None:
    def opened() -> Locator:
        (ax, ay), (bx, by) = live.spot(live.joint("A")), live.spot(live.joint("B"))
        live.page.mouse.click(ax + 0.65 * (bx - ax), ay + 0.65 * (by - ay), button="right")
        return menu(live, "crank")

    page = opened()
    assert "Drive" not in items(page)  # it is the drive
    page.get_by_role("menuitem", name="Counterweight").click()
    focused = live.page.evaluate("document.activeElement.getAttribute('aria-label')")
    assert "counterweight on crank" in focused
    page = opened()
    page.get_by_role("menuitem", name="Mass …").click()
    form = live.page.get_by_role("form", name="crank")
    expect(form.get_by_label("mass", exact=True)).to_be_focused()
    expect(form.get_by_label("mass", exact=True)).to_have_value("199 g")


@pytest.mark.exhaustive
def test_every_joint_and_link_has_a_menu(live: Live) -> None:
    """With all that can be done there; a counterweight where a link turns about the frame."""
    page = live.page
    menus = page.get_by_role("menu")
    everywhere = {
        "Spring …",
        "Load …",
        "Delete",
        "Mount of the support …",
        "Gauge of the support …",
    }
    for name in ("stephenson-six-bar", "slider-crank-engine"):
        machine = eq.load(name)
        page.get_by_role("combobox", name="Example").select_option(name)
        expect(page.get_by_role("heading", name=machine.title)).to_be_visible()
        live.settled()
        joints = {
            item.get_attribute("data-name") or "": item for item in page.locator(JOINTS).all()
        }
        held = {point for link in machine.links.values() for point in link.points}
        assert held <= {*joints}
        for point in sorted(held):
            joints[point].focus()
            page.keyboard.press("ContextMenu")
            expect(menus).to_have_attribute("aria-label", point)
            assert everywhere | {"Cylinder …"} <= {*items(menus)}, point
            page.keyboard.press("Escape")
        for link, body in machine.links.items():
            ends = [live.spot(joints[point]) for point in body.points]
            if len(body.points) == 1:  # a block, which lies on its joint
                page.mouse.click(*ends[0], button="right")
                assert f"Mass of {link} …" in items(menus)
                page.keyboard.press("Escape")
                continue
            wanted = everywhere | {"Mass …", "Point of the link"}
            if len({*body.points} & {*machine.frame}) == 1:
                wanted |= {"Counterweight"}
            offered = []
            for share in (0.3, 0.5, 0.7):  # other links may lie over it
                x, y = (a + share * (b - a) for a, b in zip(ends[0], ends[-1], strict=True))
                page.mouse.click(x, y, button="right")
                offered += [items(menus)] if menus.get_attribute("aria-label") == link else []
                page.keyboard.press("Escape")
            assert offered and wanted <= {*offered[0]}, link


@pytest.mark.exhaustive
def test_a_constraint_of_a_links_menu_holds_while_one_drags(live: Live) -> None:
    """The coupler is as long as the rocker from then on."""
    (cx, cy), (dx, dy) = live.spot(live.joint("C")), live.spot(live.joint("D"))
    live.page.mouse.click((cx + dx) / 2, (cy + dy) / 2, button="right")
    menu(live, "rocker").get_by_role("menuitem", name="Constraint …").click()
    form = live.page.get_by_role("form", name="New: constraints")
    live.page.screenshot(path=SCREENSHOTS / "constraint-form-1280.png")
    signs = live.page.locator("g.piece").count()
    form.get_by_label("kind", exact=True).select_option("equal")
    form.get_by_label("other line 1", exact=True).select_option("B")
    form.get_by_label("other line 2", exact=True).select_option("C")
    form.get_by_role("button", name="Save").click()
    expect(live.page.get_by_text("kind equal, line D C, other line B C")).to_be_visible()
    expect(live.page.locator("g.piece")).to_have_count(signs + 4)  # two strokes on two lines
    coupler, rocker = live.field("coupler B to C"), live.field("rocker D to C")
    assert coupler.input_value() == rocker.input_value() == "80 mm"
    live.drag(live.joint("B"), (6, 6))  # which makes the coupler longer
    assert coupler.input_value() == rocker.input_value() != "80 mm"
    live.page.screenshot(path=SCREENSHOTS / "constraint-1280.png")


@pytest.mark.exhaustive
def test_a_place_has_a_menu_and_a_mount_asks_for_the_support_first(live: Live) -> None:
    x, y, width, height = box(board(live))
    live.page.mouse.click(x + 0.6 * width, y + 0.15 * height, button="right")
    result = menu(live, "This place")
    result.get_by_role("menuitem", name="Mount of the support …").click()
    expect(live.page.get_by_role("form", name="New: support")).to_be_visible()
    live.page.mouse.click(x + 0.6 * width, y + 0.15 * height, button="right")
    before = live.page.locator("[data-kind=point]").count()
    result.get_by_role("menuitem", name="Point of the frame").click()
    expect(live.page.locator("[data-kind=point]")).to_have_count(before + 1)


@pytest.mark.exhaustive
def test_the_menu_key_opens_the_menu_and_delete_deletes(live: Live) -> None:
    keyboard = live.page.keyboard
    for key in ("ContextMenu", "Shift+F10"):
        live.joint("P").focus()
        keyboard.press(key)
        expect(menu(live, "P")).to_be_visible()
        keyboard.press("Escape")
        expect(menu(live, "P")).to_be_hidden()
        expect(live.joint("P")).to_be_focused()
    keyboard.press("ContextMenu")
    for _ in range(items(menu(live, "P")).index("Delete")):
        keyboard.press("ArrowDown")
    keyboard.press("Enter")
    expect(live.joint("P")).to_have_count(0)
    expect(live.page.get_by_role("group", name="Linkage", exact=True)).to_be_focused()
    keyboard.press("Control+z")
    expect(live.joint("P")).to_have_count(1)


@pytest.mark.exhaustive
def test_a_finger_that_rests_opens_the_menu(new_page: Callable[..., Page], address: str) -> None:
    options = {"viewport": {"width": 400, "height": 900}, "has_touch": True}
    live = Live.open(new_page(**options), address)
    live.joint("C").scroll_into_view_if_needed()
    x, y = live.spot(live.joint("C"))
    line = live.page.context.new_cdp_session(live.page)
    place = [{"x": x, "y": y, "id": 0}]
    line.send("Input.dispatchTouchEvent", {"type": "touchStart", "touchPoints": place})
    expect(menu(live, "C")).to_be_visible()
    live.page.screenshot(path=SCREENSHOTS / "menu-400.png")
    assert live.page.evaluate(FITS)
    away = [{"x": x + 40, "y": y, "id": 0}]
    line.send("Input.dispatchTouchEvent", {"type": "touchMove", "touchPoints": away})
    line.send("Input.dispatchTouchEvent", {"type": "touchEnd", "touchPoints": []})
    expect(menu(live, "C")).to_be_visible()
    expect(live.button("Undo")).to_be_disabled()  # nothing was dragged
    live.page.keyboard.press("Escape")
    left, top, width, _ = box(board(live))
    place = [{"x": left + 0.75 * width, "y": top + 40, "id": 0}]  # where nothing is
    line.send("Input.dispatchTouchEvent", {"type": "touchStart", "touchPoints": place})
    expect(menu(live, "This place")).to_be_visible()
    line.send("Input.dispatchTouchEvent", {"type": "touchEnd", "touchPoints": []})
    live.painted()
    expect(menu(live, "This place")).to_be_visible()


# -- pinned figures --------------------------------------------------------------------------------


def test_figures_are_pinned_on_the_drawing(live: Live) -> None:
    page = live.page
    page.get_by_role("button", name="Pin Shaking force on the drawing", exact=True).click()
    pins = page.get_by_role("list", name="Figures on the drawing")
    expect(pins).to_have_text("Shaking forceRMS 14.98 N, peak 23.22 N")
    live.type(live.field("crank mass"), "400 g")
    expect(pins).not_to_have_text("Shaking forceRMS 14.98 N, peak 23.22 N")
    page.reload()
    live.settled()
    expect(pins.get_by_role("listitem")).to_have_count(1)
    page.screenshot(path=SCREENSHOTS / "pinned-1280.png")
    page.get_by_role("button", name="Pin Shaking force on the drawing", exact=True).click()
    expect(pins).to_be_hidden()


@pytest.mark.exhaustive
def test_every_row_of_figures_is_one_line(new_page: Callable[..., Page], address: str) -> None:
    """On a telephone, too, with its unit and the button that pins it."""
    live = Live.open(new_page(viewport={"width": 400, "height": 900}), address)
    rows = live.page.get_by_role("table", name="Figures", exact=True).locator("tbody tr")
    heights = [box(row)[3] for row in rows.all()]
    assert len(heights) == 5
    assert max(heights) < min(heights) + 2
    live.type(live.field("crank mass"), "400 g")  # what figures were goes below them
    changed = live.page.locator(".readings .was").all()
    assert changed and all(box(was)[3] < heights[0] for was in changed if was.is_visible())
    assert live.page.evaluate(FITS)


# -- forces of what is drawn -----------------------------------------------------------------------


def test_a_stranger_makes_a_four_bar_with_forces_in_ten_actions(live: Live) -> None:
    """A click or a drag is an action."""
    page, actions = live.page, 0

    def press(name: str) -> None:
        nonlocal actions
        actions += 1
        page.get_by_role("button", name=name, exact=True).click()
        live.settled()

    def at(x: float, y: float) -> tuple[float, float]:
        left, top, width, height = box(board(live))
        return left + x * width, top + y * height

    def click(x: float, y: float) -> None:
        nonlocal actions
        actions += 1
        page.mouse.click(*at(x, y))
        live.settled()

    def drag(*ends: tuple[float, float]) -> None:
        nonlocal actions
        actions += 1
        page.mouse.move(*at(*ends[0]))
        page.mouse.down()
        page.mouse.move(*at(*ends[1]), steps=5)
        page.mouse.up()
        live.settled()

    press("New")
    press("Point")
    click(0.3, 0.7)
    click(0.6, 0.7)
    press("Link")
    drag((0.3, 0.7), (0.35, 0.6))
    drag((0.35, 0.6), (0.65, 0.4))
    drag((0.65, 0.4), (0.6, 0.7))
    press("Drive")
    click(0.325, 0.65)
    assert actions == 10
    expect(page.locator(".making .status")).to_have_text("1 degree of freedom; crank turns fully")
    figures = page.get_by_role("table", name="Figures")
    expect(figures.get_by_role("row", name="Shaking force", exact=False).first).to_contain_text("N")
    expect(page.get_by_text("the masses of crank, coupler, rocker are assumed")).to_be_visible()
    page.screenshot(path=SCREENSHOTS / "assumed-1280.png")
    page.set_viewport_size({"width": 400, "height": 900})
    page.screenshot(path=SCREENSHOTS / "assumed-400.png", full_page=True)
    assert page.evaluate(FITS)
    assert live.findings() == []
    width = live.field("crank bar 1, assumed, width")
    mass = live.machine().links["crank"].mass
    live.type(width, "30 mm")
    changed = live.machine().links["crank"]
    assert changed.bodies[0].assumed and mass and changed.mass and changed.mass > mass


def test_the_page_without_the_runtime_is_small() -> None:
    """What a browser loads of the page itself, uncompressed."""
    static = ROOT / "src" / "equipoise" / "web" / "static"
    loaded = ("equipoise.js", "equipoise.css", "worker.js", "service.js")
    assert sum((static / name).stat().st_size for name in loaded) < 400_000


# -- the gallery, and help -------------------------------------------------------------------------


def test_the_gallery_is_by_kind_and_is_searched_by_words(live: Live) -> None:
    page = live.page
    page.get_by_role("button", name="Open", exact=True).click()
    gallery = page.get_by_role("dialog", name="Open a machine")
    expect(gallery.get_by_text("Drawing the examples")).to_be_hidden()
    kinds = gallery.locator(".kinds").get_by_role("heading")
    names = kinds.all_inner_texts()
    assert names[:2] == ["Planting mechanisms", "Linkages"] and len(names) == 5
    cards = gallery.locator(".card")
    expected = {
        "four-bar": ("yamashita-1", "watt-six-bar"),
        "six-bar": ("watt-six-bar", "yamashita-1"),
        "straight line": ("slider-crank-engine", "drag-link"),
        "mount": ("yamashita-rig", "drag-link"),
        "cylinder": ("hydraulic-loader", "drag-link"),
        "Jansen": ("jansen-leg", "drag-link"),
    }
    for text, (shown, hidden) in expected.items():
        gallery.get_by_role("searchbox").fill(text)
        expect(gallery.locator(f"[data-name={shown}]")).to_be_visible()
        expect(gallery.locator(f"[data-name={hidden}]")).to_be_hidden()
        for section in gallery.locator(".kinds > section").filter(visible=True).all():
            assert section.locator(".card").filter(visible=True).count()
    page.screenshot(path=SCREENSHOTS / "gallery-kinds-1280.png")
    gallery.get_by_role("searchbox").fill("zeppelin")
    expect(gallery.get_by_text("No machine has these words.")).to_be_visible()
    expect(cards.filter(visible=True)).to_have_count(0)
    assert live.findings() == []


@pytest.mark.exhaustive
def test_help_reports_what_each_tool_does_and_leads_to_the_documentation(
    new_page: Callable[..., Page], address: str
) -> None:
    page = new_page()
    given = "document.head.insertAdjacentHTML('beforeend', '<link rel=help href=docs/index.html>')"
    page.add_init_script(f"document.addEventListener('DOMContentLoaded', () => {given})")
    live = Live.open(page, address)
    page.keyboard.press("?")
    keys = page.get_by_role("dialog", name="Keys")
    row = keys.get_by_role("row", name="Separate click")
    expect(row).to_contain_text("the last link at it gets a point of its own")
    link = keys.get_by_role("link", name="Documentation")
    assert (link.get_attribute("href") or "").endswith("docs/index.html")
    assert live.findings() == []
    page.set_viewport_size({"width": 400, "height": 900})
    page.screenshot(path=SCREENSHOTS / "help-400.png")
    assert page.evaluate(FITS)
