"""The notebook's widget: its module in a page, its Python side here, and between them a model that
hands messages over as anywidget does, with bytes that begin anywhere.
"""

from __future__ import annotations

from base64 import b64encode
from collections.abc import Callable
from typing import Any

from playwright.sync_api import Page, expect

import equipoise as eq
from browser.live import Live

SHOW = """async ([script, style]) => {
    const heard = new Set();
    const model = {
        on: (_, listener) => heard.add(listener),
        off: (_, listener) => heard.delete(listener),
        send: async (content) => {
            for (const [told, bytes] of await python(content)) {
                const data = Uint8Array.from(atob(bytes), (sign) => sign.charCodeAt(0));
                const buffers = data.length > 1 ? [new DataView(data.buffer, 1)] : [];
                heard.forEach((listener) => listener(told, buffers));
            }
        },
    };
    const file = new Blob([script], { type: "text/javascript" });
    const module = await import(URL.createObjectURL(file));
    const cell = document.createElement("div");  // Jupyter puts it into the page later
    window.end = await module.default.render({ model, el: cell });
    await new Promise((done) => setTimeout(done, 200));
    const sheet = new CSSStyleSheet();
    await sheet.replace(style);
    document.adoptedStyleSheets = [sheet];
    document.body.append(cell);
}"""
BLUE = """() => [...document.querySelectorAll(".uplot canvas")].map((canvas) => {
    const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
    let found = 0;
    for (let i = 0; i < data.length; i += 4) {
        if (data[i + 3] > 200 && data[i + 2] > 2 * data[i] + 60) found += 1;
    }
    return found;
})"""
"""Pixels of each chart that have the colour of curves."""


def test_the_widget(new_page: Callable[..., Page]) -> None:
    view, page = eq.view("yamashita-1"), new_page(viewport={"width": 800, "height": 900})
    replies: list[tuple[dict[str, Any], str]] = []

    def send(content: dict[str, Any], buffers: list[bytes]) -> None:
        replies.append((content, b64encode(b"\0" + b"".join(buffers)).decode()))

    def python(content: dict[str, Any]) -> list[tuple[dict[str, Any], str]]:
        replies.clear()
        view._handle_custom_msg(content, [])
        return list(replies)

    view.send = send
    page.expose_function("python", python)
    page.evaluate(SHOW, [view._esm, view._css])
    live = Live(page)
    live.type(live.field("crank mass"), "0.3 kg")
    expect(live.button("Undo")).to_be_enabled()
    assert view.machine == eq.load("yamashita-1").with_link("crank", mass=0.3)
    joint = live.joint("B")
    before = live.place(joint)
    live.drag(joint, (-10, -10))
    expect(joint).not_to_have_attribute("aria-valuenow", f"{before[0]:.2f}")
    assert abs(view.machine.links["crank"].points["B"][0]) < 0.0335
    assert min(page.evaluate(BLUE)) > 50
    page.evaluate("end()")
    assert page.inner_text("body").strip() == ""
