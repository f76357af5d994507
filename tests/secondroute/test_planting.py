"""Figures of planting machines against a second route: Fourier series and a loop by cosines.

`support.planting_reference` shares no line with the package.  Its own accuracy is 1e-14 with long
doubles and 1e-10 for accelerations without them, so both routes are held to 1e-9 of the largest
value of a kind, angles to 1e-9 rad; they differ by 2e-12 at most where long doubles are at hand.
Wider, each for a reason:

- Length of the curve relative to the machine: a mean over 720 crank angles a turn.  It converges
  like exp(-720 d), where d (rad) tells how nearly the curve has a cusp: the tip's slowness over the
  rate at which it picks up speed.  Cases are drawn with d above 0.04; at a cusp five digits remain.
- Length of the hole where the finger's foot dips below the surface: the cut ends at a jump, which
  is found to 1e-9 rad; held to 1e-7.

Left out: crank angle and direction of extremes that are flat, which only a tip on the crank has, as
any crank angle will do; and directions of vectors that vanish.

Where the foot is below the surface at entry or exit (a finger that comes from below, as no planter
has) the two routes count the hole differently; no such case is drawn.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import cache
from itertools import product
from typing import Any

import numpy as np
import pytest

import equipoise as eq
from equipoise.mechanism.parts.field import Planting
from equipoise.planting.figures import Loop
from equipoise.planting.summary import PlantingFigures, plant
from support import planting_reference as reference
from support.chosen import EXHAUSTIVE, few
from support.conformance import compared
from support.planting_reference import Case, Series, Trochoid, planter
from support.sources import SERIES

TURN = 2 * np.pi
WITHIN = 1e-9
DIPPING = 1e-7
TURNING = {"crank_angle", "direction", "attitude", "min_at", "max_at"}
VECTORS = {"velocity", "acceleration", "ground_velocity"}
FLAT = {
    "curve.smallest_radius.crank_angle",
    *(
        f"{which}_{what}.{key}"
        for which, what, key in product(
            ("max", "min"), ("speed", "acceleration"), ("crank_angle", "direction")
        )
    ),
}
GRID = np.linspace(0.0, TURN, 720, endpoint=False)

# -- cases -----------------------------------------------------------------------------------------


def drawn(seed: int) -> Case:
    """A random crank-rocker: the seed's bits tell its senses, the rest is drawn until it plants."""
    rng = np.random.default_rng([seed, 1977])
    while True:
        case = _with_depth(_crank_rocker(rng, seed), seed)
        if case is not None and _plants(case):
            return case


def _crank_rocker(rng: np.random.Generator, seed: int) -> Case:
    crank = float(rng.uniform(0.02, 0.05))
    while True:
        frame, coupler, rocker = map(float, rng.uniform(1.3, 4, 3))
        ends = [coupler**2 + rocker**2 - (frame + s) ** 2 for s in (-1, 1)]
        if max(abs(end / (2 * coupler * rocker)) for end in ends) < 0.93:
            break
    sense, side, travel = (1 if seed & bit else -1 for bit in (1, 2, 4))
    tip, base = (complex(*rng.uniform(-4, 4, 2)) * crank for _ in range(2))
    return Case(
        frame * crank, crank, coupler * crank, rocker * crank,
        ground=float(rng.uniform(-np.pi, np.pi)),
        tip=tip,
        base=base if seed % 3 else 0,
        side=side,
        omega=sense * float(rng.uniform(5, 40)),
        v=travel * float(rng.uniform(0.1, 1.5)),
    )  # fmt: skip


def _with_depth(case: Case, seed: int) -> Case | None:
    """The case planting once or, every sixth, twice a turn; None where its path does not allow it.

    Turning points of the height within a hundredth of each other are avoided: of two that tie, each
    route may take another for the lowest.
    """
    height = case.places(GRID)[0].imag
    low, high = (
        np.sort(height[(sign * height < sign * np.roll(height, 1))
                       & (sign * height < sign * np.roll(height, -1))])
        for sign in (1, -1)
    )  # fmt: skip
    whole = np.ptp(height)
    if min(np.diff(np.concatenate([low, high])), default=whole) < 0.01 * whole:
        return None
    if seed % 6 != 5:
        return replace(case, depth=float((0.06, 0.15, 0.3, 0.5)[seed % 4] * whole))
    if len(low) < 2:
        return None
    return replace(case, depth=float((low[1] + high[0]) / 2 - low[0]))


def _plants(case: Case) -> bool:
    """Whether the finger enters and leaves tip first, on a path without near-cusps."""
    tip, foot = case.places(GRID)
    below = tip.imag < tip.imag.min() + case.depth
    at_surface = below != np.roll(below, 1)
    rate = np.gradient(tip, GRID)
    near_cusp = np.min(np.abs(rate[2:-2]) / np.abs(np.gradient(rate, GRID)[2:-2]))
    deep = foot.imag < tip.imag.min() + case.depth
    return bool(near_cusp > 0.04 and not np.any(at_surface & (deep | np.roll(deep, 1))))


