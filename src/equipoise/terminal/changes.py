"""Changes to a machine in words and in the units of a workshop."""

from __future__ import annotations

from collections.abc import Iterator
from math import degrees, hypot
from typing import TYPE_CHECKING, Any

from equipoise.terminal.tables import number

if TYPE_CHECKING:
    from equipoise.balancing.design_variables import Change


def told(change: Change) -> Iterator[str]:
    """Lines that say what to change: the change itself, then one for each piece."""
    values = dict(change.values)
    if change.kind == "center of mass":
        yield (
            f"{change.link}: move the centre of mass from {_place(values['from'])} to "
            f"{_place(values['to'])}, mass {_grams(values['mass'])}"
        )
    elif change.kind == "added mass":
        yield from _added(change.link, values)
    elif change.kind == "spring":
        yield _spring(change.link, values)
    elif change.kind == "gears":
        yield _gears(change.link, values)
    else:
        shown = ", ".join(_degrees(phase).removesuffix(".00") for phase in values["phases"])
        yield f"rows: set the phases to {shown} deg"


def _added(link: str, values: dict[str, Any]) -> Iterator[str]:
    if not values["pieces"]:
        yield f"{link}: add nothing"
        return
    where = f"about {values['at']}"
    moment = values["moment"]
    if moment:
        where = (
            f"{number(values['radius'] * 1e3)} mm from {values['at']} at "
            f"{_degrees(values['direction'])} deg, {number(moment * 1e6)} g mm"
        )
    yield f"{link}: add {_grams(values['mass'])}, {where}"
    for piece in values["pieces"]:
        yield f"  {_piece(piece, values['center'])}"


def _piece(piece: dict[str, Any], center: tuple[float, float]) -> str:
    text = f"{piece['shape']} of {_grams(piece['mass'])}"
    if piece["shape"] == "ring":
        return f"{text}{_annulus(piece)} about {_place(center)}"
    if piece["shape"] == "sector":
        return (
            f"{text}{_annulus(piece)} about {_place(center)}, {_degrees(piece['angle'])} deg "
            f"wide, its middle at {_degrees(piece['direction'])} deg"
        )
    if piece["shape"] == "point":
        return f"{text} at {_place(piece['place'])}"
    size = f"radius {number(piece['radius'] * 1e3)} mm, {number(piece['thickness'] * 1e3)} mm thick"
    return f"{text}, {size}, with its centre at {_place(piece['place'])}"


def _annulus(piece: dict[str, Any]) -> str:
    radii = f"{number(piece['inner_radius'] * 1e3)} to {number(piece['outer_radius'] * 1e3)} mm"
    return f", radius {radii}, {number(piece['thickness'] * 1e3)} mm thick,"


def _spring(link: str, values: dict[str, Any]) -> str:
    if not values["stiffness"]:
        return f"{link}: set no spring"
    return (
        f"{link}: set a spring of {number(values['stiffness'])} N/m and "
        f"{number(values['free_length'] * 1e3)} mm free length from {values['point']} to "
        f"{values['to']}"
    )


def _gears(link: str, values: dict[str, Any]) -> str:
    radii = " and ".join(f"{number(radius * 1e3)} mm" for radius in values["pitch_radii"])
    text = f"{link}: gear a shaft at {_place(values['axis'])} of the frame to {values['driver']}"
    if "teeth" in values:
        first, second = values["teeth"]
        text += f" by {first} and {second} teeth of module {number(values['module'] * 1e3)} mm,"
    text += f" with the ratio {number(values['ratio'])}, pitch radii {radii}"
    if "masses" not in values:
        return text
    on_driver, on_shaft = map(_grams, values["masses"])
    return f"{text}; the gears add {on_driver} to {values['driver']} and {on_shaft} to the shaft"


def _place(place: tuple[float, float]) -> str:
    x, y = (1e3 * coordinate for coordinate in place)
    scale = hypot(x, y)
    return f"({number(x, 1e4 * scale)}, {number(y, 1e4 * scale)}) mm"


def _degrees(angle: float) -> str:
    shown = round(degrees(angle), 2) + 0.0  # + 0.0 takes the sign off a zero
    return f"{shown if shown > -180 else shown + 360:.2f}"


def _grams(mass: float) -> str:
    return f"{number(mass * 1e3)} g"
