"""What `check` asks of a file is also a note of `analyze`, in print and in the JSON."""

from __future__ import annotations

from dataclasses import replace

import equipoise as eq
from equipoise.mechanism.parts.machine import Machine
from equipoise.mechanism.parts.support import idle_parts
from equipoise.present.checks import machine_blocks
from equipoise.results.blocks import Block, Notes


def noted(blocks: object) -> set[str]:
    return {str(n) for one in blocks if isinstance(one, Notes) for n in one.notes}  # type: ignore[attr-defined]


def with_crank(machine: Machine, **changes: object) -> Machine:
    crank = replace(machine.links["crank"], **changes)  # type: ignore[arg-type]
    return (
        machine.with_links(crank=crank)
        if hasattr(machine, "with_links")
        else replace(machine, links={**machine.links, "crank": crank})
    )


def both(machine: Machine) -> tuple[set[str], set[str], set[str]]:
    analysis = eq.analyze(machine, 36)
    blocks: list[Block] = [*analysis.blocks()]
    return noted(machine_blocks(machine)), noted(blocks), set(analysis.to_dict()["notes"])


def test_an_inertia_in_another_unit_is_asked_of() -> None:
    checked, shown, plain = both(with_crank(eq.load("yamashita-1"), inertia=1500.0))
    (asked,) = (one for one in checked if "radius of gyration" in one)
    assert asked in shown and asked in plain and "check its unit" in asked


def test_lengths_in_different_units_are_asked_of() -> None:
    machine = eq.load("slider-crank-engine")
    (name, (x, y)) = [*machine.links["crank"].points.items()][1]
    shorter = {**machine.links["crank"].points, name: (x / 1000, y / 1000)}
    checked, shown, plain = both(with_crank(machine, points=shorter))
    (asked,) = (one for one in checked if "check their units" in one)
    assert asked in shown and asked in plain
    assert not any("check their units" in one for one in both(machine)[0])


def test_a_gauge_along_a_direction_in_which_nothing_moves_is_asked_of() -> None:
    machine = eq.load("yamashita-rig")
    support = machine.support
    assert support is not None and support.pivot is not None
    assert not [*idle_parts(support)]
    (name, gauge) = next(iter(support.gauges.items()))
    arm = complex(gauge.point[0] - support.pivot[0], gauge.point[1] - support.pivot[1])
    outward = (arm.real / abs(arm), arm.imag / abs(arm), 0.0)  # a pin lets nothing move along it
    still = replace(support, gauges={name: replace(gauge, direction=outward)})
    checked, shown, plain = both(replace(machine, support=still))
    (asked,) = (one for one in checked if "reads nothing" in one)
    assert asked in shown and asked in plain and f"support.gauges.{name}" in asked


def test_what_a_machine_is_asked_is_said_once() -> None:
    for name in ("straw-walker", "cam-pusher", "sieve"):
        analysis = eq.analyze(eq.load(name), 90)
        said = [str(n) for one in analysis.blocks() if isinstance(one, Notes) for n in one.notes]
        assert len(said) == len(set(said))
        assert set(analysis.notes) >= {one for one in said if "dead position" in one}
