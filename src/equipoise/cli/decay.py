"""The command `decay`."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Annotated

from cyclopts import Parameter

from equipoise.cli.app import SIGNED, app
from equipoise.cli.options import check_belonging, check_folder, quantity
from equipoise.cli.results import Kind, draw
from equipoise.errors import UsageError

if TYPE_CHECKING:
    from equipoise.measured.decay import Decay
    from equipoise.measured.record import Record

RECORD = Parameter(name="CSV", negative="")


@app.command
def decay(
    csv: Annotated[str, RECORD],
    /,
    *,
    stiffness: Annotated[str | None, SIGNED] = None,
    arm: Annotated[str | None, SIGNED] = None,
    spring_arm: Annotated[str | None, SIGNED] = None,
    confidence: Annotated[float, SIGNED] = 0.95,
    json: bool = False,
    plot: str | None = None,
    format: Kind | None = None,
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
    json
        Print one JSON object in SI units, and nothing else.
    plot
        Draw the record with its fit, and the line of half-swings, into this folder.
    format
        With --plot: kind of the pictures, svg if not given.
    """
    from equipoise.schema.records import read_record

    check_belonging("--plot", plot, format=format)
    check_belonging("--stiffness", stiffness, **{"spring-arm": spring_arm})
    if not 0 < confidence < 1:
        raise UsageError(f"--confidence: got {confidence:g}; give 0.95, or another between 0 and 1")
    if plot is not None:
        check_folder("--plot", plot)
    at, spring_at = _length("--arm", arm), _length("--spring-arm", spring_arm)
    stiff, torsional = _stiffness(stiffness)
    record = read_record(csv)
    if arm is not None and record.kind == "angle":
        raise UsageError(
            "--arm makes an angle of a length, but the record has angles; leave it out"
        )
    if stiffness is not None:
        angles = record.kind == "angle" or arm is not None
        _check_stiffness(stiffness, torsional, angles, spring_at)
    found = _identified(csv, record, stiff, at, spring_at, confidence)
    if plot is not None:
        from equipoise.plotting.decay import drawings
        from equipoise.schema.files import printable

        draw(drawings(found, printable(os.path.basename(csv))), plot, format or "svg")
    if json:
        from equipoise.schema.output import json_text

        print(json_text(found.to_dict()))
    else:
        from equipoise.terminal.decay import print_decay

        print_decay(found, os.path.basename(csv))


def _identified(
    csv: str,
    record: Record,
    stiffness: float | None,
    arm: float | None,
    spring_arm: float | None,
    confidence: float,
) -> Decay:
    from equipoise.measured.decay import identify_decay
    from equipoise.schema.files import printable

    try:
        return identify_decay(
            record, stiffness, arm=arm, spring_arm=spring_arm, confidence=confidence
        )
    except UsageError as error:
        raise UsageError(f"{printable(csv)}: {error}") from error


def _length(option: str, text: str | None) -> float | None:
    if text is None:
        return None
    return _above_zero(option, text, quantity(option, text, "length"))


def _above_zero(option: str, text: str, value: float) -> float:
    if value <= 0:
        raise UsageError(f"{option}: got {text!r}; give more than 0")
    return value


def _stiffness(text: str | None) -> tuple[float | None, bool]:
    """A stiffness, N/m or N m/rad, and whether it is torsional."""
    from equipoise.quantities.units import KINDS, plain_unit

    if text is None:
        return None, False
    unit = plain_unit(text.partition(" ")[2].strip())
    torsional = unit in KINDS["torsional stiffness"].units
    value = quantity("--stiffness", text, "torsional stiffness" if torsional else "stiffness")
    return _above_zero("--stiffness", text, value), torsional


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
