"""Links given by bodies and lengths: what they weigh, what is refused, and what follows changes."""

from __future__ import annotations

import tomllib
from cmath import exp, phase
from collections.abc import Callable, Sequence
from dataclasses import replace
from math import hypot, pi, sqrt
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import equipoise as eq
from equipoise.balancing.design_variables import with_parameters
from equipoise.codegen.figures import Figure
from equipoise.codegen.gram import MassBatch, can_use
from equipoise.errors import ModelError, UsageError
from equipoise.mechanism.assembly.family import can_vary, invalid_designs, linkage_of, with_columns
from equipoise.mechanism.assembly.linkage import Linkage, assemble
from equipoise.mechanism.dynamics.parameters import parameters_of
from equipoise.mechanism.parts.bodies import Body, Hole, inertia_of, polygon
from equipoise.mechanism.parts.machine import Link, Machine
from equipoise.schema import dumps, loads
from equipoise.web.design import Counterweight, Design
from equipoise.web.fields import fields_of
from support import refusals
from support.conformance import compared
from support.sources import BODIES
from unit.mechanism.build import refused
from unit.schema.samples import FOUR_BAR, VALIDATOR, survives

POINTS = {"A": (0.0, 0.0), "B": (0.3, 0.0), "C": (0.1, 0.2)}
STEEL = 7850.0
CLOSE = 1e-13


def mass_properties(
    body: Body, points: dict[str, tuple[float, float]] | None = None
) -> tuple[Any, Any, Any]:
    return inertia_of(body, POINTS if points is None else points)


def same(result: Sequence[complex], wanted: Sequence[complex]) -> None:
    for item, other in zip(result, wanted, strict=True):
        assert abs(item - other) <= 1e-12 * (1e-9 + abs(other)), (result, wanted)


# -- textbook shapes -------------------------------------------------------------------------------

BAR = {"between": ("A", "B"), "mass": 2.0}


@compared(BODIES, "moment of inertia about the centre of mass", CLOSE)
@pytest.mark.parametrize(
    ("body", "wanted"),
    [
        (Body("bar", **BAR), 2 * 0.3**2 / 12),
        (Body("bar", **BAR, width=0.04), 2 * (0.3**2 + 0.04**2) / 12),
        (Body("bar", **BAR, outer_diameter=0.05), 2 * (3 * 0.025**2 + 0.3**2) / 12),
        (
            Body("bar", **BAR, outer_diameter=0.05, inner_diameter=0.03),
            2 * (3 * (0.025**2 + 0.015**2) + 0.3**2) / 12,
        ),
        (Body("disc", at="C", radius=0.1, mass=2.0), 2 * 0.1**2 / 2),
        (Body("ring", at="C", radius=0.1, inner_radius=0.06, mass=2.0), (0.1**2 + 0.06**2)),
        (Body("point", at="C", mass=2.0, inertia=0.01), 0.01),
        (Body("plate", corners=((0, 0), (0.2, 0), (0.2, 0.1), (0, 0.1)), mass=2.0), 2 * 0.05 / 12),
        (Body("plate", corners=((0, 0), (0.2, 0), (0, 0.1)), mass=2.0), 2 * 0.05 / 18),
    ],
    ids=[
        "slender bar", "rectangular bar", "round bar", "tube", "disc", "ring", "point",
        "rectangular plate", "triangular plate",
    ],
)  # fmt: skip
def test_moments_of_inertia_of_the_textbook(body: Body, wanted: float) -> None:
    mass, _, inertia = mass_properties(body)
    assert mass == 2.0
    assert inertia == pytest.approx(wanted, rel=CLOSE)


@pytest.mark.parametrize("count", [3, 4, 6, 17])
def test_regular_polygons(count: int) -> None:
    """I = m R^2 (1 - 2/3 sin^2(pi / n)) / 2 about the middle."""
    corners = [1 + 2j + 0.3 * exp(2j * pi * k / count) for k in range(count)]
    area, center, second = polygon(corners)
    assert area == pytest.approx(count / 2 * 0.09 * np.sin(2 * pi / count), rel=CLOSE)
    assert abs(center - (1 + 2j)) < 1e-15
    square = np.sin(pi / count) ** 2
    assert second == pytest.approx(area * 0.09 * (1 - 2 / 3 * square) / 2, rel=1e-12)


