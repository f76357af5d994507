"""What is done is kept: in its file, in the browser, in an address."""

from __future__ import annotations

import json
import os
import signal
import socket
from collections.abc import Callable
from pathlib import Path

import pytest
from playwright.sync_api import Page, WebSocketRoute, expect

import equipoise as eq
from browser.live import OVER_A_SOCKET, Live
from support.chromium import served, serving
from surface.running import example_text

LEAVES = "window.dispatchEvent(new Event('beforeunload', { cancelable: true }))"
"""Whether the page can be left unasked."""


def free_port() -> str:
    with socket.create_server(("127.0.0.1", 0)) as held:
        return str(held.getsockname()[1])


def test_a_file_is_saved_and_its_steps_outlive_the_server(free_page: Page, tmp_path: Path) -> None:
    path, port = tmp_path / "mine.toml", free_port()
    path.write_text(example_text("yamashita-1"), encoding="utf-8")
    own, page = eq.load("yamashita-1"), free_page
    with serving(path, "--port", port) as address:
        live = Live.open(page, address)
        assert live.button("Save").is_disabled()
        live.type(live.field("crank mass"), "300 g")
        expect(live.button("Save")).to_be_enabled()
        assert page.evaluate(LEAVES) is False  # the browser asks first
        live.type(live.field("drive speed"), "150 rpm")
        live.page.keyboard.press("Control+s")
        asked = page.get_by_role("dialog", name="Question")
        expect(asked).to_contain_text("comments")
        asked.get_by_role("button", name="Save").click()
        expect(live.status("is saved")).to_be_visible()
        assert eq.load(path).links["crank"].mass == 0.3
        assert page.evaluate(LEAVES) is True
        live.button("Undo").click()
        expect(live.button("Save")).to_be_enabled()
        path.write_text(path.read_text(encoding="utf-8") + "\n", encoding="utf-8")
        live.button("Save").click()
        expect(live.status("by another page or program")).to_be_visible()
        path.write_text(path.read_text(encoding="utf-8")[:-1], encoding="utf-8")
        page.get_by_role("combobox", name="Example").select_option("drag-link")
        expect(asked).to_contain_text("mine.toml is not saved")
        asked.get_by_role("button", name="Cancel").click()
        expect(page.get_by_role("combobox", name="Example")).to_have_value("mine.toml")
    with serving(path, "--port", port) as address:
        live = Live.open(page, address)
        live.button("Redo").click()
        expect(live.button("Save")).to_be_disabled()  # as it is on disk
        live.button("Undo").click()
        live.button("Undo").click()
        expect(live.button("Undo")).to_be_disabled()
        assert live.machine() == own
        other = page.context.new_page()
        expect(Live.open(other, address).button("Undo")).to_be_disabled()
        page.close()
        other.reload()  # nobody else goes on with what was done there
        expect(other.get_by_text("was changed here before")).to_be_hidden()


@pytest.mark.exhaustive
def test_the_file_of_a_tool_is_saved_and_its_steps_outlive_the_server(
    free_page: Page, tmp_path: Path
) -> None:
    path, page, port = tmp_path / "mine.toml", free_page, free_port()
    path.write_text(example_text("brush-cutter"), encoding="utf-8")
    live = Live(page)
    with serving(path, "--port", port) as address:
        page.goto(address)
        expect(live.button("Save")).to_be_disabled()
        live.type(live.field("shaft outer diameter"), "30 mm")
        assert page.evaluate(LEAVES) is False
        live.button("Save").click()
        page.get_by_role("dialog", name="Question").get_by_role("button", name="Save").click()
        expect(live.status("mine.toml is saved")).to_be_visible()
        expect(live.button("Save")).to_be_disabled()
    with serving(path, "--port", port) as address:
        page.goto(address)
        live.button("Undo").click()
        expect(live.field("shaft outer diameter")).to_have_value("26 mm")
        expect(live.button("Save")).to_be_enabled()


@pytest.mark.exhaustive
@OVER_A_SOCKET
def test_nothing_is_undone_before_there_is_anything(
    new_page: Callable[..., Page], address: str
) -> None:
    page, held = new_page(), list[str]()

    def join(line: WebSocketRoute) -> None:
        server = line.connect_to_server()

        def pass_on(message: str | bytes) -> None:
            if '"speak"' in str(message):
                server.send(message)
            else:
                held.append(str(message))

        line.on_message(pass_on)

    page.route_web_socket("**/live*", join)
    page.goto(address)
    for name in ("Undo", "Redo", "Balance"):
        expect(Live(page).button(name)).to_be_disabled()
    for name in ("Download", "Tools"):  # what is inert is nowhere to those who hear the page
        expect(page.get_by_label(name, exact=True)).to_be_visible()
        assert page.get_by_label(name, exact=True).evaluate("one => !!one.closest('[inert]')")
    page.keyboard.press("Control+z")
    page.keyboard.press("Control+s")
    while not held:
        page.wait_for_timeout(20)
    assert [json.loads(item)["type"] for item in held] == ["ready"]


