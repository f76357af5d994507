"""A machine that contradicts itself cannot be made; each error names the place."""

from __future__ import annotations

import copy
import pickle
from collections.abc import Callable
from dataclasses import replace
from math import inf, nan, pi
from typing import Any

import numpy as np
import pytest

import equipoise as eq
from equipoise.errors import ModelError
from equipoise.mechanism.parts.machine import FRAME, LINKAGE, size_of
from support import refusals
from unit.mechanism.build import (
    ORIGIN,
    body,
    crank_rocker,
    four_bar,
    refused_in_words,
    slider_crank,
    two_gears,
)

FOUR = crank_rocker()
PISTON = eq.Slider("piston", "C", FRAME, "A", 0.0)
GEAR = eq.Gear("crank", "wheel", ratio=-2.0)
FORCE = eq.Load("coupler", "C", force=(1.0, 0.0))
TABLE = eq.mechanism.LoadTable((0.0, 1.0), ((1.0, 2.0),))


def rocker(**changes: Any) -> eq.Machine:
    return FOUR.with_link("rocker", **changes)


def slid(**changes: Any) -> eq.Machine:
    return slider_crank(sliders=(PISTON, replace(PISTON, **changes)))


def geared(**changes: Any) -> eq.Machine:
    return two_gears(replace(GEAR, **changes))


def loaded(**changes: Any) -> eq.Machine:
    return replace(FOUR, loads=(replace(FORCE, **changes),))


def tabled(
    angles: tuple[float, ...],
    *values: tuple[float, ...],
    point: str = "",
    outside: str | None = None,
) -> eq.Machine:
    table = eq.mechanism.LoadTable(angles, values)
    return loaded(force=None, table=table, point=point or None, outside=outside)


def placed(**position: Any) -> eq.Machine:
    return replace(FOUR, position=eq.mechanism.Position(**position))


def without(*names: str) -> eq.Machine:
    kept = {name: link for name, link in FOUR.links.items() if name not in names}
    return replace(FOUR, links=kept)


# -- numbers ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("value", [nan, inf, -inf])
@pytest.mark.parametrize(
    ("where", "make"),
    [
        ("drive.speed", lambda x: FOUR.with_drive(speed=x)),
        ("drive.acceleration", lambda x: FOUR.with_drive(acceleration=x)),
        ("frame.D[1]", lambda x: replace(FOUR, frame={"A": ORIGIN, "D": (x, 0.0)})),
        ("links.rocker.mass", lambda x: rocker(mass=x)),
        ("links.rocker.center_of_mass[2]", lambda x: rocker(center_of_mass=(0.0, x))),
        ("gravity[2]", lambda x: replace(FOUR, gravity=(0.0, x))),
        ("sliders[2].direction", lambda x: slid(direction=x)),
        ("gears[1].start", lambda x: geared(start=x)),
        ("loads[1].force[1]", lambda x: loaded(force=(x, 0.0))),
        ("position.crank_angle", lambda x: placed(crank_angle=x)),
    ],
)
def test_numbers_must_be_finite(where: str, make: Any, value: float) -> None:
    refused_in_words(where, f"got {value}; give a finite number", lambda: make(value))


@pytest.mark.parametrize("value", [1e31, -1e300, 1e-31])
def test_numbers_must_be_those_of_machines(value: float) -> None:
    words = f"got {value:g} in SI units, which no machine can have"
    refused_in_words(
        "links.rocker.center_of_mass[1]", words, lambda: rocker(center_of_mass=(value, 0.0))
    )


# -- what contradicts itself -----------------------------------------------------------------------

