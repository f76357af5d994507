"""From a machine to its steps: order, dyads of every kind, sides, and what is refused."""

from __future__ import annotations

import re
import tomllib
from dataclasses import replace
from math import pi, radians

import numpy as np
import pytest

import equipoise as eq
from equipoise.errors import MobilityError, ModelError, RangeError
from equipoise.mechanism.assembly.steps import KernelCall
from equipoise.mechanism.formulas import kernels
from equipoise.mechanism.parts.machine import FRAME
from laws.transforms import with_axes
from support.machines import KINDS, make
from support.refusals import refused
from unit.mechanism.build import (
    ORIGIN,
    body,
    crank_rocker,
    four_bar,
    heavy,
    machine,
    slider_crank,
    two_gears,
)

ANGLES = np.array([0.2, 1.3, 2.9, 4.4])


def kernels_of(given: eq.Machine) -> list[str]:
    """Dyads, in order of solution."""
    dyads = {kernels.rrr, kernels.rrp, kernels.rpr, kernels.prp, kernels.rpp, kernels.in_ratio}
    steps = [step for step in eq.mechanism.assemble(given).motion if isinstance(step, KernelCall)]
    return [step.kernel.__name__ for step in steps if step.kernel in dyads]


@pytest.mark.parametrize(
    ("name", "dyads"),
    [
        ("yamashita-1", ["rrr"]),
        ("slider-crank-engine", ["rrp"]),
        ("quick-return", ["rpr", "rrp"]),
        ("scotch-yoke", ["rpp"]),
        ("watt-six-bar", ["rrr", "rrr"]),
        ("geared-counterweight", ["rrr", "in_ratio"]),
        ("planetary-planting-arm", ["in_ratio", "in_ratio"]),
        ("class-three", []),
    ],
)
def test_kinds_of_dyads(name: str, dyads: list[str]) -> None:
    assert kernels_of(eq.load(name)) == dyads


@pytest.mark.parametrize(
    ("kind", "dyads"),
    [
        ("crossed_guides", ["rrr", "prp"]),
        ("slider_on_rocker", ["rrr", "rrp"]),
        ("guide_on_dyad", ["rrr", "rrp"]),
        ("v_twin", ["rrp", "rrp"]),
        ("geared_five_bar", ["in_ratio", "rrr"]),
    ],
)
def test_kinds_of_dyads_on_moving_bodies(kind: str, dyads: list[str]) -> None:
    assert kernels_of(make(kind, 0).machine) == dyads


@pytest.mark.parametrize("kind", KINDS)
def test_every_link_is_solved_once(kind: str) -> None:
    linkage = eq.mechanism.assemble(make(kind, 0).machine)
    solved = [link for group in linkage.groups for link in group.links]
    driven = [drive.link for drive in linkage.machine.driven]
    assert sorted([*solved, *driven]) == sorted(linkage.machine.links)
    assert linkage.anchors.keys() == {FRAME, *linkage.machine.links}


def test_order_does_not_depend_on_the_file() -> None:
    given = eq.load("watt-six-bar")
    names = ["output", "link", "rocker", "coupler", "crank"]
    moved = replace(given, links={name: given.links[name] for name in names},
                    assembly={"C": "right", "F": "left"})  # fmt: skip
    assert [group.links for group in eq.mechanism.assemble(moved).groups] == [
        ("rocker", "coupler"), ("output", "link")
    ]  # fmt: skip


# -- sides -----------------------------------------------------------------------------------------


@pytest.mark.parametrize(("side", "sign"), [("left", 1), ("right", -1)])
def test_left_and_right(side: str, sign: int) -> None:
    points = eq.move(four_bar(1.0, 0.35, 0.9, 0.8, side), 36).points
    b, c, d = (points[name].place for name in "BCD")
    assert np.all(sign * kernels.cross(d - b, c - b) > 0)


def test_left_is_reported_in_file_order() -> None:
    """With the rocker before the coupler the line runs from D to B."""
    given = four_bar(1.0, 0.35, 0.9, 0.8, "left")
    names = ["crank", "rocker", "coupler"]
    turned = replace(given, links={name: given.links[name] for name in names})
    right = four_bar(1.0, 0.35, 0.9, 0.8, "right")
    np.testing.assert_allclose(
        eq.move(turned, 12).points["C"].place, eq.move(right, 12).points["C"].place, atol=1e-14
    )


