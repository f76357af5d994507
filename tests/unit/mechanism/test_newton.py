"""Groups that no dyad solves, and dyads solved as such groups: the answers must be the same."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from math import degrees, pi, radians

import numpy as np
import pytest

import equipoise as eq
from equipoise.errors import ChangePointError, EquipoiseError, ModelError, MotionError
from equipoise.mechanism.assembly.linkage import assemble
from equipoise.mechanism.assembly.loops import LoopGroup
from laws.subjects import families_of, is_force, outputs, sizes
from laws.transforms import shifted, turned
from support import refusals
from support.machines import make
from support.refusals import values_of
from unit.mechanism.build import ORIGIN, crank_rocker, four_bar, refused, two_gears

TRIAD = eq.load("class-three")
ANGLES = np.linspace(0.1, 6.2, 18)


# -- dyads solved as loops -------------------------------------------------------------------------


@contextmanager
def only_loops() -> Iterator[None]:
    """Let Newton's method solve every group."""
    with pytest.MonkeyPatch.context() as patch:
        for solver in ("_dyad_of", "_coupled"):
            patch.setattr(f"equipoise.mechanism.assembly.groups.{solver}", lambda *_: None)
        yield


def with_position(given: eq.Machine, angle: float = 0.0, off: float = 0.01) -> eq.Machine:
    """Tell roughly where the machine is, instead of the sides of its dyads."""
    motion = eq.move(given, [angle])
    size = max(abs(complex(*place)) for link in given.links.values()
               for place in link.points.values())  # fmt: skip
    rng = np.random.default_rng(2)
    noise = rng.normal(size=2) * off * size
    points = {
        name: (float(point.x[0] + noise[0]), float(point.y[0] + noise[1]))
        for name, point in motion.points.items()
        if name not in given.frame
    }
    angles = {name: float(link.angle[0]) + off for name, link in motion.links.items()}
    return replace(given, assembly={}, position=eq.mechanism.Position(angle, points, angles))


DYADS = [
    "yamashita-1", "drag-link", "slider-crank-engine", "quick-return", "scotch-yoke",
    "watt-six-bar", "stephenson-six-bar", "geared-counterweight", "planetary-planting-arm",
]  # fmt: skip
KINDS = ["crossed_guides", "slider_on_rocker", "guide_on_dyad", "swinging_block", "floating_watt",
         "slider_beside_pin", "geared_coupler", "sun_and_planet", "geared_five_bar",
         "planetary_arm", "geared_counterweight", "rolling_coupler"]  # fmt: skip


def subject(name: str) -> eq.Machine:
    return make(name, 3).machine if name in KINDS else eq.load(name)


@pytest.mark.parametrize("name", [*DYADS, *KINDS])
def test_loops_give_what_dyads_give(name: str) -> None:
    given = subject(name)
    by_dyads = eq.analyze(given, ANGLES).forces
    rough = with_position(given)
    with only_loops():
        by_loops = eq.analyze(rough, ANGLES).forces
    groups = by_loops.motion.linkage.groups
    assert all(any(isinstance(step, LoopGroup) for step in group.motion) for group in groups)
    compare(by_loops, by_dyads)


def compare(by_loops: eq.mechanism.Forces, by_dyads: eq.mechanism.Forces) -> None:
    """Compare motion and every output."""
    force, moment = sizes(by_dyads)
    for name, point in by_dyads.motion.points.items():
        got = by_loops.motion.points[name]
        for part in ("place", "place_1", "place_2"):
            want = getattr(point, part)
            scale = max(1e-3, float(np.max(np.abs(want))))
            np.testing.assert_allclose(getattr(got, part), want, rtol=0, atol=1e-10 * scale)
    want = dict(outputs(by_dyads))
    assert dict(outputs(by_loops)).keys() == want.keys()
    for name, value in outputs(by_loops):
        if other_hub(name, by_loops, by_dyads):
            continue
        scale = force if is_force(name) else moment
        np.testing.assert_allclose(value, want[name], rtol=0, atol=1e-9 * scale, err_msg=name)


