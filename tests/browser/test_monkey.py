"""A monkey on the live page: whatever it clicks, drags and types, the page lives and answers.

It plays with one machine after the other on a page that is never loaded again.  After each, the
model that the page gives has to be what it shows, and where it plays for long neither page nor
server may grow.  What a page reports as an error fails the test by itself.  Set EQUIPOISE_MONKEY to
the minutes that it is to play; `build/monkey-0.txt` tells of memory.
"""

from __future__ import annotations

import io
import json
import os
import random
import re
import shutil
import time
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, field
from itertools import cycle
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pytest
from playwright.sync_api import CDPSession, Error, Locator, Page, expect

import equipoise as eq
from browser.live import SCREENSHOTS, Live
from equipoise import Machine
from equipoise.mechanism.kinematics.swinging import swing
from equipoise.schema.files import to_csv

MINUTES, LONG = float(os.environ.get("EQUIPOISE_MONKEY", "0")), 20
"""That each monkey plays, at least a round; from where on memory counts,
when all that is made once has been made.
"""
ACTIONS = 30
"""Of a round."""
MACHINES = (
    *("yamashita-1", "class-three", "yamashita-rig", "planetary-planting-arm", "scotch-yoke"),
    *("four-row-transplanter", "stephenson-six-bar", "balance-geared-a", "slider-crank-engine"),
    *("quick-return", "brush-cutter", "sieve", "balance-coupler", "riding-transplanter"),
)
REST, AWAY = "yamashita-1", "watt-six-bar"
"""What is open where memory is measured, so that it is the same each time; and another."""
ASKED = """document.querySelector(".question[open]")
    || document.querySelector(".bar [aria-label=Undo]").disabled"""
"""Whether the page asks if it may give up what was done, or there is nothing to be given up."""
TEXTS = ("", "0", "-1 mm", "50 mm", "1e9 m", "12 deg", "abc", "1,5 mm", "\u0663", "x" * 300)
KEYS = (
    *("Tab", "Enter", "Escape", "ArrowUp", "ArrowLeft", "Shift+ArrowRight", "Control+z"),
    *("Control+y", "Space", "End", "Delete", "v", "p", "l", "j", "x", "s", "g", "d", "?"),
)
SIZES = ((400, 700), (1280, 900), (1920, 1000))
TABLES = [*Path(eq.__file__).parent.glob("examples/*.csv")]
"""That examples name; a page gives them beside its model."""
LONGEST = 1000
"""ms that the monkey waits for one thing."""
MISTAKE = b"went wrong inside the program"
HEAR = """mistake => {
    const Plain = Worker;
    window.Worker = class extends Plain {
        constructor(...given) {
            super(...given);
            this.addEventListener("message", ({ data }) => {
                if (!(data instanceof Uint8Array)) return;
                const begin = new TextDecoder().decode(data.subarray(0, 500));
                if (begin.includes(mistake)) console.error(begin);
            });
        }
    };
}"""
"""Reports answers of a worker that tell of a mistake, as those of a server are heard."""
FOUND = """([what, chance]) => {
    document.querySelector("[data-found]")?.removeAttribute("data-found");
    const open = document.querySelector("dialog[open]") ?? document;
    const some = [...open.querySelectorAll(what)].filter(
        (one) => one.checkVisibility() && !one.disabled && !one.matches(".language"));
    some[Math.floor(chance * some.length)]?.setAttribute("data-found", "");
}"""
"""Marks one of what there is to be seen; a language would load the page anew."""
WAYS = {
    "click": 1,
    "button": 4,
    "drag": 4,
    "nudge": 6,
    "number": 6,
    "type": 2,
    "key": 6,
    "choose": 2,
    "scroll": 1,
    "size": 1,
}
"""What is done, and how often."""