@pytest.mark.parametrize(
    ("body", "volume"),
    [
        (Body("bar", between=("A", "B"), width=0.02, thickness=0.005, density=STEEL), 0.3 * 1e-4),
        (
            Body("bar", between=("A", "B"), width=0.02, thickness=0.01, wall=0.002, density=STEEL),
            0.3 * (2e-4 - 0.016 * 0.006),
        ),
        (
            Body("bar", between=("A", "B"), outer_diameter=0.02, overhang=0.05, density=STEEL),
            0.4 * pi * 1e-4,
        ),
        (Body("plate", corners=("A", "B", "C"), thickness=0.01, density=STEEL), 3e-4),
        (Body("disc", at="A", radius=0.1, thickness=0.01, density=STEEL), pi * 1e-4),
        (
            Body("ring", at="A", radius=0.1, inner_radius=0.05, thickness=0.01, density=STEEL),
            pi * 0.75e-4,
        ),
    ],
)
def test_masses_are_volumes_times_a_density(body: Body, volume: float) -> None:
    assert mass_properties(body)[0] == pytest.approx(STEEL * volume, rel=CLOSE)


def test_a_mass_per_length() -> None:
    bar = Body("bar", between=("A", "C"), mass_per_length=1.5, overhang=0.01)
    mass, center, inertia = mass_properties(bar)
    length = hypot(0.1, 0.2) + 0.02
    same((mass, center, inertia), (1.5 * length, 0.05 + 0.1j, 1.5 * length**3 / 12))


# -- second routes ---------------------------------------------------------------------------------


def triangles(middle: complex, corners: Sequence[complex]) -> tuple[float, complex, float]:
    """Area, centre and second moment of a polygon that is seen whole from its middle: added up
    triangle by triangle, of which each has A (a^2 + b^2 + c^2) / 36 about its own centre.
    """
    parts = []
    for corner, two in zip(corners, [*corners[1:], corners[0]], strict=True):
        area = abs(((corner - middle).conjugate() * (two - middle)).imag) / 2
        sides = abs(corner - two) ** 2 + abs(two - middle) ** 2 + abs(middle - corner) ** 2
        parts.append((area, (middle + corner + two) / 3, area * sides / 36))
    whole = sum(area for area, _, _ in parts)
    center = sum(area * place for area, place, _ in parts) / whole
    return whole, center, sum(j + a * abs(place - center) ** 2 for a, place, j in parts)


WITHIN = st.floats(-3, 3).map(lambda value: round(value, 6))
PLACE = st.builds(complex, WITHIN, WITHIN)
STARS = st.lists(st.floats(0.3, 2.0), min_size=3, max_size=9).map(
    lambda radii: [r * exp(2j * pi * k / len(radii)) for k, r in enumerate(radii)]
)


@given(STARS, PLACE, st.floats(0, 2 * pi))
def test_polygons_by_their_triangles_wherever_they_lie(
    star: list[complex], place: complex, turn: float
) -> None:
    moved = [place + corner * exp(1j * turn) for corner in star]
    result = polygon(moved)
    for entry, other in zip(result, triangles(place, moved), strict=True):
        assert abs(entry - other) <= 1e-12 * 10
    area, center, second = polygon(star)
    same = area, place + center * exp(1j * turn), second
    assert all(abs(item - other) <= 1e-12 * 10 for item, other in zip(result, same, strict=True))
    backwards = polygon(moved[::-1])
    assert all(
        abs(item - other) <= 1e-12 * 10 for item, other in zip(result, backwards, strict=True)
    )


def test_far_from_the_origin_no_digits_are_lost() -> None:
    near = polygon([0, 0.1 + 0j, 0.1j])[2]
    assert polygon([100 + 0j, 100.1 + 0j, 100 + 0.1j])[2] == pytest.approx(near, rel=1e-9)


def by_cells(inside: Callable[[Any], Any], half: float, count: int) -> tuple[float, complex, float]:
    """Area, centre and second moment of what lies inside, by midpoints of small squares."""
    step = 2 * half / count
    x = (np.arange(count) + 0.5) * step - half
    z = (x[None, :] + 1j * x[:, None]).ravel()
    z = z[inside(z)]
    center = z.mean()
    return (
        z.size * step**2,
        center,
        float(np.sum(abs(z - center) ** 2) + z.size * step**2 / 6) * step**2,
    )


# Plates and holes in closed form: the other tests of this file.
@pytest.mark.exhaustive
def test_a_plate_with_holes_by_small_cells() -> None:
    corners = [-0.9 - 0.6j, 0.8 - 0.5j, 0.7 + 0.7j, -0.2 + 0.2j, -0.8 + 0.8j]
    holes = [(0.4 + 0.1j, 0.2), (-0.6 - 0.1j, 0.15)]
    plate = Body(
        "plate",
        corners=[(z.real, z.imag) for z in corners],
        thickness=1.0,
        density=1.0,
        holes=[Hole((z.real, z.imag), r) for z, r in holes],
    )

    def inside(z: Any) -> Any:
        turned = sum(
            np.angle((b - z) / (a - z))
            for a, b in zip(corners, [*corners[1:], corners[0]], strict=True)
        )
        return (abs(turned) > pi) & np.all([abs(z - c) > r for c, r in holes], axis=0)

    for item, other in zip(mass_properties(plate), by_cells(inside, 1.0, 1500), strict=True):
        assert abs(item - other) < 1e-3


