"""A machine that contradicts itself cannot be made; each error names the place."""

from __future__ import annotations

import copy
import pickle
from dataclasses import replace
from math import inf, nan, pi
from typing import Any

import numpy as np
import pytest

import equipoise as eq
from equipoise.errors import ModelError
from equipoise.mechanism.model import FRAME, size_of
from unit.mechanism.build import ORIGIN, body, crank_rocker, four_bar, slider_crank, two_gears

FOUR = crank_rocker()
PISTON = eq.Slider("piston", "C", FRAME, "A", 0.0)
GEAR = eq.Gear("crank", "wheel", ratio=-2.0)
FORCE = eq.Load("coupler", "C", force=(1.0, 0.0))
TABLE = eq.mechanism.LoadTable((0.0, 1.0), ((1.0, 2.0),))


def refused(where: str, words: str, make: Any) -> None:
    """Check that a machine is refused at a place, in these words."""
    with pytest.raises(ModelError) as caught:
        make()
    assert caught.value.where == where
    assert words in caught.value.what
    assert str(caught.value) == f"{where}: {caught.value.what}"


# -- numbers ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("value", [nan, inf, -inf])
@pytest.mark.parametrize(
    ("where", "make"),
    [
        ("drive.speed", lambda x: FOUR.with_drive(speed=x)),
        ("drive.acceleration", lambda x: FOUR.with_drive(acceleration=x)),
        ("frame.D[1]", lambda x: replace(FOUR, frame={"A": ORIGIN, "D": (x, 0.0)})),
        ("links.rocker.mass", lambda x: FOUR.with_link("rocker", mass=x)),
        ("links.rocker.center_of_mass[2]",
         lambda x: FOUR.with_link("rocker", center_of_mass=(0.0, x))),
        ("gravity[2]", lambda x: replace(FOUR, gravity=(0.0, x))),
        ("sliders[1].direction",
         lambda x: slider_crank(sliders=(replace(PISTON, direction=x),))),
        ("gears[1].start", lambda x: two_gears(replace(GEAR, start=x))),
        ("loads[1].force[1]", lambda x: replace(FOUR, loads=(replace(FORCE, force=(x, 0.0)),))),
        ("position.crank_angle", lambda x: replace(FOUR, position=eq.mechanism.Position(x))),
    ],
)  # fmt: skip
def test_numbers_must_be_finite(where: str, make: Any, value: float) -> None:
    refused(where, f"got {value}; give a finite number", lambda: make(value))


@pytest.mark.parametrize("value", [1e31, -1e300, 1e-31])
def test_numbers_must_be_those_of_machines(value: float) -> None:
    words = f"got {value:g} in SI units, which no machine can have"
    refused("links.rocker.center_of_mass[1]", words,
            lambda: FOUR.with_link("rocker", center_of_mass=(value, 0.0)))  # fmt: skip


# -- links and points ------------------------------------------------------------------------------


def without(*names: str) -> eq.Machine:
    kept = {name: link for name, link in FOUR.links.items() if name not in names}
    return replace(FOUR, links=kept)


def test_there_must_be_links() -> None:
    refused("links", "there is no link; give at least the drive's", lambda: without(*FOUR.links))


def test_the_driven_link_must_exist() -> None:
    words = "no link is called 'crnk'; did you mean 'crank'?"
    refused("drive.link", words, lambda: FOUR.with_drive(link="crnk"))
    words = "no link is called 'crank'; there are 'coupler', 'rocker'"
    refused("drive.link", words, lambda: without("crank"))


@pytest.mark.parametrize("name", [FRAME, "", "  "])
def test_link_names(name: str) -> None:
    links = {**FOUR.links, name: body(X=ORIGIN)}
    refused(f"links.{name}", f"a link cannot be called {name!r}; choose another name",
            lambda: replace(FOUR, links=links))  # fmt: skip


