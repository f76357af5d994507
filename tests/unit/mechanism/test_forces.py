"""Names, places and parts of forces; loads; what is missing and what is worth a second look."""

from __future__ import annotations

from dataclasses import replace
from math import pi, radians
from typing import Any, Literal

import numpy as np
import pytest

import equipoise as eq
from equipoise.errors import MassError, ModelError, UsageError
from equipoise.i18n import Note
from equipoise.mechanism.dynamics.loads import load_at, work_in_cycle
from equipoise.mechanism.parts.laws import AngleLaw, AngleSegment
from equipoise.mechanism.parts.machine import FRAME
from equipoise.results.remarks import linkage_remarks
from laws.transforms import renamed
from support.refusals import refused
from unit.mechanism.build import ORIGIN, crank_rocker, four_bar, heavy, machine, slider_crank

THETA = np.array([0.3, 1.9, 4.0])


def forces(given: eq.Machine, **more: Any) -> eq.mechanism.Forces:
    return eq.analyze(given, THETA, **more).forces


# -- missing masses --------------------------------------------------------------------------------


def test_missing_masses_are_named() -> None:
    given = crank_rocker()
    for name in ("coupler", "rocker"):
        given = given.with_link(name, mass=None, center_of_mass=None, inertia=None)
    analysis = eq.analyze(given, 4)
    assert analysis.solved is None
    with refused(MassError, links="coupler, rocker"):
        _ = analysis.forces
    with pytest.raises(MassError):
        eq.forces(analysis.motion)
    assert list(analysis.motion.mass_centers) == ["crank"]


def test_links_of_mass_0_are_neglected() -> None:
    given = crank_rocker()
    for name in given.links:
        given = given.with_link(name, mass=0.0, center_of_mass=ORIGIN, inertia=0.0)
    result = forces(given)
    assert not np.any(result.drive_torque)
    assert not np.any(result.frame_force.size)


# -- names and places ------------------------------------------------------------------------------


def test_joints_are_named_by_point_and_slider() -> None:
    assert list(forces(slider_crank()).joints) == ["A", "B", "piston on frame", "C"]


def test_pins_of_three_bodies_are_named_by_the_link_held() -> None:
    given = machine(
        {"A": ORIGIN, "D": (1.0, 0.0), "G": (0.5, 1.0)},
        {
            "crank": heavy(A=ORIGIN, B=(0.3, 0.0)),
            "coupler": heavy(B=ORIGIN, C=(0.9, 0.0)),
            "rocker": heavy(D=ORIGIN, C=(0.8, 0.0)),
            "arm": heavy(C=ORIGIN, F=(0.9, 0.0)),
            "lever": heavy(G=ORIGIN, F=(0.8, 0.0)),
        },
        assembly={"C": "left", "F": "left"},
    )
    joints = forces(given).joints
    assert {name for name in joints if name.startswith("C")} == {"C/rocker", "C/arm"}
    assert {joints["C/rocker"].by, joints["C/arm"].by} == {"coupler"}


@pytest.mark.parametrize("about", ["A", (0.0, 0.0), 0j, None])
def test_ways_to_name_a_pole(about: Any) -> None:
    result = forces(crank_rocker(), about=about)
    assert result.about == 0j
    np.testing.assert_array_equal(result.shaking_moment, forces(crank_rocker()).shaking_moment)


def test_poles_elsewhere() -> None:
    result = forces(crank_rocker(), about="D")
    assert result.about == 1 + 0j
    np.testing.assert_allclose(
        result.shaking_moment, forces(crank_rocker()).shaking_moment_about("D")
    )


@pytest.mark.parametrize(
    ("about", "expected"),
    [
        ("B", {"given": "B"}),
        ((float("nan"), 0.0), {"point": "(nan, 0.0)"}),
    ],
)
def test_poles_that_cannot_be_used(about: Any, expected: dict[str, Any]) -> None:
    with refused(UsageError, **expected):
        forces(crank_rocker(), about=about)


