"""Batches: designs that fail, one by one; how many crank angles it takes; nothing else matters."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from functools import cache
from math import cos, pi, sin
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import equipoise as eq
from equipoise.codegen.batch import Batch
from equipoise.codegen.emit import can_compute
from equipoise.codegen.figures import GATHERED, PLACES, Figure, Gathered, figure_of
from equipoise.errors import ChangePointError, ModelError, RangeError, UsageError
from equipoise.mechanism.assembly.linkage import assemble
from equipoise.mechanism.parts.gear_shapes import GearShape
from equipoise.mechanism.parts.gears import Gear
from equipoise.mechanism.parts.machine import Load, LoadTable, Machine, Slider
from support.batches import WRITTEN, by_numpy, known_of, wanted_of
from support.chosen import few
from support.designs import (
    Array,
    Number,
    design,
    drawn,
    geometry_of,
    named,
    numbers_of,
    paths_of,
    reason_of,
)
from support.machines import make
from support.refusals import refused
from unit.mechanism.build import four_bar, heavy, machine

FOUR = four_bar(3.0, 1.0, 3.0, 2.5)
LENGTHS = (
    "frame.points.D.x",
    "frame.points.D.y",
    "links.crank.points.B.x",
    "links.coupler.points.C.x",
    "links.rocker.points.C.x",
)
RMS = wanted_of(["shaking_force.y"], "rms")
COUNTS = (60, 128, 360)


@pytest.fixture
def numpy_engine(tmp_path: Path) -> Iterator[None]:
    with by_numpy(tmp_path):
        yield


def same_reasons(
    base: Machine, numbers: Sequence[Number], values: Array, counts: Sequence[int | None] = COUNTS
) -> list[int]:
    """Compare the reasons with those of each design's own machine, however many crank angles."""
    texts = [reason_of(base, numbers, row) for row in values]
    for count in counts:
        figures, reasons = Batch(base, paths_of(numbers), RMS, angles=count)(values)
        off = [k for k, why in enumerate(texts) if why != reasons[k]]
        assert not off, (
            f"{len(off)} of {len(values)} differ at {count} crank angles, such as "
            f"{values[off[0]].tolist()}: {reasons[off[0]]}, not {texts[off[0]]}"
        )
        assert np.array_equal(np.isnan(figures).any(axis=1), reasons != 0)
    return texts


# -- why designs fail ------------------------------------------------------------------------------


def laid(rng: np.random.Generator, frame: float, *lengths: float) -> list[float]:
    """Numbers of a four-bar whose frame points anywhere."""
    angle = rng.uniform(-pi, pi)
    return [frame * cos(angle), frame * sin(angle), *lengths]


def anywhere(rng: np.random.Generator) -> list[float]:
    return laid(rng, *rng.uniform(0.2, 3, 4))


def at_the_border(rng: np.random.Generator, off: float) -> list[float]:
    """A four-bar whose crank just can, or cannot, pass one of its two positions in line."""
    crank = rng.uniform(0.2, 0.6)
    coupler, rocker = rng.uniform(0.8, 2), rng.uniform(0.8, 2)
    if rng.random() < 0.5 or abs(coupler - rocker) < 0.05:
        frame = coupler + rocker - crank
    else:
        frame = abs(coupler - rocker) + crank
    return laid(rng, frame * (1 + off), crank, coupler, rocker)


def test_four_bars_of_any_lengths(numpy_engine: None) -> None:
    rng = np.random.default_rng(1)
    values = np.array([anywhere(rng) for _ in range(200)])
    assert set(same_reasons(FOUR, named(FOUR, *LENGTHS), values)) == {0, 1, 2}


@pytest.mark.exhaustive(but=["-4"])
@pytest.mark.parametrize("power", few([-8, -6, -4, -2], {-8, -4}))
def test_four_bars_about_the_border(power: int, numpy_engine: None) -> None:
    """Between crank angles a dyad may open, or close, by a hair."""
    rng = np.random.default_rng(-power)
    offs = rng.choice([-1, 1], 12) * 10.0 ** rng.uniform(power, power + 2, 12)
    values = np.array([at_the_border(rng, off) for off in offs])
    counts = COUNTS if power > -8 else COUNTS[:1]
    assert {0, 2} <= set(same_reasons(FOUR, named(FOUR, *LENGTHS), values, counts))


