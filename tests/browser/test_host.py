"""The page on a web host: it computes in the browser, beside no server, and offline too."""

from __future__ import annotations

import gzip
import os
import re
import shutil
import threading
from io import BytesIO
from pathlib import Path
from zipfile import ZipFile

import pytest
from playwright.sync_api import Browser, BrowserContext, Page, Response, expect

from browser.live import LONGEST, Live
from equipoise.errors import UsageError
from equipoise.i18n import LANGUAGES, catalogue
from equipoise.web.bytecode import find_node
from equipoise.web.gallery import titles
from equipoise.web.site import Site, write_site
from support.chosen import EXHAUSTIVE, few
from support.host import RUNTIME, WHEELS, Quiet, hosting
from support.refusals import refused

TEXTS = re.compile(r"/equipoise_(\w+)-[^/]+\.whl")
"""A package with the catalogue of a language."""
MOST = 12e6
"""Bytes of the first load, from a host that compresses nothing."""


def opened(page: Page, address: str, name: str) -> Live:
    page.goto(f"{address}#example={name}")
    chosen = page.locator("select").first
    expect(chosen).to_have_value(name, timeout=LONGEST * 1000)
    live = Live(page)
    live.settled()
    return live


def until(page: Page, promise: str) -> None:
    """Wait until what a promise brings is true; `wait_for_function` takes the promise for that."""
    page.evaluate(
        f"""async () => {{
            const end = Date.now() + {LONGEST * 1000};
            while (!(await {promise})) {{
                if (Date.now() > end) throw new Error("in vain");
                await new Promise(done => setTimeout(done, 50));
            }}
        }}"""
    )


def test_the_first_load_is_small(context: BrowserContext, hosted: Site, host: str) -> None:
    """What is announced is what is sent until a machine can be dragged."""
    page, sent = context.new_page(), dict[str, int]()
    context.on("response", lambda got: sent.update({got.url: size_of(got)}))
    live = opened(page, host, "yamashita-1")
    joint = live.joint("B")
    before = live.place(joint)
    live.drag(joint, (14, -9))
    assert live.place(joint) != before
    page.close()
    unsent = re.compile(r"service\.js|^blob:")  # what starts later, and what is made in the page
    loaded = sum(size for url, size in sent.items() if not unsent.search(url))
    assert 0.99 * hosted.first < loaded < 1.01 * hosted.first
    assert hosted.first <= MOST


@pytest.mark.exhaustive
def test_what_the_first_machine_needs_is_compiled_already(hosted: Site) -> None:
    """Its sources are left out, as both would be a longer load; other modules are as they were.

    So is what pressing Balance imports, for which a drag would have to wait. Packages that lose
    their docstrings are compiled as a whole, as their modules read each other's.
    """
    if find_node() is None:
        pytest.skip("Node is not installed")
    assert hosted.compiled > 400

    def names(path: str) -> set[str]:
        (packed,) = hosted.folder.glob(f"{path}.gzip")
        with ZipFile(BytesIO(gzip.decompress(packed.read_bytes()))) as archive:
            return set(archive.namelist())

    for path, needed, other in (
        ("runtime/python_stdlib.zip", "typing", "doctest"),
        ("wheels/equipoise-*.whl", "equipoise/results/analysis", "equipoise/cli/site"),
        ("wheels/equipoise-*.whl", "equipoise/balancing/optimisation", "equipoise/cli/balance"),
    ):
        result = names(path)
        assert {f"{needed}.pyc", f"{other}.py"} <= result
        assert not {f"{needed}.py", f"{other}.pyc"} & result
    assert "numpy/ma/core.pyc" in (result := names("wheels/numpy-*.whl"))
    assert not [name for name in result if name.endswith(".py")]


@pytest.mark.exhaustive
@pytest.mark.parametrize("name", few(titles(), {"slider-crank-engine"}))
def test_every_machine_opens(context: BrowserContext, host: str, name: str) -> None:
    """One with loads that jump needs modules of NumPy that the first machine does not."""
    page = context.new_page()
    live = opened(page, host, name)
    expect(page.locator("[data-kind=point][aria-valuetext*=mm]").first).to_be_attached()
    expect(live.status("went wrong")).to_have_count(0)
    page.close()