def test_unknown_names_report_what_there_is() -> None:
    result = forces(crank_rocker())
    with refused(UsageError, name="drive_torque"):
        result.split.by_cause("drive_torqe")
    with pytest.raises(KeyError, match="no link is called 'croupier'"):
        result.motion.links["croupier"]
    with pytest.raises(KeyError, match="no point is called 'X'"):
        result.motion.points["X"]


def test_a_joint_that_is_called_like_an_output() -> None:
    given = renamed(crank_rocker(), lambda name: "drive_torque" if name == "B" else name)
    result = forces(given)
    parts = result.split.by_cause("drive_torque")
    np.testing.assert_allclose(sum(parts.values()), result.drive_torque, atol=1e-12)


def test_vectors_have_size_and_direction() -> None:
    force = forces(crank_rocker()).shaking_force
    np.testing.assert_allclose(force.size * np.exp(1j * force.direction), force.value)
    np.testing.assert_allclose(force.x + 1j * force.y, force.value)


def test_weight_is_the_same_everywhere() -> None:
    result = forces(crank_rocker())
    np.testing.assert_allclose(result.weight.value, -1.5j * 9.80665)
    arms = sum(0.5 * center.x for center in result.motion.mass_centers.values())
    np.testing.assert_allclose(result.weight_moment, -9.80665 * arms)


def test_slider_forces_are_split_by_the_line() -> None:
    result = forces(slider_crank(sliders=(eq.Slider("piston", "C", FRAME, "A", 1.1),)))
    rail = result.joints["piston on frame"]
    along = np.exp(1.1j)
    np.testing.assert_allclose((rail.value / along).imag, rail.normal)  # type: ignore[attr-defined]
    np.testing.assert_allclose((rail.value / along).real, 0, atol=1e-12)


# -- loads -----------------------------------------------------------------------------------------

CIRCLE = np.radians(np.arange(0, 360, 5))


def torque_of(load: eq.Load) -> np.ndarray:
    """Drive torque that a load on a massless crank asks for."""
    given = machine({"A": ORIGIN}, {"crank": eq.Link({"A": ORIGIN}, 0.0, ORIGIN, 0.0)})
    return -eq.analyze(replace(given, loads=(load,)), CIRCLE).forces.drive_torque


@pytest.mark.parametrize(("start", "stop"), [(30, 100), (300, 40), (-60, 40), (350, 355)])
def test_windows(start: float, stop: float) -> None:
    load = eq.Load("crank", torque=3.0, start=np.radians(start), stop=np.radians(stop))
    degrees = np.arange(0, 360, 5)
    inside = (degrees - start) % 360 < (stop - start) % 360
    np.testing.assert_allclose(torque_of(load), np.where(inside, 3.0, 0.0))


def test_tables_are_closed_polygons() -> None:
    table = eq.mechanism.LoadTable((pi / 2, pi), ((2.0, 6.0),))
    want = np.interp(CIRCLE, [-pi, pi / 2, pi, 5 * pi / 2], [6.0, 2.0, 6.0, 2.0])
    np.testing.assert_allclose(torque_of(eq.Load("crank", table=table, outside="wrap")), want)


def test_tables_may_begin_before_0() -> None:
    first = eq.mechanism.LoadTable((-1.0, 1.0, 2.0), ((1.0, 5.0, -3.0),))
    other = eq.mechanism.LoadTable((1.0, 2.0, 2 * pi - 1.0), ((5.0, -3.0, 1.0),))
    both = [torque_of(eq.Load("crank", table=t, outside="wrap")) for t in (first, other)]
    np.testing.assert_allclose(*both)


def test_tables_in_a_window() -> None:
    table = eq.mechanism.LoadTable((0.0,), ((4.0,),))
    load = eq.Load("crank", table=table, outside="hold", start=1.0, stop=2.0)
    np.testing.assert_allclose(torque_of(load), np.where((CIRCLE >= 1) & (CIRCLE < 2), 4.0, 0.0))