def test_four_bars_at_a_change_point(numpy_engine: None) -> None:
    """In whatever direction the crank lies there, be it between the crank angles or not."""
    rng = np.random.default_rng(3)
    values = np.array([at_the_border(rng, 0.0) for _ in range(5)])
    assert set(same_reasons(FOUR, named(FOUR, *LENGTHS), values, (128,))) == {3}


# Designs about the border: the tests of four-bars above.
@pytest.mark.exhaustive
def test_guides_that_come_to_lie_parallel(numpy_engine: None) -> None:
    """The number of two guides is a square: it touches zero there and is above it all around."""
    base = make("crossed_guides", 1).machine
    numbers = geometry_of(base, 0.3)
    values = drawn(numbers, 12, 1)
    assert {0, 3} <= set(same_reasons(base, numbers, values, (128,)))


# Change points: `test_four_bars_at_a_change_point`.
@pytest.mark.exhaustive
def test_change_point_before_a_gear(numpy_engine: None) -> None:
    """It is found too where a gear follows the rocker."""
    base, rng = with_gear("rocker", -2.0), np.random.default_rng(4)
    values = np.array([at_the_border(rng, 0.0) for _ in range(4)])
    same_reasons(base, named(base, *LENGTHS), values, (128,))


def opening(rng: np.random.Generator) -> list[float]:
    """A four-bar whose crank can move by 1 to 30 degrees to either side only."""
    crank, frame = rng.uniform(1, 2), rng.uniform(2.5, 4)
    half = rng.uniform(1, 30) * pi / 180
    reach = abs(frame - crank * np.exp(1j * half))
    return laid(rng, frame, crank, reach * 0.55, reach * 0.45)


# Four-bars of any lengths, some of which open: the first test of this file.
@pytest.mark.exhaustive
def test_four_bars_that_open_somewhere(numpy_engine: None) -> None:
    """A dyad that closes at some crank angles cannot turn fully; that is not to close at none."""
    rng = np.random.default_rng(5)
    values = np.array([opening(rng) for _ in range(60)])
    assert set(same_reasons(FOUR, named(FOUR, *LENGTHS), values)) == {2}


def elliptic(mean: float, eccentricity: float) -> Machine:
    """A four-bar whose crank turns a weight by elliptic gears."""
    base = with_gear("crank", mean)
    shape = GearShape("elliptic", eccentricity=eccentricity)
    return replace(base, gears=(replace(base.gears[0], shape=shape),))


def test_gears_of_varying_ratio_whose_laws_have_no_formula_go_the_other_way() -> None:
    base = elliptic(-1.0, 0.2)
    path, figure = "gears[1].shape.eccentricity", Figure("drive_torque", "rms")
    assert can_compute(base, [path, "gears[1].shape.phase"], figure)
    shape = replace(base.gears[0].shape, kind="eccentric")
    circle = replace(base, gears=(replace(base.gears[0], shape=shape),))
    assert can_compute(circle, ["gears[1].shape.phase"], figure)
    assert not can_compute(circle, [path], figure)
    assert not can_compute(circle, ["gears[1].shape.cosines[1]"], figure)


@pytest.mark.parametrize("mean", [-1.0, 0.5])
def test_pitch_curves_that_cannot_be_made(mean: float, numpy_engine: None) -> None:
    """Gears that would jam or cut their ring, on either side of where they begin to."""
    base = elliptic(mean, 0.1)
    path, e = "gears[1].shape.eccentricity", np.linspace(-0.1, 1.1, 61)[:, None]
    _, reasons = Batch(base, [path], RMS, angles=60)(e)
    texts = []
    for (first,) in e:
        try:
            elliptic(mean, float(first))
        except ModelError:
            texts.append(4)
        else:
            texts.append(0)
    assert reasons.tolist() == texts
    assert len(set(texts)) == 2


