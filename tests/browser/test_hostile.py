"""What a stranger sends to the page: nothing of it is run, and what is wrong is one sentence."""

from __future__ import annotations

import json
import os
import zlib
from base64 import urlsafe_b64encode
from collections.abc import Callable
from pathlib import Path
from typing import Any
from urllib.parse import urlencode

import pytest
import tomli_w
from playwright.sync_api import Page, expect

from browser.live import Live
from equipoise.schema.files import LARGEST
from support import machines_any
from support.chosen import few
from support.hostile import HOSTILE, hostile_text
from surface.running import equipoise, example_text, succeeded

WHOLE = "holds only a part of a model"
RUN = """() => {
  const leads = new Set(["href", "xlink:href", "src", "action", "formaction", "data", "srcdoc"]);
  const script = (value) => value.trim().toLowerCase().startsWith("javascript:");
  const runs = ({ name, value }) => name.startsWith("on") || (leads.has(name) && script(value));
  const elements = [...document.querySelectorAll("*")];
  return [
    window.x,
    ...elements.flatMap((one) => [...one.attributes].filter(runs).map(({ value }) => value)),
    ...document.querySelectorAll(
      "iframe, object, embed, img[src=x], script:not([src]):not([type])",
    ),
  ].filter(Boolean).map(String);
}"""
"""What was run of texts, or would be."""
MEMORY = 300 * 2**20
"""Bytes by which a page may grow: a bomb of its size would take four times as much."""


def packed(data: bytes) -> str:
    """As the page packs what a link holds."""
    return in_letters(zlib.compress(data, 9))


def in_letters(data: bytes) -> str:
    return urlsafe_b64encode(data).decode().rstrip("=")


def bomb(letter: bytes) -> str:
    """1.2 GB of one letter, packed block by block: of all at once it would take many seconds."""
    block, count = letter * 10**6, 1200
    packing = zlib.compressobj(9)
    first, again = (packing.compress(block) + packing.flush(zlib.Z_FULL_FLUSH) for _ in range(2))
    total = 1
    for _ in range(count):
        total = zlib.adler32(block, total)
    end = packing.flush()[:-4] + total.to_bytes(4, "big")
    return in_letters(first + again * (count - 1) + end)


def link_of(address: str, model: str, name: str = "mine.toml", **more: str) -> str:
    """A link that holds a model; more : further parts, packed."""
    page, _, _ = address.partition("#")
    return f"{page}#{urlencode({'name': name, 'model': packed(model.encode()), **more})}"


def most_memory() -> int:
    """The most that any page of this test's browsers has held so far, bytes."""
    parents, sizes = {}, {}
    for folder in Path("/proc").glob("[0-9]*"):
        try:
            status = dict(
                line.split(":\t", 1)
                for line in (folder / "status").read_text().splitlines()
                if ":\t" in line
            )
            words = (folder / "cmdline").read_bytes()
        except OSError:  # it has ended meanwhile
            continue
        parents[int(folder.name)] = int(status["PPid"])
        if b"--type=renderer" in words and "VmHWM" in status:
            sizes[int(folder.name)] = 1024 * int(status["VmHWM"].split()[0])

    def of_this_test(number: int) -> bool:
        while number > 1:
            if number == os.getpid():
                return True
            number = parents.get(number, 0)
        return False

    return max((size for number, size in sizes.items() if of_this_test(number)), default=0)


NAMES = (HOSTILE, "javascript:window.x=1", "../../etc/passwd", "n" * 9999)


@pytest.mark.parametrize("name", few(NAMES, (HOSTILE,)))
def test_names_and_texts_of_a_shared_machine_are_text(
    name: str, new_page: Callable[..., Page], address: str
) -> None:
    live = Live.open(new_page(), link_of(address, hostile_text(), name))
    page = live.page
    expect(page.get_by_role("heading", level=1)).to_contain_text("<script>window.x=1</script>")
    for handle in (page.locator("[data-kind=point]").first, page.locator("[data-kind]").last):
        handle.focus()
        handle.press("ArrowRight")
    live.settled()
    for tab in page.get_by_role("tab").all():
        tab.click()
        live.settled()
    page.get_by_title("Download", exact=True).click()
    live.settled()
    assert page.evaluate(RUN) == []