@pytest.mark.parametrize(
    ("where", "make"),
    [
        ("frame.points", lambda points: replace(FOUR, frame=points)),
        ("links.rocker.points", lambda points: FOUR.with_link("rocker", points=points)),
    ],
)
def test_bodies_have_points_with_names(where: str, make: Any) -> None:
    refused(where, "there is no point; give at least one", lambda: make({}))
    refused(where, "a point has an empty name", lambda: make({" ": ORIGIN}))


# -- masses ----------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"mass": None}, "mass missing; give mass, center_of_mass and inertia together"),
        ({"center_of_mass": None}, "center_of_mass missing; give"),
        ({"mass": None, "inertia": None}, "mass and inertia missing; give"),
    ],
)
def test_masses_are_given_whole(changes: dict[str, None], words: str) -> None:
    refused("links.rocker", words, lambda: FOUR.with_link("rocker", **changes))


@pytest.mark.parametrize(
    ("changes", "key", "words"),
    [
        ({"mass": -1.0}, "mass", "got -1 kg; a mass cannot be negative"),
        ({"inertia": -2.0}, "inertia", "got -2 kg m^2; no body has a negative moment of inertia"),
        ({"mass": 0.0, "inertia": 0.5}, "inertia", "got 0.5 kg m^2 for a mass of 0; no body"),
    ],
)
def test_masses_are_those_of_bodies(changes: dict[str, float], key: str, words: str) -> None:
    refused(f"links.rocker.{key}", words, lambda: FOUR.with_link("rocker", **changes))


def test_a_link_may_have_no_masses_or_none_known() -> None:
    nothing = {"mass": 0.0, "center_of_mass": ORIGIN, "inertia": 0.0}
    assert FOUR.with_link("rocker", **nothing).links["rocker"].has_mass
    unknown = dict.fromkeys(nothing)
    assert not FOUR.with_link("rocker", **unknown).links["rocker"].has_mass


# -- sliders ---------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("changes", "key", "words"),
    [
        ({"link": "pistn"}, "link", "no link is called 'pistn'; did you mean 'piston'?"),
        ({"link": FRAME}, "link", "no link is called 'frame'"),
        ({"point": "Z"}, "point", "no point of piston is called 'Z'; there are 'C'"),
        ({"on": "cylinder"}, "on", "no link is called 'cylinder'; there are 'frame', 'crank'"),
        ({"through": "B"}, "through", "no point of frame is called 'B'; there are 'A'"),
        ({"on": "piston", "through": "C"}, "on", "'piston' cannot slide on itself"),
    ],
)
def test_sliders(changes: dict[str, str], key: str, words: str) -> None:
    make = lambda: slider_crank(sliders=(PISTON, replace(PISTON, **changes)))  # noqa: E731
    refused(f"sliders[2].{key}", words, make)


# -- gears -----------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("changes", "key", "words"),
    [
        ({"driver": "cranc"}, ".between[1]", "did you mean 'crank'?"),
        ({"driven": "weel"}, ".between[2]", "did you mean 'wheel'?"),
        ({"carrier": "arm"}, ".carrier", "no link is called 'arm'"),
        ({"driven": "crank"}, "", "must be three different bodies"),
        ({"carrier": "crank"}, "", "must be three different bodies"),
        ({"teeth": (20, 30)}, "", "give either ratio or teeth"),
        ({"ratio": None}, "", "give either ratio or teeth"),
        ({"ratio": None, "teeth": (0, 30)}, ".teeth", "got [0, 30]; give two positive numbers"),
        ({"ratio": 0.0}, "", "the ratio is 0; no pair of gears has that"),
        ({"ratio": 1.0}, "", "the ratio is 1; no pair of gears has that"),
        ({"ratio": None, "teeth": (30, 30), "mesh": "internal"}, "", "the ratio is 1;"),
        ({"pressure_angle": pi / 2}, ".pressure_angle", "from 0 deg to less than 90 deg"),
        ({"pressure_angle": -0.1}, ".pressure_angle", "from 0 deg to less than 90 deg"),
    ],
)
def test_gears(changes: dict[str, Any], key: str, words: str) -> None:
    refused(f"gears[1]{key}", words, lambda: two_gears(replace(GEAR, **changes)))