@pytest.mark.parametrize("kind", WRITTEN)
def test_designs_of_every_kind(kind: str, numpy_engine: None) -> None:
    """Links whose couplings turn on otherwise than the base's may be told as not computed, and so
    may those that torsion springs turn far from where their torque is known.
    """
    base = make(kind, 0).machine
    numbers = geometry_of(base, 0.15)
    values = drawn(numbers, 12, 0)
    reported = np.array([reason_of(base, numbers, row) for row in values])
    _, reasons = Batch(base, paths_of(numbers), RMS, angles=60)(values)
    reasons[(reasons == 6) & (reported == 0) & bool(base.couplings or base.torsion_springs)] = 0
    assert np.array_equal(reasons, reported)


def to_the_border(
    base: Machine, numbers: Sequence[Number], count: int, seed: int
) -> Iterator[Array]:
    """Designs just on either side of where the crank of some others begins to be stopped."""
    own = np.array([number.value for number in numbers])
    rng = np.random.default_rng(seed)
    for other in drawn(numbers, count, seed):
        low, high = 0.0, 1.0
        if reason_of(base, numbers, other) == 0:
            continue
        for _ in range(22):
            middle = (low + high) / 2
            moves = reason_of(base, numbers, own + middle * (other - own)) == 0
            low, high = (middle, high) if moves else (low, middle)
        for off in rng.choice([-1, 1], 3) * 10.0 ** rng.uniform(-5, -1, 3):
            yield own + low * (1 + off) * (other - own)


@pytest.mark.exhaustive(but=["slider_crank"])
@pytest.mark.parametrize(
    "kind",
    few(
        ["slider_crank", "quick_return", "stephenson", "guide_on_dyad"],
        {"slider_crank", "quick_return"},
    ),
)
def test_designs_about_the_border(kind: str, numpy_engine: None) -> None:
    base = make(kind, 1).machine
    numbers = geometry_of(base, 0.3)
    values = np.array(list(to_the_border(base, numbers, 8, 2)))
    assert {0, 2} <= set(same_reasons(base, numbers, values, (60, 128)))


# Designs about the border: the tests of four-bars above.
@pytest.mark.exhaustive
def test_block_that_passes_near_the_pivot_of_its_guide(numpy_engine: None) -> None:
    """The pivot may lie closer to the block than the guide's offset for a moment only."""
    base = machine(
        {"A": (0.0, 0.0), "D": (2.0, 0.0)},
        {
            "crank": heavy(A=(0.0, 0.0), B=(1.0, 0.0)),
            "block": heavy(B=(0.0, 0.0)),
            "rocker": heavy(D=(0.0, 0.0), H=(0.5, 0.1)),
        },
        assembly={"B": "forward"},
        sliders=(Slider("block", "B", "rocker", "H", 0.0, 0.0),),
    )
    rng = np.random.default_rng(0)
    values = []
    for offset in 10 ** rng.uniform(-3, -1, 20):
        gap = offset * rng.uniform(0.2, 1.8) * rng.choice([-1, 1])
        values.append([*laid(rng, 1 + gap), offset])
    numbers = named(base, "frame.points.D.x", "frame.points.D.y", "links.rocker.points.H.y")
    assert set(same_reasons(base, numbers, np.array(values))) == {0, 2}


def five_bar(ratio: float) -> Machine:
    return machine(
        {"A": (0.0, 0.0), "E": (3.0, 0.0)},
        {
            "crank": heavy(A=(0.0, 0.0), B=(1.0, 0.0)),
            "follower": heavy(E=(0.0, 0.0), D=(0.5, 0.0)),
            "left": heavy(B=(0.0, 0.0), C=(2.6, 0.0)),
            "right": heavy(D=(0.0, 0.0), C=(2.6, 0.0)),
        },
        assembly={"C": "left"},
        gears=(Gear("crank", "follower", ratio),),
    )