NO_NAME = "a link cannot be called {!r}; choose another name"
THREE = "driver {!r}, driven link {!r} and carrier {!r} must be three different bodies"
ONE_OF = "give exactly one of force, torque, table, gas and indicator"
AT_A_POINT = "missing; a force acts at a point of the link"
NOT_AT_A_POINT = "a torque acts on a link, not at a point; leave it out"
LINKS: list[tuple[str, str, Any]] = [
    ("links", "there is no link; give at least the drive's", lambda: without(*FOUR.links)),
    ("drive.link", "no link is called 'crnk'; did you mean 'crank'?",
     lambda: FOUR.with_drive(link="crnk")),
    ("drive.link", "no link is called 'crank'; there are 'coupler', 'rocker'",
     lambda: without("crank")),
    *((f"links.{name}", NO_NAME.format(name),
       lambda name=name: replace(FOUR, links={**FOUR.links, name: body(X=ORIGIN)}))
      for name in (FRAME, "", "  ")),
    ("frame.points", "there is no point; give at least one", lambda: replace(FOUR, frame={})),
    ("frame.points", "a point has an empty name", lambda: replace(FOUR, frame={" ": ORIGIN})),
    ("links.rocker.points", "there is no point; give at least one", lambda: rocker(points={})),
    ("links.rocker.points", "a point has an empty name",
     lambda: rocker(points={**FOUR.links["rocker"].points, " ": ORIGIN})),
    ("links.rocker", "mass missing; give mass, center_of_mass and inertia together...",
     lambda: rocker(mass=None)),
    ("links.rocker", "center_of_mass missing; give...", lambda: rocker(center_of_mass=None)),
    ("links.rocker", "mass and inertia missing; give...", lambda: rocker(mass=None, inertia=None)),
    ("links.rocker.mass", "got -1 kg; a mass cannot be negative", lambda: rocker(mass=-1.0)),
    ("links.rocker.inertia", "got -2 kg m^2; no body has a negative moment of inertia",
     lambda: rocker(inertia=-2.0)),
    ("links.rocker.inertia", "got 0.5 kg m^2 for a mass of 0; no body...",
     lambda: rocker(mass=0.0, inertia=0.5)),
    ("links.roker", "no link is called 'roker'; did you mean 'rocker'?",
     lambda: FOUR.with_link("roker", mass=1.0)),
]  # fmt: skip
JOINTS: list[tuple[str, str, Any]] = [
    ("sliders[2].link", "no link is called 'pistn'; did you mean 'piston'?",
     lambda: slid(link="pistn")),
    ("sliders[2].link", "no link is called 'frame'...", lambda: slid(link=FRAME)),
    ("sliders[2].point", "no point of piston is called 'Z'; there are 'C'",
     lambda: slid(point="Z")),
    ("sliders[2].on", "no link is called 'cylinder'; there are 'frame', 'crank'...",
     lambda: slid(on="cylinder")),
    ("sliders[2].through", "no point of frame is called 'B'; there are 'A'",
     lambda: slid(through="B")),
    ("sliders[2].on", "'piston' cannot slide on itself", lambda: slid(on="piston", through="C")),
    ("gears[1].between[1]", "did you mean 'crank'?...", lambda: geared(driver="cranc")),
    ("gears[1].between[2]", "did you mean 'wheel'?...", lambda: geared(driven="weel")),
    ("gears[1].carrier", "no link is called 'arm'...", lambda: geared(carrier="arm")),
    ("gears[1]", THREE.format("crank", "crank", "frame"), lambda: geared(driven="crank")),
    ("gears[1]", THREE.format("crank", "wheel", "crank"), lambda: geared(carrier="crank")),
    ("gears[1]", "give either ratio or teeth", lambda: geared(teeth=(20, 30))),
    ("gears[1]", "give either ratio or teeth", lambda: geared(ratio=None)),
    ("gears[1].teeth", "got [0, 30]; give two positive numbers",
     lambda: geared(ratio=None, teeth=(0, 30))),
    ("gears[1]", "the ratio is 0; no pair of gears has that...", lambda: geared(ratio=0.0)),
    ("gears[1]", "the ratio is 1; no pair of gears has that...", lambda: geared(ratio=1.0)),
    ("gears[1]", "the ratio is 1;...", lambda: geared(ratio=None, teeth=(30, 30), mesh="internal")),
    ("gears[1].pressure_angle", "from 0 deg to less than 90 deg...",
     lambda: geared(pressure_angle=pi / 2)),
    ("gears[1].pressure_angle", "from 0 deg to less than 90 deg...",
     lambda: geared(pressure_angle=-0.1)),
    ("assembly.C", "got 'up'; give 'left', 'right', 'forward', 'backward', 'parallel' or...",
     lambda: four_bar(1.0, 0.35, 0.9, 0.8, "up")),
    (
        "position.points.X",
        "no point of a moving link is called 'X'...",
        lambda: placed(points={"X": ORIGIN}),
    ),
    ("position.angles.rokker", "did you mean 'rocker'?...", lambda: placed(angles={"rokker": 0})),
]  # fmt: skip
LOADS: list[tuple[str, str, Any]] = [
    ("loads[1].link", "did you mean 'coupler'?...", lambda: loaded(link="couplr")),
    ("loads[1].link", "no link is called 'frame'...", lambda: loaded(link=FRAME)),
    ("loads[1].link", "did you mean 'coupler'?...", lambda: loaded(link="COUPLER")),
    ("loads[1].point", "no point of coupler is called 'c'; did you mean 'C'?",
     lambda: loaded(point="c")),
    ("loads[1].point", "did you mean 'C'?...", lambda: loaded(point="\uff23")),  # a wide C
    ("loads[1].point", "no point of coupler is called 'D'; there are 'B', 'C'",
     lambda: loaded(point="D")),
    ("loads[1]", ONE_OF, lambda: loaded(force=None)),
    ("loads[1]", ONE_OF, lambda: loaded(torque=1.0)),
    ("loads[1]", ONE_OF, lambda: loaded(table=TABLE)),
    ("loads[1].point", AT_A_POINT, lambda: loaded(point=None)),
    ("loads[1].point", AT_A_POINT, lambda: tabled((0.0,), (1.0,), (2.0,))),
    ("loads[1].point", NOT_AT_A_POINT, lambda: loaded(force=None, torque=1.0)),
    ("loads[1].point", NOT_AT_A_POINT, lambda: tabled((0.0, 1.0), (1.0, 2.0), point="C")),
    ("loads[1]", "give both from and to, or neither", lambda: loaded(start=1.0)),
    ("loads[1]", "give both from and to, or neither", lambda: loaded(stop=1.0)),
    ("loads[1]", "must differ, by one turn at most...", lambda: loaded(start=1.0, stop=1.0)),
    ("loads[1]", "must differ, by one turn at most...", lambda: loaded(start=0.0, stop=13.0)),
    ("loads[1].table", "the table has no rows", lambda: tabled((), ())),
    ("loads[1].table", "the crank angles must rise from row to row",
     lambda: tabled((0.0, 0.0), (1.0, 2.0))),
    ("loads[1].table", "the crank angles must rise from row to row",
     lambda: tabled((1.0, 0.5), (1.0, 2.0))),
    ("loads[1].table", "the table covers 101 turns; give at most 100",
     lambda: tabled((0.0, 202 * pi), (1.0, 1.0))),
    ("loads[1].outside", 'missing; the table goes from 0 deg to 180 deg, not round a turn; say '
     'what acts in the rest: outside = "zero" for nothing, "hold" for what the last row has, or '
     '"wrap" for a straight line to the first row', lambda: tabled((0.0, pi), (1.0, 2.0))),
    ("loads[1].outside", "missing; the table goes from -10 deg to 540 deg, not round 2 turns; ...",
     lambda: tabled((-pi / 18, pi, 3 * pi), (1.0, 2.0, 1.0))),
    ("loads[1].outside", "goes with a table; leave it out", lambda: loaded(outside="zero")),
    ("loads[1].table", "the table has 1 N m at 0 deg and 2 N m at 360 deg, where the crank "
     "is back; give the same in both rows, or leave the last one out",
     lambda: tabled((0.0, 1.0, 2 * pi), (1.0, 5.0, 2.0))),
    ("loads[1].table", "the table has 1 N at 90 deg and -1 N at 810 deg, ...",
     lambda: tabled((pi / 2, 1.7, 4.5 * pi), (2.0, 3.0, 2.0), (1.0, 5.0, -1.0), point="C")),
    ("loads[1].table", "the columns differ in length", lambda: tabled((0.0, 1.0), (1.0,))),
]  # fmt: skip
WHOLE: list[tuple[str, str, Any]] = [
    ("title", "give printable characters...", lambda: replace(FOUR, title="bell \a")),
    ("title", "201 characters; give at most 200", lambda: replace(FOUR, title="x" * 201)),
    ("points", "got 20...", lambda: replace(FOUR, frame={f"Q{k}": ORIGIN for k in range(2001)})),
    ("loads", "got 501; at most 500...", lambda: replace(FOUR, loads=(FORCE,) * 501)),
]


