"""Changes that balancing asks for, as a workshop needs them: figures, pieces and sentences."""

from __future__ import annotations

from cmath import exp, phase, rect
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import field
from math import acos, ceil, degrees, pi, sin, sqrt
from typing import Any

from equipoise.dataclass import dataclass
from equipoise.i18n import say
from equipoise.mechanism.parts.balance import MATERIALS, Weight, material_of
from equipoise.quantities import display, fixed, format_quantity, number
from equipoise.results.machine_blocks import point_text

PieceValues = dict[str, Any]

DRILL = 1e-3
"""Step of the diameters of holes that are proposed, m, as drills have it."""
SPREAD = 1e-7
"""Over the squared distance: inertia beyond that of one point that is taken for rounding."""
SIZE_OF_0 = 1e-15
"""Of the sine of half a turn, which is 0 but for rounding."""
FULL_TURN = 2 * pi * (1 - 1e-9)
"""Angle, rad, from which a sector has no ends but for rounding."""


@dataclass(frozen=True)
class Change:
    """One thing to change.

    kind : ``center of mass``, ``added mass``, ``removed mass``, ``spring``, ``gears``, ``phases``.
    link : what is changed.  values : its figures in SI units and radians.
    """

    kind: str
    link: str
    values: Mapping[str, Any] = field(default_factory=dict)

    def to_dict(self) -> dict[str, Any]:
        return {"kind": self.kind, "link": self.link, **self.values}


# -- pieces that can be cut and screwed on ---------------------------------------------------------


def pieces_of(
    weight: Weight, mass: float, moment: complex, inertia: float, center: complex
) -> list[PieceValues]:
    """Pieces whose masses, places and inertia add up to what was found; SI units and radians.

    Parameters
    ----------
    mass, moment, inertia : kg, kg m and kg m2, the last two about the centre of the room.
    center : of the room in the link's axes, m.  Places are in the link's axes too.
    """
    if mass <= 0:
        return []
    plate = (weight.thickness or 0.0) * (weight.density or 0.0)
    if weight.shape == "ring":
        outer = sqrt(weight.inner_radius**2 + mass / (pi * plate))
        sizes = {"outer_radius": outer, "inner_radius": weight.inner_radius}
        return [_piece("ring", mass, center, **sizes, **_plate(weight))]
    if weight.shape == "sector":
        return _sectors(weight, plate, mass, moment, center)
    if weight.shape == "disc":
        radius, there = sqrt(mass / (pi * plate)), center + moment / mass
        return [_piece("disc", mass, there, radius=radius, **_plate(weight))]
    return _points(mass, moment / mass, inertia, center)


def _points(mass: float, place: complex, inertia: float, center: complex) -> list[PieceValues]:
    """One point, or two of equal mass on a line across the direction of their middle.

    Two points at place +- d, with d across place, have the inertia m (|place|^2 + d^2).
    """
    beyond = inertia / mass - abs(place) ** 2
    if beyond <= SPREAD * max(inertia / mass, abs(place) ** 2):
        return [_piece("point", mass, center + place)]
    across = 1j * exp(1j * phase(place)) * sqrt(beyond)
    return [_piece("point", mass / 2, center + (place + sign * across)) for sign in (1, -1)]


def _sectors(
    weight: Weight, plate: float, mass: float, moment: complex, center: complex
) -> list[PieceValues]:
    """One sector; or two equal ones apart, where one would throw farther than is wanted.

    A sector of half angle b has the moment c sin b; two of half angle b / 2 at +- g from their
    middle have 2 c sin(b / 2) cos g.
    """
    outer, inner = weight.radius, weight.inner_radius
    half = min(mass / (plate * (outer**2 - inner**2)), pi)
    most = 2 / 3 * plate * (outer**3 - inner**3)
    middle = phase(moment) if moment else 0.0
    if abs(moment) >= most * (sin(half) * (1 - SPREAD) - SIZE_OF_0):
        return [_sector(weight, mass, half, middle, center)]
    aside = acos(min(1.0, abs(moment) / (2 * most * sin(half / 2))))
    return [_sector(weight, mass / 2, half / 2, middle + s * aside, center) for s in (1, -1)]


def _sector(
    weight: Weight, mass: float, half: float, direction: float, center: complex
) -> PieceValues:
    outer, inner = weight.radius, weight.inner_radius
    distance = 2 / 3 * sin(half) / half * (outer**3 - inner**3) / (outer**2 - inner**2)
    return _piece(
        "sector",
        mass,
        center + rect(distance, direction),
        outer_radius=outer,
        inner_radius=inner,
        angle=2 * half,
        direction=phase(rect(1.0, direction)),
        **_plate(weight),
    )


