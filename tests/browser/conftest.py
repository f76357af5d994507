"""A Chromium, a server as a user starts it, and a page of it for each test.

Where there is no Chromium or no bundle the tests are skipped, and fail if EQUIPOISE_BROWSER is
``required``.  A test fails too if its page reports an error or asks for anything beyond the server.
A picture of each page of a test that fails is kept in ``build/screenshots``.
"""

from __future__ import annotations

import fcntl
import os
import pickle
import re
import runpy
from collections.abc import Callable, Iterator
from typing import cast

import pytest
from playwright.sync_api import Browser, BrowserContext, ConsoleMessage, Page, expect

from browser.live import LONGEST, PUBLISHED, ROOT, SCREENSHOTS, Live
from equipoise.web.bytecode import find_node
from equipoise.web.site import Site, write_site
from support.chromium import chromium, path_of_chromium, served
from support.host import RUNTIME, WHEELS, hosting, lacks_runtime


def unavailable(reason: str) -> None:
    """Skip, or fail where the tests of the browser are demanded."""
    if os.environ.get("EQUIPOISE_BROWSER") == "required":
        pytest.fail(reason)
    pytest.skip(reason)


@pytest.fixture(scope="session")
def server() -> Iterator[tuple[str, int]]:
    """A server with a machine: its address, and the number of its process."""
    if not runpy.run_path(str(ROOT / "page" / "bundle.py"))["is_fresh"]():
        unavailable("there is no bundle of the live page, or an old one: make page")
    with served("yamashita-1") as result:
        yield result


@pytest.fixture(scope="session")
def hosted(tmp_path_factory: pytest.TempPathFactory) -> Site:
    """The page as a folder for any web host, which the first worker writes for all of them."""
    if lacks_runtime():
        pytest.skip("the runtime and its wheels could not be fetched: make test fetches them")
    around = tmp_path_factory.getbasetemp()
    around = around.parent if "PYTEST_XDIST_WORKER" in os.environ else around
    written = around / "host.pickle"
    with (around / "host.lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not written.exists():
            site = write_site(around / "host" / "site", RUNTIME, WHEELS, node=find_node())
            written.write_bytes(pickle.dumps(site))
    return cast(Site, pickle.loads(written.read_bytes()))


@pytest.fixture(scope="session")
def host(hosted: Site) -> Iterator[str]:
    """The address of a web host that has it."""
    with hosting(hosted.folder) as address:
        yield address


@pytest.fixture(
    scope="session", params=["socket", pytest.param("worker", marks=pytest.mark.exhaustive)]
)
def address(request: pytest.FixtureRequest) -> str:
    """The address of a page with a machine, over a socket, or over a worker of the browser."""
    if request.param == "worker":
        return f"{request.getfixturevalue('host')}#example=yamashita-1"
    address, _ = request.getfixturevalue("server")
    return address


@pytest.fixture(scope="package")  # longer, and Playwright's event loop would disturb other tests
def browser() -> Iterator[Browser]:
    """A Chromium."""
    if path_of_chromium() is None:
        unavailable("there is no Chromium (Debian: apt-get install chromium-headless-shell)")
    expect.set_options(timeout=LONGEST * 1000)
    with chromium() as browser:
        yield browser


@pytest.fixture
def new_page(
    browser: Browser, address: str, request: pytest.FixtureRequest
) -> Iterator[Callable[..., Page]]:
    """Open a page in a context of its own, with Playwright's options of contexts.

    Reduced motion is asked for, so that the linkage stands still at first.
    """
    contexts: list[BrowserContext] = []
    wrong: list[str] = []
    origin = re.sub(r"/[?#].*", "", address)
    known = (origin, origin.replace("http", "ws", 1), "data:", "blob:")
    published = PUBLISHED if "#" in address else origin  # of a server's page nothing is asked there

    def watch(url: str) -> None:
        if not url.startswith((*known, published)):
            wrong.append(f"asks for {url}")

    def hear(said: ConsoleMessage) -> None:
        if said.type == "error" and not said.location["url"].startswith(PUBLISHED):
            wrong.append(said.text)

    def new(**options: object) -> Page:
        usual = {"viewport": {"width": 1280, "height": 900}, "reduced_motion": "reduce"}
        context = browser.new_context(**{**usual, **options})
        context.set_default_timeout(LONGEST * 1000)
        contexts.append(context)
        context.on("request", lambda sent: watch(sent.url))
        context.on("weberror", lambda error: wrong.append(str(error.error)))
        context.on("console", hear)
        page = context.new_page()
        page.on("websocket", lambda socket: watch(socket.url))
        return page

    failed = request.session.testsfailed
    yield new
    pages = [page for context in contexts for page in context.pages]
    for number, page in enumerate(pages if request.session.testsfailed > failed else []):
        name = re.sub(r"[^\w.-]+", "-", request.node.name) + (f"-{number + 1}" if number else "")
        page.screenshot(path=SCREENSHOTS / f"{name}.png", full_page=True)
    for context in contexts:
        context.close()
    assert not wrong


@pytest.fixture(scope="module")
def context(browser: Browser) -> Iterator[BrowserContext]:
    """One reader of a module's tests, whose browser keeps what it has loaded."""
    context = browser.new_context(viewport={"width": 1280, "height": 900}, reduced_motion="reduce")
    context.set_default_timeout(LONGEST * 1000)
    yield context
    context.close()


@pytest.fixture
def free_page(browser: Browser, server: tuple[str, int]) -> Iterator[Page]:
    """A page that may go to servers of its own test, whichever wire others go by."""
    context = browser.new_context(viewport={"width": 1280, "height": 900}, reduced_motion="reduce")
    context.set_default_timeout(LONGEST * 1000)
    yield context.new_page()
    context.close()


@pytest.fixture
def live(new_page: Callable[..., Page], address: str) -> Live:
    """The live page with its machine, 1280 pixels wide."""
    return Live.open(new_page(), address)