@pytest.mark.exhaustive
@OVER_A_SOCKET
def test_an_undo_while_a_page_comes_back_is_of_the_last_step(
    new_page: Callable[..., Page], address: str
) -> None:
    """And it is kept like every other."""
    page, slow, late = new_page(), False, list[Callable[[], None]]()

    def join(line: WebSocketRoute) -> None:
        server = line.connect_to_server()

        def pass_on(message: str | bytes) -> None:
            if slow and '"edit"' in str(message):
                late.append(lambda: server.send(message))
            else:
                server.send(message)

        line.on_message(pass_on)

    page.route_web_socket("**/live*", join)
    live = Live.open(page, address)
    live.type(live.field("crank mass"), "300 g")
    slow = True
    page.reload()
    while not late:
        page.wait_for_timeout(20)
    page.keyboard.press("Control+z")
    late.pop()()
    slow = False
    for _ in range(2):
        expect(live.field("crank mass")).to_have_value("199 g")
        expect(live.button("Redo")).to_be_enabled()
        expect(live.button("Undo")).to_be_disabled()
        page.reload()
    live.button("Redo").click()
    expect(live.field("crank mass")).to_have_value("300 g")


@pytest.mark.exhaustive
def test_what_was_done_in_a_closed_tab_is_offered(live: Live, address: str) -> None:
    live.type(live.field("crank mass"), "333 g")
    expect(live.button("Undo")).to_be_enabled()
    other = live.page.context.new_page()
    Live.open(other, address)
    expect(other.get_by_text("was changed here before")).to_be_hidden()  # it is open
    live.page.close()
    again = Live(live.page.context.new_page())
    again.page.goto(address.partition("#")[0])
    again.button("Go on").click()
    expect(again.field("crank mass")).to_have_value("333 g")
    again.button("Undo").click()
    expect(again.field("crank mass")).to_have_value("199 g")


@pytest.mark.exhaustive
def test_edits_without_a_server_are_kept_for_the_next_one(free_page: Page, tmp_path: Path) -> None:
    """Which has another token: the open tab goes there as soon as another one is opened."""
    path, port, page = tmp_path / "mine.toml", free_port(), free_page
    eq.save(eq.load("yamashita-1"), path)
    alert = page.get_by_role("alert").filter(has_text="does not answer")
    with served(path, "--port", port) as (address, number):
        live = Live.open(page, address)
        live.type(live.field("drive speed"), "150 rpm")
        os.kill(number, signal.SIGKILL)
        expect(alert).to_be_visible()
    live.field("crank mass").fill("300 g")
    live.field("crank mass").press("Enter")
    expect(alert).to_contain_text("Changes waiting for the server: 1")
    page.get_by_title("Download", exact=True).click()
    live.button("Download model").click()
    expect(live.status("the server does not answer; ask again when it does")).to_be_visible()
    live.button("Balance").click()
    expect(live.status("the server does not answer; ask again when it does")).to_be_visible()
    eq.save(eq.load("drag-link"), tmp_path / "other.toml")
    with serving(tmp_path / "other.toml", "--port", port) as address:
        other = page.context.new_page()
        Live.open(other, address)
        expect(page.get_by_role("alert").filter(has_text="has another file open")).to_be_visible()
        expect(other.get_by_text("was changed here before")).to_be_hidden()
    expect(alert).to_be_visible()
    with serving(path, "--port", port) as address:
        other.goto(address)
        expect(other.get_by_text("mine.toml was changed here before, in 2 steps")).to_be_visible()
        expect(page.locator(".lost[role=alert]")).to_be_hidden()
        live.settled()
        done = eq.load("yamashita-1").with_link("crank", mass=0.3)
        for tab in (live, Live(other)):
            if tab is not live:
                other.get_by_role("button", name="Go on").click()
            expect(tab.field("crank mass")).to_have_value("300 g")
            expect(tab.field("drive speed")).to_have_value("150 rpm")
            assert tab.machine().links == done.links
            tab.button("Undo").click()
            expect(tab.field("crank mass")).to_have_value("199 g")
        page.reload()  # by the new address
        expect(live.button("Redo")).to_be_enabled()


def test_a_link_holds_the_model(live: Live, new_page: Callable[..., Page]) -> None:
    """With its tables."""
    live.page.context.grant_permissions(["clipboard-read", "clipboard-write"])
    live.page.get_by_role("combobox", name="Example").select_option("four-stroke-engine")
    expect(live.page.get_by_role("heading", name="Four-stroke engine")).to_be_visible()
    live.type(live.field("crank mass"), "300 g")
    expect(live.button("Undo")).to_be_enabled()
    live.page.get_by_text("Download", exact=True).click()
    live.button("Copy link").click()
    expect(live.status("The link is copied")).to_be_visible()
    link = live.page.evaluate("navigator.clipboard.readText()")
    there = Live.open(new_page(), link)
    expect(there.field("crank mass")).to_have_value("300 g")
    files = [item.download("Download model") for item in (live, there)]
    assert files[0] == files[1] and 'table = "four-stroke-gas.csv"' in files[0][1]
    figures = ".readings .value"
    live.settled()
    expect(there.page.locator(figures)).to_have_text(live.page.locator(figures).all_inner_texts())
    assert "#" not in there.page.url  # a reload goes on with what is done from here
    there.page.goto(link[:-30])
    expect(there.status("holds only a part of a model")).to_be_visible()
    damaged = Live.open(new_page(), link.replace("model=", "model=A"))
    expect(damaged.status("holds only a part of a model")).to_be_visible()