def test_a_flat_bar_is_a_plate_and_a_hollow_one_what_is_left_of_two() -> None:
    way = (0.1 + 0.2j) / abs(0.1 + 0.2j)
    ends = (-0.02 * way, 0.1 + 0.2j + 0.02 * way)
    sides = [
        z + s * 0.015j * way for z, s in ((ends[0], -1), (ends[1], -1), (ends[1], 1), (ends[0], 1))
    ]
    more = {"thickness": 0.01, "density": STEEL}
    plate = Body("plate", corners=[(z.real, z.imag) for z in sides], **more)
    bar = {"between": ("A", "C"), "overhang": 0.02}
    same(mass_properties(Body("bar", **bar, width=0.03, **more)), mass_properties(plate))

    hole = [Hole("C", 0.004), Hole((0.03, 0.06), 0.01)]
    same(
        mass_properties(Body("bar", **bar, width=0.03, **more, holes=hole)),
        mass_properties(replace(plate, holes=hole)),
    )

    outer = mass_properties(Body("bar", **bar, width=0.03, **more))
    inner = mass_properties(Body("bar", **bar, width=0.026, thickness=0.006, density=STEEL))
    hollow = mass_properties(Body("bar", **bar, width=0.03, wall=0.002, **more))
    same(hollow, (outer[0] - inner[0], outer[1], outer[2] - inner[2]))


def test_a_hole_is_a_disc_less() -> None:
    disc = Body("disc", at="C", radius=0.1, thickness=0.01, density=STEEL)
    taken = mass_properties(
        Body("disc", at=(0.12, 0.17), radius=0.03, thickness=0.01, density=STEEL)
    )
    mass, center, inertia = mass_properties(replace(disc, holes=[Hole((0.12, 0.17), 0.03)]))
    whole = mass_properties(disc)
    assert mass + taken[0] == pytest.approx(whole[0], rel=CLOSE)
    same([mass * center + taken[0] * taken[1]], [whole[0] * whole[1]])
    steiner = sum(j + m * abs(c - whole[1]) ** 2 for m, c, j in ((mass, center, inertia), taken))
    assert steiner == pytest.approx(whole[2], rel=CLOSE)
    ring = Body("ring", at="C", radius=0.1, inner_radius=0.03, thickness=0.01, density=STEEL)
    same(mass_properties(ring), mass_properties(replace(disc, holes=[Hole("C", 0.03)])))


@given(
    st.lists(st.tuples(st.floats(0.1, 5), PLACE, st.floats(1e-3, 2)), min_size=1, max_size=6),
)
def test_bodies_add_up_by_steiner(parts: list[tuple[float, complex, float]]) -> None:
    """About the origin masses, first moments and moments of inertia are sums."""
    bodies = [Body("point", at=(z.real, z.imag), mass=m, inertia=j) for m, z, j in parts]
    mass, x, y, inertia = parameters_of(Link(POINTS, bodies=bodies))
    assert mass == pytest.approx(sum(m for m, _, _ in parts))
    assert complex(x, y) == pytest.approx(sum(m * z for m, z, _ in parts), abs=1e-12)
    assert inertia == pytest.approx(sum(j + m * abs(z) ** 2 for m, z, j in parts), abs=1e-12)


def like(link: Link, shape: str) -> Link:
    """A link of the same points and the same masses, by a body of a shape."""
    assert link.mass is not None and link.center_of_mass is not None and link.inertia is not None
    x, y = link.center_of_mass
    reach = sqrt(link.inertia / link.mass)
    measures: dict[str, Any] = {
        "point": {"at": (x, y), "inertia": link.inertia},
        "disc": {"at": (x, y), "radius": sqrt(2) * reach},
        "bar": {"between": ((x - sqrt(3) * reach, y), (x + sqrt(3) * reach, y))},
    }
    return Link(link.points, bodies=[Body(shape, mass=link.mass, **measures[shape])])  # type: ignore[arg-type]