def other_hub(name: str, item: eq.mechanism.Forces, other: eq.mechanism.Forces) -> bool:
    """Tell whether a joint belongs to a pin of three bodies that another of them holds."""
    family, _, rest = name.partition("/")
    pin = rest.partition("/")[0]
    return family == "joints" and any(
        joint.by != other.joints[key].by
        for key, joint in item.joints.items()
        if key.partition("/")[0] == pin
    )


@pytest.mark.parametrize("angle", [-3.0, 0.5, 40.0])
def test_the_position_may_be_at_any_crank_angle(angle: float) -> None:
    by_dyads = eq.analyze(crank_rocker(), ANGLES).forces
    rough = with_position(crank_rocker(), angle)
    with only_loops():
        compare(eq.analyze(rough, ANGLES).forces, by_dyads)


# -- the triad -------------------------------------------------------------------------------------


def test_all_joints_stay_together() -> None:
    motion = eq.move(TRIAD, 90)
    for name, link in motion.machine.links.items():
        origin, turn = link_axes(motion, name)
        for point, local in link.points.items():
            place = origin + turn * complex(*local)
            np.testing.assert_allclose(motion.points[point].place, place, atol=1e-13)


def link_axes(motion: eq.mechanism.Motion, name: str) -> tuple[np.ndarray, np.ndarray]:
    """Origin of a link's axes, told by its first point, and its rotation."""
    point, local = next(iter(motion.machine.links[name].points.items()))
    turn = np.exp(1j * motion.links[name].angle)
    return motion.points[point].place - turn * complex(*local), turn


def test_angles_in_any_order_lie_on_one_branch() -> None:
    whole = eq.move(TRIAD, 360)
    picked = np.random.default_rng(3).permutation(360)[:25]
    again = eq.move(TRIAD, whole.crank_angle[picked] + 4 * pi)
    for name, point in whole.points.items():
        want = point.place[picked]
        np.testing.assert_allclose(again.points[name].place, want, rtol=0, atol=1e-13)


@pytest.mark.exhaustive(but=["strides1"])
@pytest.mark.parametrize("strides", [(), (np.radians(6),)])
def test_wide_steps_lead_where_narrow_ones_do(
    strides: tuple[float, ...], monkeypatch: pytest.MonkeyPatch
) -> None:
    wide = eq.move(eq.load("class-three"), 48)
    monkeypatch.setattr("equipoise.mechanism.assembly.loops.STRIDES", strides)
    narrow = eq.move(eq.load("class-three"), 48)
    for name, point in wide.points.items():
        for part in ("place", "place_1", "place_2"):
            want = getattr(narrow.points[name], part)
            np.testing.assert_allclose(getattr(point, part), want, rtol=0, atol=1e-12)