@pytest.mark.parametrize(("start", "stop", "is_reported"), [(5, 175, True), (-350, -300, True),
                                                    (5, 181, False), (0, 20, False)])  # fmt: skip
def test_a_window_within_the_rows_of_a_table_reports_all(
    start: int, stop: int, is_reported: bool
) -> None:
    rows = eq.mechanism.LoadTable(tuple(np.radians((5.0, 90.0, 180.0))), ((4.0, 7.0, 4.0),))
    load = eq.Load("coupler", table=rows, start=radians(start), stop=radians(stop))
    if is_reported:
        assert replace(crank_rocker(), loads=(load,)).loads == (load,)
    else:
        with refused(ModelError, "loads[1].outside", high="180 deg", low="5 deg"):
            replace(crank_rocker(), loads=(load,))


def test_loads_go_on_in_every_turn() -> None:
    load = eq.Load("crank", torque=3.0, start=0.5, stop=1.5)
    given = replace(crank_rocker(), loads=(load,))
    first, later = (eq.analyze(given, THETA + 2 * pi * k).forces.drive_torque for k in (0, 7))
    np.testing.assert_allclose(first, later, atol=1e-11)


def test_force_at_a_point_of_the_crank() -> None:
    given = machine(
        {"A": ORIGIN}, {"crank": eq.Link({"A": ORIGIN, "P": (0.0, 2.0)}, 0.0, ORIGIN, 0)}
    )
    load = eq.Load("crank", "P", force=(1.0, 0.0))
    actual = eq.analyze(replace(given, loads=(load,)), CIRCLE).forces
    np.testing.assert_allclose(actual.drive_torque, 2 * np.cos(CIRCLE), atol=1e-14)
    np.testing.assert_allclose(actual.frame_force.value, 1.0)


# -- remarks ---------------------------------------------------------------------------------------


def remarked(given: eq.Machine) -> list[str]:
    return list(linkage_remarks(eq.mechanism.assemble(given)))


def test_a_good_machine_gives_no_remark() -> None:
    assert remarked(crank_rocker()) == []


@pytest.mark.parametrize(
    ("given", "words"),
    [
        (four_bar(1.0, 0.35, 0.7, 0.66), "within 13.9 deg of its dead position, at crank angle"),
        (crank_rocker().with_link("rocker", inertia=5e4), "links.rocker.inertia gives a radius of"),
        (crank_rocker().with_link("rocker", center_of_mass=(40.0, 0.0)),
         "links.rocker.center_of_mass lies far outside the link; check its unit"),
        (replace(crank_rocker(), frame={"A": ORIGIN, "D": (1.0, 0.0), "Z": (2.0, 2.0)}),
         "frame.points.Z is not used by any joint or spring"),
        (crank_rocker().with_link("rocker", mass=None, center_of_mass=None, inertia=None),
         "missing for rocker"),
    ],
)  # fmt: skip
def test_remarks(given: eq.Machine, words: str) -> None:
    result = remarked(given)
    assert len(result) == 1
    assert words in result[0]


@pytest.mark.parametrize(
    ("slip", "noted"), [(1e-3, True), (1e-6, True), (1.0, False), (0.0, False), (1e4, True)]
)
def test_a_slip_of_units_of_an_inertia(slip: float, noted: bool) -> None:
    """A factor of a thousand, either way; nothing at all is meant."""
    bar = 0.5 * 0.8**2 / 12
    result = remarked(crank_rocker().with_link("rocker", inertia=slip * bar))
    assert bool(result) == noted
    assert all("links.rocker.inertia gives a radius of gyration of" in item for item in result)


def upright(direction: float, angle: float = 0.0, **points: tuple[float, float]) -> eq.Machine:
    guide = eq.Slider("piston", "C", "frame", "A", radians(direction), radians(angle))
    piston = eq.Link({"C": (0.1, 0.2), **points}, 0.5, (0.4, 0.2), 2e-3)
    given = slider_crank(sliders=(guide,))
    return replace(given, links={**given.links, "piston": piston})