@pytest.mark.exhaustive
def test_texts_are_loaded_of_the_language_that_is_spoken(
    context: BrowserContext, hosted: Site, host: str
) -> None:
    """Once used they are there offline too, as all else; no other language is ever loaded."""
    page, loaded = context.new_page(), list[str]()
    context.on("request", lambda sent: loaded.append(sent.url))
    live = opened(page, host, "yamashita-1")
    page.wait_for_function("() => navigator.serviceWorker.controller !== null")
    ja = catalogue("ja")
    assert not [url for url in loaded if TEXTS.search(url)]
    page.get_by_role("combobox", name="Language", exact=True).select_option("ja")
    expect(page.get_by_role("button", name=ja["Undo"])).to_be_visible()
    live.settled()
    context.set_offline(True)
    try:
        page.goto("about:blank")
        opened(page, host, "watt-six-bar")
        expect(page.get_by_role("button", name=ja["Undo"])).to_be_visible()
    finally:
        context.set_offline(False)
    page.evaluate("localStorage.clear()")
    page.close()
    assert {TEXTS.search(url)[1] for url in loaded if TEXTS.search(url)} == {"ja"}  # type: ignore[index]
    assert len([*hosted.folder.glob("wheels/equipoise_*.gzip")]) == len(LANGUAGES) - 1


def size_of(got: Response) -> int:
    return int(got.headers.get("content-length", 0))


@pytest.mark.exhaustive
def test_a_machine_is_changed_and_balanced_without_a_server(
    context: BrowserContext, host: str
) -> None:
    page = context.new_page()
    wrong: list[str] = []
    page.on("pageerror", lambda error: wrong.append(str(error)))
    live = opened(page, host, "balance-crank")
    readings = page.get_by_text("Shaking force", exact=True).first
    expect(readings).to_be_visible()
    live.type(live.field("drive speed"), "150 rpm")
    live.settled()
    live.button("Undo").click()
    live.settled()
    page.get_by_role("button", name="Balance", exact=True).click()
    keep = page.get_by_role("button", name="Keep", exact=True)
    expect(keep).to_be_visible(timeout=LONGEST * 1000)
    assert not wrong
    page.close()


class WithoutSciPy(Quiet):
    """A host that hands out all but SciPy, until that is free."""

    free = threading.Event()

    def do_GET(self) -> None:
        if "/scipy-" in self.path:
            self.free.wait(2 * LONGEST)
        super().do_GET()


@pytest.mark.exhaustive
def test_a_balance_is_cancelled_and_begun_again(browser: Browser, hosted: Site) -> None:
    """What it waits for is said, and a joint follows its keys meanwhile."""
    context = browser.new_context(viewport={"width": 1280, "height": 900}, reduced_motion="reduce")
    context.set_default_timeout(LONGEST * 1000)
    with hosting(hosted.folder, WithoutSciPy) as address:
        live = opened(context.new_page(), address, "yamashita-1")
        page, joint = live.page, live.joint("B")
        balance = page.get_by_role("button", name="Balance", exact=True)
        balance.click()
        loading = page.get_by_text("loading scipy, once")
        expect(loading).to_be_visible(timeout=2 * LONGEST * 1000)  # after a second Python
        before = joint.get_attribute("aria-valuetext") or ""
        joint.press("ArrowRight")
        expect(joint).not_to_have_attribute("aria-valuetext", before)
        page.get_by_role("button", name="Cancel", exact=True).click()
        expect(live.status("cancelled; nothing was changed")).to_be_visible()
        expect(loading).to_be_hidden()
        keep = page.get_by_role("button", name="Keep", exact=True)
        expect(keep).to_be_hidden()
        WithoutSciPy.free.set()
        balance.click()
        expect(keep).to_be_visible(timeout=2 * LONGEST * 1000)
        expect(live.button("Undo")).to_be_enabled()
    context.close()


@pytest.mark.exhaustive
def test_what_was_loaded_is_used_offline(browser: Browser, host: str) -> None:
    """From the first visit on, of one who has never been there."""
    context = browser.new_context(viewport={"width": 1280, "height": 900}, reduced_motion="reduce")
    context.set_default_timeout(LONGEST * 1000)
    page = context.new_page()
    opened(page, host, "yamashita-1")
    until(page, "caches.match(location.origin + '/')")
    page.close()
    again = context.new_page()
    context.set_offline(True)
    try:
        live = opened(again, host, "watt-six-bar")
        joint = again.locator("[data-kind=point]").first
        expect(joint).to_have_attribute("aria-valuetext", re.compile("mm"))
        live.settled()
    finally:
        context.close()