@pytest.mark.parametrize(
    ("mesh", "ratio"), [("external", -0.4), ("internal", 0.4)]
)  # fmt: skip
def test_teeth_tell_the_ratio(mesh: Any, ratio: float) -> None:
    gear = eq.Gear("crank", "wheel", teeth=(20, 50), mesh=mesh)
    assert gear.speed_ratio == pytest.approx(ratio)
    assert gear.exact_ratio is not None
    assert (abs(gear.exact_ratio.numerator), gear.exact_ratio.denominator) == (2, 5)


@pytest.mark.parametrize(("ratio", "exact"), [(-0.47, True), (1 / 3, True), (pi, False)])
def test_ratios_of_whole_numbers_are_recognised(ratio: float, exact: bool) -> None:
    found = eq.Gear("crank", "wheel", ratio=ratio).exact_ratio
    assert (found is not None) == exact
    assert found is None or float(found) == pytest.approx(ratio, rel=1e-13)


# -- loads -----------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("changes", "key", "words"),
    [
        ({"link": "couplr"}, ".link", "did you mean 'coupler'?"),
        ({"link": FRAME}, ".link", "no link is called 'frame'"),
        ({"point": "D"}, ".point", "no point of coupler is called 'D'; there are 'B', 'C'"),
        ({"force": None}, "", "give exactly one of force, torque and table"),
        ({"torque": 1.0}, "", "give exactly one of force, torque and table"),
        ({"table": TABLE}, "", "give exactly one of force, torque and table"),
        ({"point": None}, ".point", "missing; a force acts at a point of the link"),
        ({"force": None, "torque": 1.0}, ".point", "a torque acts on a link, not at a point"),
        ({"force": None, "table": TABLE}, ".point", "a torque acts on a link, not at a point"),
        ({"start": 1.0}, "", "give both from and to, or neither"),
        ({"stop": 1.0}, "", "give both from and to, or neither"),
    ],
)
def test_loads(changes: dict[str, Any], key: str, words: str) -> None:
    load = replace(FORCE, **changes)
    refused(f"loads[1]{key}", words, lambda: replace(FOUR, loads=(load,)))


def test_a_table_of_forces_acts_at_a_point() -> None:
    table = eq.mechanism.LoadTable((0.0,), ((1.0,), (2.0,)))
    words = "missing; a force acts at a point of the link"
    refused("loads[1].point", words, lambda: loaded(eq.Load("coupler", table=table)))


def loaded(load: eq.Load) -> eq.Machine:
    return replace(FOUR, loads=(load,))


@pytest.mark.parametrize(
    ("angles", "values", "words"),
    [
        ((), ((),), "the table has no rows"),
        ((0.0, 0.0), ((1.0, 2.0),), "the crank angles must rise from row to row"),
        ((1.0, 0.5), ((1.0, 2.0),), "the crank angles must rise from row to row"),
        ((0.0, 6.3), ((1.0, 2.0),), "the crank angles cover more than one turn"),
        ((0.0, 1.0), ((1.0,),), "the columns differ in length"),
    ],
)
def test_tables(angles: Any, values: Any, words: str) -> None:
    load = eq.Load("coupler", table=eq.mechanism.LoadTable(angles, values))
    refused("loads[1].table", words, lambda: loaded(load))


# -- assembly and position -------------------------------------------------------------------------


def test_sides_are_words() -> None:
    words = "got 'up'; give 'left', 'right', 'forward' or 'backward'"
    refused("assembly.C", words, lambda: four_bar(1.0, 0.35, 0.9, 0.8, "up"))


def test_positions_are_of_points_and_links() -> None:
    words = "no point is called 'X'"
    off, misspelt = ({"points": {"X": ORIGIN}}, {"angles": {"rokker": 0.0}})
    refused("position.points.X", words,
            lambda: replace(FOUR, position=eq.mechanism.Position(**off)))  # fmt: skip
    refused("position.angles.rokker", "did you mean 'rocker'?",
            lambda: replace(FOUR, position=eq.mechanism.Position(**misspelt)))  # fmt: skip