@pytest.mark.parametrize("apart", [0.0, 2 * pi])
def test_a_machine_near_another_is_solved_at_all_angles_together(
    apart: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Or step by step, where that leads to another branch: to angles in another turn."""
    other = replace(TRIAD.links["crank"], points={"A": (0.0, 0.0), "B": (0.0402, 0.0)})
    anew = replace(TRIAD, links={**TRIAD.links, "crank": other})
    want = eq.move(replace(anew), 360)
    cycle = assemble(TRIAD).cycle
    tables = {name: table + apart for name, table in cycle.tables.items()}
    steps, each = [], LoopGroup.follow_each
    monkeypatch.setattr(LoopGroup, "follow_each", lambda *a: steps.append(1) or each(*a))
    assemble(anew, guess=replace(cycle, tables=tables))
    got = eq.move(anew, 360)
    assert bool(steps) == bool(apart)
    for name, point in want.points.items():
        np.testing.assert_allclose(got.points[name].place, point.place, rtol=0, atol=1e-12)


def test_few_crank_angles_are_solved_by_themselves(monkeypatch: pytest.MonkeyPatch) -> None:
    """The way round takes a post every 30 degrees, and all between at once."""
    sizes = []
    solve = LoopGroup.solve

    def counted(self: LoopGroup, guess: np.ndarray, *given: object) -> np.ndarray:
        solution = solve(self, guess, *given)  # type: ignore[arg-type]
        sizes.append(solution.size)
        return solution

    monkeypatch.setattr(LoopGroup, "solve", counted)
    eq.move(eq.load("class-three"), 360)
    assert len(sizes) < 20
    assert max(sizes) == 4 * 721


def places_of(motion: eq.mechanism.Motion, names: str) -> dict[str, tuple[float, float]]:
    points = {name: motion.points[name] for name in names}
    return {name: (float(point.x[0]), float(point.y[0])) for name, point in points.items()}


@pytest.mark.parametrize("angle", [0.3, -2.0, 3.0])
def test_the_triad_may_be_given_at_another_angle(angle: float) -> None:
    points = places_of(eq.move(TRIAD, [angle]), "BCPQ")
    moved = replace(TRIAD, position=eq.mechanism.Position(angle, points))
    np.testing.assert_allclose(
        eq.move(moved, 24).points["Q"].place, eq.move(TRIAD, 24).points["Q"].place, atol=1e-13
    )


def test_the_position_may_be_given_by_angles() -> None:
    at_zero = eq.move(TRIAD, [0.0])
    points = places_of(at_zero, "PQ")
    angles = {name: float(at_zero.links[name].angle[0]) for name in TRIAD.links}
    text = replace(TRIAD, position=eq.mechanism.Position(0.0, points, angles))
    np.testing.assert_allclose(
        eq.move(text, 24).points["Q"].place, eq.move(TRIAD, 24).points["Q"].place, atol=1e-13
    )


@pytest.mark.parametrize("size", [1e-3, 1.0, 1e3])
def test_size_does_not_matter(size: float) -> None:
    def grown(points: object) -> dict[str, tuple[float, float]]:
        return {k: (x * size, y * size) for k, (x, y) in points.items()}  # type: ignore[attr-defined]

    assert TRIAD.position is not None
    big = replace(
        TRIAD,
        frame=grown(TRIAD.frame),
        links={name: eq.Link(grown(link.points)) for name, link in TRIAD.links.items()},
        position=replace(TRIAD.position, points=grown(TRIAD.position.points)),
    )
    want = eq.move(TRIAD, 60).points["Q"].place * size
    np.testing.assert_allclose(eq.move(big, 60).points["Q"].place, want, atol=1e-12 * size)


def test_far_from_the_origin() -> None:
    moved = shifted(turned(TRIAD, 1.0), 50 - 80j)
    forces = eq.analyze(moved, np.array([1.0, 2.0])).forces
    plain = eq.analyze(TRIAD, np.array([0.0, 1.0])).forces
    np.testing.assert_allclose(forces.drive_torque, plain.drive_torque, rtol=1e-9)


# -- what is refused -------------------------------------------------------------------------------


def test_position_missing() -> None:
    expected = {"names": "rod, plate, front-link, rear-link"}
    refused("position", expected, lambda: eq.mechanism.assemble(replace(TRIAD, position=None)))


@pytest.mark.parametrize(
    ("missing", "link"), [("C", "rod"), ("P", "front-link"), ("Q", "rear-link")]
)
def test_position_incomplete(missing: str, link: str) -> None:
    assert TRIAD.position is not None
    points = {name: place for name, place in TRIAD.position.points.items() if name != missing}
    with refusals.refused(ModelError, "position", link=link, crank_angle=0.0):
        eq.mechanism.assemble(replace(TRIAD, position=eq.mechanism.Position(0.0, points)))


def test_a_triad_that_never_closes() -> None:
    """A front link of 1 m among links of 0.1 m."""
    given = TRIAD.with_link("front-link", points={"D": ORIGIN, "P": (1.0, 0.0)})
    with refusals.refused(MotionError, angle=0.0, links="rod, plate, front-link, rear-link"):
        eq.move(given, 36)


def stuck() -> eq.Machine:
    """The triad with a crank so long that it cannot turn."""
    points = {"A": ORIGIN, "B": (0.1, 0.0)}
    place = {"C": (0.192, -0.051), "P": (0.155, -0.015), "Q": (0.095, -0.068)}
    return replace(TRIAD, position=eq.mechanism.Position(0.0, place)).with_link(
        "crank", points=points
    )


def test_a_position_far_from_any_solution() -> None:
    """Newton's method may land in another assembly; that must not pass unseen."""
    points = {"C": (0.3, -0.2), "P": (0.1, 0.2), "Q": (-0.2, 0.1)}
    with pytest.raises(EquipoiseError) as caught:
        eq.mechanism.assemble(replace(TRIAD, position=eq.mechanism.Position(0.0, points)))
    assert "too rough" in str(caught.value) or "no solution nearby" in str(caught.value)


def test_angles_start_within_half_a_turn() -> None:
    motion = eq.move(eq.load("class-three"), [0.0])
    assert all(abs(link.angle[0]) <= pi for link in motion.links.values())


# The angle: the test below.
@pytest.mark.exhaustive
def test_a_triad_that_cannot_turn_reports_the_angle() -> None:
    with refusals.refused(MotionError, low="-140.91 deg", high="77.66 deg"):
        eq.move(stuck(), 36)


def test_the_angle_reported_is_where_it_ends() -> None:
    """A four-bar that only swings, as a loop group: its end is known in closed form."""
    limit = np.arccos((1 + 0.9**2 - 1.05**2) / 1.8)
    rough = with_position(four_bar(1.0, 0.9, 0.5, 0.55))
    with (
        only_loops(),
        refusals.refused(MotionError, last="'rocker'", first="'coupler'") as caught,
    ):
        eq.move(rough, 36)
    values = dict(values_of(caught.value.note))
    low, high = (float(values[name].removesuffix(" deg")) for name in ("low", "high"))
    assert (low, high) == pytest.approx((-degrees(limit), degrees(limit)), abs=0.01)


def geared_loop(gear: eq.Gear, at: float = 0.0) -> eq.Machine:
    place = eq.mechanism.Position(at, {"E": (0.5, 0.0)}, {"wheel": 0.0})
    return two_gears(gear, position=place)


def test_gears_need_the_position_at_0() -> None:
    given = geared_loop(eq.Gear("crank", "wheel", ratio=-1.0), at=0.2)
    with only_loops(), pytest.raises(ModelError) as caught:
        eq.mechanism.assemble(given)
    assert caught.value.where == "position.crank_angle"


def test_a_loop_that_closes_after_several_turns() -> None:
    with only_loops():
        motion = eq.move(geared_loop(eq.Gear("crank", "wheel", teeth=(20, 30))), 12)
    assert motion.turns == 3
    assert motion.linkage.cycle.windings["wheel"] == -2


def test_a_loop_that_never_closes() -> None:
    with only_loops(), refusals.refused(MotionError, tried="6"):
        eq.move(geared_loop(eq.Gear("crank", "wheel", ratio=-pi)), 12)


def test_the_driver_comes_first() -> None:
    """A gear pair whose `driven` gear is the one that moves already."""
    given = two_gears(eq.Gear("wheel", "crank", ratio=-1.0))
    refused("gears[1]", {}, lambda: eq.mechanism.assemble(given))


def test_split_and_regressor_go_through_loops() -> None:
    forces = eq.analyze(TRIAD, ANGLES).forces
    force, _ = sizes(forces)
    rows = dict(families_of(eq.mechanism.regressor(forces.motion)))
    values = eq.mechanism.regressor(forces.motion).values
    for name, joint in forces.joints.items():
        got = values @ rows[f"joints/{name}/value"]
        np.testing.assert_allclose(got, joint.value, rtol=0, atol=1e-12 * force)


@pytest.mark.exhaustive(but=["0.7"])
@pytest.mark.parametrize("lean", [0.7, radians(0.25)])
def test_a_bifurcation_is_called_one(lean: float) -> None:
    """A four-bar of equal opposite sides: where it lies in line it goes on parallel or crossed."""
    place = (float(np.cos(lean)), float(np.sin(lean)))
    given = four_bar(1.0, 0.3, 1.0, 0.3, "right")
    rough = with_position(replace(given, frame={**given.frame, "D": place}))
    with (
        only_loops(),
        refusals.refused(ChangePointError, last="'rocker'", first="'coupler'") as caught,
    ):
        eq.move(rough, 36)
    at = caught.value.crank_angle
    assert abs(np.sin(at - lean)) < radians(0.5)  # a step of the grid
