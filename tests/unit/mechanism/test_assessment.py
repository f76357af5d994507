"""Names and figures of four-bars, against dense sampling of their motion."""

from __future__ import annotations

from dataclasses import replace
from math import isclose, pi

import numpy as np
import pytest

import equipoise as eq
from support.chosen import few
from support.machines import make
from unit.mechanism.build import crank_rocker, four_bar, two_gears


def describe(*lengths: float) -> eq.mechanism.FourBar:
    machine = eq.mechanism.four_bar(four_bar(*lengths))
    assert machine is not None
    return machine


@pytest.mark.parametrize(
    ("lengths", "grashof", "name"),
    [
        ((1.0, 0.35, 0.9, 0.8), "Grashof", "crank-rocker"),
        ((0.3, 0.8, 0.65, 0.75), "Grashof", "double-crank (drag link)"),
        ((1.0, 0.8, 0.3, 0.9), "Grashof", "double-rocker"),
        ((1.0, 0.8, 0.9, 0.35), "Grashof", "rocker-crank"),
        ((1.0, 0.9, 0.5, 0.55), "non-Grashof", "triple-rocker"),
        ((1.0, 0.4, 0.8, 0.6), "change point", "change-point linkage"),
        ((1.0, 0.3, 1.0, 0.3), "change point", "change-point linkage"),
    ],
)
def test_types(lengths: tuple[float, ...], grashof: str, name: str) -> None:
    description = describe(*lengths)
    assert (description.grashof, description.type) == (grashof, name)
    assert (description.a, description.b, description.c, description.d) == pytest.approx(lengths)
    assert (description.crank, description.coupler, description.rocker) == (
        "crank",
        "coupler",
        "rocker",
    )
    assert description.pins == ("A", "B", "C", "D")


@pytest.mark.parametrize(
    ("name", "kind"),
    [("yamashita-1", "crank-rocker"), ("lee-kim-c", "crank-rocker"),
     ("drag-link", "double-crank (drag link)"), ("stephenson-six-bar", "crank-rocker")],
)  # fmt: skip
def test_examples(name: str, kind: str) -> None:
    machine = eq.mechanism.four_bar(eq.load(name))
    assert machine is not None
    assert machine.type == kind
    assert machine.condition_5
    assert machine.condition_6


@pytest.mark.parametrize("name", ["slider-crank-engine", "scotch-yoke", "class-three",
                                  "planetary-planting-arm", "quick-return"])  # fmt: skip
def test_machines_without_a_four_bar(name: str) -> None:
    assert eq.mechanism.four_bar(eq.load(name)) is None


def test_gears_alone_are_no_four_bar() -> None:
    assert eq.mechanism.four_bar(two_gears(eq.Gear("crank", "wheel", ratio=-1.0))) is None
    assert eq.mechanism.four_bar(make("geared_five_bar", 0).machine) is None


def test_links_in_another_order() -> None:
    given = crank_rocker()
    names = ["rocker", "coupler", "crank"]
    turned = replace(given, links={name: given.links[name] for name in names},
                     assembly={"C": "right"})  # fmt: skip
    assert eq.mechanism.four_bar(turned) == eq.mechanism.four_bar(given)


TURNING = [
    (1.0, 0.35, 0.9, 0.8), (0.3, 0.8, 0.65, 0.75), (0.066, 0.032, 0.06, 0.065),
    (0.13, 0.042, 0.092, 0.095), (1.0, 0.2, 0.5, 0.9), (2.0, 0.5, 2.2, 1.0),
]  # fmt: skip


@pytest.mark.parametrize("lengths", TURNING)
@pytest.mark.parametrize("side", ["left", "right"])
def test_transmission_angle_against_sampling(lengths: tuple[float, ...], side: str) -> None:
    description = describe(*lengths)
    points = eq.move(four_bar(*lengths, side=side), 7200).points
    b, c, d = (points[name].place for name in "BCD")
    angle = np.abs(np.angle((b - c) / (d - c)))
    assert description.transmission_min == pytest.approx(angle.min(), abs=1e-6)
    assert description.transmission_max == pytest.approx(angle.max(), abs=1e-6)


