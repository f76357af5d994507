"""Figures of batches against one analysis of each design's own machine, built without columns."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import equipoise as eq
from equipoise.codegen.batch import Batch
from equipoise.codegen.emit import can_compute, can_emit, signals_in_loops
from equipoise.codegen.figures import Figure
from equipoise.codegen.redundant_forces import MOST_SWITCHING
from equipoise.errors import UsageError
from equipoise.keys.paths import KeyPath
from equipoise.mechanism.assembly.linkage import assemble
from equipoise.mechanism.dynamics.reactions import idle_teeth_notes
from equipoise.mechanism.outputs.declared import declared
from equipoise.mechanism.parts.belts import Belt
from equipoise.mechanism.parts.gears import Gear
from equipoise.mechanism.parts.joint_properties import JointProperties
from equipoise.mechanism.parts.laws import LengthLaw
from equipoise.mechanism.parts.machine import Machine
from support import free_bodies, machines_cams
from support.batches import by_numpy, every_dyad, known_of, same_figures, signals_of, wanted_of
from support.chosen import DISTINCT, few, model_of
from support.designs import Number, design, drawn, named, numbers_of, paths_of, reason_of
from support.machines import KINDS, make
from support.machines_planes import set_apart
from support.poses import from_motion
from support.refusals import refused
from unit.mechanism.build import heavy, machine

ANGLES = 60
TOLERANCE = 1e-10
"""Both routes run the same formulas on the same numbers; near a change point rounding grows."""

EXAMPLES = sorted(
    name for name in eq.examples("linkage")
    if can_emit(linkage := assemble(model_of(name))) and linkage.shared is None
)  # fmt: skip
RANDOM = [
    pytest.param(kind, seed, id=f"{kind}-{seed}")
    for kind in KINDS
    for seed in (0, 1)
    if can_emit(assemble(make(kind, seed).machine))
]
FEW = [
    "shaking_force", "frame_moment", "drive_torque", "points.P.ax", "joints.B/coupler.force_y",
    "joints.piston on frame.moment", "joints.block on arm", "joints.standing on frame",
    "joints.yoke on frame", "gears.rocker to weight", "links.weight.angular_acceleration",
]  # fmt: skip
"""Signals that between them need every step of `every_dyad`."""


@pytest.fixture
def numpy_engine(tmp_path: Path) -> Iterator[None]:
    with by_numpy(tmp_path):
        yield


def compared(
    base: Machine, count: int, seed: int, wanted: Sequence[Figure] = (), polar: bool = False
) -> int:
    """Compare designs of a machine in which every number varies; tell how many could be moved.

    wanted : figures; all figures of all signals if none.
    """
    numbers = numbers_of(base, polar=polar)
    values = drawn(numbers, count, seed)
    wanted = wanted or wanted_of(signals_of(base))
    signals = list(dict.fromkeys(figure.signal for figure in wanted))
    figures, reasons = Batch(base, paths_of(numbers), wanted, angles=ANGLES)(values)
    moved = 0
    for row, got, reason in zip(values, figures, reasons, strict=True):
        reported = reason_of(base, numbers, row)
        assert reason == reported
        if reported:
            assert np.isnan(got).all()
            continue
        known = known_of(design(base, numbers, row), ANGLES, signals)
        same_figures(got, wanted, known, ANGLES, TOLERANCE)
        moved += 1
    return moved


def numbered(base: Machine, numbers: Sequence[Number], values: Sequence[float]) -> Machine:
    """A design of a machine of which `design` does not keep everything."""
    for number, value in zip(numbers, values, strict=True):
        base = base.with_number(number.path, float(value))
    return base


@pytest.mark.exhaustive(but=["balance-spring", "cam-pusher"])
@pytest.mark.parametrize("name", few(EXAMPLES, DISTINCT))
def test_example(name: str, numpy_engine: None) -> None:
    # designs by numbers are built without resistances and planting, and what friction changes is
    # not computed in loops: see `test_fingers_in_soil` and `test_resistances_and_friction`
    base = replace(eq.load(name).without_friction(), resistances=(), planting=None)
    assert compared(base, 3, 1)
    assert compared(base, 1, 2, polar=True)


@pytest.mark.exhaustive(but=["sun_and_planet-0", "swinging_block-0"])
@pytest.mark.parametrize(("kind", "seed"), RANDOM)
def test_random_machine(kind: str, seed: int, numpy_engine: None) -> None:
    assert compared(make(kind, seed).machine, 4, seed, polar=seed == 1)


@pytest.mark.parametrize("kind", ["planet_train", "rocking_screen", "double_guide"])
def test_joints_that_hold_too_much(kind: str, numpy_engine: None) -> None:
    """Where masses and the speed vary; lengths are looked at by each machine itself."""
    base = make(kind, 1).machine
    link = next(iter(base.links))
    paths = ("drive.speed", f"links.{link}.mass", f"links.{link}.center_of_mass.x")
    wanted = [Figure(signal, "rms") for signal in ("shaking_moment", "drive_torque", "frame_force")]
    values = np.array([[20.0, 0.5, 0.01], [-9.0, 2.0, 0.3]])
    batch = Batch(base, paths, wanted, angles=ANGLES)
    figures, reasons = batch(values)
    assert not reasons.any()
    for row, got in zip(values, figures, strict=True):
        given = base
        for path, value in zip(paths, row, strict=True):
            given = given.with_number(path, float(value))
        summary = eq.analyze(given, ANGLES).summary
        np.testing.assert_allclose(got, [summary[f.signal].rms for f in wanted], rtol=1e-10)
    joint = next(iter(eq.analyze(base, 8).forces.joints))
    can = can_compute(base, paths, Figure(f"joints.{joint}", "rms"))
    idle = idle_teeth_notes(assemble(base), eq.analyze(base, 180).forces.solved.state)
    many = sum(coupling.switches for coupling in base.couplings) > MOST_SWITCHING
    assert can == (not many and not any(idle))  # these are left to single analyses
    with refused(UsageError, by="Batch.__init__"):
        Batch(base, [f"links.{link}.points.A.x"], wanted)


@pytest.mark.parametrize("name", ["straw-walker", "parallel_cranks", "double_guide"])
def test_forces_that_joints_share(name: str, numpy_engine: None) -> None:
    """As of an analysis of each design, and of least squares on all its free bodies at once."""
    base = eq.load(name) if "-" in name else make(name, 1).machine
    link = next(name for name, item in base.links.items() if item.mass)
    own = (str(KeyPath(("links", link, *keys))) for keys in (("mass",), ("center_of_mass", "y")))
    numbers = named(base, *own, "drive.speed")
    mass, y, speed = (number.value for number in numbers)
    joints = [*eq.analyze(base, 8).forces.joints]
    wanted = [Figure(f"joints.{joint}", "rms") for joint in joints]
    values = np.array([[mass, y, speed], [2.5 * mass, y + 0.02, -0.7 * speed]])
    figures, reasons = Batch(base, paths_of(numbers), wanted, angles=ANGLES)(values)
    assert not reasons.any()
    for row, got in zip(values, figures, strict=True):
        machine = design(base, numbers, row)
        analysis = eq.analyze(machine, ANGLES)
        known = [analysis.summary[figure.signal].rms for figure in wanted]
        largest = max(known)
        np.testing.assert_allclose(got, known, rtol=1e-9, atol=1e-9 * largest)
        free = free_bodies.solve(machine, from_motion(machine, analysis.motion)).joints
        for joint, value in analysis.forces.joints.items():
            least = free[joint].force @ [1, 1j]
            np.testing.assert_allclose(value.value, np.squeeze(least), atol=1e-8 * largest)


@pytest.mark.parametrize("name", ["straw-walker", "double_guide", "rocking_screen"])
@pytest.mark.parametrize("stiff", [False, True])
def test_forces_that_are_shared_with_teeth_or_by_stiffness(
    name: str, stiff: bool, numpy_engine: None
) -> None:
    """As of an analysis of each design, in which all teeth bear on one flank."""
    base = eq.load(name) if "-" in name else make(name, 1).machine
    shared = assemble(base).shared
    assert shared is not None
    if stiff:
        each = enumerate(shared.names, 1)
        given = (JointProperties(joint, stiffness=1e5 * (9 + number)) for number, joint in each)
        base = replace(base, joints=tuple(given))
    link = next(name for name, item in base.links.items() if item.mass)
    numbers = named(base, str(KeyPath(("links", link, "mass"))), "drive.speed")
    analysis = eq.analyze(base, 8)
    names = [f"joints.{joint}" for joint in analysis.forces.joints]
    names += [f"gears.{gear.name}" for gear in base.gears]
    mass, speed = (item.value for item in numbers)
    values = np.array([[mass, speed], [1.5 * mass, 0.7 * speed]])
    wanted = [Figure(name, "rms") for name in names]
    figures, reasons = Batch(base, paths_of(numbers), wanted, angles=ANGLES)(values)
    assert not reasons.any()
    for row, got in zip(values, figures, strict=True):
        own = numbered(base, numbers, row)
        summary = eq.analyze(own, ANGLES).summary
        known = [summary[name].rms for name in names]
        np.testing.assert_allclose(got, known, rtol=1e-9, atol=1e-9 * max(known))
    if stiff:
        bare = eq.analyze(replace(own, joints=()), ANGLES).summary
        assert not np.allclose(known, [bare[name].rms for name in names], rtol=1e-3)


def test_forces_that_are_shared_with_a_belt(numpy_engine: None) -> None:
    """Cranks that a body keeps parallel, and a belt too; with its strands."""
    base = make("parallel_cranks", 1).machine
    start = float(eq.move(base, [0.0]).links["follower 1"].angle[0])
    belt = Belt("crank", "follower 1", radii=(0.03, 0.03), tension=400.0, start=start)
    base = replace(base, belts=(belt,))
    assert assemble(base).shared is not None
    outputs = eq.analyze(base, 8).outputs
    names = [array.name for array in outputs.arrays if array.name.startswith("belts.")]
    assert {f"belts.{belt.name}.pull", f"belts.{belt.name}.left"} <= {*names}
    weighed(base, [*names, "drive_torque", "joints.B1"])


@pytest.mark.parametrize("name", few(["transplanter", "rotary-transplanter"], {"transplanter"}))
def test_fingers_in_soil(name: str, numpy_engine: None) -> None:
    """Where the motion of the tip is that of the base."""
    base = eq.load(name).without_friction()
    assert base.in_soil
    signals = ["frame_force", "frame_moment", "drive_torque"]
    signals += [f"joints.{joint}" for joint in eq.analyze(base, 8).forces.joints]
    assert weighed(base, signals) != weighed(replace(base, planting=None), signals)


@pytest.mark.parametrize("name", ["cutter-bar", "two-motor-mixer"])
def test_resistances_and_friction(name: str, numpy_engine: None) -> None:
    """What friction changes is refused, all else is as in analyses, which have the friction."""
    base = eq.load(name)
    assert base.rubs or base.resistances
    analysis = eq.analyze(base, 8)
    names = [array.name for array in analysis.outputs.arrays]
    known = signals_in_loops(assemble(base), names)
    free = signals_in_loops(assemble(base.without_friction()), names)
    changed = {name for name in names if declared(name)[0].by_friction}
    assert {*known} == {*free} - (changed if base.rubs else set())
    # where friction sets in analyses have further angles, so that tops between angles differ
    weighed(base, known, ["rms"] if base.rubs else ["rms", "max"])


def weighed(
    base: Machine, signals: Sequence[str], names: Sequence[str] = ("rms", "max")
) -> list[list[float]]:
    """Compare designs of which a mass and the speed vary, of any machine; give their figures."""
    link = next(name for name, item in base.links.items() if item.mass)
    numbers = named(base, str(KeyPath(("links", link, "mass"))), "drive.speed")
    mass, speed = (number.value for number in numbers)
    values = np.array([[mass, speed], [1.5 * mass, 0.7 * speed]])
    wanted = wanted_of(signals, *names)
    figures, reasons = Batch(base, paths_of(numbers), wanted, angles=ANGLES)(values)
    assert not reasons.any()
    for row, got in zip(values, figures, strict=True):
        own = numbered(base, numbers, row)
        same_figures(got, wanted, known_of(own, ANGLES, signals), ANGLES, TOLERANCE)
    return [[*map(float, row)] for row in figures]


CAMS = [(kind, seed) for kind in machines_cams.KINDS for seed in range(3)]


@pytest.mark.exhaustive(but=["pusher_lever-0", "fixed_cam_tappet-0", "camshaft_lever-0"])
@pytest.mark.parametrize(("kind", "seed"), CAMS)
def test_cams(kind: str, seed: int, numpy_engine: None) -> None:
    """Laws that the crank angle tells, and such as are looked up at each design's own angle."""
    base = machines_cams.make(kind, seed).machine
    assert compared(base, 12, seed)