def test_axes_that_a_slider_turns_are_noted() -> None:
    """With the angle that the note gives, they are those of the frame."""
    (note,) = remarked(upright(90.0, E=(0.1, 0.9)))
    assert isinstance(note, Note)
    assert {"place": "sliders[1]", "link": "piston", "turn": "90", "further": "E"}.items() <= (
        note.values.items()
    )
    given = float(note.values["back"])
    for angle, turn in ((0.0, 90.0), (given, 0.0)):
        motion = eq.move(upright(90.0, angle, E=(0.1, 0.9)), 4)
        np.testing.assert_allclose(
            np.exp(1j * motion.links["piston"].angle), np.exp(1j * radians(turn)), atol=1e-12
        )


def test_axes_that_a_slider_does_not_turn_are_not_noted() -> None:
    off_line = upright(90.0).with_link("piston", center_of_mass=(0.1, 0.3))
    (note,) = remarked(off_line)
    assert isinstance(note, Note) and note.values["further"] == "center_of_mass"
    for given in (upright(0.0, E=(0.3, 0.9)), upright(90.0), upright(90.0, -90.0, E=(0.3, 0.9))):
        assert remarked(given) == []


# -- load tables -----------------------------------------------------------------------------------


Outside = Literal["zero", "hold", "wrap"]


def table(
    degrees_: tuple[float, ...], torques: tuple[float, ...], outside: Outside | None = "wrap"
) -> eq.Load:
    angles = tuple(float(np.radians(d)) for d in degrees_)
    return eq.Load("coupler", table=eq.mechanism.LoadTable(angles, (torques,)), outside=outside)


@pytest.mark.parametrize(
    ("given", "at", "torque"),
    [
        (table((0, 180, 360), (1.0, 2.0, 1.0), None), (0, 90, 270, 360), (1.0, 1.5, 1.5, 1.0)),
        (table((0, 180, 720), (1.0, 2.0, 1.0), None), (0, 90, 450, 810), (1.0, 1.5, 1.5, 1.5)),
        (table((0, 180), (1.0, 2.0), "hold"), (0, 180, 270, 359), (1.0, 2.0, 2.0, 2.0)),
        (table((0, 180), (1.0, 2.0), "zero"), (0, 180, 180.1, 359), (1.0, 2.0, 0.0, 0.0)),
        (table((90, 180), (1.0, 2.0), "hold"), (90, 270, 450, 0), (1.0, 2.0, 1.0, 2.0)),
        (table((0, 180), (1.0, 2.0)), (90, 270, 359.999), (1.5, 1.5, 1.0)),
        (table((-90, 90), (1.0, 3.0)), (-90, 0, 90, 180, 270), (1.0, 2.0, 3.0, 2.0, 1.0)),
        (table((45,), (4.0,)), (0, 45, 200), (4.0, 4.0, 4.0)),
    ],
)
def test_tables_between_their_rows(
    given: eq.Load, at: tuple[float, ...], torque: tuple[float, ...]
) -> None:
    result = load_at(given, np.radians(at))[1]
    np.testing.assert_allclose(result, torque, atol=1e-4)


# -- work ------------------------------------------------------------------------------------------

ROWS = ((30, 100, 250), (3.0, -1.0, 4.0))
AREA = radians(70) * 1.0 + radians(150) * 1.5
"""Under the rows, N m: two trapezoids."""