WRONG: dict[str, Callable[[], str]] = {
    "no base64": lambda: "model=%%%",
    "markup": lambda: f"model={HOSTILE}",
    "a script": lambda: "model=javascript:window.x=1&example=",
    "not packed": lambda: "model=aGVsbG8",
    "not UTF-8": lambda: f"model={packed(b'schema = 1 ' + bytes([0xFF, 0xFE]))}",
    "cut off": lambda: f"model={packed(example_text('yamashita-1').encode())[:-30]}",
    "too large": lambda: f"model={packed(b'#' * (LARGEST + 1))}",
    "a bomb": lambda: f"model={bomb(b'#')}",
    "tables that are a bomb": lambda: f"model={packed(b'a = 1')}&tables={bomb(b' ')}",
    "tables that are no JSON": lambda: f"model={packed(b'a = 1')}&tables={packed(b'{')}",
}


ONE_OF_EACH = (
    *("not UTF-8", "cut off", "a bomb"),
    *("tables that are a bomb", "tables that are no JSON"),
)


@pytest.mark.parametrize("kind", few(WRONG, ONE_OF_EACH))
def test_a_link_that_holds_no_model_is_refused_in_a_sentence(
    kind: str, new_page: Callable[..., Page], address: str
) -> None:
    live = Live.open(new_page(), address)
    before = most_memory()
    live.page.evaluate("hash => { location.hash = hash }", WRONG[kind]())
    expect(live.status(WHOLE)).to_be_visible()
    live.joint("B").press("ArrowRight")  # the machine that was there still is
    live.settled()
    assert live.page.evaluate(RUN) == []
    assert 0 < most_memory() < before + MEMORY


TABLES: tuple[Any, ...] = ([], {"load.csv": 7}, {"__proto__": "x"})
MORE_TABLES = (7, "text", {"load.csv": {"a": []}}, None)


@pytest.mark.exhaustive
@pytest.mark.parametrize("tables", few((*TABLES, *MORE_TABLES), TABLES[1:2]))
def test_tables_of_other_kinds_are_refused_in_a_sentence(
    tables: object, new_page: Callable[..., Page], address: str
) -> None:
    model = example_text("yamashita-1") + '\n[[loads]]\nlink = "crank"\ntable = "load.csv"\n'
    link = link_of(address, model, tables=packed(json.dumps(tables).encode()))
    live = Live.open(new_page(), address)
    live.page.goto(link)
    reported = live.status("load.csv").or_(live.status("texts of files")).or_(live.status(WHOLE))
    expect(reported.first).to_be_visible()
    assert live.page.evaluate(RUN) == []


@pytest.mark.exhaustive
def test_an_example_of_a_link_is_a_name_and_nothing_else(
    new_page: Callable[..., Page], address: str
) -> None:
    live = Live.open(new_page(), address)
    for name in (HOSTILE, "../../../etc/passwd", "n" * 9999):
        live.page.evaluate(
            "name => { location.hash = new URLSearchParams({ example: name }) }", name
        )
        expect(live.status(name[:20])).to_be_visible()
        assert live.page.evaluate(RUN) == []
    live.joint("B").press("ArrowRight")
    live.settled()


@pytest.mark.exhaustive
@pytest.mark.parametrize("seed", few(range(0, 60, 10), (0, 10)))
def test_machines_from_nothing_open_by_a_link_or_are_refused(
    seed: int, new_page: Callable[..., Page], address: str
) -> None:
    document, tables = machines_any.files(seed)
    more = {"tables": packed(json.dumps(tables).encode())} if tables else {}
    page = new_page()
    page.goto(link_of(address, tomli_w.dumps(document), **more))
    title = page.get_by_role("heading", name=document["title"], exact=True)
    texts = page.get_by_role("status").filter(has_text="mine.toml")
    expect(title.or_(texts).first).to_be_visible()
    assert page.evaluate(RUN) == []


def test_an_interactive_file_runs_no_name(new_page: Callable[..., Page], tmp_path: Path) -> None:
    (tmp_path / "model.toml").write_text(hostile_text(), encoding="utf-8")
    succeeded(equipoise("export", tmp_path / "model.toml", "-o", tmp_path / "machine.html"))
    succeeded(equipoise("report", tmp_path / "model.toml", "-o", tmp_path / "report.html"))
    page = new_page()
    for name in ("machine.html", "report.html"):
        page.set_content((tmp_path / name).read_text(encoding="utf-8"))
        expect(page.get_by_text("<script>window.x=1</script>").first).to_be_attached()
        assert page.evaluate("window.x === undefined && !document.querySelector('img[src=x]')")