@pytest.mark.parametrize(("side", "sign"), [("forward", 1), ("backward", -1)])
@pytest.mark.parametrize("direction", [0.0, 90.0, 180.0, -135.0])
def test_forward_and_backward(side: str, sign: int, direction: float) -> None:
    guide = eq.Slider("piston", "C", FRAME, "A", radians(direction))
    motion = eq.move(slider_crank(sliders=(guide,), assembly={"C": side}), 36)
    along = motion.points["C"].place * np.exp(-1j * radians(direction))
    assert np.all(sign * along.real > 0.69)
    np.testing.assert_allclose(along.imag, 0, atol=1e-15)


def quick_return(side: str, **changes: object) -> eq.Machine:
    slider = eq.Slider("block", "B", "lever", "D", 0.0)
    return machine(
        {"A": ORIGIN, "D": (0.0, -1.0)},
        {"crank": heavy(A=ORIGIN, B=(0.4, 0.0)), "block": heavy(B=ORIGIN),
         "lever": heavy(D=ORIGIN, E=(2.0, 0.0))},
        sliders=(replace(slider, **changes),),  # type: ignore[arg-type]
        assembly={"B": side},
    )  # fmt: skip


@pytest.mark.parametrize(("side", "turn"), [("forward", 0.0), ("backward", pi)])
def test_sides_of_a_swinging_guide(side: str, turn: float) -> None:
    motion = eq.move(quick_return(side), 36)
    towards = motion.points["B"].place - motion.points["D"].place
    lever = np.exp(1j * motion.links["lever"].angle)
    np.testing.assert_allclose(towards / abs(towards), lever * np.exp(1j * turn), atol=1e-14)


@pytest.mark.parametrize(
    ("given", "joint", "sides"),
    [
        (crank_rocker(), "C", ("left", "right")),
        (slider_crank(), "C", ("forward", "backward")),
        (quick_return("forward"), "B", ("forward", "backward")),
    ],
)
def test_missing_sides(given: eq.Machine, joint: str, sides: tuple[str, str]) -> None:
    first, second = sides
    with refused(ModelError, f"assembly.{joint}", first=first, second=second):
        eq.mechanism.assemble(replace(given, assembly={}))


def test_a_side_of_the_wrong_kind() -> None:
    with refused(ModelError, "assembly.C", given="left", first="forward", second="backward"):
        eq.mechanism.assemble(slider_crank(assembly={"C": "left"}))
    with refused(ModelError, "assembly.C", given="forward", first="left", second="right"):
        eq.mechanism.assemble(four_bar(1.0, 0.35, 0.9, 0.8, "forward"))


@pytest.mark.parametrize(
    ("given", "joint", "expected"),
    [
        (four_bar(1.0, 0.35, 0.9, 0.8), "B", {"dyads": "C"}),
        (four_bar(1.0, 0.35, 0.9, 0.8), "c", {"name": "C"}),
        (eq.load("scotch-yoke"), "B", {}),
        (two_gears(eq.Gear("crank", "wheel", -1.0)), "A", {}),
    ],
)
def test_idle_sides(given: eq.Machine, joint: str, expected: dict[str, str]) -> None:
    with refused(ModelError, f"assembly.{joint}", **expected):
        eq.mechanism.assemble(replace(given, assembly={**given.assembly, joint: "left"}))


# -- sliders from either side ----------------------------------------------------------------------


def same_forces(item: eq.Machine, other: eq.Machine, slider: str, swapped: str) -> None:
    """Compare all outputs of a machine told in two ways; the slider has another name."""
    a, b = (eq.analyze(m, ANGLES).forces for m in (item, other))
    assert a.joints.keys() - {slider} == b.joints.keys() - {swapped}
    np.testing.assert_allclose(a.drive_torque, b.drive_torque, atol=1e-11)
    for name in a.joints.keys() - {slider}:
        np.testing.assert_allclose(a.joints[name].value, b.joints[name].value, atol=1e-11)
    first, second = a.joints[slider], b.joints[swapped]
    assert {first.on, first.by} == {second.on, second.by}
    sign = 1 if first.on == second.on else -1
    np.testing.assert_allclose(first.value, sign * second.value, atol=1e-11)


def test_block_and_guide_change_roles_in_a_swinging_guide() -> None:
    first = quick_return("forward")
    other = replace(
        first,
        sliders=(eq.Slider("lever", "D", "block", "B", 0.0, 0.0),),
        assembly={"D": "backward"},
    )
    same_forces(first, other, "block on lever", "lever on block")