@dataclass
class Monkey:
    """What plays on a page, and what it has found."""

    live: Live
    chance: random.Random
    wrong: list[str] = field(default_factory=list)
    done: int = 0
    rounds: int = 0
    checked: int = 0

    def __post_init__(self) -> None:
        self.live.page.on("websocket", lambda socket: socket.on("framereceived", self._hear))
        self.live.page.add_init_script(f"({HEAR})({json.dumps(MISTAKE.decode())})")

    def _hear(self, frame: str | bytes) -> None:
        if isinstance(frame, bytes) and MISTAKE in frame:
            self.wrong.append(repr(frame[:500]))

    def round(self, machine: str, actions: int) -> None:
        """Play with a machine, and look at what has become of it."""
        self.open(machine)
        for _ in range(actions):
            self.play()
        self.check()
        self.rounds += 1

    def play(self) -> None:
        """Do one thing, somewhere; what cannot be done there is left."""
        what = self.chance.choices([*WAYS], [*WAYS.values()])[0]
        with suppress(Error):  # what it reached for has gone meanwhile, or lies under another
            getattr(self, f"_{what}")()
        self.done += 1

    def _element(self, what: str) -> Locator | None:
        """One of those that a selector finds; no handle, which would keep what is taken away."""
        self.live.page.evaluate(FOUND, [what, self.chance.random()])
        result = self.live.page.locator("[data-found]")
        return result if result.count() else None

    @property
    def _spot(self) -> tuple[float, float]:
        size = self.live.page.viewport_size
        assert size is not None
        return self.chance.uniform(0, size["width"]), self.chance.uniform(0, size["height"])

    def _click(self) -> None:
        self.live.page.mouse.click(*self._spot)

    def _button(self) -> None:
        if (result := self._element("button, summary, input[type=checkbox]")) is not None:
            result.click(timeout=LONGEST)

    def _hold(self, to: Callable[[float, float], tuple[float, float]]) -> None:
        result = self._element("svg [role=slider]")
        box = None if result is None else result.bounding_box(timeout=LONGEST)
        if box is None:
            return
        x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
        mouse = self.live.page.mouse
        mouse.move(x, y)
        mouse.down()
        mouse.move(*to(x, y), steps=3)
        mouse.up()

    def _drag(self) -> None:
        there = self._spot
        self._hold(lambda *_: there)

    def _nudge(self) -> None:
        """Drag a little, so that the machine is one that turns still."""
        dx, dy = self.chance.uniform(-15, 15), self.chance.uniform(-15, 15)
        self._hold(lambda x, y: (x + dx, y + dy))

    def _type(self) -> None:
        self._enter(self.chance.choice(TEXTS))

    def _number(self) -> None:
        """Type a number a little larger or smaller than what there is."""
        factor = self.chance.uniform(0.8, 1.25)
        self._enter(
            lambda old: re.sub(r"\d+(\.\d+)?", lambda item: f"{float(item[0]) * factor:.4g}", old)
        )

    def _enter(self, text: str | Callable[[str], str]) -> None:
        field = self._element("input:not([type=checkbox], [type=range], [type=file])")
        if field is not None:
            old = field.input_value(timeout=LONGEST)
            field.fill(text if isinstance(text, str) else text(old), timeout=LONGEST)
            field.press("Enter", timeout=LONGEST)

    def _key(self) -> None:
        actual = self._element("svg [role=slider]") if self.chance.random() < 0.5 else None
        if actual is not None:
            actual.focus()
        self.live.page.keyboard.press(self.chance.choice(KEYS))

    def _choose(self) -> None:
        result = self._element("select")
        if result is not None:
            values = result.evaluate(
                "one => [...one.options].map(({ value }) => value)", timeout=LONGEST
            )
            if values:  # a machine without joints has none to choose from
                result.select_option(self.chance.choice(values), timeout=LONGEST)

    def _scroll(self) -> None:
        self.live.page.mouse.wheel(0, self.chance.choice((-400, 400)))

    def _size(self) -> None:
        width, height = self.chance.choice(SIZES)
        self.live.page.set_viewport_size({"width": width, "height": height})

    # -- between rounds ----------------------------------------------------------------------------

    def rest(self) -> None:
        """Close and put down whatever is open or in hand."""
        page = self.live.page
        page.set_viewport_size({"width": 1280, "height": 900})
        for _ in range(9):
            if not page.locator("dialog[open]").count():
                break
            page.keyboard.press("Escape")
        page.evaluate(
            "document.querySelectorAll('details[open]').forEach((one) => (one.open = false))"
        )
        for _ in range(3):
            page.keyboard.press("Escape")
        self.live.settled()

    def open(self, name: str) -> None:
        """Open an example in the place of what there is, whatever that is."""
        self.rest()
        choice = self.live.page.locator("select[data-machines]")
        for item in (AWAY, name) if choice.input_value() == name else (name,):
            choice.select_option(item)
            self.live.page.wait_for_function(ASKED)
            question = self.live.page.locator(".question[open] button.strong")
            question.click() if question.count() else None
            expect(self.live.button("Undo")).to_be_disabled()
            expect(choice).to_have_value(item)
            opening = self.live.page.get_by_text(f"Opening {item} …").filter(visible=True)
            expect(opening).to_have_count(0)

    def check(self) -> None:
        """What the page shows has to be what `analyze` makes of the model that it gives."""
        self.rest()
        live = self.live
        if live.page.locator(".tool:visible").count():
            return
        while live.page.locator(".equipoise.unfinished").count():
            if live.button("Undo").is_disabled():
                return  # it was begun from nothing
            live.button("Undo").click()
            live.settled()
        shown = self._download("csv")
        machine = self._model()
        swings = swing(machine)  # as commands let it, too, where the crank cannot turn
        analysis = eq.analyze(swings.machine if swings else machine)
        angles = (shown.count("\n") - 1) // analysis.motion.turns
        made = to_csv(eq.analyze(analysis.machine, angles))
        assert shown.partition("\n")[0] == made.partition("\n")[0]
        tables = (io.StringIO(text) for text in (shown, made))
        of_page, of_model = (np.genfromtxt(table, delimiter=",", skip_header=1) for table in tables)
        near = 1e-6 * np.nanmax(np.abs(of_model), axis=0) + 1e-12  # a file has 12 digits
        assert np.all((np.abs(of_page - of_model) <= near) | np.isnan(of_model))
        self.checked += 1

    def _model(self) -> Machine:
        """The machine of the model that the page gives, beside the tables of all examples."""
        with TemporaryDirectory() as folder:
            for table in TABLES:
                shutil.copy(table, folder)
            file = Path(folder, "model.toml")
            file.write_text(self._download("model"), encoding="utf-8")
            return eq.load(file)

    def _download(self, kind: str) -> str:
        """The text of one of the downloads, past any that the monkey has asked for before."""
        self.live.page.locator("summary[aria-label=Download]").click()
        name, end = {"csv": ("Download CSV", ".csv"), "model": ("Download model", ".toml")}[kind]
        with self.live.page.expect_download(
            lambda item: item.suggested_filename.endswith(end)
        ) as coming:
            self.live.button(name).click()
        text: str = coming.value.path().read_text(encoding="utf-8")
        return text