def test_a_cam_of_many_rows(numpy_engine: None) -> None:
    """More pieces than are told apart by comparing."""
    base = eq.load("cam-pusher")
    (cam,) = base.cams
    angles = tuple(np.linspace(0.0, 2 * np.pi, 31)[:-1] + 0.03 * np.cos(np.arange(30)))
    heights = tuple(0.006 * (1 - np.cos(angle)) for angle in angles)
    rows = LengthLaw(crank_angles=angles, values=heights, phase=1.0)
    base = replace(base, cams=(replace(cam, lift=rows),))
    wanted = wanted_of(["drive_torque", f"cams.{cam.name}.normal"], "rms", "max")
    wanted += wanted_of([f"cams.{cam.name}.pressure_angle"], "peak", "min_at")
    assert compared(base, 12, 2, wanted) > 3


BESIDE = ["slider_crank", "geared_counterweight", "belted_counterweight", "v_twin"]


@pytest.mark.exhaustive(but=["v_twin", "slider_crank"])
@pytest.mark.parametrize("kind", BESIDE)
def test_links_beside_each_other(kind: str, numpy_engine: None) -> None:
    """Rocking moments and bearings too, where planes vary, of a point as well."""
    base = make(kind, 1).machine
    base = replace(base, belts=tuple(replace(belt, tension=20.0) for belt in base.belts))
    base = set_apart(base, np.random.default_rng(2), flat=True)
    loose = next(name for name, k in base.links.items() if not k.points.keys() & base.frame.keys())
    base = base.with_link(loose, planes={next(iter(base.links[loose].points)): 0.02})
    known = {*signals_of(base)}
    assert known > {"rocking_moment.x", "frame_rocking_moment"}
    assert known > {f"bearings.{name}.force_x" for name in base.bearings}
    assert {f"links.{loose}.plane", 'bearings."left of crank".plane'} < {
        *paths_of(numbers_of(base))
    }
    assert compared(base, 3, 1)


