"""The command `decay`."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Annotated, Any

from cyclopts import Parameter

from equipoise.cli.options import SIGNED, blaming, check_belonging, quantity, read_by, size
from equipoise.cli.outputs import Drawn
from equipoise.errors import UsageError

if TYPE_CHECKING:
    from collections.abc import Mapping

    from equipoise.figures import Picture

Arm = Annotated[float | None, size("length", "give more than 0")]


def _stiffness(option: str, text: str) -> tuple[float, bool, str]:
    """A stiffness, N/m or N m/rad, whether it is torsional, and how it was given."""
    from equipoise.quantities import KINDS, plain_unit

    unit = plain_unit(text.partition(" ")[2].strip())
    torsional = unit in KINDS["torsional stiffness"].units
    value = quantity(option, text, "torsional stiffness" if torsional else "stiffness")
    if value <= 0:
        raise UsageError(f"{option}: got {text!r}; give more than 0")
    return value, torsional, text


def decay(
    csv: Annotated[str, Parameter(name="CSV", negative="")],
    /,
    *,
    stiffness: Annotated[Any, read_by(_stiffness)] = None,
    arm: Arm = None,
    spring_arm: Arm = None,
    confidence: Annotated[float, SIGNED] = 0.95,
    outputs: Drawn = Drawn(),
) -> None:
    """Frequency, inertia, viscous damping and Coulomb friction from a recorded free decay.

    Parameters
    ----------
    csv
        Path of a record: columns "time [s]" and "displacement [mm]" or "angle [deg]".
    stiffness
        Of the spring, such as "12 N/mm", or of a pivot, "500 N m/rad"; adds inertia and forces.
    arm
        Distance from the pivot at which the displacement was read; makes an angle of it.
    spring_arm
        Distance from the pivot at which the spring acts; its stiffness is then in N/m.
    confidence
        Of the intervals.
    """
    from equipoise.measured.decay import identify_decay
    from equipoise.schema.files import printable
    from equipoise.schema.records import read_record

    check_belonging("--stiffness", stiffness is not None, spring_arm=spring_arm)
    if not 0 < confidence < 1:
        raise UsageError(f"--confidence: got {confidence:g}; give 0.95, or another between 0 and 1")
    record = read_record(csv)
    if arm is not None and record.kind == "angle":
        raise UsageError(
            "--arm makes an angle of a length, but the record has angles; leave it out"
        )
    value = None
    if stiffness is not None:
        value, torsional, text = stiffness
        _check_stiffness(text, torsional, record.kind == "angle" or arm is not None, spring_arm)
    with blaming(printable(csv)):
        found = identify_decay(record, value, arm=arm, spring_arm=spring_arm, confidence=confidence)

    def show() -> None:
        from equipoise.present import show_blocks

        show_blocks(printable(os.path.basename(csv)), found.blocks())

    def drawings() -> Mapping[str, Picture]:
        from equipoise.figures import measured as pictures

        return pictures.decay_charts(found, printable(os.path.basename(csv)))

    outputs.give(drawings, found.to_dict, show)


def _check_stiffness(text: str, torsional: bool, angles: bool, spring_arm: float | None) -> None:
    """The stiffness has to suit the record."""
    if torsional and spring_arm is not None:
        raise UsageError(
            f"--spring-arm belongs to a stiffness in N/m, but --stiffness is {text!r}; leave one "
            "of them out, or change it"
        )
    if torsional and not angles:
        raise UsageError(
            f"--stiffness: got {text!r}, but the record has lengths; give a stiffness in N/m, or "
            "by --arm how far from the pivot they were read"
        )
    if not torsional and angles and spring_arm is None:
        raise UsageError(
            f"--stiffness: got {text!r}, but the record has angles; give a stiffness in N m/rad, "
            "or by --spring-arm how far from the pivot the spring acts"
        )
    if spring_arm is not None and not angles:
        raise UsageError(
            "--spring-arm belongs to a record of angles; give by --arm how far from the pivot the "
            "lengths were read, or leave it out"
        )
