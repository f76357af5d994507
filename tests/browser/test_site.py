"""The documentation site, opened as files: search in three languages, and what all can read."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from urllib.parse import quote

import pytest
from playwright.sync_api import Browser, Page, expect

from browser.live import FITS, Live
from browser.test_looks import SCHEMES, WIDTHS, brightness
from support.chosen import few


@pytest.fixture
def page(browser: Browser, site: Path) -> Iterator[Page]:
    """A page that may read the site's files, and nothing else."""
    context = browser.new_context(reduced_motion="reduce")
    wrong: list[str] = []
    context.on("request", lambda sent: sent.url.startswith("file:") or wrong.append(sent.url))
    context.on("weberror", lambda error: wrong.append(str(error.error)))
    yield context.new_page()
    context.close()
    assert wrong == []


SOUGHT = {
    "how to model a spring": "recipes/model-a-spring.html",
    "how to cure a change point": "errors/change-point.html",
    "about which point is a shaking moment taken": (
        "recipes/about-which-point-a-shaking-moment-is-taken.html"
    ),
    "how to balance an engine's couple": "recipes/balance-an-engines-couple.html",
    "how to put a machine on mounts": "recipes/put-a-machine-on-mounts.html",
    "crank cannot turn": "errors/the-crank-cannot-turn-fully.html",
    "torsion spring table": "model-file/torsion_springs.html",
    "counterwieght": "recipes/cut-a-counterweight.html",
    "固有振動": "ja/first-machine.html",
    "균형추": "ko/first-machine.html",
}
"""What is typed into the search, and where its first hit leads."""


ALIKE = {"how to model a spring", "how to balance an engine's couple", "torsion spring table",
         "how to cure a change point", "how to put a machine on mounts",
         "about which point is a shaking moment taken"}  # fmt: skip
"""English, as others of them."""


@pytest.mark.parametrize("typed", few(SOUGHT, {*SOUGHT} - ALIKE))
def test_the_first_hit_answers(page: Page, site: Path, typed: str) -> None:
    """Each hit is a section; its excerpt has the words, and they are marked there."""
    page.goto((site / "index.html").as_uri())
    page.get_by_role("textbox", name="Search").fill(typed)
    page.keyboard.press("Enter")
    expect(page.get_by_role("heading", name="Search Results")).to_be_visible()
    first = page.locator(".search-hits > li").first
    link = first.get_by_role("link").get_attribute("href")
    assert link is not None
    assert link.partition("#")[0] == SOUGHT[typed]
    assert (site / SOUGHT[typed]).is_file()
    if typed != "counterwieght":  # what is misspelled stands nowhere
        expect(first.locator("mark").first).to_be_visible()


ASKED = {
    "why does my crank not turn all the way": "errors/the-crank-cannot-turn-fully.html",
    "degrees of freedom wrong": "errors/the-linkage-has-too-many-degrees-of-freedom.html",
    "dead centre": "errors/change-point.html",
    "the motor is too weak": "errors/the-motor-stalls.html",
    "how to add friction in a bearing": "recipes/see-what-friction-costs.html",
    "how to model a cam": "recipes/model-a-cam.html",
    "how to model a hydraulic cylinder": "examples.html",
    "how to size a flywheel": "recipes/size-a-flywheel.html",
    "transmission angle too small": "recipes/improve-a-transmission-angle-that-is-too-small.html",
    "isolate the floor from vibration": "recipes/put-a-machine-on-mounts.html",
    "how to avoid a resonance": "recipes/find-speeds-to-keep-away-from.html",
    "what counterweight do I need": "recipes/cut-a-counterweight.html",
    "drawing of the counterweight for the workshop": "exchange.html",
    "how much vibration may my hands take per day": "recipes/judge-what-a-hand-may-bear.html",
    "how do tolerances affect the shaking": "studies.html",
    "gas pressure on a piston": "model-file/loads.html",
    "several rows with cranks out of phase": "balancing.html",
    "how to use it from Python": "python.html",
    "sign convention of angles": "conventions.html",
    "bearing life": "output.html",
    "friction in pins": "recipes/see-what-friction-costs.html",
    "flywheel size": "recipes/size-a-flywheel.html",
    "hand arm vibration limit": "exposure.html",
    "import from MATLAB": "commands.html",
    "why is my torque zero": "recipes/find-out-why-a-torque-is-zero.html",
    "units": "model-file/units-1.html",
    "counterweight drawing": "recipes/cut-a-counterweight.html",
    "natural frequencies of the frame": "tutorials/put-it-on-mounts.html",
    "export to CAD": "commands.html",
    "critical speed of a shaft": "recipes/find-speeds-to-keep-away-from.html",
    "moment of inertia from geometry": (
        "recipes/compute-a-moment-of-inertia-from-the-geometry.html"
    ),
    "share a machine with a colleague": "recipes/share-a-machine-with-others.html",
    "jerk of a cam follower": "recipes/model-a-cam.html",
    "what is a dyad": "theory.html",
    "soil resistance of a planting finger": "model-file/planting/plantingsoil.html",
    "stress in a link": "output.html",
    "belt drive": "model-file/belts.html",
    "gear ratio": "model-file/gears.html",
    "how accurate is it": "trust.html",
    "run many designs in parallel": "tour.html",
    "how do I install it": "README.html",
    "which units can I use": "model-file/units-1.html",
    "how to make a video": "animation.html",
}
"""What an engineer asks in words of the trade, and the page that answers."""