@pytest.mark.parametrize(("where", "words", "make"), [*LINKS, *JOINTS, *LOADS, *WHOLE])
def test_what_contradicts_itself(where: str, words: str, make: Any) -> None:
    refused_in_words(where, words, make)


def test_a_link_may_have_no_masses_or_none_known() -> None:
    nothing = {"mass": 0.0, "center_of_mass": ORIGIN, "inertia": 0.0}
    assert rocker(**nothing).links["rocker"].has_mass
    unknown = dict.fromkeys(nothing)
    assert not rocker(**unknown).links["rocker"].has_mass


@pytest.mark.parametrize(("mesh", "ratio"), [("external", -0.4), ("internal", 0.4)])
def test_teeth_report_the_ratio(mesh: Any, ratio: float) -> None:
    gear = eq.Gear("crank", "wheel", teeth=(20, 50), mesh=mesh)
    assert gear.speed_ratio == pytest.approx(ratio)
    assert gear.exact_ratio is not None
    assert (abs(gear.exact_ratio.numerator), gear.exact_ratio.denominator) == (2, 5)


@pytest.mark.parametrize(("ratio", "exact"), [(-0.47, True), (1 / 3, True), (pi, False)])
def test_ratios_of_whole_numbers_are_recognised(ratio: float, exact: bool) -> None:
    exact_ratio = eq.Gear("crank", "wheel", ratio=ratio).exact_ratio
    assert (exact_ratio is not None) == exact
    assert exact_ratio is None or float(exact_ratio) == pytest.approx(ratio, rel=1e-13)


