"""Sources: valid whatever things are called, and nothing but arithmetic."""

from __future__ import annotations

import ast
import builtins
import keyword
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest

import equipoise as eq
from equipoise.codegen.batch import Batch
from equipoise.codegen.emit import can_emit, emit
from equipoise.codegen.figures import Figure, Gathered
from equipoise.codegen.source import NUMPY, TermSource
from equipoise.errors import MassError, UsageError
from equipoise.mechanism.assembly.linkage import assemble
from equipoise.mechanism.parts.machine import FRAME, Drive, Link, Machine
from laws.transforms import renamed
from support.batches import WRITTEN, by_numpy, every_dyad, known_of, same_figures, signals_of
from support.designs import design, drawn, numbers_of, paths_of
from support.machines import make
from support.refusals import refused
from unit.mechanism.build import four_bar


def source_of(machine: Machine, *signals: str) -> TermSource:
    wanted = [Figure(signal, "rms") for signal in signals or signals_of(machine)]
    return emit(assemble(machine), Gathered.of(wanted))


# -- what is written -------------------------------------------------------------------------------


@pytest.mark.parametrize("kind", WRITTEN)
def test_a_loop_is_arithmetic_on_what_it_knows(kind: str) -> None:
    """Every name is given before it is used, once, and nothing but NumPy's functions is called."""
    module = ast.parse(source_of(make(kind, 0).machine).text)
    names = [node for node in ast.walk(module) if isinstance(node, ast.Name)]
    stored = [name.id for name in names if isinstance(name.ctx, ast.Store)]
    loaded = {name.id for name in names if isinstance(name.ctx, ast.Load)}
    called = {node.func.id for node in ast.walk(module) if isinstance(node, ast.Call)}  # type: ignore[attr-defined]
    values = [name for name in stored if name.startswith("v")]
    assert values
    assert len(values) == len({*values})
    assert called <= {*NUMPY, "range", "empty"}
    assert loaded - called <= {*stored, "table", "grid", "out"}


def test_numbers_are_not_in_the_source() -> None:
    """Machines of one build share a loop, whatever their lengths, masses and speed."""
    first = make("crank_rocker", 1).machine
    numbers = numbers_of(first, 0.02)
    other = design(first, numbers, drawn(numbers, 1, 3)[0])
    assert other != first
    assert source_of(first).text == source_of(other).text


def test_only_what_is_asked_for() -> None:
    """Masses and joints are traced where a signal depends on them, and nowhere else."""
    bare = source_of(four_bar(3.0, 1.0, 3.0, 2.5), "points.C.vx")
    assert not any(slot.name.startswith(("mass", "gravity")) for slot in bare.slots)
    shaken = source_of(four_bar(3.0, 1.0, 3.0, 2.5), "drive_torque")
    assert any(slot.name.startswith("mass") for slot in shaken.slots)
    borne = source_of(four_bar(3.0, 1.0, 3.0, 2.5), "drive_torque", "joints.C")
    assert len(bare.text) < len(shaken.text) < len(borne.text)


def test_slots_read_any_linkage() -> None:
    machine = make("stephenson", 0).machine
    source = source_of(machine)
    for slot in source.slots:
        value = slot.read(assemble(machine))
        assert isinstance(complex(value), complex)
        assert slot.vector or not np.iscomplexobj(value)


# -- names -----------------------------------------------------------------------------------------

