"""Numbers of a cam's law as columns of designs, beside each design's own machine."""

from __future__ import annotations

import pickle
from collections.abc import Sequence
from dataclasses import replace
from math import radians
from pathlib import Path

import numpy as np
import pytest

import equipoise as eq
from equipoise.codegen.batch import Batch, jumps_alike
from equipoise.codegen.coupled import curve_value
from equipoise.codegen.emit import can_compute
from equipoise.codegen.figures import COMPUTED, NO_MACHINE, Figure, figure_of
from equipoise.codegen.source import on_arrays
from equipoise.codegen.terms import ANGLE
from equipoise.codegen.trace import Trace
from equipoise.errors import ModelError
from equipoise.keys import changed, with_fields
from equipoise.keys.paths import KeyPath
from equipoise.mechanism.assembly.family import can_vary
from equipoise.mechanism.assembly.linkage import assemble
from equipoise.mechanism.parts.laws import AngleLaw, LengthLaw, LengthSegment
from equipoise.mechanism.parts.machine import Machine
from equipoise.schema.template import Template
from support.batches import by_numpy, known_of, same_figures, wanted_of
from support.machines_cams import make

SIGNALS = ("shaking_force.x", "drive_torque", "cams.crank to pusher.normal")

SWING = LengthLaw(between=(0.0, 0.012), phase=radians(70))
SEGMENTS = LengthLaw(
    start=0.0,
    segments=(
        LengthSegment(over=radians(100), to=0.012, law="3-4-5"),
        LengthSegment(over=radians(60), to=0.012),
        LengthSegment(over=radians(120), to=0.004, law="modified sine"),
        LengthSegment(over=radians(80), to=0.0),
    ),
    phase=1.0,
)
JUMPING = LengthLaw(
    segments=(
        LengthSegment(over=radians(180), to=0.01, law="harmonic"),
        LengthSegment(over=radians(180), to=0.0, law="cycloidal"),
    )
)
ROWS = LengthLaw(
    crank_angles=tuple(np.radians([0, 60, 120, 200, 280]).tolist()),
    values=(0.0, 0.004, 0.01, 0.008, 0.002),
    phase=0.5,
)


CLOSED = LengthLaw(
    crank_angles=tuple(np.radians([0, 60, 120, 200, 280, 360]).tolist()),
    values=(0.001, 0.004, 0.01, 0.008, 0.002, 0.001),
)


def pusher(law: LengthLaw) -> Machine:
    """The bundled cam with another law."""
    machine = eq.load("cam-pusher")
    (cam,) = machine.cams
    return replace(machine, cams=(replace(cam, lift=law),))


def design(base: Machine, paths: Sequence[str], values: Sequence[float]) -> Machine:
    for path, value in zip(paths, values, strict=True):
        base = changed(base, KeyPath.parse(path), lambda _, value=value: value)
    return base


@pytest.mark.parametrize(
    ("law", "keys", "values"),
    [
        (SWING, ("between[2]",), [[0.010], [0.014]]),
        (SWING, ("between[1]", "between[2]"), [[0.001, 0.009], [-0.001, 0.013]]),
        (SWING, ("phase",), [[0.2], [1.4], [-2.0]]),
        (SWING, ("phase", "between[2]"), [[0.2, 0.011], [1.4, 0.013]]),
        (SEGMENTS, ("segments[1].to",), [[0.011], [0.0125]]),
        (SEGMENTS, ("segments[1].to", "segments[3].to"), [[0.0115, 0.005], [0.0122, 0.001]]),
        (SEGMENTS, ("segments[2].to", "phase"), [[0.0125, 0.7], [0.0118, 1.3]]),
        (ROWS, ("values[2]", "values[4]"), [[0.0042, 0.0083], [0.0038, 0.0078]]),
        (ROWS, ("values[3]", "phase"), [[0.0105, 0.3], [0.0095, 0.9]]),
        (CLOSED, ("values[3]", "phase"), [[0.0105, 0.3], [0.0095, 0.9]]),
    ],
)
def test_designs_are_their_own_machines(
    law: LengthLaw, keys: Sequence[str], values: list[list[float]], tmp_path: Path
) -> None:
    base, paths = pusher(law), [f"cams[1].lift.{key}" for key in keys]
    wanted = wanted_of(SIGNALS)
    assert all(can_compute(base, paths, figure) for figure in wanted)
    with by_numpy(tmp_path):
        figures, reasons = Batch(base, paths, wanted, angles=180)(np.array(values))
    assert not reasons.any()
    for row, own in zip(figures, values, strict=True):
        known = known_of(design(base, paths, own), 180, SIGNALS)
        same_figures(row, wanted, known, 180, 1e-9)


@pytest.mark.parametrize("law", [SWING, SEGMENTS, ROWS])
def test_curves_in_loops_are_those_of_an_analysis(law: LengthLaw) -> None:
    """Over several turns, whatever a part of it is in the file or becomes of an amount of 0."""
    trace = Trace(assemble(pusher(law)))
    angle = trace.graph.argument("angle", ANGLE)
    at = np.linspace(-8.0, 8.0, 801)
    flat = law.with_amounts(dict.fromkeys([*law.amounts][:1], 0.0)).curve
    for curve in (law.curve, flat, *map(law.unit_curve, law.amounts)):
        states = on_arrays(curve_value(trace, curve, angle))
        for value, own in zip(states(at), curve.at(at), strict=True):
            assert np.allclose(value, own, rtol=0, atol=1e-12 * np.max(np.abs(own), initial=1e-3))