# -- changing and keeping --------------------------------------------------------------------------


def test_changes_leave_the_old_machine() -> None:
    changed = FOUR.with_link("rocker", mass=9.0).with_drive(speed=-1.0)
    assert (changed.links["rocker"].mass, changed.drive.speed) == (9.0, -1.0)
    assert (FOUR.links["rocker"].mass, FOUR.drive.speed) == (0.5, 10.0)
    assert list(changed.links) == list(FOUR.links)


def test_a_changed_machine_is_assembled_anew() -> None:
    before = eq.move(FOUR, 4).points["C"].place
    after = eq.move(four_bar(1.0, 0.35, 0.9, 0.75), 4).points["C"].place
    assert eq.mechanism.assemble(FOUR) is eq.mechanism.assemble(FOUR)
    changed = FOUR.with_link("rocker", points={"D": ORIGIN, "C": (0.75, 0.0)})
    assert abs(eq.move(changed, 4).points["C"].place - after).max() == 0
    assert abs(before - after).max() > 0.01


def test_size_of_a_link() -> None:
    assert size_of({"A": ORIGIN, "B": (3.0, 0.0), "C": (0.0, 4.0)}) == 5.0
    assert size_of({"A": ORIGIN}) == 0.0


def test_an_error_knows_its_file() -> None:
    error = ModelError("links", "there is none").in_file("machine.toml")
    assert str(error) == "machine.toml: links: there is none"
    assert str(ModelError("", "broken")) == "broken"
    assert str(ModelError("links", "there is none")) == "links: there is none"


# -- values that stay as they are ------------------------------------------------------------------


def test_mappings_are_copied_and_cannot_be_changed() -> None:
    points = {"A": ORIGIN, "B": (1.0, 0.0)}
    link = eq.Link(points)
    points["B"] = (2.0, 0.0)
    assert link.points["B"] == (1.0, 0.0)
    with pytest.raises(TypeError):
        link.points["B"] = (3.0, 0.0)  # type: ignore[index]
    with pytest.raises(TypeError):
        FOUR.links["crank"] = link  # type: ignore[index]


def test_machines_are_pickled_and_copied() -> None:
    eq.mechanism.assemble(FOUR)
    for again in (pickle.loads(pickle.dumps(FOUR)), copy.deepcopy(FOUR)):
        assert again == FOUR
        assert not again.memory
        with pytest.raises(TypeError):
            again.frame["A"] = (1.0, 1.0)


def test_numbers_of_any_kind_become_floats() -> None:
    link = eq.Link({"A": np.array([1, 2])}, np.int64(2), [np.float32(0.5), 1], 3)  # type: ignore
    assert link == eq.Link({"A": (1.0, 2.0)}, 2.0, (0.5, 1.0), 3.0)
    assert type(link.mass) is float
    assert type(link.points["A"][0]) is float