def test_masses_in_planes_of_their_own(numpy_engine: None) -> None:
    """Of links that are made of bodies."""
    base = set_apart(make("slider_crank", 3).machine, np.random.default_rng(5))
    link = next(name for name, item in base.links.items() if item.bodies)
    path, wanted = f"links.{link}.bodies[2].mass", [Figure("rocking_moment", "rms")]
    wanted += [Figure(f"bearings.{name}", "peak") for name in base.bearings]
    masses = np.array([[0.3], [1.7]])
    figures, reasons = Batch(base, [path], wanted, angles=ANGLES)(masses)
    assert not reasons.any()
    for (mass,), got in zip(masses, figures, strict=True):
        heavier = base.with_number(f"links.{link}.bodies[2].mass", float(mass))
        summary = eq.analyze(heavier, ANGLES).summary
        for value, figure in zip(got, wanted, strict=True):
            assert value == pytest.approx(getattr(summary[figure.signal], figure.name), rel=1e-10)


# By NumPy: the test below; compiled loops of other machines: the tests above.
@pytest.mark.exhaustive
def test_every_dyad_compiled() -> None:
    base = every_dyad()
    used = {step.kernel.__name__ for step in assemble(base).motion if hasattr(step, "kernel")}
    assert used == {"in_ratio", "point", "rrr", "rrp", "rpr", "rpp", "prp"}
    wanted = [*wanted_of(FEW, "rms", "peak_to_peak"), *wanted_of(FEW[:1], "mean", "peak_at")]
    assert compared(base, 12, 3, wanted) > 6