@pytest.mark.exhaustive
def test_the_first_hit_answers_questions_of_engineers(page: Page, site: Path) -> None:
    """Each in words of the trade."""
    first = {}
    for typed in ASKED:
        page.goto(f"{site.as_uri()}/search.html?q={quote(typed)}")
        link = page.locator(".search-hits > li a").first.get_attribute("href")
        first[typed] = (link or "").partition("#")[0]
    assert first == ASKED


@pytest.mark.exhaustive
def test_what_is_nowhere_is_not_shown(page: Page, site: Path) -> None:
    """No hits, and a sentence."""
    page.goto(f"{site.as_uri()}/search.html?q=xyzzyq")
    expect(page.locator("#search-results")).to_have_text("Nothing was found.")


def test_the_first_page_has_a_machine_that_can_be_dragged(page: Page, site: Path) -> None:
    """A drag in the frame of the first page changes the figures in it."""
    page.set_viewport_size({"width": 1280, "height": 1000})
    page.goto((site / "index.html").as_uri())
    frame = page.frame_locator("iframe.live-machine")
    figures = frame.locator("table").first
    expect(figures).to_be_visible()
    before = figures.inner_text()
    box = frame.get_by_role("slider", name="Joint C", exact=True).bounding_box()
    assert box is not None
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x + 15, y + 10, steps=4)
    page.mouse.up()
    expect(figures).not_to_have_text(before)


@pytest.mark.exhaustive
def test_pictures_are_as_dark_as_the_page_that_is_chosen(page: Page, site: Path) -> None:
    """Whatever the system is; a picture of another shape than its place has no frame of white."""
    for system, chosen in (("light", "dark"), ("dark", "light")):
        page.emulate_media(color_scheme=system)
        page.goto((site / "examples.html").as_uri())
        page.evaluate("chosen => { document.body.dataset.theme = chosen; }", chosen)
        picture = page.locator("img[src*='plunger-pump']").first
        picture.scroll_into_view_if_needed()
        assert picture.evaluate("one => one.complete || one.decode()") is not False
        assert (brightness(picture) > 128) == (chosen == "light")


READABLE = (
    "conformance/kim-and-chung.html",
    "conformance/yamashita-ichikawa-and-mori.html",
    "conformance/iso-5349.html",
    "model-file/springs.html",
    "model-file/support/supportmountsname.html",
    "glossary.html",
)


@pytest.mark.exhaustive
@pytest.mark.parametrize("width", few(WIDTHS, {400}))
def test_tables_of_many_columns_are_read_without_moving_them(
    page: Page, site: Path, width: int
) -> None:
    """Each column is in sight; where there is no room for all, a row is a list with headings."""
    page.set_viewport_size({"width": width, "height": 900})
    for name in READABLE:
        page.goto(f"{site.as_uri()}/{name}")
        assert page.locator("table.many-columns").count(), name
        hidden = "all => all.filter(one => one.scrollWidth > one.clientWidth + 1).length"
        assert page.eval_on_selector_all(".table-wrapper", hidden) == 0, name


@pytest.mark.exhaustive
@pytest.mark.parametrize("width", few(WIDTHS, {400}))
def test_long_lines_of_code_make_no_page_wider(page: Page, site: Path, width: int) -> None:
    page.set_viewport_size({"width": width, "height": 900})
    for name in ("studies.html", "balancing.html"):
        page.goto(f"{site.as_uri()}/{name}")
        assert page.evaluate(FITS), name
    page.goto(f"{site.as_uri()}/errors/change-point.html")  # messages are read whole
    cut = "all => all.filter(one => one.scrollWidth > one.clientWidth + 1).length"
    assert page.eval_on_selector_all(".highlight-text pre", cut) == 0