def _plate(weight: Weight) -> dict[str, float | None]:
    """Thickness (m) and density (kg/m3) of what a piece is cut from."""
    return {"thickness": weight.thickness, "density": weight.density}


def _piece(shape: str, mass: float, there: complex, **sizes: float | None) -> PieceValues:
    """A piece whose centre of mass is at a place in the link's axes."""
    return {"shape": shape, "mass": mass, "place": (there.real, there.imag), **sizes}


def is_ring(piece: Mapping[str, Any]) -> bool:
    """Whether a piece of plate surrounds the centre of its room, as a sector of a full turn does,
    too.
    """
    return bool(piece["shape"] == "ring" or piece.get("angle", 0.0) >= FULL_TURN)


def covers(piece: Mapping[str, Any], center: complex, place: complex) -> bool:
    """Whether a piece of plate lies where a pin is.

    center : of the room, about which rings and sectors lie; as all places in the link's axes, m.
    """
    if piece["shape"] == "point":
        return False
    if piece["shape"] == "disc":
        return bool(abs(place - complex(*piece["place"])) < piece["radius"])
    away = place - center
    if not piece["inner_radius"] < abs(away) < piece["outer_radius"]:
        return False
    aside = abs(phase(away * exp(-1j * piece.get("direction", 0.0))))
    return bool(piece["shape"] == "ring" or aside < piece["angle"] / 2)


# -- sentences -------------------------------------------------------------------------------------


def sentences(change: Change) -> Iterator[str]:
    """What to change; one sentence for the change, then one for each piece of an added mass."""
    link, values = change.link, dict(change.values)
    if change.kind == "center of mass":
        yield say(
            "{link}: move the centre of mass from {old} to {new}, with a mass of {mass}",
            link=link,
            old=point_text(values["from"]),
            new=point_text(values["to"]),
            mass=format_quantity(values["mass"], "mass"),
        )
    elif change.kind == "added mass":
        what = _added(link, values)
        yield in_its_plane(what, values) if values["pieces"] else what
        for piece in values["pieces"]:
            yield say(
                "{link}, made as: {piece}",
                link=link,
                piece=_describe(piece, point_text(values["center"])),
            )
    elif change.kind == "removed mass":
        yield _taken_off(link, values)
    elif change.kind == "spring":
        yield _spring(link, values)
    elif change.kind == "gears":
        yield "; ".join(_gears(link, values))
    else:
        yield say("Rows: set the phases to {phases}", phases=phases_text(values["phases"]))


def in_short(change: Change) -> Iterator[str]:
    """What to change: of an added mass that is cut from plate its pieces alone, which say all; of
    one point mass its mass and place alone.
    """
    link, values = change.link, dict(change.values)
    first = next(sentences(change))
    pieces = values.get("pieces", ())
    if not pieces or any(piece["shape"] == "point" for piece in pieces):
        yield from sentences(change) if len(pieces) > 1 else [first]
        return
    for piece in pieces:
        what = say("{link}: add a {piece}", link=link, piece=_describe(piece, values["at"]))
        yield in_its_plane(what, values)


def in_its_plane(what: str, values: Mapping[str, Any]) -> str:
    """A mass and the plane in which it lies, where it matters."""
    if "plane" in values:
        plane = format_quantity(values["plane"], "length")
        return say("{what}, in the plane z = {plane}", what=what, plane=plane)
    if "beside" in values:
        pins = say(", ").join(values["beside"])
        return say("{what}, in a plane of its own beside pin {pins}", what=what, pins=pins)
    if "beside_links" in values:
        links = say(", ").join(values["beside_links"])
        return say("{what}, in a plane of its own beside {links}", what=what, links=links)
    return what


def _added(link: str, values: dict[str, Any]) -> str:
    if not values["pieces"]:
        return say("{link}: add nothing", link=link)
    words = {"link": link, "mass": format_quantity(values["mass"], "mass"), "point": values["at"]}
    if not values["moment"]:
        return say("{link}: add {mass} about {point}", **words)
    return say(
        "{link}: add a counterweight of {mass}, its centre of mass {radius} from {point} "
        "at {direction} in the axes of the link ({moment})",
        radius=format_quantity(values["radius"], "length"),
        direction=direction_named(values["direction"]),
        moment=format_quantity(values["moment"], "unbalance", "g mm"),
        **words,
    )