def test_a_bundled_machine_made_of_bodies_has_the_same_figures() -> None:
    machine = eq.load("yamashita-1")
    shapes = {"crank": "disc", "coupler": "bar", "rocker": "point"}
    links = {name: like(link, shapes[name]) for name, link in machine.links.items()}
    made = loads(dumps(replace(machine, links=links)))
    actual, wanted = (eq.analyze(item).summary for item in (made, machine))
    for name, figures in wanted.items():
        for figure in ("mean", "rms", "peak", "max", "min"):
            near = pytest.approx(getattr(figures, figure), rel=1e-9, abs=1e-9 * figures.peak)
            assert getattr(actual[name], figure) == near, name


# -- lengths ---------------------------------------------------------------------------------------


def test_two_points_and_their_distance() -> None:
    link = Link(("B", "C"), length=0.12)  # type: ignore[arg-type]
    assert link.points == {"B": (0.0, 0.0), "C": (0.12, 0.0)}


@given(st.floats(0.1, 5), st.floats(0.1, 5), st.floats(0.01, 3.13))
def test_a_triangle_by_its_sides(a: float, c: float, angle: float) -> None:
    """By the law of cosines, from two sides and the angle between them."""
    b = abs(a - c * exp(1j * angle))
    sides = {"B-C": a, "P-C": b, "P-B": c}
    link = Link(("B", "C", "P"), sides=sides)  # type: ignore[arg-type]
    places = {name: complex(*place) for name, place in link.points.items()}
    assert places["B"] == 0 and places["C"] == a
    assert places["P"].imag >= 0
    for name, length in sides.items():
        first, other = name.split("-")
        assert abs(places[first] - places[other]) == pytest.approx(length, rel=1e-9)
    assert phase(places["P"]) == pytest.approx(angle, abs=1e-6)


NO_TRIANGLE = {"B-C": 0.1, "C-P": 0.02, "P-B": 0.03}


@pytest.mark.parametrize(
    ("given", "where", "expected"),
    [
        ({"points": ("B", "C")}, "points", {}),
        ({"points": ("B",), "length": 0.1}, "points", {"count": 1}),
        ({"points": ("B", "B"), "length": 0.1}, "points", {}),
        ({"points": ("B", "C"), "sides": NO_TRIANGLE}, "points", {}),
        ({"points": ("B", "C"), "length": -0.1}, "length", {"text": "-0.1 m"}),
        (
            {"points": {"B": (0, 0), "C": (1, 0)}, "length": 0.1},
            "points",
            {},
        ),
        ({"points": tuple("BCP"), "length": 0.1, "sides": NO_TRIANGLE}, "sides", {}),
        ({"points": tuple("BCP"), "sides": NO_TRIANGLE}, "sides", {"sides": "100, 20, 30"}),
        ({"points": tuple("BCP"), "sides": {"B-C": 1}}, "sides.C-P", {}),
        (
            {"points": tuple("BCP"), "sides": {"B-C": 1, "C-P": 1, "P-X": 1}},
            "sides.P-B",
            {"given": "P-X"},
        ),
        (
            {"points": tuple("BCP"), "sides": {"B-C": 1, "C-P": 1, "P-B": 1, "B-P": 1}},
            "sides.B-P",
            {},
        ),
    ],
)
def test_lengths_that_are_refused(
    given: dict[str, Any], where: str, expected: dict[str, Any]
) -> None:
    refused(where, expected, lambda: Link(**given))


# -- what is refused -------------------------------------------------------------------------------

FLAT = {"between": ("A", "B"), "width": 0.02, "thickness": 0.005, "density": STEEL}
CUT = {"thickness": 0.005, "density": STEEL}
SQUARE = ((0, 0), (1, 0), (1, 1), (0, 1))


