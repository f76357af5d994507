"""The models that commands are given; one whose crank cannot turn swings instead, which is told."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

from equipoise.cli.options import naming
from equipoise.cli.outputs import tell

if TYPE_CHECKING:
    from equipoise.i18n import Note
    from equipoise.mechanism.parts.machine import Machine
    from equipoise.schema.template import Template
    from equipoise.studies.study import Study


def linkage_of(file: str, speed: float | None = None, swings: bool = True) -> Machine:
    """The machine of a file, whose crank turns at another speed where one is given, rad/s.

    swings : whether a crank that cannot turn swings instead.
    """
    from equipoise.schema.models import load_linkage

    machine = load_linkage(file)
    machine = machine if speed is None else machine.with_drive(speed=speed)
    return swinging(machine, file) if swings else machine


def swinging(machine: Machine, file: str) -> Machine:
    """The machine of a file, which swings where its crank cannot turn."""
    from equipoise.mechanism.kinematics.swings import swing

    with naming(file):
        found = swing(machine)
    tell_swing(None if found is None else found.note)
    return machine if found is None else found.machine


def template_of(file: str) -> Template:
    """The model of a file as one whose numbers can be replaced."""
    from equipoise.schema.template import Template

    found = Template.load(file).swinging()
    tell_swing(found.swings)
    return found


def study_named(file: str) -> Study:
    """The study of a file."""
    from equipoise.schema.studies import load_study

    study = load_study(file)
    tell_swing(getattr(study.model, "swings", None))
    return study


def tell_swing(note: Note | None) -> None:
    """Tell that a crank swings, where it does."""
    if note is not None:
        tell(f"note: {note}", sys.stderr)