@pytest.mark.exhaustive(but=["-8.0"])
@pytest.mark.parametrize("ratio", few([2.5, -8.0, 12.0, -20.0], {-8.0, 12.0}))
def test_dyad_on_a_fast_gear(ratio: float, numpy_engine: None) -> None:
    """Its number dips as fast as the gear turns."""
    base, rng = five_bar(ratio), np.random.default_rng(7)
    theta = np.linspace(0, 4 * pi, 40_001)
    values = []
    for off in rng.choice([-1, 1], 16) * 10.0 ** rng.uniform(-5, -1, 16):
        crank, follower, frame = rng.uniform(0.5, 1.5), rng.uniform(0.2, 1.5), rng.uniform(3.5, 6)
        start = rng.uniform(-3, 3)
        apart = abs(
            frame + follower * np.exp(1j * (start + ratio * theta)) - crank * np.exp(1j * theta)
        )
        both = apart.max() * (1 + off)
        values.append([frame, crank, follower, 0.55 * both, 0.45 * both, start])
    paths = (
        "frame.points.E.x", "links.crank.points.B.x", "links.follower.points.D.x",
        "links.left.points.C.x", "links.right.points.C.x", "gears[1].start",
    )  # fmt: skip
    assert {0, 2} <= set(same_reasons(base, named(base, *paths), np.array(values), (60, 128)))


# -- designs do not know each other ----------------------------------------------------------------

SIGNALS = ["shaking_force.y", "joints.C", "drive_torque"]
WANTED = [*wanted_of(SIGNALS[:2], "rms", "peak_to_peak"), *wanted_of(SIGNALS[2:], "max_at")]


@cache
def compiled_batch(angles: int | None = None, threads: int | None = 1) -> Batch:
    """The same loop for all tests below."""
    return Batch(FOUR, paths_of(numbers_of(FOUR)), WANTED, angles, 1e-2, threads)


def mixed(count: int, seed: int = 0) -> Array:
    """Designs of which some fail, in every way."""
    numbers = numbers_of(FOUR, 0.12)
    values = drawn(numbers, count, seed)
    paths = paths_of(numbers)
    values[3::10, paths.index("links.rocker.mass")] = -1.0
    values[5::10, paths.index("links.crank.points.B.x")] = 9.0
    values[7::10, paths.index("frame.points.D.x")] = 5.6
    return values


# Failed designs among others: `test_designs_of_every_kind`.
@pytest.mark.exhaustive
def test_failed_designs_leave_others_alone() -> None:
    values = mixed(200)
    figures, reasons = compiled_batch()(values)
    assert {0, 1, 2, 4} <= set(reasons.tolist())
    assert np.array_equal(np.isnan(figures), (reasons != 0)[:, None] & np.ones(len(WANTED), bool))
    alone, fine = compiled_batch()(values[reasons == 0])
    assert not fine.any()
    assert alone.tobytes() == figures[reasons == 0].tobytes()


# By NumPy: `test_numpy_changes_no_bit_either`.
@pytest.mark.exhaustive
@pytest.mark.parametrize("angles", few([None, 60], {60}))
def test_order_and_splitting_change_no_bit(angles: int | None) -> None:
    values, batch = mixed(150), compiled_batch(angles)
    figures, reasons = batch(values)
    order = np.random.default_rng(1).permutation(len(values))
    shuffled, why = batch(values[order])
    assert shuffled.tobytes() == figures[order].tobytes()
    assert np.array_equal(why, reasons[order])
    for size in (1, 7, 64):
        parts = [batch(values[k : k + size])[0] for k in range(0, len(values), size)]
        assert np.concatenate(parts).tobytes() == figures.tobytes()


# Order and splitting change none either: the test above.
@pytest.mark.exhaustive
@pytest.mark.parametrize("angles", few([None, 360], {360}))
def test_threads_change_no_bit(angles: int | None) -> None:
    values = mixed(4500)
    first, four = (compiled_batch(angles, threads)(values) for threads in (1, 4))
    assert first[0].tobytes() == four[0].tobytes()
    assert np.array_equal(first[1], four[1])


def test_numpy_changes_no_bit_either(numpy_engine: None) -> None:
    values = mixed(300)
    batch = Batch(FOUR, paths_of(numbers_of(FOUR)), WANTED, angles=60, threads=1)
    figures, _ = batch(values)
    parts = [batch(values[k : k + 11])[0] for k in range(0, len(values), 11)]
    assert np.concatenate(parts).tobytes() == figures.tobytes()
    batch.threads = 4
    assert batch(values)[0].tobytes() == figures.tobytes()


