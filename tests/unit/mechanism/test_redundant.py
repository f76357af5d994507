"""Joints that hold more than the motion needs, and parallel linkages at their change points."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import equipoise as eq
from equipoise.errors import EquipoiseError, MobilityError, ModelError, UsageError
from equipoise.exchange import mjcf, modelica
from equipoise.exchange.formats import Job
from equipoise.mechanism.assembly.linkage import assemble
from equipoise.mechanism.assembly.redundant_reactions import IDLE
from equipoise.mechanism.dynamics.out_of_plane import exerted_in
from equipoise.mechanism.dynamics.reactions import idle_teeth_notes, indeterminate_reactions
from equipoise.mechanism.parts.joint_properties import JointProperties
from equipoise.mechanism.parts.machine import FRAME, FurtherDrive, Link, Slider, Vector
from support.chosen import few
from support.machines import make
from support.machines_redundant import REDUNDANT
from support.refusals import refused
from unit.mechanism.build import ORIGIN, four_bar, heavy, machine

CRANK, PIVOTS = 0.1, ((0.0, 0.0), (1.0, 0.0), (0.4, 0.3))
LINE = ((0.0, 0.0), (1.0, 0.0), (2.0, 0.0))


def cranks(pivots: tuple[Vector, ...] = PIVOTS, last: float = CRANK, **more: Any) -> eq.Machine:
    """Equal cranks that carry a body, of which the last may have another length."""
    frame = {f"A{k}": place for k, place in enumerate(pivots)}
    links = {
        f"crank{k}": heavy(**{f"A{k}": ORIGIN, f"B{k}": (CRANK, 0.0)}) for k in range(len(pivots))
    }
    final = len(pivots) - 1
    links[f"crank{final}"] = heavy(**{f"A{final}": ORIGIN, f"B{final}": (last, 0.0)})
    links["body"] = heavy(**{f"B{k}": place for k, place in enumerate(pivots)})
    return machine(frame, links, drive=eq.Drive("crank0", 10.0), **more)


def parallel(mode: str | None = "parallel") -> eq.Machine:
    """Two cranks: a parallelogram without any joint too many."""
    return cranks(PIVOTS[:2], assembly={} if mode is None else {"mode": mode})


def guided(offset: float = 0.0, turn: float = 0.0) -> eq.Machine:
    """A block that a crank and a rod push between two guides."""
    return machine(
        {"A": ORIGIN, "G": (0.0, -0.1), "H": (0.0, 0.1 + offset)},
        {
            "crank": heavy(A=ORIGIN, B=(0.2, 0.0)),
            "rod": heavy(B=ORIGIN, C=(1.0, 0.0)),
            "block": heavy(C=ORIGIN, U=(0.0, -0.1), V=(0.0, 0.1)),
        },
        sliders=(
            Slider("block", "U", FRAME, "G", 0.0),
            Slider("block", "V", FRAME, "H", turn, -turn, label="upper"),
        ),
        assembly={"C": "forward"},
    )


def refusal_of(given: eq.Machine) -> str:
    with pytest.raises(EquipoiseError) as caught:
        eq.analyze(given)
    return str(caught.value)


# -- motion ----------------------------------------------------------------------------------------


def test_a_body_on_three_cranks_goes_round_without_turning() -> None:
    motion = eq.move(cranks())
    np.testing.assert_allclose(motion.links["body"].angle, 0.0, atol=1e-14)
    for k in range(3):
        link = motion.links[f"crank{k}"]
        np.testing.assert_allclose(link.angle, motion.crank_angle, atol=1e-13)
        np.testing.assert_allclose([link.angle_1 - 1, link.angle_2], 0.0, atol=1e-13)


def test_further_cranks_wait_for_the_body_that_a_rod_pushes() -> None:
    """By count the body on three hangers alone would stand still: the third decides nothing."""
    three = cranks(((0.0, 0.0), (1.0, 0.0), (0.4, 0.3)))
    links = {name.replace("crank", "hanger"): link for name, link in three.links.items()}
    body = Link({**links["body"].points, "P": (-0.2, 0.1)}, 1.0, ORIGIN, 0.1)
    links |= {
        "body": body,
        "crank": heavy(O=ORIGIN, Q=(0.02, 0.0)),
        "rod": heavy(Q=ORIGIN, P=(0.5, 0.0)),
    }
    places = {"P": (-0.2, 0.2), "B0": (0.0, 0.1), "B1": (1.0, 0.1)}
    angles = {"body": 0.0, "hanger0": np.pi / 2, "hanger1": np.pi / 2}
    at = eq.mechanism.Position(0.0, places, angles)
    given = machine({**three.frame, "O": (-0.72, 0.2)}, links, position=at)
    analysis = eq.analyze(given)
    np.testing.assert_allclose(analysis.motion.links["body"].angle, 0.0, atol=1e-10)
    assert [g.kind for g in analysis.motion.linkage.groups] == ["loops", "pointed"]
    assert np.all(np.isfinite(analysis.forces.drive_torque))


def test_lengths_that_do_not_agree_are_reported_with_what_would_fit() -> None:
    sentence = refusal_of(cranks(last=0.1012))
    assert sentence.startswith(
        "the linkage cannot move (mobility by count 0: 4 moving links, 6 pins "
    )
    assert "B2 of 'crank2' comes 1.2 mm beside its pin, at crank angle " in sentence
    assert sentence.endswith("A2 and B2 are 101.2 mm apart, and 100 mm would fit")


def test_a_pivot_in_the_wrong_place_is_reported_as_it_varies() -> None:
    given = cranks()
    sentence = refusal_of(replace(given, frame={**given.frame, "A2": (0.41, 0.3)}))
    assert (
        "A2 and B2 are 100 mm apart, and the others bring the pins 90 to 110 mm apart" in sentence
    )


@pytest.mark.parametrize(("offset", "turn", "misfit"), [(0.002, 0.0, "2"), (0.0, 0.01, "12")])
def test_guides_that_do_not_agree(offset: float, turn: float, misfit: str) -> None:
    sentence = refusal_of(guided(offset, turn))
    assert "'upper' of 'block' is " + misfit in sentence
    assert "mm beside where it should be at crank angle" in sentence


def test_two_guides_move_as_one_does() -> None:
    first = guided()
    alone = eq.analyze(replace(first, sliders=first.sliders[:1]))
    both = eq.analyze(first)
    np.testing.assert_allclose(both.motion.points["C"].x, alone.motion.points["C"].x, atol=1e-15)
    np.testing.assert_allclose(both.forces.drive_torque, alone.forces.drive_torque, atol=1e-11)
    names = {"block on frame", "upper"}
    total = sum(both.forces.joints[name].value for name in names)
    np.testing.assert_allclose(total, alone.forces.joints["block on frame"].value, atol=1e-9)
    np.testing.assert_allclose(
        both.forces.joints["C"].value, alone.forces.joints["C"].value, atol=1e-9
    )


def test_points_at_which_nothing_is_joined_leave_forces_as_they_are() -> None:
    """On the frame or on a link, and wherever along its line a guide is said to go through."""
    body = heavy(C=(0.1, 0.0), U=(-0.2, -0.1), V=(0.2, 0.1))
    block = replace(guided(), links={**guided().links, "block": body})
    further = block.links["block"]
    beside = replace(
        block,
        frame={**block.frame, "Z": (9.0, 7.0)},
        links={
            **block.links,
            "block": replace(further, points={**further.points, "T": (3.0, 1.0)}),
        },
    )
    along = replace(block, frame={**block.frame, "G": (5.0, -0.1)})
    wanted = eq.analyze(block, 90).forces.joints
    for changed in (beside, along):
        joints = eq.analyze(changed, 90).forces.joints
        for name, force in wanted.items():
            assert joints[name].x == pytest.approx(force.x, abs=1e-9), name
            assert joints[name].y == pytest.approx(force.y, abs=1e-9), name
    assert indeterminate_reactions(assemble(block)).reach == pytest.approx(
        1.0
    )  # the rod, between its pins


def test_two_guides_need_two_names() -> None:
    given = guided()
    same = replace(given, sliders=(given.sliders[0], replace(given.sliders[1], label="")))
    assert "two joints would be called 'block on frame'" in refusal_of(same)


def planets(last: int = 40, start: float = 0.0, count: int = 3) -> eq.Machine:
    """An arm that turns planets in a ring, which turn a sun; the last pair may not fit."""
    ways = [2 * np.pi * k / count for k in range(count)]
    places = {f"P{k}": (float(np.cos(w)), float(np.sin(w))) for k, w in enumerate(ways)}
    links = {"arm": heavy(A=ORIGIN, **places), "sun": heavy(A=ORIGIN, S=(0.4, 0.0))}
    gears = []
    for k in range(count):
        links[f"planet{k}"] = heavy(**{f"P{k}": ORIGIN})
        gears += [eq.Gear(FRAME, f"planet{k}", teeth=(80, 20), mesh="internal", carrier="arm"),
                  eq.Gear(f"planet{k}", "sun", teeth=(20, 40), carrier="arm")]  # fmt: skip
    gears[-1] = replace(gears[-1], teeth=(20, last), start=start)
    return machine({"A": ORIGIN}, links, drive=eq.Drive("arm", 10.0), gears=tuple(gears))


def test_several_planets_turn_one_sun() -> None:
    """Willis: the sun of a fixed ring turns 1 + z_ring / z_sun times as fast as the arm."""
    analysis = eq.analyze(planets())
    np.testing.assert_allclose(analysis.motion.links["sun"].angle_1, 3.0, rtol=1e-14)


def test_planets_alike_push_alike() -> None:
    """By least squares each bears a third of what turns the sun, here by inertia alone."""
    given = planets()
    still = {name: replace(link, center_of_mass=ORIGIN) for name, link in given.links.items()}
    forces = eq.analyze(replace(given, links=still, gravity=ORIGIN)).forces.at(acceleration=50.0)
    inertia = still["sun"].inertia
    assert inertia is not None
    for k in range(3):
        push = forces.gears[f"planet{k} to sun"].tangential
        np.testing.assert_allclose(push, inertia * 3 * 50.0 / (3 * 40 / 60), rtol=1e-10)


@pytest.mark.parametrize(
    ("last", "start", "words"),
    [
        (41, 0.0, "'planet2 to sun' turns 'sun' 17.56 deg beside where other joints turn it"),
        (40, 0.1, "'planet2 to sun' starts 'sun' at 5.72958 deg, where other joints have it at 0"),
    ],
)
def test_planets_that_do_not_agree(last: int, start: float, words: str) -> None:
    assert words in refusal_of(planets(last, start))


def yokes(lean: float = 0.0) -> eq.Machine:
    """A block on a crank pin that runs in two yokes, of which both decide its angle."""
    along, up = 0.0, np.pi / 2
    return machine(
        {"A": ORIGIN, "G": (1.0, 0.0), "H": (0.0, 1.0)},
        {
            "crank": heavy(A=ORIGIN, B=(CRANK, 0.0)),
            "block": heavy(B=ORIGIN),
            "across": heavy(X=ORIGIN, Y=(0.8, 0.0)),
            "up": heavy(U=ORIGIN, V=(0.0, 0.8)),
        },
        sliders=(
            Slider("across", "Y", FRAME, "G", along),
            Slider("up", "V", FRAME, "H", up, -up),
            Slider("block", "B", "across", "X", up, -up),
            Slider("block", "B", "up", "U", along, lean),
        ),
    )


def test_two_yokes_on_one_pin_show_sine_and_cosine() -> None:
    motion = eq.move(yokes())
    assert [group.kind for group in motion.linkage.groups] == ["dyad", "loops"]
    theta = motion.crank_angle
    np.testing.assert_allclose(motion.points["X"].x, CRANK * np.cos(theta), atol=1e-15)
    np.testing.assert_allclose(motion.points["U"].y, CRANK * np.sin(theta), atol=1e-15)
    assert "count 0: 4 moving links" in refusal_of(yokes(0.01))


def test_what_hangs_on_shared_links_is_left_to_its_own_steps() -> None:
    linkage = eq.move(with_rocker(cranks())).linkage
    assert linkage.shared is not None
    assert linkage.shared.group.links == ("crank0", "crank1", "body", "crank2")
    assert [group.links for group in linkage.shared.decided] == [("rod", "rocker")]


# -- change points ---------------------------------------------------------------------------------


def test_a_parallelogram_stays_parallel_through_its_change_points() -> None:
    motion = eq.move(parallel(), np.array([0.0, np.pi - 1e-9, np.pi, np.pi + 1e-9, 2.0]))
    rocker = motion.links["crank1"]
    np.testing.assert_allclose(np.exp(1j * (rocker.angle - motion.crank_angle)), 1.0, atol=1e-13)
    np.testing.assert_allclose([rocker.angle_1 - 1, rocker.angle_2], 0.0, atol=1e-12)


def test_a_crossed_parallelogram_turns_as_elliptic_gears_do() -> None:
    """Speed ratio of an elliptic pair: i = -(1 - k^2) / (1 + k^2 - 2 k cos theta), k = a / d."""
    motion = eq.move(parallel("antiparallel"))
    theta, k = motion.crank_angle, CRANK
    bottom = 1 + k * k - 2 * k * np.cos(theta)
    rocker = motion.links["crank1"]
    np.testing.assert_allclose(rocker.angle_1, -(1 - k * k) / bottom, atol=1e-12)
    second = (1 - k * k) * 2 * k * np.sin(theta) / bottom**2
    np.testing.assert_allclose(rocker.angle_2, second, atol=1e-12)


def test_forces_without_bound_are_not_reported() -> None:
    analysis = eq.analyze(parallel())
    assert set(indeterminate_reactions(analysis.motion.linkage).unbounded) == {
        "A0",
        "B0",
        "A1",
        "B1",
    }
    assert not analysis.forces.joints
    assert analysis.to_dict()["unbounded"]["joints"] == ["A0", "A1", "B0", "B1"]
    kinetic = analysis.forces.frame_force.value - analysis.forces.weight.value
    np.testing.assert_allclose(kinetic, analysis.forces.shaking_force.value, atol=1e-10)
    assert np.all(np.isfinite(analysis.forces.drive_torque))


def test_a_force_without_bound_is_not_asked_for() -> None:
    analysis = eq.analyze(parallel())
    with refused(UsageError, angle=0.0, last="'body'", first="'crank1'"):
        analysis.outputs["joints.B0.x"]


def test_formats_whose_equations_state_the_same_twice() -> None:
    with refused(UsageError, by="need_every_joint"):
        modelica.export_bytes(Job(cranks()))
    job = Job(guided())
    assert "upper" not in mjcf.export_bytes(job)
    assert {"guide": "upper", "link": "block"} in [part.values for part in job.left_out]


def test_forces_between_change_points_are_those_of_a_plain_four_bar() -> None:
    theta = np.array([0.3, 1.0, 2.5])
    given = parallel()
    got = eq.analyze(given, theta).forces
    want = eq.analyze(replace(given, assembly={"B1": "right"}), theta).forces
    for name, joint in want.joints.items():
        np.testing.assert_allclose(got.joints[name].value, joint.value, rtol=1e-10)
    np.testing.assert_allclose(got.drive_torque, want.drive_torque, rtol=1e-10)


def test_three_cranks_in_line_do_not_hold_the_change_point() -> None:
    line = indeterminate_reactions(eq.analyze(cranks(LINE)).motion.linkage)
    assert "B2" in line.unbounded
    assert not indeterminate_reactions(eq.analyze(cranks()).motion.linkage).unbounded


def test_a_mode_has_to_be_given() -> None:
    sentence = refusal_of(parallel(None))
    assert sentence.startswith('assembly.B1: missing; give "parallel" or "antiparallel"')


def test_sides_that_are_nearly_equal_are_reported_with_the_misfit() -> None:
    given = cranks(PIVOTS[:2], last=0.1005, assembly={"mode": "parallel"})
    assert refusal_of(given).startswith(
        "assembly.mode: opposite sides of a parallel linkage are equal, and A0-B0 is 100 mm, "
        "A1-B1 100.5 mm, 0.5 mm apart"
    )


def test_a_mode_that_is_a_side() -> None:
    given = replace(cranks(), assembly={"mode": "left"})
    assert refusal_of(given) == "assembly.mode: got 'left'; give 'parallel' or 'antiparallel'"
    given = replace(cranks(), assembly={"B0": "left"})
    assert refusal_of(given).endswith("the dyads of this linkage meet at B1")


def test_a_mode_without_change_points() -> None:
    given = four_bar(1.0, 0.3, 0.9, 0.8)
    mode = replace(given, assembly={**given.assembly, "mode": "parallel"})
    assert refusal_of(mode).startswith(
        "assembly.mode: no two links of this linkage close a four-bar"
    )


# -- forces ----------------------------------------------------------------------------------------


def test_what_statics_decides_does_not_depend_on_the_rule() -> None:
    """Forces that hold each other are added by other stiffness: nothing else may change."""
    given = with_rocker(cranks())
    analysis = eq.analyze(given)
    assert set(indeterminate_reactions(analysis.motion.linkage).open) == {
        f"{p}{k}" for p in "AB" for k in range(3)
    }
    assert analysis.to_dict()["open"]["rule"] == "least squares"
    stiff = (
        JointProperties("joints.B0", stiffness=1e6),
        JointProperties("joints.A2", stiffness=3e5),
    )
    other = eq.analyze(replace(given, joints=stiff))
    assert other.to_dict()["open"]["rule"] == "stiffness"
    first, two = analysis.forces, other.forces
    assert np.max(np.abs(first.joints["B0"].value - two.joints["B0"].value)) > 1.0
    for name in ("drive_torque", "frame_moment", "shaking_moment"):
        np.testing.assert_allclose(getattr(first, name), getattr(two, name), atol=1e-9)
    np.testing.assert_allclose(first.frame_force.value, two.frame_force.value, atol=1e-9)
    for name in ("P", "Q", "R"):
        np.testing.assert_allclose(first.joints[name].value, two.joints[name].value, atol=1e-9)


@pytest.mark.parametrize("kind", few(REDUNDANT, {*REDUNDANT} - {"planet_differential"}))
def test_of_all_kinds_both_rules_report_alike_what_statics_decides(kind: str) -> None:
    given = make(kind, 1).machine
    linkage = eq.mechanism.assemble(given)
    rng, names = np.random.default_rng(1), linkage.shared.names
    stiff = tuple(JointProperties(name, stiffness=float(rng.uniform(1e5, 1e6))) for name in names)
    first, two = (eq.analyze(each, 24).forces for each in (given, replace(given, joints=stiff)))
    text, scale = (
        indeterminate_reactions(linkage).open,
        max(np.max(joint.size) for joint in first.joints.values()),
    )
    assert text
    size = scale * linkage.shared.group.size
    both = exerted_in(first.solved), exerted_in(two.solved)
    off = {
        name: max(
            np.max(np.abs(both[0][name].value - both[1][name].value)) / scale,
            np.max(
                np.abs(getattr(both[0][name], "moment", 0) - getattr(both[1][name], "moment", 0))
            )
            / size,
        )
        for name in both[0]
    }
    assert max(off.values()) > 1e-6
    assert all(apart < 1e-9 for name, apart in off.items() if name not in text)
    for name, torque in first.drives.items():
        np.testing.assert_allclose(two.drives[name], torque, atol=1e-9 * size)
    np.testing.assert_allclose(two.frame_force.value, first.frame_force.value, atol=1e-9 * scale)
    np.testing.assert_allclose(two.frame_moment, first.frame_moment, atol=1e-9 * size)


@pytest.mark.exhaustive(but=["planet_train"])
@pytest.mark.parametrize("kind", ["planet_train", "planet_differential"])
def test_teeth_push_as_their_flanks_lie(kind: str) -> None:
    """Where they share; idle are those alone that push back on either flank."""
    forces = eq.analyze(make(kind, 1).machine, 24).forces
    linkage, state = forces.motion.linkage, dict(forces.solved.state)
    names = [gear.name for gear in linkage.machine.gears]
    least = -1e-9 * max(np.max(np.abs(state[f"T({name})"])) for name in names)
    assert all(np.all(state[f"T({name})"] * state[f"flank({name})"] >= least) for name in names)
    for link in linkage.machine.links:
        causes = (forces.inertia, forces.weights, forces.loads, forces.springs)
        parts = [cause[link] for cause in causes if link in cause]
        state[f"F({link})"], state[f"M({link})"] = map(sum, zip(*parts, strict=True))
    shared, idle_ones = linkage.shared, []
    poses = shared.poses(state)
    for name in names:
        idle = state[IDLE.format(name)]
        assert np.all(state[f"T({name})"][idle] == 0)
        idle_ones += [name] * bool(np.any(idle))
        loop = [item.name for item in shared.loops].index(name)
        for sense in (1.0, -1.0):
            tried = {**state, f"flank({name})": sense, IDLE.format(name): np.zeros_like(idle)}
            senses = [tried.get(f"flank({item.name})", 0.0) for item in shared.loops]
            push = shared.solve(tried, poses, senses)[loop][0]
            assert np.all(sense * push[idle] < -least)
    (text,) = idle_teeth_notes(linkage, state)
    assert idle_ones and all(name in str(text) for name in idle_ones)


def test_drives_that_share_a_torque_are_reported() -> None:
    """Both crankshafts of coupling rods are driven alike: nothing tells who bears what."""
    with refused(ModelError, "drives", first="'crank0'", last="'crank1'"):
        eq.analyze(cranks(drives=(FurtherDrive("crank1"),)))
    off = refusal_of(cranks(drives=(FurtherDrive("crank1", start=0.1),)))
    assert "and the others bring the pins 990.0042 to 1009.996 mm apart" in off


def with_rocker(given: eq.Machine) -> eq.Machine:
    """A dyad that hangs on the body and on the frame."""
    body = given.links["body"]
    links = {**given.links, "body": replace(body, points={**body.points, "P": (0.5, 0.6)})}
    links |= {"rod": heavy(P=ORIGIN, Q=(0.8, 0.0)), "rocker": heavy(R=ORIGIN, Q=(0.7, 0.0))}
    frame = {**given.frame, "R": (1.3, 1.2)}
    return replace(given, links=links, frame=frame, assembly={**given.assembly, "Q": "left"})


def test_stiff_supports_share_a_weight_as_springs_do() -> None:
    """Cranks upright under a beam: of equal springs in a row each bears W/3 + M x / sum x^2."""
    given = cranks(LINE)
    links = {name: replace(link, mass=0.0, inertia=0.0) for name, link in given.links.items()}
    beam = replace(given.links["body"], mass=3.0, center_of_mass=(1.2, 0.0), inertia=0.0)
    soft = tuple(JointProperties(f"joints.B{k}", stiffness=1e6) for k in range(3))
    still = replace(given, links={**links, "body": beam}, joints=soft, gravity=(0.0, -10.0))
    forces = eq.analyze(still, [np.pi / 2], speed=0.0).forces
    got = [forces.joints[f"B{k}"].y[0] for k in range(3)]
    np.testing.assert_allclose(got, [30 * (1 / 3 + 0.2 * x / 2) for x in (-1, 0, 1)], rtol=1e-9)


def test_stiffness_that_leaves_forces_open() -> None:
    stiff = (JointProperties("joints.C", stiffness=1e6),)
    sentence = refusal_of(replace(guided(), joints=stiff))
    assert sentence.startswith(
        "joints: with the given stiffness the forces in joints.block on frame and joints.upper "
        "remain"
    )


def test_teeth_share_by_their_stiffness() -> None:
    """Planets alike on teeth of other stiffness: each bears as much as its teeth are stiff."""
    given = planets()
    still = {name: replace(link, center_of_mass=ORIGIN, inertia=0.0 if name == "arm" else 2e-3)
             for name, link in given.links.items()}  # fmt: skip
    sizes = {f"gears.planet{k} to sun": 1e6 * (k + 1) for k in range(3)}
    sizes |= {f"joints.P{k}": 1e12 for k in range(3)} | {"joints.A/sun": 1e12}
    springs = tuple(JointProperties(name, stiffness=k) for name, k in sizes.items())
    flat = {"links": still, "gravity": ORIGIN, "joints": springs}
    forces = eq.analyze(replace(given, **flat)).forces.at(acceleration=50.0)
    push = [forces.gears[f"planet{k} to sun"].tangential[0] for k in range(3)]
    np.testing.assert_allclose(push, np.sum(push) * np.array([1, 2, 3]) / 6, rtol=1e-4)


@pytest.mark.parametrize(
    ("joint", "given", "expected"),
    [
        ("joints.Q", guided(), {"place": "joints[1].joint", "given": "joints.Q"}),
        ("B", guided(), {"place": "joints[1].joint", "name": "joints.B", "joint": "B"}),
        ("gears.B", guided(), {"place": "joints[1].joint", "given": "gears.B"}),
        ("joints.B1", parallel(), {"place": "joints[1].stiffness"}),
    ],
)
def test_stiffness_of_no_use(joint: str, given: eq.Machine, expected: dict[str, Any]) -> None:
    with refused(ModelError, **expected):
        eq.analyze(replace(given, joints=(JointProperties(joint, stiffness=1e6),)))


def test_a_brace_locks_a_four_bar() -> None:
    given = four_bar(1.0, 0.3, 0.9, 0.8)
    coupler = given.links["coupler"]
    points = {**coupler.points, "P": (0.3, 0.3)}
    braced = replace(given, frame={**given.frame, "E": (0.5, -1.0)},
                     links={**given.links, "coupler": replace(coupler, points=points),
                            "brace": heavy(E=ORIGIN, P=(1.2, 0.0))})  # fmt: skip
    with refused(MobilityError, link="brace", second="P"):
        eq.move(braced)