@dataclass
class Memory:
    """What page and server, if there is one, hold after each round, with the same machine open."""

    page: CDPSession
    server: int | None
    samples: list[tuple[float, float, float]] = field(default_factory=list)

    def measure(self) -> None:
        """Tell the script's memory (MB), the number of nodes, and the server's memory (MB)."""
        self.page.send("HeapProfiler.collectGarbage")
        heap = self.page.send("Runtime.getHeapUsage")["usedSize"] / 1e6
        nodes = self.page.send("Memory.getDOMCounters")["nodes"]
        self.samples.append((heap, nodes, self._resident()))

    def _resident(self) -> float:
        if self.server is None:
            return 0.0
        status = Path(f"/proc/{self.server}/status").read_text(encoding="ascii")
        resident = re.search(r"VmRSS:\s+(\d+)", status)
        assert resident is not None
        return int(resident[1]) / 1e3

    def growth(self) -> list[float]:
        """How much each has grown over the last half, by the line that fits best."""
        late = np.array(self.samples[len(self.samples) // 2 :])
        return [float(np.polyfit(range(len(late)), item, 1)[0] * len(late)) for item in late.T]


@pytest.mark.exhaustive(but=["socket-0"] if MINUTES else [])
@pytest.mark.parametrize("seed", range(2 if MINUTES else 1))
def test_a_monkey(
    new_page: Callable[..., Page], address: str, request: pytest.FixtureRequest, seed: int
) -> None:
    page = new_page(accept_downloads=True)
    monkey = Monkey(Live(page), random.Random(seed))
    Live.open(page, address)
    process = None if "#" in address else request.getfixturevalue("server")[1]
    memory = Memory(page.context.new_cdp_session(page), process)
    end = time.monotonic() + 60 * MINUTES
    machines = cycle(MACHINES[seed:] + MACHINES[:seed])
    text = SCREENSHOTS.parent / f"monkey-{seed}.txt"
    text.parent.mkdir(exist_ok=True)
    while monkey.rounds < 1 or time.monotonic() < end:
        monkey.round(next(machines), ACTIONS)
        monkey.open(REST)
        memory.measure()
        lines = [f"{monkey.done} actions, {monkey.checked} checks; heap, nodes, server"]
        lines += [
            f"{heap:.2f} MB {nodes} {server:.0f} MB" for heap, nodes, server in memory.samples
        ]
        text.write_text("\n".join(lines), encoding="utf-8")
    assert monkey.wrong == []
    assert monkey.checked
    if MINUTES >= LONG:
        heap, nodes, resident = memory.growth()
        assert heap < 1 and nodes < 1500 and resident < 60