def test_values_may_lie_in_memory_as_they_like() -> None:
    values, batch = mixed(40), compiled_batch(60)
    figures, _ = batch(values)
    assert batch(np.asfortranarray(values))[0].tobytes() == figures.tobytes()
    assert batch(np.repeat(values, 2, axis=0)[::2])[0].tobytes() == figures.tobytes()


# What is not asked for: `test_each_figure_alone`.
@pytest.mark.exhaustive
def test_nothing_varies_and_nothing_is_wanted() -> None:
    reported = eq.analyze(FOUR, 60).summary["drive_torque"].rms
    batch = Batch(FOUR, [], wanted_of(SIGNALS, "rms"), angles=60)
    figures, reasons = batch(np.empty((3, 0)))
    assert figures[:, 2] == pytest.approx([reported] * 3, rel=1e-12)
    assert not reasons.any()
    figures, reasons = Batch(FOUR, ["drive.speed"], [], angles=60)(np.ones((2, 1)))
    assert figures.shape == (2, 0)
    figures, reasons = batch(np.empty((0, 0)))
    assert figures.shape == (0, 3)
    assert reasons.shape == (0,)


def test_what_cannot_be_asked() -> None:
    with refused(UsageError, angles="0"):
        Batch(FOUR, ["drive.speed"], RMS, angles=0)
    with refused(UsageError, paths="links.nothing.mass"):
        Batch(FOUR, ["links.nothing.mass"], RMS)(np.ones((1, 1)))
    with refused(UsageError, kind="signal"):
        Batch(FOUR, ["drive.speed"], wanted_of(["joints.Q"], "rms"))


def test_base_need_not_turn() -> None:
    """What is asked is whether its designs do."""
    base = four_bar(3.0, 1.0, 1.5, 1.0)
    with pytest.raises((RangeError, ChangePointError)):
        assemble(base).cycle  # noqa: B018
    numbers = named(base, "links.coupler.points.C.x", "links.rocker.points.C.x")
    values = np.array([[1.5, 1.0], [3.0, 2.5]])
    batch = Batch(base, paths_of(numbers), wanted_of(SIGNALS, "rms"), angles=60)
    figures, reasons = batch(values)
    assert list(reasons) == [2, 0]
    known = known_of(design(base, numbers, values[1]), 60, SIGNALS)
    assert figures[1] == pytest.approx([known[s].figures.rms for s in SIGNALS], rel=1e-10)


@pytest.mark.parametrize("driver", [None, "crank"])
def test_a_load_of_two_turns(driver: str | None, numpy_engine: None) -> None:
    """Loops go round its whole cycle, with gears of another and without any."""
    table = LoadTable((0.0, pi, 4 * pi), ((0.0, 40.0, 0.0),))
    base = with_gear(driver, -1.5) if driver else FOUR
    base = replace(base, loads=(Load("coupler", table=table),))
    assert assemble(base).cycle.turns == 2
    numbers = named(base, *LENGTHS)
    values = np.array([[number.value for number in numbers]])
    figures, reasons = Batch(base, paths_of(numbers), wanted_of(SIGNALS, "rms"), angles=60)(values)
    known = known_of(design(base, numbers, values[0]), 60, SIGNALS)
    assert list(reasons) == [0]
    assert figures[0] == pytest.approx([known[s].figures.rms for s in SIGNALS], rel=1e-10)


# -- how many crank angles -------------------------------------------------------------------------

SMOOTH = ["shaking_force.x", "shaking_moment", "drive_torque"]
"""Signals without a kink: the length of a vector has one where the vector passes zero."""


