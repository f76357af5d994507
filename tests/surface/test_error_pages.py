"""The page of errors: each message is what its machine gives, and each cure is accepted."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

import pytest

from equipoise import EquipoiseError, analyze, loads, respond

PAGE = (Path(__file__).parents[2] / "docs" / "errors.md").read_text(encoding="utf-8")
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
    "The linkage has several free motions": (
        analyze,
        [('points = ["Q", "B"]', 'points = ["Q", "C"]')],
        [('points = ["Q", "C"]', 'points = ["Q", "B"]')],
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
    said, shown = (
        text.removeprefix("links.toml: ").split() for text in (str(error.value), printed)
    )
    assert said == shown
    command(loads(changed(given, cure), "links.toml"))
