"""How long a user of the live page waits: from a key or a drag to the painted frame.

    python benchmarks/live_page.py [NAME ...]

A Chromium without a window shows 720 crank angles and all charts of bundled linkages: of those that
are named, else of a four-bar, of one on its rig, and of the one that takes longest.  The page marks
when an input came and when the frame that shows its answer was painted; an input whose place a
newer one took is answered by the frame of the newer one.

Medians and 95th percentiles (ms) on two quiet cores, the slowest among them:

    linkage                      keys      drag     of it the server's processor, a move
    yamashita-1                  26  41    26  41    6
    stephenson-six-bar           31  51    33  50
    quick-return                 33  50    33  49   10
    four-row-transplanter        29  46    30  43
    yamashita-rig                29  47    30  46    8, was 34 by threads that waited
    yamashita-rig-counterweight  30  50    33  49
    riding-transplanter          35  58    37  59   10, was 55; gauges 20, five times a second
    sieve                        39  63    37  53   11, was 18
    class-three                  45  65    44  63   15, was 25: followed from the motion before

Beside other programs that keep both cores busy all of these are up to twice as long, and beside
many of them several times: that is printed, and ends no benchmark after it.

    python benchmarks/live_page.py --worker [NAME ...]

measures the page of a site in the same way, which computes in WebAssembly in the browser.  On two
cores without other programs, medians and 95th percentiles of three days:

    linkage                keys      drag         keys      drag         keys      drag
    yamashita-1            40  75    35  54       69 145    65  97       67 117    55  85
    slider-crank-engine    78 113    63  82      104 176    83 133       63  99    51  93
    stephenson-six-bar     46  74    41  59      145 239   107 256       74 155    75 122

On the second day the machine was slower, not the page: in alternation with the page of the first
day, beside other programs, a frame of `yamashita-1` took 130 ms of the processor's time while keys
were pressed, against 154 ms; a third of it in the browser's main thread, a quarter in the worker,
and the rest to paint and compose, as there was no graphics card.

Before the third day a drawing came to be laid out once a frame, and figures and readings to be
written every 0.3 s while something is held. In alternation with the page before, beside many other
programs, a frame took 124 ms of the processor's time against 142 (`stephenson-six-bar`), and 99
against 102 (`slider-crank-engine`).

After the third day the least margins of dyads are searched between the points of the grid only
where they are asked for. In alternation with the page of that day, beside many other programs, a
frame of `stephenson-six-bar` took 107 ms of the processor's time against 128, the worker 37 of it
against 50.

On the fourth day keys of `stephenson-six-bar` took 33 and 82 ms (median, 95th percentile) beside
other programs with a load of 5. A frame took 45 ms of the processor's time, the worker 14 of it,
and of 31 bundled linkages of dyads 35 to 87: `balance-rig` 87, `hydraulic-loader` 78, `knife-drive`
70, `exudyn-slider-crank` 69, `cam-pusher` 62, `plunger-pump` 60, all others at most 56. Since then
outputs are listed once for a build, and the swing of a support comes from a fast transform: a move
takes 11.5 ms of a server's processor, and no longer 27, for `balance-rig`, and 6.5 for the six-bar,
after 7.2. In alternation in a browser the worker took 14.5 ms a frame for the six-bar, after 17.2,
and 21.5 for `balance-rig`, after 22. A first visit took Chromium 6.4 s of the processor's time
until a joint was dragged.

On a fifth day, on two cores without other programs, of a faster machine (its server answers
`yamashita-1` in 23 and 34 ms):

    linkage                keys      drag
    yamashita-1            23  39    22  38
    slider-crank-engine    23  41    21  41
    stephenson-six-bar     28  49    23  39
    balance-rig            28  48    33  46
    knife-drive            30  57    30  50
    cam-pusher             35  57    32  48
    hydraulic-loader       46  71    45  74

A key costs as much as a move of a drag: keys that follow one another are moves of one drag, which
is finished once they have paused.  But keys come whether or not the page keeps up, while a browser
takes the next move of a mouse only with the next frame.  A drag therefore never runs ahead
of the page, and where a frame takes longer than the pause between two inputs, keys do: beside other
programs 150 keys had 92 frames, and as many moves 150.  Frames are printed beside the inputs.

    python benchmarks/live_page.py --cold

measures how long a stranger waits: from an empty browser, over 20 Mbit/s from a host that
compresses nothing, until a joint has been dragged.  Without bytecode in the site, on a slow
machine, that took 16.5 s, and Chromium 19.0 and 19.3 s of the processor's time until the machine
was drawn; with it, in alternation, 12.0 and 10.9 s of that time, and later 11.1 s as a whole; on
the faster machine of the fifth day 7.3 s.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Sequence
from pathlib import Path
from statistics import median, quantiles
from tempfile import TemporaryDirectory
from time import monotonic

from equipoise import load
from equipoise.web.bytecode import find_node
from equipoise.web.edits import movable
from equipoise.web.site import write_site
from peers import required

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))

with required("playwright"):
    from playwright.sync_api import Browser, Page

    from browser.live import Live
    from support.chromium import chromium, path_of_chromium, serving
    from support.host import RUNTIME, WHEELS, SlowLine, hosting

NAMES = "yamashita-1", "yamashita-rig", "class-three"
INPUTS = 150
PAUSE = 30  # ms between inputs: a held key, and half as many moves as a mouse can make
Limits = dict[str, float]
LIMITS: Limits = {"median": 50, "95th percentile": 100}  # ms
OF_WORKER: Limits = {"median": 80, "95th percentile": 150}  # ms
DYADS = "yamashita-1", "slider-crank-engine", "stephenson-six-bar"
LARGEST = 400_000  # bytes
COLD = 15  # s
MARKS = """name => performance.getEntriesByName(name).map(m => [m.detail.seq, m.startTime])"""


def waits(page: Page) -> tuple[list[float], int]:
    """Milliseconds from each input to the first frame that shows it or a newer one, and how many
    frames were painted.
    """
    painted = sorted(page.evaluate(MARKS, "equipoise:painted"))
    found = []
    for seq, came in page.evaluate(MARKS, "equipoise:input"):
        frame = next((at for shown, at in painted if shown >= seq and at >= came), None)
        if frame is not None:
            found.append(frame - came)
    page.evaluate("performance.clearMarks()")
    return found, len(painted)


def pin_of(name: str) -> str:
    """The crank's pin, or another point that moves and can be dragged."""
    machine = load(name)
    points = [point for point in movable(machine) if point not in machine.frame]
    crank = machine.links[machine.drive.link].points
    return next((point for point in points if point in crank), points[0])