@pytest.mark.exhaustive(but=["0.0001", "0.001"])
@pytest.mark.parametrize("tolerance", [1e-2, 1e-3, 1e-4])
def test_tolerance_is_kept(tolerance: float) -> None:
    """Figures stand beside those at 8192 crank angles as close as was asked."""
    numbers = geometry_of(FOUR, 0.05)
    wanted = wanted_of(SMOOTH, "mean", "rms", "peak", "peak_to_peak", "min")
    values = drawn(numbers, 250, 3)
    figures, reasons = Batch(FOUR, paths_of(numbers), wanted, tolerance=tolerance)(values)
    fine, why = Batch(FOUR, paths_of(numbers), wanted, angles=8192)(values)
    assert np.mean(reasons == 0) > 0.7
    assert np.array_equal(reasons[reasons != 5], why[reasons != 5])
    rms = {figure.signal: fine[:, k] for k, figure in enumerate(wanted) if figure.name == "rms"}
    for k, figure in enumerate(wanted):
        apart = np.abs(figures[:, k] - fine[:, k]) / rms[figure.signal]
        worst = np.nanmax(apart) / tolerance
        assert worst <= 1.0, f"{figure} is {worst:.2g} times the tolerance off"


@pytest.mark.exhaustive(but=["0.001"])
@pytest.mark.parametrize("tolerance", [1e-2, 1e-3])
def test_tolerance_of_places(tolerance: float) -> None:
    """Places of extremes are held against a whole turn."""
    numbers = geometry_of(FOUR, 0.05)
    wanted = wanted_of(SMOOTH, *PLACES)
    values = drawn(numbers, 100, 4)
    figures, reasons = Batch(FOUR, paths_of(numbers), wanted, tolerance=tolerance)(values)
    fine, _ = Batch(FOUR, paths_of(numbers), wanted, angles=8192)(values)
    apart = np.abs(figures - fine)[reasons == 0]
    assert np.max(np.minimum(apart, 2 * pi - apart)) <= tolerance * 2 * pi


# Doubled angles: `test_doubled_angles_are_the_same_as_all_at_once`.
@pytest.mark.exhaustive
def test_means_and_rms_need_few_angles() -> None:
    """They converge faster than any power; 128 crank angles leave rounding."""
    numbers = geometry_of(FOUR, 0.02)
    wanted = wanted_of(SMOOTH, "mean", "rms")
    values = drawn(numbers, 20, 3)
    few, reasons = Batch(FOUR, paths_of(numbers), wanted, angles=128)(values)
    many, _ = Batch(FOUR, paths_of(numbers), wanted, angles=8192)(values)
    assert not reasons.any()
    scale = np.repeat(many[:, 1::2], 2, axis=1)
    assert np.max(np.abs(few - many) / scale) < 1e-9
    settled, _ = Batch(FOUR, paths_of(numbers), wanted, tolerance=1e-9)(values)
    assert np.max(np.abs(settled - many) / scale) < 1e-9


@pytest.mark.exhaustive(but=["rocker"])
@pytest.mark.parametrize("driver", ["crank", "rocker"])
def test_doubled_angles_are_the_same_as_all_at_once(driver: str, numpy_engine: None) -> None:
    """Only new crank angles are computed; but angles that are counted on start afresh."""
    base = with_gear(driver, -1.5)
    assert bool(Batch(base, [], RMS).source.running) == (driver == "rocker")
    numbers = numbers_of(base, 0.01)
    wanted = wanted_of(["shaking_force.y", "drive_torque"], "rms", "mean", "max", "peak_to_peak")
    values = drawn(numbers, 10, 2)
    settled, reasons = Batch(base, paths_of(numbers), wanted, tolerance=1e-3)(values)
    assert (reasons == 0).sum() > 5
    at_once = [
        Batch(base, paths_of(numbers), wanted, angles=128 * 2**power)(values)[0]
        for power in range(1, 10)
    ]
    for k in np.flatnonzero(reasons == 0):
        apart = [np.max(np.abs(settled[k] - other[k])) for other in at_once]
        # Tops are found among each set of crank angles alone, from values twice as far apart.
        assert min(apart) < 1e-7 * np.max(settled[k])


def with_gear(driver: str, ratio: float) -> Machine:
    """The four-bar with a geared weight on the frame."""
    links = {**FOUR.links, "weight": heavy(W=(0.0, 0.0), U=(0.3, 0.1))}
    gear = Gear(driver, "weight", ratio, start=0.3)
    return replace(FOUR, frame={**FOUR.frame, "W": (6.0, -2.0)}, links=links, gears=(gear,))


