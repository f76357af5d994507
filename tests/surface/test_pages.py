"""Commands, options, targets and variables that pages name are there (snippets run elsewhere)."""

from __future__ import annotations

import re
import shlex
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import cyclopts
import pytest

from equipoise.balancing import (
    box_bounds,
    branch_and_bound,
    geared,
    pareto,
    phase_grid,
    policy,
    problem,
)
from equipoise.cli import COMMANDS, app, reports
from equipoise.design import lifts, minimax
from equipoise.figures import film
from equipoise.limits import THREAD, USUAL
from equipoise.measured import fits
from equipoise.planting import search
from equipoise.planting.figures import SAMPLES_OF_TURN
from equipoise.schema.files import LARGEST
from equipoise.studies import outcomes, searching, selection, study, tolerances
from equipoise.vibration import collocation, coupled, free, steady
from equipoise.web import stores, view_state
from surface.running import example_text, read, written

TOP = Path(__file__).parents[2]
PAGES = [
    *sorted((TOP / "docs").rglob("*.md")),
    *(TOP / name for name in ("README.md", "CONTRIBUTING.md", "SECURITY.md")),
]
EACH_PAGE = pytest.mark.parametrize(
    "page", PAGES, ids=lambda page: page.relative_to(TOP).as_posix()
)
ELSEWHERE = {"--seeds", "--exhaustive", "--narrow", "--all"}
"""Options of the tests and of `.ci/run`."""
STYLE = re.compile("--linkage-")
"""Of a drawing, for style sheets."""


def blocks(text: str) -> Iterator[str]:
    """Lines of code blocks as a shell has them, fenced or by indentation."""
    fenced = re.findall(r"```(?:bash|sh|console|text)?\n(.*?)```", text, re.DOTALL)
    indented = re.findall(r"(?:^    .+\n)+", text, re.MULTILINE)
    for block in (*fenced, *indented):
        for line in re.sub(r"\\\n\s*", " ", block).splitlines():
            yield re.sub(r"^(\.venv/bin/)?equipoise ", "equipoise ", line.strip(" $"))


def commands(text: str) -> Iterator[list[str]]:
    """Words of each line that runs the program, up to where the shell goes on with another."""
    for line in blocks(text):
        if line.startswith("equipoise "):
            words = shlex.split(line, comments=True)
            ends = [k for k, word in enumerate(words) if word in ("|", ">", "&&")]
            yield words[1 : ends[0] if ends else None]


@cache
def options() -> set[str]:
    """Names of all options of all commands."""
    result: set[str] = set()

    def of(item: cyclopts.App) -> None:
        if item.default_command:
            for argument in item.assemble_argument_collection():
                result.update((*argument.names, *argument.negatives))
        for name in item:
            if name.startswith("-"):
                result.add(name)
            else:
                of(item[name])

    _ = app.resolved_commands()
    of(app)
    return result


@EACH_PAGE
def test_commands_are_understood(page: Path) -> None:
    for words in commands(page.read_text(encoding="utf-8")):
        app.parse_args(words, exit_on_error=False, print_error=False)


@EACH_PAGE
def test_named_commands_and_options_are_there(page: Path) -> None:
    text = page.read_text(encoding="utf-8")
    code = re.findall(r"`([^`\n]+)`", re.sub(r"```.*?```", "", text, flags=re.DOTALL))
    named = [item for item in code if item.startswith(("equipoise ", "--"))]
    for entry in named:
        words = entry.split()
        if words[0] == "equipoise" and words[1].islower() and words[1][0] != "-":
            assert words[1] in COMMANDS, entry
        for option in re.findall(r"(?<![\w-])--[a-z][\w-]*", entry):
            assert option in {*options(), *ELSEWHERE} or STYLE.match(option), entry


@EACH_PAGE
def test_targets_and_variables_are_there(page: Path) -> None:
    text = page.read_text(encoding="utf-8")
    targets = re.findall(
        r"^([\w-]+):", (TOP / "Makefile").read_text(encoding="utf-8"), re.MULTILINE
    )
    assert {*re.findall(r"(?:`|^    )make (\w+)", text, re.MULTILINE)} <= {*targets}
    for name in {*re.findall(r"\bEQUIPOISE_\w+", text)}:
        used = (file for folder in ("src", "tests") for file in (TOP / folder).rglob("*.py"))
        assert any(
            name in file.read_text(encoding="utf-8")
            for file in used
            if file.name != "test_pages.py"
        )


def test_a_wrong_command_would_be_seen() -> None:
    (words,) = commands("```sh\n$ equipoise analyze sieve --no-such   # told\n```\n")
    with pytest.raises(cyclopts.UnknownOptionError):
        app.parse_args(words, exit_on_error=False, print_error=False)
    assert "--no-such" not in options() and {"--full", "--json", "--plot"} <= options()


