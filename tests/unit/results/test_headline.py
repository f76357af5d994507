"""What stands first: the verdict for this machine, in some lines; the rest where it is wanted."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import pytest

import equipoise as eq
import support.findings
from equipoise.cli import run
from equipoise.handheld.hand_exposure import expose_tool
from equipoise.i18n import speaking
from equipoise.present import html_of
from equipoise.present.pages import page
from equipoise.quantities import parse
from equipoise.results.blocks import Facts, Text
from equipoise.results.yardsticks import assess, verdict
from support.chosen import DISTINCT, EXHAUSTIVE, model_of
from support.findings import findings_of, report_of
from support.languages import COMPLETE

EXAMPLES = Path(eq.__file__).parent / "examples"
ADVISED = [*map(str, sorted((Path(support.findings.__file__).parent / "advised").glob("*.toml")))]
(EXCAVATOR,) = (file for file in ADVISED if Path(file).stem == "excavator")
NARROW = "\N{NO-BREAK SPACE}"
VERDICTS = {
    "hydraulic-loader": "Force of the cylinder A to B, peak: 25.6 kN",
    "cam-pusher": "Shaking moment, peak: 7.13 N m",
    "twin-engine": "Rocking moment, peak: 116 N m",
    "quick-return": "Drive torque, peak to peak: 211 N m",
    "sieve": "Velocity at stand_along, RMS: 143 mm/s",
}


def printed(capsys: pytest.CaptureFixture[str], *words: str) -> list[str]:
    assert run([*words]) == 0
    return capsys.readouterr().out.splitlines()


@pytest.mark.exhaustive(
    but=[
        "hydraulic-loader-Force of the cylinder A to B, peak: 25.6 kN",
        "cam-pusher-Shaking moment, peak: 7.13 N m",
    ]
)
@pytest.mark.parametrize(("name", "first"), VERDICTS.items())
def test_the_verdict_of_this_machine_stands_first_everywhere(
    name: str, first: str, capsys: pytest.CaptureFixture[str]
) -> None:
    lines = printed(capsys, "analyze", name)
    assert lines[1].startswith(first)
    assert printed(capsys, "analyze", name, "--full")[1] == lines[1]
    analysis = eq.analyze(eq.load(name))
    html = html_of(analysis).replace(NARROW, " ")
    assert html.index(first) < html.index("<table")
    report = page(report_of(name)).replace(NARROW, " ")
    assert report.index(first) < report.index('class="tiles"')


BRIEF = 15
"""Lines, at 80 columns."""
LINKAGES = [
    name
    for name in sorted(eq.examples("linkage"))
    if "\n[drive]" in (EXAMPLES / f"{name}.toml").read_text("utf-8")
]
QUICK = {
    *(("analyze", name) for name in (*DISTINCT, "excavator", "press", "two-motor-mixer")),
    *(("respond", name) for name in ("riding-transplanter", "yamashita-rig")),
    *(("balance", name) for name in ("balance-shafts", "beam-pump", "frame-saw", "hydraulic-loader",
                                     "inline-3-rows", "press", "stamping-press")),
    ("tool", "nagamine-irie"),
}  # fmt: skip
"""Of every command and kind of machine some; the others show the same before a release."""
COMMANDS = [
    *(("analyze", item) for item in (*LINKAGES, *ADVISED)),
    *(("respond", name) for name in LINKAGES if model_of(name).support is not None),
    *(("balance", item) for item in ADVISED),
    *(("balance", name) for name in ("balance-geared-a", "balance-shafts", "cam-pusher",
                                     "exudyn-slider-crank", "hydraulic-loader", "sieve",
                                     "walking-transplanter", "watt-six-bar")),
    *(("tool", name) for name in sorted(eq.examples("tool"))),
]  # fmt: skip


@pytest.mark.parametrize(
    "command",
    [
        pytest.param(
            (command, name),
            id=f"{command} {Path(name).stem}",
            marks=() if (command, Path(name).stem) in QUICK else EXHAUSTIVE,
        )
        for command, name in COMMANDS
    ],
)
def test_what_stands_first_has_fifteen_lines_and_begins_with_the_verdict(
    command: tuple[str, ...], capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COLUMNS", "80")
    lines = printed(capsys, *command)
    assert len(lines) <= BRIEF and max(map(len, lines)) <= 80
    title = 1 if len(str(eq.load(command[1]).title)) <= 80 else 2
    verdict = " ".join(lines[title : title + 2])
    assert re.search(r"\d|Leave the|No counterweight|^!", verdict) and not verdict.startswith(" ")
    assert lines[-2].startswith("Look at next: ") or lines[-3].startswith("Look at next: ")


def test_changes_are_never_left_out(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Notes and what else is large may be."""
    monkeypatch.setenv("COLUMNS", "60")
    lines = printed(capsys, "balance", "balance-shafts")
    assert sum(": add a sector of" in line for line in lines) == 3