def test_longer_cycle_than_that_of_the_base(numpy_engine: None) -> None:
    """A rocker that turns fully drives a gear that comes back after two turns of the crank."""
    base = with_gear("rocker", -1.5)
    numbers = named(base, "frame.points.D.x", "links.crank.points.B.x")
    values = np.array([[3.0, 1.0], [0.5, 3.1], [3.1, 0.9]])
    turns = [assemble(design(base, numbers, row)).cycle.turns for row in values]
    assert turns == [1, 2, 1]
    assert Batch(base, paths_of(numbers), RMS, angles=60)(values)[1].tolist() == [0, 6, 0]


def balanced_four_bar(**more: Any) -> Machine:
    """A four-bar whose shaking force is nothing but rounding (Berkof and Lowen)."""
    frame, crank, coupler, rocker = 0.31, 0.107, 0.293, 0.251
    center, mass = complex(0.11, 0.037), 1.3
    first = -mass * crank * (1 - center / coupler) / 2.1
    last = -mass * rocker * (center / coupler) / 1.7
    return machine(
        {"A": (0.02, 0.013), "D": (0.02 + frame * cos(0.3), 0.013 + frame * sin(0.3))},
        {
            "crank": replace(
                heavy(A=(0.0, 0.0), B=(crank, 0.0)),
                mass=2.1, center_of_mass=(first.real, first.imag),
            ),
            "coupler": replace(
                heavy(B=(0.0, 0.0), C=(coupler, 0.0)),
                mass=mass, center_of_mass=(center.real, center.imag),
            ),
            "rocker": replace(
                heavy(D=(0.0, 0.0), C=(rocker, 0.0)),
                mass=1.7, center_of_mass=(last.real, last.imag),
            ),
        },
        assembly={"C": "left"},
        gravity=(0.0, 0.0),
        **more,
    )  # fmt: skip


@pytest.mark.parametrize("tolerance", [1e-3, 1e-4, 1e-6, 1e-9])
def test_balanced_outputs_stand_still(tolerance: float, numpy_engine: None) -> None:
    """What only rounding is left of is zero, however fast the machine runs beside its base."""
    wanted = wanted_of(["shaking_force.x", "shaking_force"], "rms", "mean", "peak_to_peak")
    values = np.array([[10.0, 0.1], [1.0, 0.4], [300.0, 0.1]])
    batch = Batch(
        balanced_four_bar(), ["drive.speed", "links.crank.inertia"], wanted, tolerance=tolerance
    )
    figures, reasons = batch(values)
    assert not reasons.any()
    assert np.all(np.abs(figures) < 1e-12 * values[:, :1] ** 2)


@pytest.mark.exhaustive(but=["2.2"])
@pytest.mark.parametrize("stop", few([0.5, 1.0, 2.2, 3.0], {0.5, 2.2}))
def test_loads_that_end_in_a_step(stop: float, numpy_engine: None) -> None:
    """The mean of a torque that acts over an odd part of the turn comes closer as 1 / N only.

    It may be told not to stand still, but not to be what it is not.
    """
    base = replace(FOUR, loads=(Load("crank", torque=1000.0, start=0.0, stop=stop),))
    wanted = wanted_of(["drive_torque"], "mean")
    fine = eq.analyze(base, 100_000).summary["drive_torque"]
    for tolerance in (1e-2, 1e-3, 1e-4):
        batch = Batch(base, ["links.crank.mass"], wanted, tolerance=tolerance)
        figures, reasons = batch(np.array([[0.5]]))
        apart = abs(figures[0, 0] - fine.mean) / fine.rms
        assert reasons[0] == 5 or apart < tolerance + 1e-5, f"{apart:.2g} off at {tolerance:g}"


# -- figures ---------------------------------------------------------------------------------------