# Its commands are run by `make documentation`.
@pytest.mark.exhaustive
def test_the_first_hour_reports_what_is_offered_without_a_plan() -> None:
    text = example_text("sieve").partition("\n[balance]")[0]
    result = read("balance", written(text))
    crank, left, right = result["tried"]
    (weight,), (hanger,) = (item["changes"] for item in (crank, left))
    plates = [1e3 * item["pieces"][0]["thickness"] for item in (weight, hanger)]
    reported = " ".join((TOP / "docs/first-machine.md").read_text(encoding="utf-8").split())
    assert f"a sector of {plates[0]:.0f} mm plate on the {weight['link']}" in reported
    assert (
        f"of {1e3 * weight['mass']:.0f} g, would reduce them by {100 * crank['gain']:.0f} %, and "
        f"sectors of {plates[1]:.0f} mm plate on the hangers by {100 * left['gain']:.0f} %"
        in reported
    )
    assert left["gain"] > right["gain"]
    assert not any(item["worth"] for item in (crank, left, right))
    assert f"reduces both gauges together by {100 * result['mounts']['gain']:.0f} %" in reported


CLAIMS = {
    "animation.md": [
        f"{film.MOST_PIXELS // 1_000_000} million pixels at most",
        f"{film.MOST_PIXELS // 640**2} frames at a width of 640",
        f"{reports.SVG_FRAMES} steps a turn",
    ],
    "balancing.md": [
        f"reduces its objective by at least {100 * policy.LEAST_GAIN:.0f} %",
        f"by {100 * policy.LEAST_NET_GAIN:.0f} % more than the share that it adds",
        f"with added mass by at least {100 * policy.LEAST_GAIN_OF_ADDED:.0f} %",
        f"at least {policy.AMPLIFIED:g} times that of stiffness or mass alone",
        (
            f"no thicker than {policy.THICKNESS_OF_REACH:g} of the largest radius that is "
            f"considered, {1e3 * policy.THICKEST_PLATE:.0f} mm, and"
        ),
        f"meet, {branch_and_bound.MOST_NODES} at the most",
        f"{geared.GRID} ratios, then",
        f"q up to {geared.LARGEST_DENOMINATOR}",
        f"{geared.WAYS} directions, with {geared.COARSE} ratios",
        f"{phase_grid.MOST:,}".replace(",", " "),
        f"{box_bounds.MOST_BOXES:,} boxes".replace(",", " "),
        f"{pareto.POINTS} points, or `--points`",
        f"Orders go up to {problem.HIGHEST}",
    ],
    "decay.md": [f"more than {fits.MOST:,} samples".replace(",", " ")],
    "figures.md": [f"Of more than {selection.MOST} designs"],
    "live-page.md": [
        f"A, B and so on, up to {view_state.MOST}",
        f"Of more than {stores.MOST} designs",
        f"A model file may have {LARGEST // 1_000_000} MB",
    ],
    "output.md": [
        f"{free.SAMPLES_PER_TURN} instants for each turn and {free.LEAST_SAMPLES} at least",
        f"at most {USUAL // 2**30} GiB of memory (and {THREAD // 2**20} MiB for each processor)",
    ],
    "planting.md": [
        f"| {search.GENERATIONS} | of the global search",
        f"| {search.POPULATION} | designs in a generation",
        f"{lifts.SHORTEST} to {lifts.LONGEST} times as long",
        f"at {SAMPLES_OF_TURN} crank angles",
    ],
    "studies.md": [
        (
            f"crank angles in a turn at which analyses are computed, {study.ANGLES[0]} to "
            f"{study.ANGLES[1]}"
        ),
        f"up to {study.CHUNK} designs of compiled figures, up to {study.SLOW_CHUNK} of others",
        f"rows again {tolerances.DRAWN_AGAIN} times",
        f"and {tolerances.LEAST_ROWS} machines in each are the least",
        f"generations of {searching.POPULATION} designs",
        f"and at most {searching.GENERATIONS}",
        f"{outcomes.PATIENCE} generations have added less than 1e-4",
    ],
    "theory.md": [
        f"{collocation.STAGES} nodes per interval, beginning with {steady.INTERVALS} intervals",
        f"most {steady.ROUNDS} times",
        f"{coupled.KNOTS} crank angles a turn",
    ],
    "tools.md": [f"{minimax.TRIED} designs of a Sobol sequence"],
    "trust.md": [f"{SAMPLES_OF_TURN} crank angles a turn"],
    "vibration.md": [f"at most {steady.MOST_SWINGS} free swings"],
}
"""Numbers in words of pages that are constants of the code."""


@pytest.mark.parametrize("page", CLAIMS)
def test_numbers_of_pages_are_those_of_the_code(page: str) -> None:
    text = " ".join((TOP / "docs" / page).read_text(encoding="utf-8").split())
    assert [claim for claim in CLAIMS[page] if claim not in text] == []