def test_block_and_guide_change_roles_in_a_yoke() -> None:
    first = eq.load("scotch-yoke")
    slot, rail = first.sliders
    swapped = eq.Slider("yoke", "Y", "block", "B", 0.0, -slot.direction)
    same_forces(first, replace(first, sliders=(swapped, rail)), "block on yoke", "yoke on block")


def test_a_guide_on_the_crank() -> None:
    """The guide may be a known link that names the unknown one as its own guide."""
    frame = {"A": ORIGIN, "D": (0.3, 0.0)}
    links = {
        "crank": heavy(A=ORIGIN, G=(1.0, 0.1)),
        "block": heavy(C=ORIGIN),
        "rod": heavy(D=ORIGIN, C=(0.9, 0.0)),
    }
    first = machine(frame, links, sliders=(eq.Slider("block", "C", "crank", "G", 0.2, 0.5),),
                  assembly={"C": "forward"})  # fmt: skip
    other = replace(first, sliders=(eq.Slider("crank", "G", "block", "C", -0.5, -0.2),))
    assert kernels_of(first) == kernels_of(other) == ["rrp"]
    same_forces(first, other, "block on crank", "crank on block")


def test_crossed_guides_meet() -> None:
    """A pin on two guides, of which the crank carries one: they are parallel twice a turn."""
    given = machine(
        {"A": ORIGIN, "K": (0.0, 0.4)},
        {"crank": heavy(A=ORIGIN), "one": heavy(C=ORIGIN), "other": heavy(C=ORIGIN)},
        sliders=(
            eq.Slider("one", "C", "crank", "A", 0.0),
            eq.Slider("other", "C", FRAME, "K", 0.0),
        ),
    )
    theta = np.array([0.7, 1.5, 2.4])
    motion = eq.move(given, theta)
    assert kernels_of(given) == ["prp"]
    np.testing.assert_allclose(motion.points["C"].place, 0.4 / np.tan(theta) + 0.4j, atol=1e-14)
    np.testing.assert_allclose(motion.points["C"].place_1, -0.4 / np.sin(theta) ** 2, atol=1e-14)


def test_parallel_guides_are_refused() -> None:
    given = eq.load("scotch-yoke")
    slot, rail = given.sliders
    with refused(ModelError, "sliders[1]", name="yoke on frame", other="yoke"):
        eq.mechanism.assemble(replace(given, sliders=(replace(slot, direction=0.0), rail)))


def test_three_sliding_joints_in_a_row_are_refused() -> None:
    given = machine(
        {"A": ORIGIN, "H": (0.5, 0.0)},
        {"crank": body(A=ORIGIN), "one": body(C=ORIGIN), "other": body(E=ORIGIN)},
        sliders=(
            eq.Slider("one", "C", "crank", "A", 0.0),
            eq.Slider("other", "E", "one", "C", 1.0),
            eq.Slider("other", "E", FRAME, "H", 2.0),
        ),
    )
    with refused(MobilityError, pair="one", pair_2="other"):
        eq.mechanism.assemble(given)


# -- pins that coincide ----------------------------------------------------------------------------


def test_a_link_of_no_length() -> None:
    given = four_bar(1.0, 0.35, 0.9, 0.8)
    with refused(ModelError, "links.rocker.points"):
        eq.mechanism.assemble(given.with_link("rocker", points={"D": ORIGIN, "C": ORIGIN}))


# -- sides that are missing ------------------------------------------------------------------------


def asked(given: eq.Machine) -> tuple[dict[str, str], str]:
    """What is offered for the table of sides, and the whole sentence, of a machine without it."""
    with pytest.raises(ModelError) as caught:
        eq.mechanism.assemble(replace(given, assembly={}))
    sentence, lines = caught.value.what, "\n".join(caught.value.lines)
    assert sentence
    return tomllib.loads(lines)["assembly"], lines


def named(name: str) -> eq.Machine:
    kind, _, seed = name.partition(":")
    return make(kind, int(seed)).machine if seed else eq.load(name)


EXAMPLES = ("watt-six-bar", "stephenson-six-bar", "quick-return", "geared-counterweight")
TWO_SIDED = [
    name
    for name in (*(f"{kind}:{seed}" for kind in KINDS for seed in (0, 1)), *EXAMPLES)
    if named(name).assembly and named(name).drive.motion is None  # drawn at its own angle 0
]