@pytest.mark.exhaustive
def test_a_command_stands_beside_python(page: Page, site: Path) -> None:
    """Where there is room; on a narrow page below it, and each has a button that copies it."""
    for width, beside in ((1280, True), (400, False)):
        page.set_viewport_size({"width": width, "height": 900})
        page.goto(f"{site.as_uri()}/recipes/put-a-machine-on-mounts.html")
        shown = page.locator(".two-ways pre")
        command, python = (shown.nth(place).bounding_box() for place in (0, 1))
        assert command is not None and python is not None
        assert (command["x"] + command["width"] <= python["x"]) == beside
        assert page.locator(".two-ways button.copybtn").count() == shown.count() == 2
        assert page.locator("article img").first.get_attribute("src")


SMALL_TEXT = 6.5
"""Size of the smallest letters of plots, points."""


@pytest.mark.exhaustive
def test_texts_of_plots_can_be_read_on_a_telephone(page: Page, site: Path) -> None:
    """Another picture stands there; the smallest letters of both are 8 pixels at least."""
    sizes = """all => all.filter(one => one.offsetParent)
        .map(one => one.clientWidth / one.naturalWidth)"""
    for name in ("balancing.html", "figures.html", "recipes/size-a-flywheel.html"):
        for width in WIDTHS:
            page.set_viewport_size({"width": width, "height": 900})
            page.goto(f"{site.as_uri()}/{name}")
            plots = page.locator("img.where-wide, img.where-narrow")
            expect(plots.locator("visible=true")).to_have_count(plots.count() // 2)
            for scale in plots.evaluate_all(sizes):
                assert SMALL_TEXT * 96 / 72 * scale >= 8, (name, width)


@pytest.mark.exhaustive
def test_names_of_functions_are_whole_on_a_telephone(page: Page, site: Path) -> None:
    page.set_viewport_size({"width": 400, "height": 900})
    page.goto(f"{site.as_uri()}/api/equipoise.balancing.html")
    lines = "all => all.map(one => one.getClientRects().length)"
    assert {*page.eval_on_selector_all("table.names td:first-child code span.pre", lines)} == {1}


PRINTED = (
    "index.html",
    "glossary.html",
    "conformance/lee-and-kim.html",
    "api/equipoise.balancing.html",
    "tutorials/put-it-on-mounts.html",
    "balancing.html",
    "recipes/balance-an-engines-couple.html",
)


@pytest.mark.exhaustive
def test_pages_are_printed_whole(page: Page, site: Path) -> None:
    """Nothing is cut at an edge, no table waits for a page of its own, no link lies on the text."""
    page.emulate_media(media="print")
    page.set_viewport_size({"width": 700, "height": 1000})  # as wide as paper
    scrolled = """all => all.filter(one => one.scrollWidth > one.clientWidth + 1
        && getComputedStyle(one).overflowX != "visible").length"""
    parted = """all => all.filter(one => getComputedStyle(one).overflowY != "visible").length"""
    for name in PRINTED:
        page.goto(f"{site.as_uri()}/{name}")
        assert page.eval_on_selector_all("article *", scrolled) == 0, name
        containers = "article .table-wrapper, article pre, article .highlight, article .cell-html"
        assert page.eval_on_selector_all(containers, parted) == 0, name
        expect(page.locator(".skip-to-content")).to_be_hidden()


KINDS = (
    "index.html",
    "first-machine.html",
    "displacement-matrices.html",
    "decay.html",
    "ko/examples.html",
    "api/equipoise.measured.html",
    "tutorials/put-it-on-mounts.html",
    "glossary.html",
    "model-file/springs.html",
    "conformance/kim-and-chung.html",
    "recipes/model-a-spring.html",
    "errors/change-point.html",
    "search.html?q=counterweight",
)


@pytest.mark.parametrize("turn", few([0, 1], {0}))
def test_a_page_of_each_kind(page: Page, site: Path, turn: int) -> None:
    """Nothing serious is found by axe, and nothing has to be moved from side to side.

    turn : pages are wide and light, or narrow and dark, by turns; which of them begins.
    """
    looks = [*zip(WIDTHS, SCHEMES, strict=True)]
    for number, name in enumerate(KINDS, turn):
        width, scheme = looks[number % len(looks)]
        page.set_viewport_size({"width": width, "height": 900})
        page.emulate_media(color_scheme=scheme)
        page.goto(f"{site.as_uri()}/{name}")
        assert page.evaluate(FITS), name
        assert Live(page).findings() == [], name