@pytest.mark.parametrize("lengths", [row for row in TURNING if min(row) == row[1]])
def test_swing_and_time_ratio_against_sampling(lengths: tuple[float, ...]) -> None:
    description = describe(*lengths)
    count = 72_000
    angle = eq.move(four_bar(*lengths), count).links["rocker"].angle
    assert description.swing == pytest.approx(np.ptp(angle), abs=1e-6)
    first = (int(np.argmax(angle)) - int(np.argmin(angle))) % count
    slow, fast = max(first, count - first), min(first, count - first)
    assert description.time_ratio == pytest.approx(slow / fast, abs=2e-4)


def test_figures_of_a_drag_link() -> None:
    description = describe(0.3, 0.8, 0.65, 0.75)
    assert description.swing is None
    assert description.time_ratio is None
    assert description.transmission_min is not None


def test_figures_of_a_linkage_that_does_not_turn() -> None:
    description = describe(1.0, 0.9, 0.5, 0.55)
    assert (description.transmission_min, description.transmission_max, description.swing) == (
        None,
        None,
        None,
    )


def lengths_at_random() -> list[tuple[float, ...]]:
    rng = np.random.default_rng(11)
    return [tuple(float(x) for x in rng.uniform(0.2, 1.2, 4)) for _ in range(150)]


@pytest.mark.parametrize(
    "lengths", few([*lengths_at_random(), *TURNING], [*lengths_at_random()[::3], *TURNING])
)
def test_condition_5_is_full_rotation(lengths: tuple[float, ...]) -> None:
    """|E_c / R_c| and |E_a / R_a| up to 1, all round: the crank turns, or it does not."""
    try:
        turns = eq.move(four_bar(*lengths), 8).whole_cycle
    except eq.EquipoiseError:
        turns = False
    assert describe(*lengths).condition_5 == turns


@pytest.mark.parametrize("lengths", lengths_at_random()[:40])
def test_condition_5_by_its_own_words(lengths: tuple[float, ...]) -> None:
    a, b, c, d = lengths
    s = np.abs(a - b * np.exp(1j * np.linspace(0, 2 * pi, 3601)))
    at_b = np.abs(s**2 + c**2 - d**2) / (2 * s * c)
    at_d = np.abs(s**2 + d**2 - c**2) / (2 * s * d)
    holds = max(at_b.max(), at_d.max()) <= 1 + 1e-12
    assert describe(*lengths).condition_5 == holds


@pytest.mark.parametrize(
    ("lengths", "holds"),
    [((1.0, 0.4, 0.8, 0.6), False), ((1.0, 0.6, 0.8, 0.3), True), ((0.6, 0.3, 0.9, 0.6), False),
     ((1.0, 0.35, 0.9, 0.8), True)],
)  # fmt: skip
def test_condition_6(lengths: tuple[float, ...], holds: bool) -> None:
    a, b, c, d = lengths
    assert holds == (not isclose(a + b, c + d) and not isclose(b + c, a + d))
    assert describe(*lengths).condition_6 == holds


def test_crank_as_long_as_the_frame() -> None:
    assert not describe(0.5, 0.5, 0.7, 0.7).condition_5


def test_the_drive_pivot_need_not_be_the_origin() -> None:
    given = crank_rocker()
    shifted = replace(given, frame={"A": (3.0, 1.0), "D": (3.0, 2.0)})
    moved = shifted.with_link("crank", points={"A": (1.0, 1.0), "B": (1.0, 1.35)})
    actual, plain = eq.mechanism.four_bar(moved), eq.mechanism.four_bar(given)
    assert actual is not None
    assert plain is not None
    assert (actual.a, actual.b, actual.swing) == pytest.approx((plain.a, plain.b, plain.swing))