@pytest.mark.parametrize(
    ("shape", "given", "where", "expected"),
    [
        ("bar", {}, "between", {"shape": "bar"}),
        (
            "bar",
            FLAT | {"between": ("A", "Z")},
            "between[2]",
            {"given": "Z"},
        ),
        ("bar", FLAT | {"between": ("A", (0, 0))}, "between", {}),
        ("bar", FLAT | {"thickness": None}, "thickness", {}),
        ("bar", FLAT | {"width": None}, "width", {}),
        ("bar", FLAT | {"density": None}, "material", {}),
        ("bar", FLAT | {"mass": 1.0}, "mass", {"given": "density"}),
        ("bar", FLAT | {"mass": 1.0, "density": None, "width": -1.0}, "width", {"text": "-1 m"}),
        ("bar", FLAT | {"wall": 0.01}, "wall", {}),
        ("bar", FLAT | {"outer_diameter": 0.01}, "outer_diameter", {}),
        ("bar", FLAT | {"inner_diameter": 0.01}, "inner_diameter", {}),
        ("bar", FLAT | {"radius": 0.01}, "radius", {"shape": "bar"}),
        ("plate", CUT | {"corners": ("A", "B")}, "corners", {"count": 2}),
        ("plate", CUT | {"corners": ("A", "B", (0.6, 0))}, "corners", {}),
        (
            "plate",
            CUT | {"corners": ((0, 0), (1, 1), (1, 0), (0, 1))},
            "corners",
            {"start": 1, "end": 2, "other_start": 3, "other_end": 4},
        ),
        ("disc", CUT | {"at": "A"}, "radius", {"shape": "disc"}),
        ("disc", CUT | {"at": "A", "radius": 0.0}, "radius", {"text": "0 m"}),
        (
            "disc",
            CUT | {"at": "A", "radius": 1, "inner_radius": 0.5},
            "inner_radius",
            {},
        ),
        (
            "ring",
            CUT | {"at": "A", "radius": 1, "inner_radius": 1.0},
            "inner_radius",
            {},
        ),
        ("point", {"at": "A"}, "mass", {"shape": "point"}),
        (
            "point",
            {"at": "A", "mass": 1.0, "holes": [Hole("A", 1)]},
            "holes",
            {"shape": "point"},
        ),
    ],
)
def test_bodies_that_are_refused(
    shape: Any, given: dict[str, Any], where: str, expected: dict[str, Any]
) -> None:
    refused(f"bodies[1].{where}", expected, lambda: Link(POINTS, bodies=[Body(shape, **given)]))


@pytest.mark.parametrize(
    ("shape", "given", "holes", "where"),
    [
        ("plate", {"corners": SQUARE}, [((0.95, 0.5), 0.1)], 1),
        ("plate", {"corners": SQUARE}, [((2.0, 0.5), 0.1)], 1),
        ("plate", {"corners": SQUARE}, [((0.3, 0.5), 0.2), ((0.6, 0.5), 0.2)], 2),
        ("disc", {"at": "A", "radius": 0.5}, [("B", 0.3)], 1),
        ("disc", {"at": "A", "radius": 0.5}, [("A", 0.5)], 0),
        ("ring", {"at": "A", "radius": 0.5, "inner_radius": 0.2}, [("B", 0.15)], 1),
        ("bar", {"between": ("A", "B"), "width": 0.1}, [("B", 0.01)], 1),
    ],
)
def test_holes_that_do_not_fit(shape: Any, given: Any, holes: Any, where: int) -> None:
    body = Body(shape, **CUT, **given, holes=[Hole(*hole) for hole in holes])
    place = f"bodies[1].holes[{where}]" if where else "bodies[1].holes"
    refused(place, {}, lambda: Link(POINTS, bodies=[body]))
    Link(POINTS, bodies=[replace(body, holes=())])


def test_a_cut_out_that_is_reached_from_the_edge() -> None:
    """A square with a square hole, as one line."""
    inner = ((0.25, 0.25), (0.25, 0.75), (0.75, 0.75), (0.75, 0.25))
    corners = (*SQUARE, SQUARE[0], *inner, inner[0])
    mass, center, inertia = mass_properties(Body("plate", corners=corners, thickness=1, density=1))
    same((mass, center, inertia), (0.75, 0.5 + 0.5j, 1 / 6 - 0.5**4 / 6))


def test_masses_beside_bodies() -> None:
    disc = Body("disc", at="A", radius=0.1, mass=2.0)
    refused("mass", {}, lambda: Link(POINTS, mass=1.0, bodies=[disc]))
    assert Link(POINTS, mass=2.0, bodies=[disc]).inertia == pytest.approx(0.01)


# -- files -----------------------------------------------------------------------------------------

BODIES = """
[[links.rocker.bodies]]
shape = "bar"
between = ["D", "C"]
overhang = "10 mm"
width = "20 mm"
thickness = "5 mm"
material = "steel"

[[links.rocker.bodies.holes]]
at = "C"
radius = "5 mm"

[[links.rocker.bodies]]
shape = "plate"
corners = ["D", ["40 mm", "-20 mm"], { distance = "50 mm", direction = "30 deg" }]
thickness = "3 mm"
density = "2500 kg/m^3"

[[links.rocker.bodies]]
shape = "disc"
at = ["-20 mm", "0 mm"]
radius = "30 mm"
mass = "300 g"
"""
COUPLER = """[links.coupler]
points = ["B", "C"]
length = "71.5 mm"

[[links.coupler.bodies]]
shape = "bar"
between = ["B", "C"]
outer_diameter = "12 mm"
inner_diameter = "8 mm"
material = "aluminium"
"""
OLD = '[links.coupler]\npoints.B = ["0 mm", "0 mm"]\npoints.C = ["71.5 mm", "0 mm"]\n'
TEXT = FOUR_BAR.replace(OLD, COUPLER).replace("\n[assembly]", f"{BODIES}\n[assembly]")


