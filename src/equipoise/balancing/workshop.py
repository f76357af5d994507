"""Changes that balancing asks for, as sentences for a workshop."""

from __future__ import annotations

from collections.abc import Iterator
from math import degrees
from typing import Any

from equipoise.balancing.design_variables import Change
from equipoise.i18n import say
from equipoise.quantities import number
from equipoise.results.machine_blocks import place


def sentences(change: Change) -> Iterator[str]:
    """What to change; one sentence for the change, then one for each piece of an added mass."""
    values = dict(change.values)
    if change.kind == "center of mass":
        yield say(
            "{link}: move the centre of mass from ({old}) mm to ({new}) mm, "
            "with a mass of {mass} g",
            link=change.link,
            old=place(values["from"]),
            new=place(values["to"]),
            mass=_grams(values["mass"]),
        )
    elif change.kind == "added mass":
        yield from _added(change.link, values)
    elif change.kind == "spring":
        yield _spring(change.link, values)
    elif change.kind == "gears":
        yield _gears(change.link, values)
    else:
        yield say("Rows: set the phases to {phases}°", phases=_phases(values["phases"]))


def _added(link: str, values: dict[str, Any]) -> Iterator[str]:
    if not values["pieces"]:
        yield say("{link}: add nothing", link=link)
    elif values["moment"]:
        yield say(
            "{link}: add a counterweight of {mass} g, its centre of mass {radius} mm from {point} "
            "at {direction}° in the axes of the link ({moment} g mm)",
            link=link,
            mass=_grams(values["mass"]),
            radius=_millimetres(values["radius"]),
            point=values["at"],
            direction=_direction(values["direction"]),
            moment=number(1e6 * values["moment"]),
        )
    else:
        yield say(
            "{link}: add {mass} g about {point}",
            link=link,
            mass=_grams(values["mass"]),
            point=values["at"],
        )
    for piece in values["pieces"]:
        yield say("{link}, made as: {piece}", link=link, piece=_piece(piece, values["center"]))


def _piece(piece: dict[str, Any], center: tuple[float, float]) -> str:
    mass = _grams(piece["mass"])
    if piece["shape"] == "point":
        place_of = place(piece["place"])
        return say("point mass of {mass} g at ({at}) mm", mass=mass, at=place_of)
    thickness = _millimetres(piece["thickness"])
    if piece["shape"] in ("ring", "sector"):
        told: dict[str, str] = {
            "mass": mass,
            "inner": _millimetres(piece["inner_radius"]),
            "outer": _millimetres(piece["outer_radius"]),
            "thickness": thickness,
            "at": place(center),
        }
        if piece["shape"] == "ring":
            return say(
                "ring of {mass} g about ({at}) mm, radius {inner} to {outer} mm, "
                "{thickness} mm thick",
                **told,
            )
        return say(
            "sector of {mass} g about ({at}) mm, radius {inner} to {outer} mm, "
            "{thickness} mm thick, {wide}° wide, its middle at {direction}°",
            wide=_direction(piece["angle"]),
            direction=_direction(piece["direction"]),
            **told,
        )
    return say(
        "disc of {mass} g, radius {radius} mm, {thickness} mm thick, its centre at ({at}) mm",
        mass=mass,
        radius=_millimetres(piece["radius"]),
        thickness=thickness,
        at=place(piece["place"]),
    )


def _spring(link: str, values: dict[str, Any]) -> str:
    if not values["stiffness"]:
        return say("{link}: set no spring", link=link)
    return say(
        "{link}: set a spring of {stiffness} N/m with a free length of {length} mm from {point} "
        "to {to}",
        link=link,
        stiffness=number(values["stiffness"]),
        length=_millimetres(values["free_length"]),
        point=values["point"],
        to=values["to"],
    )


def _gears(link: str, values: dict[str, Any]) -> str:
    radii = " / ".join(map(_millimetres, values["pitch_radii"]))
    text = say(
        "{link}: a shaft at ({at}) mm of the frame, geared to {driver} with the ratio {ratio}, "
        "pitch radii {radii} mm",
        link=link,
        at=place(values["axis"]),
        driver=values["driver"],
        ratio=number(values["ratio"]),
        radii=radii,
    )
    if "teeth" in values:
        first, second = values["teeth"]
        module = _millimetres(values["module"])
        text += "; " + say(
            "{first} and {second} teeth of module {module} mm",
            first=first,
            second=second,
            module=module,
        )
    if "masses" in values:
        on_driver, on_shaft = map(_grams, values["masses"])
        text += "; " + say(
            "the gears add {first} g to {driver} and {second} g to the shaft",
            first=on_driver,
            driver=values["driver"],
            second=on_shaft,
        )
    return text


def _phases(phases: tuple[float, ...]) -> str:
    return ", ".join(_direction(phase) for phase in phases)


def _direction(radians: float) -> str:
    shown = round(degrees(radians), 2) + 0.0
    return f"{shown if shown > -180 else shown + 360:.2f}".removesuffix(".00")


def _grams(mass: float) -> str:
    return number(1e3 * mass)


def _millimetres(length: float) -> str:
    return number(1e3 * length)