def test_every_signal_of_every_dyad(numpy_engine: None) -> None:
    assert compared(every_dyad(), 4, 5)


def test_gears_in_proportion_to_the_crank_compiled() -> None:
    base = eq.load("planetary-planting-arm")
    assert compared(base, 6, 3, wanted_of(["shaking_force.x", "joints.B"], "rms", "min_at"))


# -- gears -----------------------------------------------------------------------------------------


def train(first: float, second: float, driver: str = "rocker", carrier: str = "frame") -> Machine:
    """A four-bar one of whose links drives a gear that drives another one."""
    centers = {"W": (6.0, -2.0), "V": (7.0, -4.0)} if carrier == "frame" else {}
    held = {} if centers else {"W": (1.0, 2.0), "V": (2.0, 2.5)}
    return machine(
        {"A": (0.0, 0.0), "D": (3.0, 0.3), **centers},
        {
            "crank": heavy(A=(0.0, 0.0), B=(1.0, 0.1), **(held if carrier == "crank" else {})),
            "coupler": heavy(B=(0.0, 0.0), C=(3.0, 0.0)),
            "rocker": heavy(D=(0.0, 0.0), C=(2.5, 0.0)),
            "first": heavy(W=(0.0, 0.0), U=(0.3, 0.1)),
            "second": heavy(V=(0.0, 0.0), T=(0.1, 0.1)),
        },
        assembly={"C": "left"},
        gears=(
            Gear(driver, "first", first, carrier=carrier, start=0.4),
            Gear("first", "second", second, carrier=carrier, start=-2.9),
        ),
    )


