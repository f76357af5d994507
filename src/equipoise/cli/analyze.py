"""The command `analyze`."""

from __future__ import annotations

import re
import sys
from typing import TYPE_CHECKING, Annotated

from equipoise.cli.app import FILE, SIGNED, app
from equipoise.cli.options import check_belonging, check_target, naming, quantity, whole
from equipoise.errors import UsageError

if TYPE_CHECKING:
    from equipoise.mechanism.model import Machine

MOST_ORDERS = 100


@app.command
def analyze(
    file: Annotated[str, FILE],
    /,
    *,
    angles: Annotated[str, SIGNED] = "360",
    speed: Annotated[str | None, SIGNED] = None,
    acceleration: Annotated[str | None, SIGNED] = None,
    about: Annotated[str | None, SIGNED] = None,
    json: bool = False,
    split: bool = False,
    csv: str | None = None,
    orders: Annotated[str | None, SIGNED] = None,
    crank_zero: Annotated[str | None, SIGNED] = None,
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
    json
        Print one JSON object in SI units, and nothing else.
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

    machine = load_linkage(file)
    check_belonging("--json", json or None, split=split or None)
    if crank_zero is not None and orders is None:
        raise UsageError("--crank-zero belongs to --orders; give both")
    count = None if orders is None else whole("--orders", orders, 1, MOST_ORDERS)
    zero = 0.0 if crank_zero is None else quantity("--crank-zero", crank_zero, "angle")
    if csv is not None:
        check_target("--csv", csv, file, machine)
    arguments = (
        _angles(angles),
        None if speed is None else quantity("--speed", speed, "angular speed"),
        None
        if acceleration is None
        else quantity("--acceleration", acceleration, "angular acceleration"),
        None if about is None else _place(machine, about),
    )
    with naming(file):
        analysis = analyzed(machine, *arguments)
        told = {} if count is None else {"by_order": order_values(analysis, count, zero)}
    if csv is not None:
        from equipoise.schema.output import to_csv, write

        write(csv, to_csv(analysis))
        print(f"wrote {csv}", file=sys.stderr)
    if json:
        from equipoise.schema.output import json_text

        print(json_text(analysis.to_dict(split) | told))
    elif count is not None:
        from equipoise.terminal.orders import print_orders

        print_orders(analysis, count, zero)
    else:
        from equipoise.terminal.analysis import print_analysis

        print_analysis(analysis)


def _angles(text: str) -> int | list[float]:
    from equipoise.quantities import parse

    if re.fullmatch("[+-]?[0-9]{1,20}", text):
        return int(text)
    try:
        return [parse(part.strip(), "angle") for part in text.split(",")]
    except UsageError as error:
        raise UsageError(
            f'--angles: {error}; give a number, or angles such as "0 deg, 45 deg"'
        ) from error


def _place(machine: Machine, text: str) -> str | tuple[float, float]:
    if "," not in text or text in machine.frame:
        return text
    parts = [quantity("--about", part.strip(), "length") for part in text.split(",")]
    if len(parts) != 2:
        raise UsageError(f'--about: got {text!r}; give a point, or x and y: "10 mm, 20 mm"')
    return parts[0], parts[1]