def test_designs_that_cannot_be_made(tmp_path: Path) -> None:
    """Those that the checks of each machine refuse, and no others."""
    base, paths = pusher(SEGMENTS), ["cams[1].lift.segments[3].to", "cams[1].base_radius"]
    values = [[lift, radius] for lift in (0.004, -0.01, -0.02) for radius in (0.01, 0.018)]
    with by_numpy(tmp_path):
        _, reasons = Batch(base, paths, [Figure("shaking_force.x", "rms")], 60)(np.array(values))
    refused = []
    for own in values:
        try:
            eq.analyze(design(base, paths, own), 8)
        except ModelError:
            refused.append(NO_MACHINE)
        else:
            refused.append(COMPUTED)
    assert reasons.tolist() == refused
    assert {*refused} == {COMPUTED, NO_MACHINE}


def test_a_swing_is_its_own_machine(tmp_path: Path) -> None:
    """A pinned follower, whose law is an angle."""
    base = make("camshaft_lever", 0).machine
    (cam,) = base.cams
    swing = AngleLaw(between=(0.0, 0.15), phase=0.2)
    base = replace(base, cams=(replace(cam, swing=swing),))
    paths = ["cams[1].swing.between[2]", "cams[1].swing.phase"]
    wanted = wanted_of(["shaking_force.x", "drive_torque"])
    values = [[0.12, 0.5], [0.17, -0.4]]
    with by_numpy(tmp_path):
        figures, reasons = Batch(base, paths, wanted, angles=180)(np.array(values))
    assert not reasons.any()
    for row, own in zip(figures, values, strict=True):
        known = known_of(design(base, paths, own), 180, ["shaking_force.x", "drive_torque"])
        same_figures(row, wanted, known, 180, 1e-9)


def test_a_law_that_jumps_begins_elsewhere_in_each_design(tmp_path: Path) -> None:
    """As many crank angles are taken as hold the jumps of each."""
    base, paths = pusher(JUMPING), ["cams[1].lift.phase"]
    assert not jumps_alike(assemble(base), paths)
    values = [[0.3], [2.0]]
    with by_numpy(tmp_path):
        batch = Batch(base, paths, [Figure("shaking_force.x", "rms")], tolerance=1e-3)
        figures, reasons = batch(np.array(values))
    assert not reasons.any()
    for (value,), own in zip(figures.tolist(), values, strict=True):
        exact = eq.analyze(design(base, paths, own)).summary["shaking_force.x"].rms
        assert value == pytest.approx(exact, rel=1e-3)


def test_many_designs_are_looked_at_by_parts(tmp_path: Path) -> None:
    """Also those that are near to what cannot be made."""
    base, paths = pusher(SEGMENTS), ["cams[1].lift.segments[3].to", "cams[1].base_radius"]
    values = np.array([[low, 0.01] for low in np.linspace(-0.012, 0.004, 300)])
    with by_numpy(tmp_path):
        _, reasons = Batch(base, paths, [Figure("shaking_force.x", "rms")], 60)(values)
    feasible = np.flatnonzero(reasons == COMPUTED)
    border = feasible[0]
    assert 128 < len(feasible) < 300 and feasible.tolist() == [*range(border, 300)]
    eq.analyze(design(base, paths, values[border].tolist()), 8)
    with pytest.raises(ModelError):
        eq.analyze(design(base, paths, values[border - 1].tolist()), 8)


def test_ends_of_a_lift_have_numbers_as_in_a_file() -> None:
    """They are no point with x and y; so studies and interactive files vary them in loops."""
    numbers = Template.of(pusher(SWING)).numbers()
    assert {"cams[1].lift.between[1]", "cams[1].lift.between[2]"} < numbers.keys()
    assert not any(path.endswith((".between.x", ".between.y")) for path in numbers)
    assert "links.crank.points.B.x" in numbers
    assert can_vary(pusher(SWING), "cams[1].lift.between[2]")


def test_names_in_quotes_are_those_of_signals() -> None:
    """As figures of studies write names that hold spaces."""
    quoted, bare = (figure_of(f"cams.{q}crank to pusher{q}.normal.min") for q in ('"', ""))
    assert quoted == bare == Figure("cams.crank to pusher.normal", "min")


@pytest.mark.parametrize(
    ("law", "key"),
    [
        (SEGMENTS, "segments[4].to"),  # the start of the next turn
        (SEGMENTS, "start"),
        (SEGMENTS, "segments[1].over"),  # where all knots after it are
        (JUMPING, "segments[2].to"),
        (ROWS, "crank_angles[2]"),
        (CLOSED, "values[1]"),  # and the last, which is the same place
        (CLOSED, "values[6]"),
    ],
)
def test_numbers_that_others_follow_are_no_columns(law: LengthLaw, key: str) -> None:
    assert not can_vary(pusher(law), f"cams[1].lift.{key}")


def test_laws_that_would_jump_elsewhere_are_no_columns() -> None:
    """A rest between harmonic segments has no jump of acceleration at its end; a design would."""
    first = LengthSegment(over=radians(90), to=0.01)
    still = LengthSegment(over=radians(90), to=0.01, law="harmonic")
    last = LengthSegment(over=radians(180), to=0.0)
    resting = pusher(LengthLaw(segments=(first, still, last)))
    assert not can_vary(resting, "cams[1].lift.segments[2].to")
    assert can_vary(pusher(JUMPING), "cams[1].lift.segments[1].to")


def test_copies_take_along_nothing_that_was_computed() -> None:
    """Of a law: its curve and those of its amounts, which are of the old values."""
    law = LengthLaw(between=(0.0, 0.01))
    before = law.value(np.array([1.0]))[0]
    other = with_fields(law, between=(0.0, 0.02))
    assert other.value(np.array([1.0]))[0] == pytest.approx(2 * before)
    assert not {"curve", "amounts"} & vars(pickle.loads(pickle.dumps(law))).keys()