def test_a_file_keeps_its_bodies_and_lengths() -> None:
    text = survives(loads(TEXT))
    table = tomllib.loads(text)["links"]
    assert table == tomllib.loads(TEXT)["links"]
    assert text.count("[[links.rocker.bodies]]") == 3


@pytest.mark.parametrize(
    ("old", "new", "where", "expected"),
    [
        ("[[links.coupler.b", 'mass = "1 g"\n[[links.coupler.b', "links.coupler.mass", {}),
        (
            'points = ["B", "C"]\n',
            'points.B = ["0 mm", "0 mm"]\npoints.C = ["1 mm", "0 mm"]\n',
            "links.coupler.points",
            {},
        ),
        (
            "[[links.rocker.bodies.holes]]",
            "[links.rocker.bodies.holes]",
            "links.rocker.bodies[1].holes",
            {"header": "links.rocker.bodies.holes"},
        ),
        ('length = "71.5 mm"', "", "links.coupler.points", {}),
        (
            'shape = "disc"',
            'shape = "disk"',
            "links.rocker.bodies[3].shape",
            {"given": "'disk'", "name": "disc"},
        ),
        ('at = "C"', 'at = "E"', "links.rocker.bodies[1].holes[1].at", {"given": "E"}),
        ('at = "C"', "at = 3", "links.rocker.bodies[1].holes[1].at", {"number": 3}),
        ('"steel"', '"stone"', "links.rocker.bodies[1].material", {"given": "stone"}),
        (
            'radius = "5 mm"',
            'radius = "15 mm"',
            "links.rocker.bodies[1].holes[1]",
            {"shape": "bar"},
        ),
        (
            'between = ["B", "C"]',
            'between = ["B"]',
            "links.coupler.bodies[1].between",
            {"count": 1},
        ),
        ('points = ["B", "C"]', "points = [1, 2]", "links.coupler.points[1]", {"number": 1}),
        ('points = ["B", "C"]', "points = []", "links.coupler.points", {"count": 0}),
    ],
)
def test_files_that_are_refused(old: str, new: str, where: str, expected: dict[str, Any]) -> None:
    assert old in TEXT
    with refusals.refused(ModelError, where, **expected):
        loads(TEXT.replace(old, new, 1), "mine.toml")


def test_the_schema_knows_what_goes_together() -> None:
    def valid(text: str) -> bool:
        return VALIDATOR.is_valid(tomllib.loads(text))

    assert valid(TEXT)
    assert not valid(TEXT.replace('length = "71.5 mm"\n', ""))
    assert not valid(TEXT.replace("[[links.coupler.b", 'mass = "1 g"\n[[links.coupler.b'))
    assert not valid(TEXT.replace('radius = "30 mm"\n', ""))
    assert not valid(TEXT.replace('shape = "disc"', 'shape = "plate"'))
    assert not valid(TEXT.replace('mass = "300 g"', ""))


# -- what follows changes --------------------------------------------------------------------------


def test_numbers_of_bodies_and_lengths_by_their_path() -> None:
    machine = loads(TEXT)
    path = "links.rocker.bodies[1].thickness"
    thick = machine.with_number(path, 0.010)
    assert thick == loads(TEXT.replace('thickness = "5 mm"', 'thickness = "10 mm"', 1))
    longer = machine.with_number("links.coupler.length", 0.075)
    assert longer == loads(TEXT.replace("71.5 mm", "75 mm"))
    assert longer.links["coupler"].mass == pytest.approx(
        machine.links["coupler"].mass * 75 / 71.5,
        rel=1e-12,  # type: ignore[operator]
    )


def test_errors_of_changed_links_report_their_place() -> None:
    machine = loads(TEXT)
    path = "links.rocker.bodies[1].width"
    refused(
        "links.rocker.bodies[1].width", {"text": "-1 m"}, lambda: machine.with_number(path, -1.0)
    )
    refused("links.rocker.mass", {"text": "-1 kg"}, lambda: machine.with_link("rocker", mass=-1.0))
    refused(
        "links.coupler.length", {"text": "0 m"}, lambda: machine.with_link("coupler", length=0.0)
    )


def test_a_given_value_takes_the_place_of_a_derived_one() -> None:
    machine = loads(TEXT)
    heavy = machine.with_link("rocker", mass=1.0).links["rocker"]
    assert heavy.bodies == () and heavy.mass == 1.0
    assert heavy.inertia == machine.links["rocker"].inertia
    moved = machine.with_number("links.coupler.points.C.x", 0.08)
    coupler = moved.links["coupler"]
    assert coupler.length is None and coupler.points["C"] == (0.08, 0.0)
    assert coupler.center_of_mass == (0.04, 0.0)  # its bar goes where its points go
    with refusals.refused(ModelError, "mass"):
        replace(machine.links["rocker"], mass=1.0)