@EXHAUSTIVE
def test_notes_that_are_left_out_are_counted(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COLUMNS", "80")
    (crusher,) = (file for file in ADVISED if Path(file).stem == "jaw-crusher")
    text = "\n".join(printed(capsys, "balance", crusher))
    assert "shaft: add a sector of" in text and re.search(r"notes left out here: \d", text)


@pytest.mark.exhaustive(but=["command0"])
@pytest.mark.parametrize(
    "command",
    [
        ("analyze", "twin-engine"),
        ("respond", "sieve", "--speed", "100 rpm : 400 rpm", "--speeds", "9"),
        pytest.param(("balance", "balance-rig"), marks=EXHAUSTIVE),
        pytest.param(("tool", "nagamine-irie"), marks=EXHAUSTIVE),
    ],
)
def test_a_command_prints_a_few_lines_and_the_rest_with_full(
    command: tuple[str, ...], capsys: pytest.CaptureFixture[str]
) -> None:
    brief, whole = printed(capsys, *command), printed(capsys, *command, "--full")
    assert len(brief) <= BRIEF and len(whole) > 1.3 * len(brief)
    assert brief[-1].startswith("--full prints all tables")
    assert not any(line.startswith("--full prints") for line in whole)
    assert printed(capsys, *command, "--json") == printed(capsys, *command, "--json", "--full")


# Verdicts of tools: `test_what_stands_first_has_fifteen_lines_and_begins_with_the_verdict`.
@pytest.mark.exhaustive
def test_the_verdict_of_a_tool_is_what_a_day_amounts_to(capsys: pytest.CaptureFixture[str]) -> None:
    brief = printed(capsys, "tool", "brush-cutter")
    assert brief[1].startswith("! A day of work: A(8) = 6.85 m/s^2, above the limit value")
    assert printed(capsys, "tool", "brush-cutter", "--full")[1] == brief[1]
    actual, document = findings_of("brush-cutter"), report_of("brush-cutter")
    assert document.verdict is not None and document.verdict.emphasis == "broken"
    a8 = expose_tool(actual.tool, actual.speeds).a8  # type: ignore[union-attr]
    assert f"A(8) = {a8:.2f} m/s²" in document.verdict.text


@pytest.mark.exhaustive(but=["hydraulic-loader"])
@pytest.mark.parametrize("file", ["hydraulic-loader", EXCAVATOR])
def test_a_machine_without_a_crank_has_no_crank_angle(
    file: str, capsys: pytest.CaptureFixture[str]
) -> None:
    for words in (("analyze", file), ("analyze", file, "--full"), ("balance", file)):
        text = "\n".join(printed(capsys, *words))
        reported = text.partition("Look at next")[0]
        assert not re.search(r"crank|rpm|drive pivot", reported.replace("double-crank", ""), re.I)
        assert "cycle" in text and "cycles a minute" in text
    assert "crank angle" not in "\n".join(printed(capsys, "check", file))


def test_the_report_of_a_machine_without_a_crank_has_none(tmp_path: Path) -> None:
    document = page(report_of("hydraulic-loader"))
    text = re.sub(r"(?s)<style.*?</style>|<[^>]+>", " ", document).replace(NARROW, " ")
    own = text.partition("Settings")[0].partition("speed = ")[0]
    assert not re.search(r"crank angle|\brpm\b|drive pivot", own)


def test_commands_that_are_named_are_there(capsys: pytest.CaptureFixture[str]) -> None:
    """The output to look at is one that `analyze --output` takes, with names of several words."""
    for name in ("hydraulic-loader", "cam-pusher", "quick-return", "rotary-transplanter"):
        lines = "\n".join(printed(capsys, "analyze", name))
        (output,) = re.findall(r"analyze --output ('[^']+'|[^\s;]+)[;.]", lines)
        shown = printed(capsys, "analyze", name, "--output", output.strip("'"))
        assert any(line.startswith("Outputs over") for line in shown)


def test_what_else_is_large_is_ranked_beside_its_yardsticks() -> None:
    analysis = eq.analyze(eq.load("twin-engine"))
    entries = assess(analysis)
    first = verdict(entries)
    (large,) = (element for element in analysis.headline(alone=True)
                if isinstance(element, Facts) and "large" in element.title)  # fmt: skip
    rest = [element for element in entries if element is not first and element.is_large]
    assert len(large.items) == min(3, len(rest))
    for item, entry in zip(large.items, rest, strict=False):
        assert item.lower().startswith(str(entry.label).lower()[:12])


def test_a_machine_without_masses_is_judged_by_its_motion() -> None:
    machine = eq.load("yamashita-1")
    links = {name: link.__class__(points=link.points) for name, link in machine.links.items()}
    analysis = eq.analyze(replace(machine, links=links, balance=None))
    blocks = [*analysis.headline(alone=True)]
    texts = [block.text for block in blocks if isinstance(block, Text)]
    assert any("3 moving links; crank driven" in text for text in texts)
    assert texts[0].startswith("Transmission angle")


def test_a_nearly_dead_dyad_is_judged_before_what_shakes(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """The machine of `new` with its pins in the frame 9 mm apart turns as a drag link, 17 deg from
    where it jams; at 90 mm it is a good crank-rocker.
    """
    file = tmp_path / "machine.toml"
    assert run(["new", str(file)]) == 0
    text = file.read_text("utf-8")
    assert text.count('distance = "90 mm"') == 1
    for distance, first in (("9 mm", "Transmission angle at C, smallest: 17.1"),
                            ("90 mm", "Shaking")):  # fmt: skip
        file.write_text(text.replace('"90 mm"', f'"{distance}"'), "utf-8")
        capsys.readouterr()
        assert printed(capsys, "analyze", str(file))[1].startswith(first)
    (wiper,) = (file for file in ADVISED if file.endswith("wiper.toml"))
    assert printed(capsys, "analyze", wiper)[1].startswith("Transmission angle at C, largest: 162")


def test_a_follower_that_stays_on_is_no_trouble(capsys: pytest.CaptureFixture[str]) -> None:
    """What is large comes first, then up to which speed the follower stays on; one that lifts off
    stands before all else, and so does the margin of a machine of which nothing is known but that.
    """
    lines = " ".join(printed(capsys, "analyze", "cam-pusher")[:5])
    assert "The follower of “crank to pusher” stays on its cam up to 583 rpm, 2.4 times" in lines
    assert "ift-off" not in lines
    report = page(report_of("cam-pusher")).replace(NARROW, " ")
    assert report.index("stays on its cam up to 583 rpm") < report.index('class="tiles"')
    fast = eq.analyze(eq.load("cam-pusher"), speed=62.0)
    first = next(iter(fast.headline()))
    assert isinstance(first, Text) and first.emphasis == "broken"
    assert first.text.startswith("Lift-off speed of the crank: 583 rpm")
    assert "stays on" not in first.text
    kept = tuple(item for item in assess(eq.analyze(eq.load("cam-pusher"))) if item.is_contact)
    assert verdict(kept) is kept[0] and verdict(()) is None


def test_what_stands_first_has_every_language() -> None:
    for name in ("hydraulic-loader", "cam-pusher", "yamashita-rig"):
        analysis = eq.analyze(eq.load(name), 90)
        said = set()
        for language in COMPLETE:
            with speaking(language):
                first = next(iter(analysis.headline()))
                assert isinstance(first, Text)
                said.add(first.text)
        assert len(said) == len(COMPLETE)


def test_the_next_command_has_no_exponent(capsys: pytest.CaptureFixture[str]) -> None:
    """Its speeds are the range about the speed, which the command takes as they stand."""
    text = " ".join(printed(capsys, "respond", "sieve", "--speed", "1000 rpm"))
    (range_given,) = re.findall(r'respond --speed "([^"]*)"', text)
    assert "e" not in range_given
    low, high = (parse(part.strip(), "angular speed") for part in range_given.split(":"))
    assert low < parse("1000 rpm", "angular speed") < high
    assert high >= parse("1000 rpm", "angular speed") * 1.5
