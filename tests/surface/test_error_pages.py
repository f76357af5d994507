"""The page of errors: each message is what its machine gives, and each cure is accepted."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from functools import partial
from importlib.resources import files
from pathlib import Path

import pytest

import equipoise
from equipoise import analyze, loads, respond
from equipoise.errors import EquipoiseError, ModelError, UsageError
from equipoise.keys import all_keys
from equipoise.schema.topics import errors, known_topic, tables, terms
from surface.running import equipoise as equipoise_runs
from surface.running import refused, succeeded, written

PAGE = files("equipoise").joinpath("errors.md").read_text(encoding="utf-8")
MODEL, *SECTIONS = PAGE.split("\n## ")
BASE = re.findall(r"```toml\n(.*?)```", MODEL, re.DOTALL)[0]
Change = tuple[str, str]
MASSES = 'length = "{0} mm"\nmass = "1 kg"\ncenter_of_mass = ["0 mm", "0 mm"]\ninertia = "1 kg m^2"'
WEIGHED = [(f'length = "{n} mm"', MASSES.format(n)) for n in (20, 90, 40)]
SUPPORT = """
[support]
mass = "60 kg"
center_of_mass = ["0 mm", "0 mm"]
inertia = "7 kg m^2"
freedoms = ["heave"]
[support.mounts.front]
point = ["0 mm", "0 mm"]
stiffness = "20 kN/m"
damping = "150 N s/m"
[support.gauges.stand]
point = ["100 mm", "0 mm"]
"""
RUBBING = """
[[joints]]
joint = "joints.B"
radius = "30 mm"
friction = 1
"""
ABOVE = 'points.R = ["100 mm", "60 mm"]'
STRUT = """
[links.strut]
points = ["R", "B"]
length = "40 mm"
"""
AXLE = 'points.W = ["0 mm", "60 mm"]'
GEARED = """
[links.wheel]
points = ["W", "V"]
length = "10 mm"
[[gears]]
between = ["crank", "wheel"]
ratio = 0.123457
"""
UNDAMPED = SUPPORT.replace("150 N s/m", "0 N s/m").replace("20 kN/m", "1008 N/m")
MOTOR = """
[drive.motor]
no_load_speed = "66 rpm"
stall_torque = "20 N m"
"""
LOADED = """
[[loads]]
link = "rocker"
point = "B"
force = ["-9 kN", "0 N"]
"""
CASES: dict[str, tuple[Callable[..., object], list[Change], list[Change]]] = {
    "The crank cannot turn fully": (
        analyze,
        [('length = "20 mm"', 'length = "60 mm"')],
        [("[frame]", 'motion = { between = ["38.31 deg", "97.6 deg"] }\n[frame]')],
    ),
    "Change point": (
        analyze,
        [('length = "20 mm"', 'length = "40 mm"'), ('length = "90 mm"', 'length = "100 mm"')],
        [('B = "left"', 'B = "antiparallel"')],
    ),
    "The linkage has too many degrees of freedom": (
        analyze,
        [('points = ["Q", "B"]', 'points = ["Q", "C"]')],
        [('points = ["Q", "C"]', 'points = ["Q", "B"]')],
    ),
    "The linkage has no degree of freedom": (
        analyze,
        [
            ('points.Q = ["100 mm", "0 mm"]', 'points.Q = ["100 mm", "0 mm"]\n' + ABOVE),
            ("[assembly]", STRUT + "[assembly]"),
        ],
        [(ABOVE, ""), (STRUT, "")],
    ),
    "The motion does not repeat": (
        analyze,
        [
            ('points.Q = ["100 mm", "0 mm"]', 'points.Q = ["100 mm", "0 mm"]\n' + AXLE),
            ("[assembly]", GEARED + "[assembly]"),
        ],
        [("ratio = 0.123457", "teeth = [65, 8]")],
    ),
    "Friction locks the machine": (
        analyze,
        [*WEIGHED, ("[assembly]", RUBBING + "[assembly]")],
        [("friction = 1", "friction = 0.7")],
    ),
    "A side is missing in assembly": (
        analyze,
        [('[assembly]\nB = "left"', "")],
        [("[frame]", '[assembly]\nB = "right"\n[frame]')],
    ),
    "Links cannot be joined at any crank angle": (
        analyze,
        [('length = "90 mm"', 'length = "20 mm"')],
        [('["A", "B"]\nlength = "20 mm"', '["A", "B"]\nlength = "90 mm"')],
    ),
    "Masses are missing": (
        lambda machine: analyze(machine).forces.drive_torque,
        [],
        WEIGHED,
    ),
    "A unit is missing or wrong": (
        analyze,
        [('speed = "60 rpm"', 'speed = "1 Hz"')],
        [('speed = "1 Hz"', 'speed = "1 turn/s"')],
    ),
    "No key of that name": (
        analyze,
        [("[assembly]", '[[spring]]\nlink = "rocker"\n\n[assembly]')],
        [('[[spring]]\nlink = "rocker"\n\n', "")],
    ),
    "The machine stands on solid ground": (
        respond,
        [],
        [*WEIGHED, ("[assembly]", SUPPORT + "[assembly]")],
    ),
    "There is no steady state": (
        respond,
        [*WEIGHED, ('"60 rpm"', '"4 rad/s"'), ("[assembly]", UNDAMPED + "[assembly]")],
        [('damping = "0 N s/m"', 'damping = "10 N s/m"')],
    ),
    "The motor stalls": (
        partial(respond, drive=True),
        [
            *((old, new.replace("1 kg m^2", "0.001 kg m^2")) for old, new in WEIGHED),
            ('speed = "60 rpm"', 'speed = "60 rpm"\n' + MOTOR),
            ("[assembly]", LOADED + "[assembly]"),
        ],
        [('"20 N m"', '"500 N m"')],
    ),
}
"""Heading -> what is done with the machine, what leads to the error, what cures it."""


def changed(text: str, changes: list[Change]) -> str:
    """The text with each change made."""
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    return text


def test_every_section_has_a_case() -> None:
    """No section stands unproved."""
    assert [section.partition("\n")[0] for section in SECTIONS] == [*CASES]


@pytest.mark.parametrize("section", SECTIONS, ids=[*CASES])
def test_the_message_is_printed_and_its_cure_accepted(section: str) -> None:
    """The text of the page is that of the error, word by word."""
    heading = section.partition("\n")[0]
    command, wrong, cure = CASES[heading]
    given = changed(BASE, wrong)
    with pytest.raises(EquipoiseError) as error:
        command(loads(given, "links.toml"))
    printed = re.findall(r"```text\n(.*?)\n```", section, re.DOTALL)[0]
    assert errors()[error.value.topic].title == heading
    said, shown = (
        text.removeprefix("links.toml: ").split() for text in (str(error.value), printed)
    )
    assert said == shown
    command(loads(changed(given, cure), "links.toml"))


# -- from a message to its page --------------------------------------------------------------------


def below(of: type[EquipoiseError]) -> Iterator[type[EquipoiseError]]:
    """A class of errors, and all that are made of it."""
    yield of
    for item in of.__subclasses__():
        yield from below(item)


def test_every_class_of_errors_has_a_page() -> None:
    """But for those whose sentence is about an argument, or whose place in a file is the topic."""
    general = {EquipoiseError, *below(ModelError), *below(UsageError)}
    kinds = {of for of in below(EquipoiseError) if of.__module__ == "equipoise.errors"} - general
    assert len(kinds) > 5
    assert {of.__name__ for of in kinds if of.usual_topic not in errors()} == set()


NAMED = re.compile(
    r'(?:about|with_topic)\("([a-z-]+)"\)|(?m:^ *)(?:usual_topic|TOPIC|UNKNOWN|REPEAT) = "(.+)"'
)
"""A topic in the package."""


def test_every_topic_of_a_sentence_is_on_the_page_and_every_page_is_reached() -> None:
    """Wherever one is named in the package."""
    package = Path(equipoise.__file__).parent
    topics = {
        "".join(result)
        for file in package.rglob("*.py")
        for result in NAMED.findall(file.read_text(encoding="utf-8"))
    }
    assert topics == {*errors()}


@pytest.mark.parametrize("heading", [name for name, (does, *_) in CASES.items() if does is analyze])
def test_the_command_line_leads_to_the_page(heading: str) -> None:
    """Its last line is a command that prints the message and its cure."""
    _, wrong, _ = CASES[heading]
    result = equipoise_runs("analyze", written(changed(BASE, wrong), to="links.toml"))
    refused(result)
    more = result.err.splitlines()[-1].removeprefix("# ")
    assert more.startswith("more: equipoise explain ")
    page = succeeded(equipoise_runs(*more.split()[2:]))
    assert page.startswith(f"{heading}\n\n")
    section = next(item for item in SECTIONS if item.startswith(f"{heading}\n"))
    message = re.findall(r"```text\n(.*?)\n```", section, re.DOTALL)[0]
    assert " ".join(message.split()) in " ".join(page.split())
    assert "](" not in page and "```" not in page


def test_a_wrong_value_leads_to_the_keys_of_its_table() -> None:
    """Which are those that are declared."""
    wrong = BASE.replace('points = ["O", "A"]', 'points = ["O", "A", "A"]')
    result = equipoise_runs("analyze", written(wrong, to="links.toml"))
    refused(result)
    assert result.err.splitlines()[-1] == "more: equipoise explain links.NAME"


@pytest.mark.parametrize("topic", [*tables()])
def test_every_table_is_explained(topic: str) -> None:
    """With every key that it declares, or with the table below it that the key is."""
    text = succeeded(equipoise_runs("explain", topic))
    assert [name for name in all_keys(tables()[topic].of) if name not in text] == []


def test_topics_are_listed_and_unknown_ones_refused() -> None:
    """A key leads to its table, by its path."""
    listed = succeeded(equipoise_runs("explain"))
    words = " ".join(listed.split())
    assert [topic for topic in (*errors(), *tables(), *terms()) if topic not in words] == []
    assert len(terms()) > 25
    said = succeeded(equipoise_runs("explain", "shaking moment"))
    assert said.startswith("shaking moment\nMoment of the inertia forces") and "\\n" not in said
    for term, meaning in (
        ("friction", "Resistance of a joint"),
        ("fluctuation", "Largest less smallest speed"),
        ("A8", "A(8): the weighted vibration"),
        ("A(8)", "A(8): the weighted vibration"),
        ("transmission angle", "Angle between the two links that meet in a joint"),
        ("throw", "Distance of the pin of a crank"),
    ):
        assert f"\n{meaning}" in succeeded(equipoise_runs("explain", term))
    assert known_topic("links.crank.section.width") == "links.NAME.section"
    assert known_topic("links") == "links.NAME"  # the word before a name of the user's
    assert known_topic("support.mounts") == known_topic("mounts") == "support.mounts.NAME"
    assert known_topic("support.mounts.left.stiffness") == "support.mounts.NAME"
    gravity = succeeded(equipoise_runs("explain", "gravity"))  # a key of a whole file
    assert "linkage" in gravity and "two accelerations" in gravity
    assert "drive.motor.servo" in succeeded(equipoise_runs("explain", "speed"))
    weight = " ".join(succeeded(equipoise_runs("explain", "weight")).split())  # a term, and a key
    assert "Force of gravity on all moving links. in kind" in weight
    width = " ".join(succeeded(equipoise_runs("explain", "width")).split())  # without its table
    assert "of a rectangle or an I, across the plane" in width
    said = refused(equipoise_runs("explain", "sprngs"))
    assert said == "no topic is called 'sprngs'; did you mean 'springs'?"