def of_samples(name: str, theta: Array, x: Array) -> float:
    """A figure by its definition."""
    ways: dict[str, Callable[[], Any]] = {
        "mean": x.mean,
        "rms": lambda: np.sqrt((x * x).mean()),
        "peak": lambda: np.abs(x).max(),
        "max": x.max,
        "min": x.min,
        "peak_to_peak": lambda: np.ptp(x),
        "max_at": lambda: theta[x.argmax()],
        "min_at": lambda: theta[x.argmin()],
        "peak_at": lambda: theta[np.abs(x).argmax()],
    }
    return float(ways[name]())


@pytest.mark.parametrize("name", GATHERED)
def test_each_figure_alone(name: str, numpy_engine: None) -> None:
    """What a figure is made of is gathered for it, whatever else is wanted."""
    motion = eq.move(FOUR, 72_000)
    batch = Batch(FOUR, ["drive.speed"], [Figure("points.C.vy", name)], angles=60)
    figures, _ = batch(np.array([[10.0], [-10.0]]))
    vy = motion.points["C"].vy
    for k, sign in enumerate((1, -1)):
        reported = of_samples(name, motion.crank_angle, sign * vy)
        # Sixty crank angles give extremes to 1e-8, dense ones the places of these to half a step.
        assert figures[k, 0] == pytest.approx(
            reported, rel=1e-7, abs=1e-4 if "_at" in name else 1e-9
        )


def test_names_of_figures() -> None:
    assert figure_of("shaking_force.y.rms") == Figure("shaking_force.y", "rms")
    assert figure_of("summary.joints.B/rod.peak_at") == Figure("joints.B/rod", "peak_at")
    for value in (
        "rms",
        "",
        "shaking_force.y",
        "summary.rms",
        "four_bar.kind",
        "shaking_force.RMS",
    ):
        assert figure_of(value) is None, value


@pytest.mark.parametrize(("count", "kind"), [(120, "max_at"), (120, "peak_at"), (None, "max_at")])
def test_of_equal_extremes_the_first_is_reported(
    count: int | None, kind: str, numpy_engine: None
) -> None:
    """A yoke shakes as much at either end, and rounding does not decide which end is told."""
    yoke = eq.load("scotch-yoke")
    batch = Batch(yoke, ["links.yoke.mass"], [Figure("shaking_force", kind)], angles=count)
    force = eq.analyze(yoke, 120).summary["shaking_force"].max_at
    figures, _ = batch(np.linspace(0.9, 1.3, 20)[:, None])
    assert figures[:, 0] == pytest.approx(force, abs=1e-3)
    assert np.all(figures[:, 0] < pi)


def test_equal_extremes_of_two_sets_of_angles() -> None:
    gathered = Gathered.of([Figure("s", "max_at")])
    highest, at = (gathered.columns.index(("s", kind)) for kind in ("top", "top_at"))
    first, other = np.zeros((2, 3, len(gathered.columns)))
    first[:, highest], first[:, at] = (1.0, 1.0 - 1e-15, 1.0), 2.0
    other[:, highest], other[:, at] = (1.0 - 1e-15, 1.0, 1.1), (3.0, 1.0, 3.0)
    assert list(gathered.joined(first, other)[:, at]) == [2.0, 1.0, 3.0]


def test_fingers_in_soil_whose_motion_no_design_changes() -> None:
    """Against each machine by itself; numbers that move the finger are not for loops."""
    base = eq.load("transplanter")
    paths = ["links.coupler.mass", "drive.speed"]
    names = ("drive_torque", "shaking_moment", "frame_force", "joints.C")
    batch = Batch(base, paths, [Figure(name, "rms") for name in names], angles=360)
    values = np.array([[0.9, 25.0], [0.72, 40.0]])
    figures, reason = batch(values)
    assert not np.any(reason)
    for row, (mass, speed) in zip(figures, values, strict=True):
        machine = base.with_link("coupler", mass=float(mass)).with_drive(speed=float(speed))
        summary = eq.analyze(machine, 360).summary
        np.testing.assert_allclose(row, [summary[name].rms for name in names], rtol=1e-10)
    moving = ["links.coupler.points.P.x"]
    assert not can_compute(base, moving, Figure("drive_torque", "rms"))
    with refused(UsageError, by="Batch.__init__"):
        Batch(base, moving, [Figure("drive_torque", "rms")])
