"""A Chromium, and the live page's server as a user starts it."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager

from playwright.sync_api import Browser, sync_playwright

from surface.running import command

NAMES = ("chromium-headless-shell", "chromium", "chromium-browser", "google-chrome")
"""The shell has no windows and menus behind its page, which cost a quarter of a test."""
FLAGS = [
    "--disable-quic",
    "--disable-component-update",
    "--disable-background-networking",
    "--host-resolver-rules=MAP * ~NOTFOUND, EXCLUDE 127.0.0.1",
    # Chromium heeds the last such list alone: Playwright's that matter here, and the two pages that
    # wait behind the address bar of every window, which cost as much as the live page.
    "--disable-features=AvoidUnnecessaryBeforeUnloadCheckSync,HttpsUpgrades,PaintHolding,"
    "ThirdPartyStoragePartitioning,WebUIOmniboxAimPopup,WebUIOmniboxPopup",
]


def path_of_chromium() -> str | None:
    """Return where Chromium is installed."""
    return next(filter(None, map(shutil.which, NAMES)), None)


@contextmanager
def chromium(*more: str) -> Iterator[Browser]:
    """A Chromium without a window, that finds nothing but this machine."""
    flags = [*FLAGS, *more] if os.geteuid() else [*FLAGS, *more, "--no-sandbox"]  # root has none
    with sync_playwright() as playwright:
        path = path_of_chromium()
        browser = playwright.chromium.launch(executable_path=path, args=flags)
        yield browser
        browser.close()


@contextmanager
def serving(*arguments: str) -> Iterator[str]:
    """Run `equipoise serve`, and give the address that it prints."""
    with served(*arguments) as (address, _):
        yield address


@contextmanager
def served(*arguments: str) -> Iterator[tuple[str, int]]:
    """The same, and the number of its process."""
    words = command("serve", *arguments, "--no-browser")
    with subprocess.Popen(words, stdout=subprocess.PIPE, encoding="utf-8") as server:
        assert server.stdout is not None
        actual = (re.search(r"http://\S+", line) for line in iter(server.stdout.readline, ""))
        address = next(filter(None, actual), None)
        try:
            assert address is not None, "the server ended"
            yield address[0], server.pid
        finally:
            server.terminate()