def drawn(given: eq.Machine) -> eq.Machine:
    """The machine with the axes of every link in those of the frame at crank angle 0."""
    at_zero = eq.move(given, np.zeros(1))
    for link in given.links:
        turn = np.exp(1j * at_zero.links[link].angle[0])
        point, place = next(iter(given.links[link].points.items()))
        origin = at_zero.points[point if point in at_zero.points else f"{link}.{point}"].place[0]
        shift = complex(*place) - origin / turn
        given = with_axes(given, link, -float(np.angle(turn)), shift)
    return given


@pytest.mark.parametrize("name", TWO_SIDED)
def test_missing_sides_are_those_that_are_drawn(name: str) -> None:
    """Whoever draws all links in the frame's axes is given every side back, at once."""
    given = drawn(named(name))
    sides, lines = asked(given)
    assert sides == given.assembly
    assert lines.count("as drawn") == len(sides)
    again = replace(given, assembly=sides)
    np.testing.assert_allclose(eq.move(again, 12).crank_angle, eq.move(given, 12).crank_angle)


@pytest.mark.parametrize("name", ["watt-six-bar", "stephenson-six-bar", "quick-return", "v_twin:0"])
@pytest.mark.parametrize("angle", [0.0, 1.0, -2.5])
def test_missing_sides_are_those_of_the_position(name: str, angle: float) -> None:
    given = named(name)
    motion = eq.move(given, np.array([angle]))
    position = eq.mechanism.Position(
        angle, {}, {link: float(motion.links[link].angle[0]) + 0.1 for link in given.links}
    )
    sides, lines = asked(replace(given, position=position))
    assert sides == given.assembly
    assert lines.count("as in [position]") == len(sides)


@pytest.mark.parametrize("name", ["yamashita-1", "slider-crank-engine"])
def test_where_nothing_reports_both_sides_are_listed_with_their_places(name: str) -> None:
    given = eq.load(name)
    (joint,) = given.assembly
    _, lines = asked(given)
    entries = [line.removeprefix("# or ") for line in lines.splitlines()[2:]]
    assert len(entries) == 2
    for entry in entries:
        machine = replace(given, assembly=tomllib.loads(entry))
        place = 1e3 * eq.move(machine, np.zeros(1)).points[joint].place[0]
        x, y = map(float, re.findall(r"\((.*), (.*)\) mm at crank angle 0 deg", entry)[0])
        assert complex(x, y) == pytest.approx(place, rel=1e-3, abs=1e-3)


def test_places_of_a_pushed_machine_are_those_of_the_pose_that_is_named() -> None:
    """What its stroke makes of crank angle 0 is another pose; a crank at the boom's angle tells."""
    machine = eq.load("hydraulic-loader")
    sides = dict(machine.assembly)
    del sides["E"]
    with pytest.raises(ModelError) as caught:
        eq.mechanism.assemble(replace(machine, assembly=sides))
    matches = re.findall(
        r'E = "(\w+)"  # at \((.*), (.*)\) mm with boom at (.*) deg', str(caught.value)
    )
    assert [words[0] for words in matches] == ["parallel", "antiparallel"]
    crank = replace(machine, drive=eq.Drive("boom", 1.0), loads=())
    for side, x, y, degrees in matches:
        turned = replace(crank, assembly={**sides, "E": side})
        place = eq.move(turned, np.radians([float(degrees)])).points["E"]
        # four digits of some 2000 mm
        assert [place.x[0], place.y[0]] == pytest.approx([float(x) / 1e3, float(y) / 1e3], abs=1e-3)


def test_places_that_hang_on_a_side_before_name_it() -> None:
    """With the other side of C, D is elsewhere."""
    sieve = eq.load("sieve")
    _, lines = asked(sieve)
    first, second = [line for line in lines.splitlines() if "D = " in line]
    assert first.endswith('at crank angle 0 deg, with C = "left"')
    assert second.endswith('at crank angle 0 deg, with C = "left"')
    assert "with" not in "".join(line for line in lines.splitlines() if line.startswith("C = "))


def test_a_side_without_which_the_crank_cannot_turn() -> None:
    """With C on the other side no F closes for a whole turn; F itself is open."""
    sides, lines = asked(eq.load("watt-six-bar"))
    assert sides["C"] == eq.load("watt-six-bar").assembly["C"]
    assert lines.count("the crank turns fully with this side alone") == 1
    assert '\n# or F = "right"' in lines
    for side in ("left", "right"):
        other = replace(eq.load("watt-six-bar"), assembly={"C": "right", "F": side})
        with pytest.raises(RangeError):
            eq.move(other, 12)