def keys(live: Live, joint: str) -> None:
    """Move a joint by arrow keys."""
    live.joint(joint).focus()
    for number in range(INPUTS):
        live.page.keyboard.press("ArrowRight" if number // 10 % 2 else "ArrowLeft")
        live.page.wait_for_timeout(PAUSE)


def drags(live: Live, joint: str) -> None:
    """Drag a joint around a small circle."""
    x, y = live.spot(live.joint(joint))
    live.page.mouse.move(x, y)
    live.page.mouse.down()
    for number in range(INPUTS):
        angle = number * math.tau / 40
        live.page.mouse.move(x - 15 + 15 * math.cos(angle), y + 15 * math.sin(angle))
        live.page.wait_for_timeout(PAUSE)
    live.page.mouse.up()


def report(what: str, found: list[float], frames: int, limits: Limits) -> bool:
    """Print the times; tell whether they are within the limits."""
    values = {"median": median(found), "95th percentile": quantiles(found, n=20)[-1]}
    for name, value in values.items():
        count = f"{len(found)} inputs, {frames} frames"
        print(f"{what}, {name}: {value:.1f} ms (limit {limits[name]} ms, {count})")
    return all(value <= limits[name] for name, value in values.items())


def acted(live: Live, name: str, limits: Limits) -> bool:
    """Measure keys and a drag; tell whether they are within the limits."""
    within = []
    for what, act in {"arrow keys": keys, "drag": drags}.items():
        waits(live.page)
        act(live, pin_of(name))
        live.page.wait_for_timeout(500)
        within.append(report(f"{name}, {what}", *waits(live.page), limits))
    return all(within)


def timed(browser: Browser, name: str) -> bool:
    """Measure one linkage on a server's page; tell whether it is within the limits."""
    with serving(name) as address:
        page = browser.new_page(viewport={"width": 1280, "height": 900}, reduced_motion="reduce")
        sizes: list[int] = []
        page.on("response", lambda answer: sizes.append(len(answer.body())))
        live = Live.open(page, address)
        page.wait_for_timeout(1000)
        print(f"{name}: page {sum(sizes) / 1000:.1f} kB (limit {LARGEST / 1000:.0f} kB)")
        within = acted(live, name, LIMITS)
        page.close()
    return within and sum(sizes) <= LARGEST


def timed_in_worker(browser: Browser, names: Sequence[str]) -> bool:
    """Measure linkages on the page of a site; tell whether it is within the limits."""
    within = []
    with TemporaryDirectory() as folder:
        site = write_site(Path(folder) / "site", RUNTIME, WHEELS, node=find_node())
        with hosting(site.folder) as address:
            for name in names:
                page = browser.new_page(
                    viewport={"width": 1280, "height": 900}, reduced_motion="reduce"
                )
                page.set_default_timeout(10_000 * COLD)
                page.goto(f"{address}#example={name}")
                page.wait_for_selector(f"option[value='{name}']:checked", state="attached")
                live = Live(page)
                live.settled()
                within.append(acted(live, name, OF_WORKER))
                page.close()
    return all(within)


def timed_cold(browser: Browser) -> bool:
    """Measure a first visit to a site; tell whether a joint was dragged within the limit."""
    with TemporaryDirectory() as folder:
        site = write_site(Path(folder) / "site", RUNTIME, WHEELS, node=find_node())
        with hosting(site.folder, SlowLine) as address:
            page = browser.new_page(viewport={"width": 1280, "height": 900})
            page.set_default_timeout(10_000 * COLD)
            begin = monotonic()
            page.goto(f"{address}#example={NAMES[0]}", wait_until="commit")
            joint = page.locator(f"[data-name={pin_of(NAMES[0])}]")
            joint.and_(page.locator("[aria-valuetext]")).wait_for()
            shown = monotonic() - begin
            before = joint.get_attribute("aria-valuetext")
            box = joint.bounding_box()
            assert box is not None
            page.mouse.move(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
            page.mouse.down()
            page.mouse.move(box["x"] + 25, box["y"] + 25, steps=5)
            page.mouse.up()
            page.wait_for_function(
                "([joint, before]) => joint.getAttribute('aria-valuetext') !== before",
                arg=[joint.element_handle(), before],
            )
            dragged = monotonic() - begin
            page.close()
    print(f"first visit: drawn after {shown:.1f} s, dragged after {dragged:.1f} s (limit {COLD} s)")
    return dragged <= COLD


def main(worker: bool, cold: bool, names: Sequence[str]) -> bool:
    if path_of_chromium() is None:
        print("Chromium is not installed, and nothing is measured without it")
        return True
    with chromium() as browser:
        if cold:
            return timed_cold(browser)
        if worker:
            return timed_in_worker(browser, names or DYADS)
        within = [timed(browser, name) for name in names or NAMES]
    return all(within)


if __name__ == "__main__":
    words = [word for word in sys.argv[1:] if not word.startswith("--")]
    if not main("--worker" in sys.argv, "--cold" in sys.argv, words):
        print("slower or larger than its limits, which are those of two quiet cores")