RANDOM = {f"crank-rocker-{seed}": drawn(seed) for seed in range(25)}
PRINTED = {f"kim-chung-{name.lower()}": case for name, case in reference.MACHINES.items()}
TROCHOIDS = {
    f"trochoid-{'left' if omega > 0 else 'right'}-{'forward' if v > 0 else 'backward'}-{abs(v)}":
        Trochoid(0.1, omega, v, 0.04)
    for omega, v in product((10.0, -10.0), (0.6, 1.0, 1.5, -0.6, -1.0, -1.5))
}  # fmt: skip
CASES: dict[str, Case | Trochoid] = {**PRINTED, **TROCHOIDS, **RANDOM}
every_case = pytest.mark.parametrize(
    "name", few(CASES, {*list(PRINTED)[:1], *list(TROCHOIDS)[::6], *list(RANDOM)[3:5]})
)


def machine_of(case: Case | Trochoid, **more: Any) -> eq.Machine:
    """The machine of a case, without masses."""
    links = {"crank": eq.Link({"A": (0.0, 0.0), "P": (case.r, 0.0)})} if isinstance(
        case, Trochoid
    ) else {
        "crank": eq.Link({"A": (0.0, 0.0), "B": (case.b, 0.0)}),
        "coupler": eq.Link(
            {"B": (0.0, 0.0), "C": (case.c, 0.0), "P": (case.tip.real, case.tip.imag),
             "Q": (complex(case.base).real, complex(case.base).imag)}
        ),
        "rocker": eq.Link({"D": (0.0, 0.0), "C": (case.d, 0.0)}),
    }  # fmt: skip
    frame, assembly = {"A": (0.0, 0.0)}, {}
    if isinstance(case, Case):
        frame["D"] = (case.a * np.cos(case.ground), case.a * np.sin(case.ground))
        assembly["C"] = "left" if case.side > 0 else "right"
        more = {"finger_from": "Q", **more}
    planting = Planting(
        tip="P",
        forward_speed=abs(case.v),
        travel="forward" if case.v > 0 else "backward",
        depth=case.depth,
        **more,
    )
    return eq.Machine(
        "drawn", eq.Drive("crank", case.omega), frame, links, assembly, planting=planting
    )


@cache
def figures_of(name: str) -> PlantingFigures:
    return plant(eq.load(name) if name in PRINTED else machine_of(CASES[name]))


# -- how far apart ---------------------------------------------------------------------------------


def turned_apart(a: float, b: float) -> float:
    """Smallest angle between two directions."""
    return float(abs((a - b + np.pi) % TURN - np.pi))


def common(want: dict[str, Any]) -> Iterator[str]:
    """Names of single figures, those of flat extremes left out."""
    flat = FLAT if want["min_speed.value"] > (1 - 1e-9) * want["max_speed.value"] else set()
    for name in want:
        if name not in {"visits", "loops", "cusps", *flat} and not _idle(name, want):
            yield name


def _idle(name: str, want: dict[str, Any]) -> bool:
    """Whether a figure is the direction of a vector that vanishes."""
    *path, last = name.split(".")
    size = want.get(".".join([*path, "size"]))
    return last == "direction" and size is not None and size < 1e-9 * want["max_speed.value"]


def apart(name: str, found_value: float, want: dict[str, Any]) -> float:
    """Difference from the reference: rad, or a part of the largest value of the kind."""
    path = name.split(".")
    if path[-1] in TURNING:
        return turned_apart(found_value, want[name])
    scale = abs(want[name])
    if len(path) == 3 and path[1] in VECTORS:
        scale = want[f"max_{'acceleration' if path[1] == 'acceleration' else 'speed'}.value"]
    elif path[-1] in ("x", "y"):
        scale = want["curve.height"]
    elif path[0] == "ratio":
        scale = 1.0
    elif scale == 0:  # the radius of a cusp
        scale = want["curve.height"]
    return float(abs(found_value - want[name]) / scale)


def dips(case: Case | Trochoid) -> bool:
    """Whether the finger's foot goes below the surface during the stay."""
    p = planter(case)
    return bool(np.any(p.foot(np.linspace(*p.visits[0], 400)).imag < p.surface))


@pytest.mark.exhaustive(but=["kim-chung-a", "crank-rocker-3", "trochoid-left-forward-0.6"])
@compared(SERIES, "all figures, stays, loops and cusps", WITHIN)
@every_case
def test_figures_stays_loops_and_cusps(name: str) -> None:
    want = reference.figures(CASES[name])
    same_figures(name, want)
    same_stays(name, want["visits"])
    same_loops(name, want)
    assert figures_of(name).cusps == pytest.approx(want["cusps"], abs=WITHIN)