def _taken_off(link: str, values: dict[str, Any]) -> str:
    words = {
        "link": link,
        "mass": format_quantity(values["mass"], "mass"),
        "radius": format_quantity(values["radius"], "length"),
        "point": values["at"],
        "direction": direction_named(values["direction"]),
    }
    if "hole_radius" in values:
        return say(
            "{link}: drill a hole of {diameter} through body {number}, its centre {radius} from "
            "{point} at {direction} in the axes of the link, which takes {mass} off",
            diameter=format_quantity(2 * values["hole_radius"], "length"),
            number=values["body"],
            **words,
        )
    diameter, depth = _hole_of(values["mass"])
    return say(
        "{link}: take {mass} off, {radius} from {point} at {direction} in the axes of the link "
        "({moment}), as much as a hole of {diameter} through {depth} of steel",
        moment=format_quantity(values["moment"], "unbalance", "g mm"),
        diameter=format_quantity(diameter, "length", digits=2),
        depth=format_quantity(depth, "length", digits=3),
        **words,
    )


def _hole_of(mass: float) -> tuple[float, float]:
    """Diameter, in whole millimetres, and depth of a hole in steel, about half as deep as wide."""
    volume = mass / MATERIALS["steel"]
    diameter = DRILL * max(ceil((8 * volume / pi) ** (1 / 3) / DRILL), 1)
    return diameter, 4 * volume / (pi * diameter**2)


def _describe(piece: PieceValues, center: str) -> str:
    """A piece in words; rings and sectors are described about the centre of their room."""
    shape = piece["shape"]
    sizes = ("radius", "outer_radius", "thickness")
    words = {name: format_quantity(piece[name], "length") for name in sizes if name in piece}
    words |= {"mass": format_quantity(piece["mass"], "mass"), "at": point_text(piece["place"])}
    if shape != "point":
        density = piece["density"]
        words["stuff"] = say(material_of(density) or format_quantity(density, "density"))
    if shape == "point":
        return say("point mass of {mass} at {at}", **words)
    if shape == "disc":
        return say(
            "disc of {mass}, radius {radius}, {thickness} of {stuff}, its centre at {at}",
            **words,
        )
    unit = display("length", [piece["outer_radius"]])
    words |= {"at": center, "inner": unit.text(piece["inner_radius"])}
    words["outer"] = words.pop("outer_radius")
    if shape == "ring":
        return say(
            "ring of {mass} about {at}, radius {inner} to {outer}, {thickness} of {stuff}",
            **words,
        )
    return say(
        "sector of {mass} about {at}, radius {inner} to {outer}, {thickness} of {stuff}, "
        "{wide} wide, its middle at {direction}",
        wide=direction_named(piece["angle"], digits=1),
        direction=direction_named(piece["direction"], digits=1),
        **words,
    )


def _spring(link: str, values: dict[str, Any]) -> str:
    if not values["stiffness"]:
        return say("{link}: set no spring", link=link)
    return say(
        "{link}: set a spring of {stiffness} with a free length of {length} from {point} to {to}",
        link=link,
        stiffness=format_quantity(values["stiffness"], "stiffness", "N/m"),
        length=format_quantity(values["free_length"], "length"),
        point=values["point"],
        to=values["to"],
    )


def _gears(link: str, values: dict[str, Any]) -> Iterator[str]:
    unit = display("length", values["pitch_radii"])
    yield say(
        "{link}: a shaft at {at} of the frame, geared to {driver} with the ratio {ratio}, "
        "pitch radii {radii}",
        link=link,
        at=point_text(values["axis"]),
        driver=values["driver"],
        ratio=number(values["ratio"]),
        radii=unit.with_unit(" / ".join(map(unit.text, values["pitch_radii"]))),
    )
    if "teeth" in values:
        first, second = values["teeth"]
        yield say(
            "{first} and {second} teeth of module {module}",
            first=first,
            second=second,
            module=format_quantity(values["module"], "length"),
        )
    if "masses" in values:
        first, second = (format_quantity(mass, "mass") for mass in values["masses"])
        yield say(
            "the gears add {first} to {driver} and {second} to the shaft",
            first=first,
            second=second,
            driver=values["driver"],
        )


def phases_text(phases: Sequence[float]) -> str:
    """Phases of rows, given in rad, as text; the unit follows the last."""
    *others, last = phases
    return ", ".join(
        [*(direction_named(item, named=False) for item in others), direction_named(last)]
    )


def weight_named(moment: float, radius: float) -> str:
    """A first moment (kg m), and the mass that has it at a radius (m)."""
    return say(
        "{moment} ({mass} at {radius})",
        moment=format_quantity(moment, "unbalance", digits=2),
        mass=format_quantity(moment / radius, "mass", digits=2),
        radius=format_quantity(radius, "length", digits=3),
    )


def direction_named(radians: float, named: bool = True, digits: int = 2) -> str:
    """An angle above minus half a turn, with its unit where that is to be named.

    digits : after the point, none where it is whole: one of what is marked out and cut.
    """
    unit = display("angle")
    radians += 2 * pi * (round(degrees(radians), digits) <= -180)
    text = fixed(unit, radians, digits).removesuffix("." + digits * "0")
    return unit.with_unit(text) if named else text