def parameters(linkage: Linkage) -> list[Any]:
    return [
        value
        for step in (*linkage.motion, *linkage.forces)
        for value in getattr(step, "parameters", ())
    ]


MASSY = TEXT.replace('mass = "199 g"', 'mass = "150 g"')
ROCKER = "links.rocker.bodies"
COLUMNS = {
    "links.coupler.length": (0.07, 0.0735),
    f"{ROCKER}[1].thickness": (0.004, 0.009),
    f"{ROCKER}[2].density": (2000.0, 8000.0),
    f"{ROCKER}[3].radius": (0.02, 0.05),
    f"{ROCKER}[3].at.x": (-0.05, 0.02),
    "links.coupler.bodies[1].outer_diameter": (0.01, 0.02),
}


@pytest.mark.parametrize("paths", [*[[path] for path in COLUMNS], [*COLUMNS]])
def test_columns_are_designs_of_their_own(paths: list[str]) -> None:
    machine = loads(MASSY)
    base = assemble(machine)
    columns = {path: np.array(COLUMNS[path])[:, None] for path in paths}
    columned = with_columns(machine, columns)
    assert not invalid_designs(columned, base, columns).any()
    result = parameters(linkage_of(columned, base))
    for k in range(2):
        alone = machine
        for path in paths:
            alone = alone.with_number(path, COLUMNS[path][k])
        wanted = parameters(assemble(alone))
        for item, other in zip(result, wanted, strict=True):
            value = np.broadcast_to(item, (2, 1))[k, 0]
            assert abs(value - other) <= CLOSE * (1 + abs(other))


SIDES = OLD.replace(
    'points.B = ["0 mm", "0 mm"]\npoints.C = ["71.5 mm", "0 mm"]\n',
    """points = ["B", "C", "P"]
sides.B-C = "71.5 mm"
sides.C-P = "60 mm"
sides.P-B = "50 mm"
mass = "100 g"
center_of_mass = ["0 mm", "0 mm"]
inertia = "1 kg mm^2"
""",
)


def test_columns_of_sides_and_what_no_machine_can_have() -> None:
    machine = loads(FOUR_BAR.replace(OLD, SIDES).replace("\n[assembly]", f"{BODIES}\n[assembly]"))
    base = assemble(machine)
    columns = {"links.coupler.sides.C-P": np.array([[0.05], [0.5], [-1.0]])}
    assert invalid_designs(with_columns(machine, columns), base, columns).tolist() == [
        False,
        True,
        True,
    ]
    alone = machine.with_number("links.coupler.sides.C-P", 0.05).links["coupler"]
    reported = with_columns(machine, columns).links["coupler"].points["P"]
    assert [float(part[0, 0]) for part in reported] == pytest.approx(alone.points["P"])
    columns = {f"{ROCKER}[3].radius": np.array([[0.05], [0.0], [-1.0]])}
    with np.errstate(all="ignore"):
        result = invalid_designs(with_columns(machine, columns), base, columns)
    assert result.tolist() == [False, True, True]


@pytest.mark.parametrize(
    "path",
    [
        "links.rocker.points.D.x",  # where a hole is
        f"{ROCKER}[1].width",  # around a hole
        f"{ROCKER}[2].corners[2].x",
        f"{ROCKER}[1].holes[1].radius",
        f"{ROCKER}[2].mass",  # not given
        f"{ROCKER}[4].mass",
        "links.crank.length",
    ],
)
def test_no_such_columns(path: str) -> None:
    assert not can_vary(loads(TEXT), path)
    with pytest.raises(UsageError):
        with_columns(loads(TEXT), {path: np.ones((1, 1))})


QUAD = """
[[links.crank.bodies]]
shape = "plate"
corners = ["A", ["10 mm", "-20 mm"], "B", ["10 mm", "20 mm"]]
thickness = "4 mm"
material = "steel"
"""