@pytest.mark.parametrize(
    ("changes", "where", "wanted"),
    [
        ({"mass": "5"}, "mass", "a mass, such as"),
        ({"mass": True}, "mass", "a number"),
        ({"inertia": 10**400}, "inertia", "a number"),
        ({"center_of_mass": (1, 2, 3)}, "center_of_mass", "two numbers"),
        ({"center_of_mass": 1.0}, "center_of_mass", "two numbers"),
        ({"points": "A"}, "points", "a mapping of names to two numbers"),
    ],
)
def test_values_of_the_wrong_kind(changes: dict[str, Any], where: str, wanted: str) -> None:
    refused_in_words(where, f"give {wanted}...", lambda: replace(FOUR.links["crank"], **changes))


def test_a_changed_mass_keeps_the_solved_linkage() -> None:
    eq.move(FOUR)
    heavier, faster = FOUR.with_link("crank", mass=9.0), FOUR.with_drive(speed=3.0)
    for given in (heavier, faster):
        assert LINKAGE in given.memory
        assert eq.mechanism.assemble(given).machine is given
    longer = FOUR.with_link("crank", points={"A": ORIGIN, "B": (0.3, 0.0)})
    assert LINKAGE not in longer.memory
    anew = replace(heavier)
    np.testing.assert_array_equal(
        eq.analyze(heavier, 12).forces.drive_torque, eq.analyze(anew, 12).forces.drive_torque
    )


def test_joints_of_one_name_are_refused() -> None:
    pinned = slider_crank()
    renamed = pinned
    for name, link in pinned.links.items():
        points = {"piston on frame" if p == "B" else p: q for p, q in link.points.items()}
        renamed = replace(renamed, links={**renamed.links, name: replace(link, points=points)})
    with refusals.refused(ModelError, "links", name="piston on frame"):
        eq.mechanism.assemble(renamed)


# -- points ----------------------------------------------------------------------------------------


def test_one_point_is_moved() -> None:
    """On a link or the frame; what else the body has stays where it is."""
    moved = FOUR.with_point("crank", "B", (0.3, 0.1)).with_point(FRAME, "D", (1.1, 0.0))
    assert dict(moved.links["crank"].points) == {"A": ORIGIN, "B": (0.3, 0.1)}
    assert dict(moved.frame) == {"A": ORIGIN, "D": (1.1, 0.0)}
    place = eq.move(moved, 12).points["B"].place
    np.testing.assert_allclose(np.abs(place), np.hypot(0.3, 0.1))


@pytest.mark.parametrize(
    ("change", "expected"),
    [
        (
            lambda: FOUR.with_link("crank", points={"B": (0.3, 0.0)}),
            {"place": "links.crank.points"},
        ),
        (
            lambda: FOUR.with_point("crank", "b", ORIGIN),
            {"place": "links.crank.points", "given": "b", "body": "crank"},
        ),
        (
            lambda: FOUR.with_point("krank", "B", ORIGIN),
            {"place": "links.krank", "name": "crank", "given": "krank"},
        ),
        (
            lambda: FOUR.with_point("crank", "B", 3.0),
            {"place": "links.crank.points", "given": "{'A': (0.0, 0.0), 'B': 3.0}"},
        ),  # type: ignore[arg-type]
    ],
)
def test_no_point_is_lost_or_made_unawares(
    change: Callable[[], object], expected: dict[str, Any]
) -> None:
    with refusals.refused(ModelError, **expected):
        change()


def test_a_number_is_changed_by_text_with_its_unit() -> None:
    """As in a file; in SI units without."""
    machine = eq.load("yamashita-1")
    crank = machine.with_number("links.crank.mass", "250 g").links["crank"]
    assert crank == machine.with_number("links.crank.mass", 0.25).links["crank"]
    moved = machine.with_number("links.crank.points.B.x", "3.4 cm")
    assert moved.links["crank"].points["B"] == pytest.approx((0.034, 0.0))
    assert machine.with_number("drive.speed", "30 rpm").drive.speed == pytest.approx(np.pi)
    with refusals.refused(ModelError, "links.crank.mass", given="'250'"):
        machine.with_number("links.crank.mass", "250")
