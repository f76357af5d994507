"""The command `analyze`."""

from __future__ import annotations

import re
import sys
from typing import TYPE_CHECKING, Annotated, Any

from cyclopts import Parameter

from equipoise.cli.options import (
    Angle,
    File,
    Speed,
    Text,
    check_belonging,
    check_result_file,
    count,
    naming,
    quantity,
    read_by,
    size,
    sources_of,
)
from equipoise.cli.outputs import Printed
from equipoise.errors import UsageError

if TYPE_CHECKING:
    from equipoise.mechanism.model import Machine

MOST_ORDERS = 100


def _angles(option: str, text: str) -> int | list[float]:
    if re.fullmatch("[+-]?[0-9]{1,20}", text):
        return int(text)
    try:
        return [quantity(option, part.strip(), "angle") for part in text.split(",")]
    except UsageError as error:
        raise UsageError(f'{error}; give a number, or angles such as "0 deg, 45 deg"') from error


Angles = Annotated[Any, read_by(_angles), Parameter(show_default=True)]


def analyze(
    file: File,
    /,
    *,
    angles: Angles = 360,
    speed: Speed = None,
    acceleration: Annotated[float | None, size("angular acceleration")] = None,
    about: Text = None,
    split: bool = False,
    csv: str | None = None,
    orders: Annotated[int | None, count(1, MOST_ORDERS)] = None,
    crank_zero: Angle = None,
    outputs: Printed = Printed(),
) -> None:
    """Motion, shaking force and moment, drive torque and every joint force over a turn.

    Parameters
    ----------
    file
        Path of a model file, or the name of a bundled example.
    angles
        Number of crank angles a turn, or the angles: "0 deg, 45 deg, 90 deg".
    speed
        Speed of the crank instead of the file's, such as "250 rpm".
    acceleration
        Acceleration of the crank instead of the file's, such as "10 rad/s^2".
    about
        Point about which moments are taken: a point of the frame, or "10 mm, 20 mm".
    split
        With --json: add every force by cause and by link.
    csv
        Write every signal against crank angle to this file.
    orders
        Print the harmonics of forces, moment and torque up to this order instead.
    crank_zero
        With --orders: direction from which crank angles count, such as "-83 deg"; else the x axis.
    """
    from equipoise.results.analysis import analyze as analyzed
    from equipoise.results.analysis import order_values
    from equipoise.schema.models import load_linkage

    check_belonging("--json", outputs.json, split=split or None)
    if crank_zero is not None and orders is None:
        raise UsageError("--crank-zero belongs to --orders; give both")
    machine = load_linkage(file)
    zero = crank_zero or 0.0
    if csv is not None:
        check_result_file("--csv", csv, sources_of(machine, file))
    place = None if about is None else _place(machine, about)
    with naming(file):
        analysis = analyzed(machine, angles, speed, acceleration, place)
        by_order = {} if orders is None else {"by_order": order_values(analysis, orders, zero)}
    if csv is not None:
        from equipoise.schema.output import to_csv, write

        write(csv, to_csv(analysis))
        print(f"wrote {csv}", file=sys.stderr)

    def show() -> None:
        from equipoise.present import show as shown

        shown(analysis, orders=orders, zero=zero)

    outputs.print(lambda: analysis.to_dict(split) | by_order, show)


def _place(machine: Machine, text: str) -> str | tuple[float, float]:
    if "," not in text or text in machine.frame:
        return text
    parts = [quantity("--about", part.strip(), "length") for part in text.split(",")]
    if len(parts) != 2:
        raise UsageError(f'--about: got {text!r}; give a point, or x and y: "10 mm, 20 mm"')
    return parts[0], parts[1]