@pytest.mark.parametrize(
    ("outside", "rest"), [("zero", 0.0), ("hold", radians(140) * 4.0), ("wrap", radians(140) * 3.5)]
)
@pytest.mark.parametrize("speed", [3.0, -3.0])
def test_the_work_of_a_torque_is_the_area_under_its_table(
    outside: Outside, rest: float, speed: float
) -> None:
    given = machine({"A": ORIGIN}, {"crank": eq.Link({"A": ORIGIN}, 0.0, ORIGIN, 0.0)})
    load = replace(table(*ROWS, outside), link="crank")
    given = replace(given, loads=(load,)).with_drive(speed=speed)
    work, _, largest = work_in_cycle(given, load)
    assert work == pytest.approx((AREA + rest) * np.sign(speed), rel=1e-12)
    assert largest == pytest.approx(4.0)
    # what the drive does in the same cycle, from samples of power between the jumps
    torque = eq.analyze(given, (np.arange(3600) + 0.5) * (2 * pi / 3600)).forces.drive_torque
    assert np.mean(torque) * 2 * pi * np.sign(speed) == pytest.approx(-work, rel=1e-6)


@pytest.mark.parametrize("outside", ["zero", "hold", "wrap"])
def test_what_loads_do_in_a_cycle_is_what_the_drive_does(outside: Outside) -> None:
    """Weights and inertia give back what they take."""
    angles = tuple(np.radians((40.0, 100.0, 200.0)))
    forces_ = eq.mechanism.LoadTable(angles, ((3.0, -9.0, 4.0), (1.0, 5.0, -2.0)))
    loads = (
        eq.Load("coupler", "C", table=forces_, outside=outside),
        eq.Load("rocker", torque=2.0, start=1.0, stop=2.5),
        table(*ROWS, outside),
    )
    given = replace(crank_rocker(), loads=loads)
    work = sum(work_in_cycle(given, load)[0] for load in loads)
    samples = (np.arange(36_000) + 0.5) * (2 * pi / 36_000)
    torque = eq.analyze(given, samples).forces.drive_torque
    assert abs(work) > 0.1
    assert np.mean(torque) * 2 * pi == pytest.approx(-work, abs=2e-3)


def test_a_steady_load_does_no_work_where_accelerations_jump() -> None:
    """Nor a trace of it, whatever falls between the crank angles at which it is summed."""
    ways = ((2.0, 1.0), (1.5, 1.0), (2 * pi - 3.5, 0.0))
    swing = AngleLaw(segments=[AngleSegment(over, to, "trapezoid") for over, to in ways])
    load = eq.Load("rocker", "C", force=(3.0, -9.0))
    given = replace(crank_rocker(), loads=(load,)).with_drive(motion=swing)
    work = work_in_cycle(given, load)
    assert abs(work.net) < 1e-13 * work.both


def test_a_load_of_two_turns_makes_a_cycle_of_two() -> None:
    """Of four strokes one works; half orders appear, and so does all of the work in two turns."""
    stroke = table((0, 180, 360, 540, 720), (0.0, 5.0, 0.0, 0.0, 0.0), None)
    once = replace(crank_rocker(), loads=(replace(stroke, link="crank"),))
    analysis = eq.analyze(once, 720)
    assert analysis.motion.turns == 2
    plain = eq.analyze(replace(once, loads=()), 720)
    first, second = analysis.forces.drive_torque.reshape(2, -1) - plain.forces.drive_torque
    assert np.max(np.abs(first)) == pytest.approx(5.0)
    np.testing.assert_allclose(second, 0.0, atol=1e-12)
    assert work_in_cycle(once, once.loads[0])[0] == pytest.approx(5.0 * pi)
    assert np.mean(analysis.forces.drive_torque) * 4 * pi == pytest.approx(-5.0 * pi, rel=1e-4)
    three = replace(stroke, table=eq.mechanism.LoadTable((0.0, 6 * pi), ((1.0, 1.0),)))
    both = replace(once, loads=(*once.loads, three))
    assert eq.mechanism.assemble(both).cycle.turns == 6


def test_a_slip_of_units_is_said_in_a_unit_that_can_be_read() -> None:
    """46.73 m, where it was 4.673e+04 mm."""
    (note,) = remarked(eq.load("yamashita-1").with_link("coupler", inertia=1500.0))
    assert "a radius of gyration of 46.73 m, for a link of 234.9 mm" in note
    assert "e+" not in note