STRANGE = {
    "spaces": lambda k, name: f"  the {name} no. {k} ",
    "umlauts": lambda k, name: "äöüßéñ点线Ω∂"[k % 10] * (1 + k // 10),
    "digits": lambda k, name: str(k),
    "keywords": lambda k, name: sorted(keyword.kwlist)[k],
    "functions": lambda k, name: [*NUMPY, *"abcdefghijklmnopqrstuvwxyz"][k],
    "names of the loop": lambda k, name: (
        [*"xgikn", "out", "grid", "x0", "g0", "table"][k % 10] + ("" if k < 10 else f"_{k // 10}")
    ),
    "builtins": lambda k, name: [n for n in dir(builtins) if n[0].islower()][k],
    "the same identifier": lambda k, name: "a" + "-_ .:+"[k % 6] * (1 + k // 6),
    "names of values": lambda k, name: (
        ["p", "u", "w", "phi", "mass", "arm", "speed"][k % 7]
        + ("_" + "abcdefghi"[k // 7] if k > 6 else "")
    ),
    "quotes": lambda k, name: "\"'\\{}%()[]"[k % 10] * (1 + k // 10),
    "long": lambda k, name: f"{k:x>199}",
}


@pytest.fixture
def numpy_engine(tmp_path: Path) -> Iterator[None]:
    with by_numpy(tmp_path):
        yield


def same_under_other_names(
    base: Machine, rename: Callable[[int, str], str], signals: dict[str, str]
) -> None:
    """Compare a batch of a renamed machine with one of the machine, and with an analysis of it.

    signals : of the machine, each with the pattern of its name.
    """
    points = dict.fromkeys([*base.frame, *(p for b in base.links.values() for p in b.points)])
    new = {name: rename(k, name) for k, name in enumerate([*points, *base.links])} | {FRAME: FRAME}
    other = renamed(base, new.__getitem__)
    numbers = numbers_of(other, 1e-3)
    values = drawn(numbers, 3, 1)
    values[0] = [number.value for number in numbers]
    plain = [Figure(signal, "rms") for signal in signals]
    called = [Figure(pattern.format_map(new), "rms") for pattern in signals.values()]
    figures, reasons = Batch(other, paths_of(numbers), called, angles=24)(values)
    text, why = Batch(base, paths_of(numbers_of(base, 1e-3)), plain, angles=24)(values)
    assert not reasons.any()
    assert not why.any()
    assert np.array_equal(figures, text)
    known = known_of(other, 24, [figure.signal for figure in called])
    same_figures(figures[0], called, known, 24, 1e-10)


@pytest.mark.exhaustive(but=["quotes", "builtins", "umlauts", "the same identifier"])
@pytest.mark.parametrize("names", STRANGE)
def test_strange_names(names: str, numpy_engine: None) -> None:
    signals = {
        "shaking_force": "shaking_force",
        "points.P.vx": "points.{P}.vx",
        "links.weight.angular_velocity": "links.{weight}.angular_velocity",
        "joints.C": "joints.{C}",
        "joints.B/rod.force_x": "joints.{B}/{rod}.force_x",
        "joints.piston on frame.moment": "joints.{piston} on frame.moment",
        "gears.rocker to weight": "gears.{rocker} to {weight}",
    }
    same_under_other_names(every_dyad(), STRANGE[names], signals)


# The same names without compiling: the test above.
@pytest.mark.exhaustive
def test_strange_names_compiled() -> None:
    names = ["lambda", "rrr", "x0", "B 1", "B_1", "ä", "1", "state"]
    signals = {"shaking_force": "shaking_force", "joints.C": "joints.{C}"}
    same_under_other_names(four_bar(3.0, 1.0, 3.0, 2.5), lambda k, _: names[k], signals)


# -- what cannot be written ------------------------------------------------------------------------


@pytest.mark.parametrize(
    "signal",
    [
        "",
        "points",
        "points.B",
        "points.Q.x",
        "points.B.z",
        "links.crank.angle",
        "links.frame.angular_velocity",
        "joints.Q",
        "joints.B.moment",
        "joints.B.normal",
        "joints",
        "shaking_force.z",
        "torque",
        "drive_force",
        "rocking_moment",
    ],
)
def test_unknown_signal(signal: str) -> None:
    with refused(UsageError, given=signal):
        source_of(four_bar(3.0, 1.0, 3.0, 2.5), signal)


@pytest.mark.parametrize(
    ("name", "signal", "meant"),
    [
        ("knife-drive", "belts.shaft to crank", "belts.shaft to crank.pull"),
        ("yamashita-1", "drive_force", "drive_torque"),
    ],
)
def test_what_is_proposed_in_place_of_an_unknown_signal_is_there(
    name: str, signal: str, meant: str
) -> None:
    machine = eq.load(name)
    with refused(UsageError, given=signal, name=meant):
        source_of(machine, signal)
    assert source_of(machine, meant)


def test_forces_need_masses() -> None:
    bare = four_bar(3.0, 1.0, 3.0, 2.5).with_link(
        "rocker", mass=None, center_of_mass=None, inertia=None
    )
    assert source_of(bare, "points.C.ax")
    with refused(MassError, links="rocker"):
        source_of(bare, "shaking_force.x")


def test_forces_that_joints_share_are_refused_where_no_formula_holds() -> None:
    """Many teeth, and joints that let go."""
    train = make("planet_train", 1).machine
    square = Machine(
        "square", Drive("crank", 10.0),
        {"A": (0.0, 0.0), "D": (0.2, 0.0)},
        {
            "crank": Link({"A": (0.0, 0.0), "B": (0.05, 0.0)}, 1.0, (0.02, 0.0), 1e-3),
            "coupler": Link({"B": (0.0, 0.0), "C": (0.2, 0.0)}, 1.0, (0.1, 0.0), 1e-3),
            "rocker": Link({"D": (0.0, 0.0), "C": (0.05, 0.0)}, 1.0, (0.02, 0.0), 1e-3),
        },
        assembly={"mode": "parallel"},
    )  # fmt: skip
    for machine in (train, square):
        assert assemble(machine).shared is not None
        joint = next(iter(assemble(machine).named_reactions))[0]
        with refused(UsageError, by="check_shared"):
            source_of(machine, f"joints.{joint}")


@pytest.mark.parametrize("name", eq.examples("linkage"))
def test_every_bundled_machine_can_be_written(name: str) -> None:
    assert can_emit(assemble(eq.load(name)))