def test_plates_of_columns() -> None:
    """Corners that are points of the link: a plate is refused where its edges cross."""
    own = '[links.crank]\npoints.A = ["0 mm", "0 mm"]\npoints.B = ["33.5 mm", "0 mm"]\n'
    text = (
        TEXT[: TEXT.index("[links.crank]")] + own + QUAD + TEXT[TEXT.index("\n[links.coupler]") :]
    )
    machine = loads(text)
    base, path = assemble(machine), "links.crank.points.B.x"
    values = [0.03, 0.04, -0.005, 0.012]
    columns = {path: np.array(values)[:, None]}
    columned = with_columns(machine, columns)
    assert invalid_designs(columned, base, columns).tolist() == [False, False, False, False]
    crossing = {"links.crank.points.B.y": np.array([[0.0], [0.05]])}
    made = with_columns(machine.with_number(path, 0.002), crossing)
    assert invalid_designs(made, base, crossing).tolist() == [False, True]
    for k, value in enumerate(values):
        alone = machine.with_number(path, value).links["crank"]
        link = columned.links["crank"]
        assert float(link.mass[k, 0]) == pytest.approx(alone.mass, rel=CLOSE)  # type: ignore[index]
        assert float(link.inertia[k, 0]) == pytest.approx(alone.inertia, rel=1e-12)  # type: ignore[index]
    with refusals.refused(ModelError, "links.crank.bodies[1].corners"):
        machine.with_link("crank", points={"A": (0.0, 0.0), "B": (0.002, 0.05)})


def test_what_only_a_machine_of_its_own_reports_is_not_computed_at_once() -> None:
    """A disc with a hole in it, whose radius varies: its designs are looked at one by one."""
    machine, figure = loads(MASSY), Figure("shaking_force.y", "rms")
    assert can_use(machine, [f"{ROCKER}[1].thickness"], [figure])
    assert not can_use(machine, [f"{ROCKER}[1].width"], [figure])


def test_mean_squares_by_masses_alone() -> None:
    """More designs than are computed at once, by the Gram factor and each by itself."""
    machine, path = loads(MASSY), f"{ROCKER}[1].thickness"
    figure = Figure("shaking_force", "rms")
    values = np.linspace(0.001, 0.02, 8200)[:, None]
    values[4] = -1.0
    figures, reason = MassBatch(machine, [path], [figure])(values)
    assert np.flatnonzero(reason).tolist() == [4]
    for k in (0, 3, 8199):
        alone = machine.with_number(path, values[k, 0])
        wanted = eq.analyze(alone).summary["shaking_force"].rms
        assert figures[k, 0] == pytest.approx(wanted, rel=1e-6)


# -- added mass ------------------------------------------------------------------------------------


def test_added_mass_is_a_further_body() -> None:
    machine = loads(MASSY)
    rocker = machine.links["rocker"]
    more = rocker.with_added(0.2, (-0.03, 0.01), 1e-5)
    plain = replace(rocker, bodies=()).with_added(0.2, (-0.03, 0.01), 1e-5)
    assert more.bodies[:-1] == rocker.bodies and plain.bodies == ()
    same(parameters_of(more), parameters_of(plain))
    made = with_parameters(machine, "rocker", np.array(parameters_of(plain)))
    assert made.links["rocker"].bodies[:-1] == rocker.bodies
    same(parameters_of(made.links["rocker"]), parameters_of(plain))
    assert with_parameters(machine, "rocker", np.array(parameters_of(rocker))) == machine
    lighter = with_parameters(machine, "rocker", 0.5 * np.array(parameters_of(rocker)))
    assert lighter.links["rocker"].bodies == ()


def test_a_balanced_machine_is_written_with_its_bodies(tmp_path: Path) -> None:
    machine = loads(
        MASSY
        + """
[[balance.masses]]
link = "rocker"
at = "D"
radius = "60 mm"
shape = "disc"
thickness = "20 mm"
material = "steel"
at_most = "300 g"

[[balance.objectives]]
output = "shaking_force"
"""
    )
    balanced = eq.balance(machine).machine
    assert balanced.links["rocker"].bodies[:3] == machine.links["rocker"].bodies
    eq.save(balanced, tmp_path / "balanced.toml")
    again = eq.load(tmp_path / "balanced.toml")
    assert again == balanced
    assert len(again.links["rocker"].bodies) == 4


def test_the_page_shows_measures_and_keeps_bodies() -> None:
    machine: Machine = loads(MASSY)
    design = Design("mine", machine)
    fields = fields_of(design)
    assert "links.rocker.bodies[1].thickness" in fields and "links.coupler.length" in fields
    assert "links.rocker.bodies[3].at.x" in fields
    hidden = {"links.rocker.mass", "links.coupler.points.C.x", "links.rocker.bodies[1].wall"}
    assert not hidden & fields.keys()
    changed = fields["links.rocker.bodies[1].thickness"].put(design, 0.007)
    assert changed.own.links["rocker"].bodies[0].thickness == 0.007
    weighted = design.with_weight("rocker", Counterweight(0.1, 0.05, pi)).machine
    assert weighted.links["rocker"].bodies[:3] == machine.links["rocker"].bodies
    assert weighted.links["rocker"].bodies[3].mass == 0.1