def test_wrong_and_idle_sides_are_reported_with_missing_ones() -> None:
    given = replace(eq.load("watt-six-bar"), assembly={"C": "forward", "f": "left"})
    with refused(ModelError, "assembly", joint="F", given="forward", name="F") as caught:
        eq.mechanism.assemble(given)
    assert "[assembly]" not in caught.value.lines  # there is one already


def test_sides_of_links_that_cannot_be_joined() -> None:
    _, lines = asked(four_bar(1.0, 0.1, 0.2, 0.2))
    assert lines.splitlines()[2:] == ['C = "left"', '# or C = "right"']


# -- dyads at one point ----------------------------------------------------------------------------


def block_on_the_pin(label: str = "", *, arms: int = 1, **changes: object) -> eq.Machine:
    """Crank-rocker; on the pin of coupler and rocker are blocks, each of which slides on an arm."""
    given = four_bar(1.0, 0.35, 0.9, 0.8)
    frame, links, sliders = dict(given.frame), dict(given.links), []
    for number in range(1, arms + 1):
        frame[f"E{number}"] = (0.5, -0.8 - 0.2 * number)
        links[f"block{number}"] = body(C=ORIGIN)
        links[f"arm{number}"] = body(**{f"E{number}": ORIGIN})
        slider = eq.Slider(f"block{number}", "C", f"arm{number}", f"E{number}", 0.0, label=label)
        sliders.append(slider)
    return replace(given, frame=frame, links=links, sliders=tuple(sliders), **changes)  # type: ignore[arg-type]


def test_dyads_at_one_point_have_entries_of_their_own() -> None:
    """Without entries both are asked for, and what is offered to be pasted makes the machine."""
    given = block_on_the_pin()
    sides, _ = asked(given)
    assert sides.keys() == {"C", "block1 on arm1"}
    with refused(
        ModelError, "assembly.block1 on arm1", first="forward", second="backward"
    ) as caught:
        eq.mechanism.assemble(replace(given, assembly={"C": sides["C"]}))
    assert caught.value.where == "assembly.block1 on arm1"
    turned = []
    for side in ("forward", "backward"):
        motion = eq.move(replace(given, assembly={"C": "left", "block1 on arm1": side}), 12)
        turned.append(np.exp(1j * motion.links["arm1"].angle))
        assert set(motion.transmission) == {"C", "block1 on arm1"}
        way = motion.points["C"].place - complex(*given.frame["E1"])
        np.testing.assert_allclose(way / abs(way) * (1 if side == "forward" else -1), turned[-1])
    np.testing.assert_allclose(turned[0], -turned[1])


def test_two_blocks_on_one_point_lie_as_each_is_given() -> None:
    """A word for the point is that of both, as ever; their names tell them apart."""
    given = block_on_the_pin(arms=2)
    names = [slider.name for slider in given.sliders]
    assert set(asked(given)[0]) == {"C", *names}
    others = {name: given.links[name] for name in given.links if name not in ("coupler", "rocker")}
    free = replace(given, links=others | {"crank": body(A=ORIGIN, C=(0.35, 0.0))})
    both = eq.move(replace(free, assembly={"C": "backward"}), 12)
    each = eq.move(replace(free, assembly=dict.fromkeys(names, "backward")), 12)
    apart = eq.move(
        replace(free, assembly=dict(zip(names, ("backward", "forward"), strict=True))), 12
    )
    assert set(both.transmission) == set(names)
    for name in ("arm1", "arm2"):
        np.testing.assert_allclose(both.links[name].angle, each.links[name].angle)
    turn = np.exp(1j * (apart.links["arm2"].angle - both.links["arm2"].angle))
    np.testing.assert_allclose(turn, -1)


def test_a_guide_called_as_the_pin_of_another_dyad_is_refused() -> None:
    given = block_on_the_pin("C", assembly={"C": "left"})
    with refused(ModelError, "assembly", name="C"):
        eq.mechanism.assemble(given)


@pytest.mark.parametrize("key", ["mode", "block on rocker"])
def test_a_guide_or_its_point_may_be_called_mode(key: str) -> None:
    quick = eq.load("quick-return")
    slider = next(item for item in quick.sliders if item.on != FRAME)
    label = key if key == "mode" else ""
    sliders = tuple(
        replace(item, label=label) if item == slider else item for item in quick.sliders
    )
    name = label or slider.name
    entries = {
        name if joint == slider.point else joint: side for joint, side in quick.assembly.items()
    }
    given = replace(quick, sliders=sliders, assembly=entries)
    np.testing.assert_allclose(
        eq.move(given, 12).links[slider.on].angle, eq.move(quick, 12).links[slider.on].angle
    )