@pytest.mark.exhaustive(but=["several turns", "planets round the frame", "gear on a gear"])
@pytest.mark.parametrize(
    ("base", "turns"),
    [
        pytest.param(train(-1.7, -0.3), 1, id="swinging driver, any ratio"),
        pytest.param(train(2.5, -0.4), 1, id="gear on a gear"),
        pytest.param(train(-0.5, 1 / 3, driver="crank"), 6, id="several turns"),
        pytest.param(train(-1.5, -2.0, "coupler", "crank"), 2, id="turning carrier"),
        pytest.param(train(0.75, -1.5, "frame", "crank"), 8, id="planets round the frame"),
    ],
)
def test_train_of_gears(base: Machine, turns: int, numpy_engine: None) -> None:
    assert assemble(base).cycle.turns == turns
    assert compared(base, 4, 7) >= 2


def test_driver_that_turns_fully(numpy_engine: None) -> None:
    """A gear behind a drag link winds on with it, in a cycle of three turns."""
    four = eq.load("drag-link")
    rocker = assemble(four).groups[0].links[1]
    links = {**four.links, "weight": heavy(W=(0.0, 0.0), U=(0.03, 0.0))}
    base = machine(
        {**four.frame, "W": (1.0, -5.0)},
        links,
        assembly=dict(four.assembly),
        drive=four.drive,
        gears=(Gear(rocker, "weight", -1 / 3),),
    )
    assert assemble(base).cycle.turns == 3
    assert compared(base, 4, 1)


def test_other_windings_are_right_or_reported(numpy_engine: None) -> None:
    """A rocker may become a link that turns fully; then the gear behind it turns on too."""
    base = train(-2.0, -0.5)
    numbers = named(base, "frame.points.D.x", "links.crank.points.B.x")
    values = np.array([[3.0, 1.0], [1.0, 3.2], [0.5, 3.1], [3.1, 0.9]])
    signals = ["shaking_force.y", "drive_torque"]
    wanted = wanted_of(signals)
    figures, reasons = Batch(base, paths_of(numbers), wanted, angles=ANGLES)(values)
    assert list(reasons[[0, 3]]) == [0, 0]
    for row, got, reason in zip(values, figures, reasons, strict=True):
        assert reason_of(base, numbers, row) == 0
        assert reason in (0, 6)
        if reason == 0:
            known = known_of(design(base, numbers, row), ANGLES, signals)
            same_figures(got, wanted, known, ANGLES, TOLERANCE)