# -- changing and keeping --------------------------------------------------------------------------


def test_changing_an_unknown_link() -> None:
    words = "no link is called 'roker'; did you mean 'rocker'?"
    refused("links.roker", words, lambda: FOUR.with_link("roker", mass=1.0))


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


def test_machines_travel_between_processes() -> None:
    eq.mechanism.assemble(FOUR)
    again = pickle.loads(pickle.dumps(FOUR))
    assert again == FOUR
    assert "_linkage" not in vars(again)


def test_size_of_a_link() -> None:
    assert size_of({"A": ORIGIN, "B": (3.0, 0.0), "C": (0.0, 4.0)}) == 5.0
    assert size_of({"A": ORIGIN}) == 0.0


@pytest.mark.parametrize(
    ("changes", "where", "words"),
    [
        ({"title": "bell \a"}, "title", "give printable characters"),
        ({"title": "x" * 201}, "title", "201 characters; give at most 200"),
        ({"frame": {f"Q{k}": ORIGIN for k in range(2001)}}, "points", "got 20"),
        ({"loads": (FORCE,) * 501}, "loads", "got 501; at most 500"),
    ],
)
def test_what_no_machine_has(changes: dict[str, Any], where: str, words: str) -> None:
    refused(where, words, lambda: replace(FOUR, **changes))


def test_an_error_knows_its_file() -> None:
    error = ModelError("links", "there is none").in_file("machine.toml")
    assert str(error) == "machine.toml: links: there is none"
    assert str(ModelError("", "broken")) == "broken"


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
    for again in (pickle.loads(pickle.dumps(FOUR)), copy.deepcopy(FOUR)):
        assert again == FOUR
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
        ({"mass": "5"}, "mass", "a number"),
        ({"mass": True}, "mass", "a number"),
        ({"inertia": 10**400}, "inertia", "a number"),
        ({"center_of_mass": (1, 2, 3)}, "center_of_mass", "two numbers"),
        ({"center_of_mass": 1.0}, "center_of_mass", "two numbers"),
        ({"points": ["A"]}, "points", "a mapping of names to two numbers"),
    ],
)
def test_values_of_the_wrong_kind(changes: dict[str, Any], where: str, wanted: str) -> None:
    with pytest.raises(ModelError) as caught:
        replace(FOUR.links["crank"], **changes)
    assert caught.value.where == where
    assert f"give {wanted}" in caught.value.what


def test_a_changed_mass_keeps_the_solved_linkage() -> None:
    eq.move(FOUR)
    heavier, faster = FOUR.with_link("crank", mass=9.0), FOUR.with_drive(speed=3.0)
    for given in (heavier, faster):
        assert "_linkage" in vars(given)
        assert eq.mechanism.assemble(given).machine is given
    longer = FOUR.with_link("crank", points={"A": ORIGIN, "B": (0.3, 0.0)})
    assert "_linkage" not in vars(longer)
    anew = replace(heavier)
    np.testing.assert_array_equal(
        eq.analyze(heavier, 12).forces.drive_torque, eq.analyze(anew, 12).forces.drive_torque
    )


@pytest.mark.parametrize(("start", "stop"), [(1.0, 1.0), (0.0, 13.0)])
def test_windows_of_loads(start: float, stop: float) -> None:
    load = replace(FORCE, start=start, stop=stop)
    refused("loads[1]", "must differ, by one turn at most", lambda: replace(FOUR, loads=(load,)))


def test_joints_of_one_name_are_refused() -> None:
    pinned = slider_crank()
    renamed = replace(
        pinned,
        links={
            name: replace(
                link,
                points={"piston on frame" if p == "B" else p: q for p, q in link.points.items()},
            )
            for name, link in pinned.links.items()
        },
    )
    with pytest.raises(ModelError, match="two joints would be called 'piston on frame'"):
        eq.mechanism.assemble(renamed)