@EXHAUSTIVE
def test_a_new_build_takes_the_place_of_the_old_one(
    browser: Browser, hosted: Site, tmp_path: Path
) -> None:
    """Whatever the browser's own cache has: the visit after the next has all of the new one."""
    site = tmp_path / "site"
    shutil.copytree(hosted.folder, site)
    script, start = site / "worker.js", site / "index.html"
    os.utime(script)  # it has just been written, so that browsers ask whether there is a newer one
    context = browser.new_context(viewport={"width": 1280, "height": 900}, reduced_motion="reduce")
    context.set_default_timeout(LONGEST * 1000)

    def visited(address: str, build: str) -> str:
        """The script that the visit of a build leaves with what is kept."""
        text = start.read_text(encoding="utf-8")
        start.write_text(re.sub(r"build=\w+", f"build={build}", text), encoding="utf-8")
        page = context.new_page()
        opened(page, address, "yamashita-1")
        until(page, f"caches.has('equipoise {build}')")
        if build == "old":
            until(page, f"caches.match('{address}')")
        page.wait_for_timeout(2000)  # for what must not be kept
        kept: str = page.evaluate(
            "caches.match('/worker.js').then(script => script ? script.text() : '')"
        )
        page.close()
        return kept

    with hosting(site) as address:
        old = visited(address, "old")
        assert old == script.read_text(encoding="utf-8")
        script.write_text(f"{old}// newer\n", encoding="utf-8")
        assert visited(address, "new") != old
        assert visited(address, "new") == f"{old}// newer\n"
    context.close()


def test_a_link_opens_on_servers_and_hosts_alike(
    browser: Browser, host: str, server: tuple[str, int]
) -> None:
    context = browser.new_context(viewport={"width": 1280, "height": 900}, reduced_motion="reduce")
    context.set_default_timeout(LONGEST * 1000)
    context.grant_permissions(["clipboard-read", "clipboard-write"])
    live = Live.open(context.new_page(), server[0])
    live.type(live.field("crank mass"), "311 g")
    for there in (host, server[0]):  # from a server to a host, and on to a server
        live.page.get_by_text("Download", exact=True).click()
        live.button("Copy link").click()
        expect(live.status("The link is copied")).to_be_visible()
        _, _, model = live.page.evaluate("navigator.clipboard.readText()").partition("#")
        other = Live.open(context.new_page(), f"{there}#{model}")
        expect(other.field("crank mass")).to_have_value("311 g")
        assert other.machine() == live.machine()
        live = other
    context.close()


def test_a_damaged_wheel_is_refused(tmp_path: Path) -> None:
    if not RUNTIME.is_dir() or not any(WHEELS.glob("numpy-*.whl")):
        pytest.skip("the runtime and its wheels could not be fetched: make test fetches them")
    (wheel,) = WHEELS.glob("numpy-*.whl")
    (tmp_path / wheel.name).write_bytes(wheel.read_bytes()[:-1] + b"x")
    with refused(UsageError, by="_packages"):
        write_site(tmp_path / "site", RUNTIME, tmp_path)
    assert not (tmp_path / "site").exists()


def test_nothing_is_written_through_a_link(tmp_path: Path) -> None:
    if not RUNTIME.is_dir():
        pytest.skip("the runtime could not be fetched: make test fetches it")
    outside = tmp_path / "outside"
    outside.mkdir()
    for name in (".site.new", "link"):
        (tmp_path / name).symlink_to(outside)
    write_site(tmp_path / "site", RUNTIME)
    with refused(UsageError, by="_check_free"):
        write_site(tmp_path / "link", RUNTIME)
    assert not any(outside.iterdir())
    assert {path.name for path in tmp_path.iterdir()} == {".site.new", "link", "outside", "site"}


def test_the_gallery_opens_machines_in_the_page(tmp_path: Path) -> None:
    """Its links are hidden where there is no page around the documentation."""
    if not RUNTIME.is_dir():
        pytest.skip("the runtime could not be fetched: make test fetches it")
    docs = tmp_path / "docs"
    (docs / "ja").mkdir(parents=True)
    (docs / "index.html").write_text("", encoding="utf-8")
    link = '<a class="open-page" hidden href="../../#example=sieve">動かす</a>'
    (docs / "ja" / "examples.html").write_text(link, encoding="utf-8")
    site = write_site(tmp_path / "site", RUNTIME, docs=docs)
    shown = (site.folder / "docs" / "ja" / "examples.html").read_text(encoding="utf-8")
    assert shown == link.replace(" hidden", "")
    assert (docs / "ja" / "examples.html").read_text(encoding="utf-8") == link