def same_figures(name: str, want: dict[str, Any]) -> None:
    """Compare every figure that both routes have."""
    names = list(common(want))
    assert len(names) >= 80
    for figure in names:
        within = DIPPING if figure == "soil.hole_length" and dips(CASES[name]) else WITHIN
        assert apart(figure, figures_of(name)[figure], want) < within, figure


def same_stays(name: str, want: list[tuple[float, float]]) -> None:
    """Compare stays; the reference lists the deepest first, then the others as time goes on."""
    got = figures_of(name).visits
    assert len(got) == len(want)
    assert turned_apart(got[0].entry, want[0][0]) < WITHIN
    for visit in got:
        pairs = (turned_apart(visit.entry, a) + turned_apart(visit.exit, b) for a, b in want)
        assert min(pairs) < WITHIN


def same_loops(name: str, want: dict[str, Any]) -> None:
    """Compare loops, each with the reference's that passes its crossing at the same times."""
    assert len(figures_of(name).loops) == len(want["loops"])
    pairs = [pair(loop, want["loops"]) for loop in figures_of(name).loops]
    assert sorted(k for k, _ in pairs) == list(range(len(want["loops"])))
    for k, loop in pairs:
        other = want["loops"][k]
        for key in ("first", "second"):
            assert turned_apart(getattr(loop, key), other[key]) < WITHIN
        assert abs(loop.way - other["duration"]) < WITHIN
        assert abs(loop.y - other["y"]) < WITHIN * want["curve.height"]
        for key in ("height", "width", "area"):
            assert getattr(loop, key) == pytest.approx(other[key], rel=WITHIN)
        assert loop.in_soil == (other["y"] < planter(CASES[name]).surface)


def pair(loop: Loop, others: list[dict[str, float]]) -> tuple[int, Loop]:
    """A loop with the number of the reference's that passes its crossing at the same times."""
    gaps = [turned_apart(loop.first, o["first"]) + turned_apart(loop.second, o["second"])
            for o in others]  # fmt: skip
    return int(np.argmin(gaps)), loop


@EXHAUSTIVE  # Each of these machines is in other tests of this file on every change.
def test_some_machines_plant_twice() -> None:
    assert [name for name in RANDOM if len(figures_of(name).visits) == 2] == [
        f"crank-rocker-{seed}" for seed in range(25) if seed % 6 == 5
    ]


@pytest.mark.exhaustive(
    but=[
        "trochoid-right-forward-1.0",
        "trochoid-left-backward-1.0",
        "trochoid-right-backward-1.5",
        "trochoid-left-forward-1.5",
        "trochoid-left-forward-0.6",
        "trochoid-right-backward-0.6",
    ]
)
@pytest.mark.parametrize("name", TROCHOIDS)
def test_trochoids_have_a_loop_a_cusp_or_neither(name: str) -> None:
    """A tip on the crank outruns the machine, keeps up with it or stays behind.

    It is slowest over ground where it moves against the machine: at the top where crank and travel
    have the same sign, else at the bottom.
    """
    case = TROCHOIDS[name]
    slowest = np.pi / 2 if case.omega * case.v > 0 else 3 * np.pi / 2
    ratio = case.r * abs(case.omega / case.v)
    assert len(figures_of(name).loops) == (ratio > 1)
    assert figures_of(name).cusps == (pytest.approx((slowest,)) if ratio == 1 else ())
    for loop in figures_of(name).loops:
        middle = (loop.first + np.sign(case.omega) * loop.way / 2) % TURN
        assert turned_apart(middle, slowest) < WITHIN


@pytest.mark.exhaustive(but=["0.0"])
@pytest.mark.parametrize("beside", [3e-4, 3e-5, 0.0])
def test_lengths_of_a_curve_with_a_cusp(beside: float) -> None:
    """At the pole of the coupler the tip stops; there, and near it, five to six digits hold."""
    coupler = Series(lambda theta: reference.A.links(theta)[0])
    crank_pin = Series(lambda theta: reference.A.places(theta)[1])
    pole = complex(-crank_pin(4.0, 1) / coupler(4.0, 1))
    case = replace(reference.A, tip=pole + beside)
    assert abs(planter(case).tip(4.0, 1)) == pytest.approx(beside * abs(coupler(4.0, 1)), abs=1e-12)
    got, want = plant(machine_of(case)), reference.figures(case)
    for figure in ("curve.length", "soil.path_length_machine"):
        assert got[figure] == pytest.approx(want[figure], rel=1e-5)
    assert got["soil.path_length_ground"] == pytest.approx(
        want["soil.path_length_ground"], rel=WITHIN
    )
