"""The same shaken four-bar for the package and for the second routes."""

from __future__ import annotations

from dataclasses import replace

import equipoise as eq
from equipoise.mechanism.parts import support as package
from equipoise.mechanism.parts.motors import Motor
from equipoise.mechanism.parts.springs import Spring
from support.rig_reference import Mount, Rig, Row, Support, Tie, Torsion, paper_rig, rig_of

MACHINE = eq.load("yamashita-1")
RPM = 3.141592653589793 / 30
PHASES = (0.0, 3.141592653589793)


def one_row() -> Rig:
    """The paper's rig."""
    return paper_rig(MACHINE)


def two_rows() -> Rig:
    """The paper's rig with two four-bars in opposite phase."""
    return replace(one_row(), rows=tuple(Row(phase) for phase in PHASES))


def rows_apart() -> Rig:
    """The paper's rig with two four-bars beside each other, a third of a turn apart."""
    return replace(one_row(), rows=(Row(), Row(2.0, 0.12 + 0.05j)))


def on_feet(one_sided: bool = False, stiffer: float = 1.0, **parts: object) -> Rig:
    """A light body that is free in the plane, on four mounts; the first may lift off."""
    support = Support(6.0, 0.15 - 0.05j, 0.5, 0.15 - 0.05j, pivoted=False)
    mounts = (
        Mount(-0.2 - 0.2j, 1j, 2400.0 * stiffer, 45.0, one_sided=one_sided),
        Mount(0.5 - 0.2j, 1j, 3500.0 * stiffer, 40.0),
        Mount(0.4 - 0.1j, 1.0, 6000.0 * stiffer, 60.0),
        Mount(0.1 + 0.3j, 0.8 + 0.6j, 1500.0 * stiffer, 25.0),
    )
    whole = rig_of(MACHINE, support, mounts=mounts, gauge=0.3 + 0.4j, gauge_direction=0.6 + 0.8j)
    return replace(whole, **parts)  # type: ignore[arg-type]


BARS = ("crank", "coupler", "rocker")
TIES = (Tie(2, 0.06 + 0.01j, 0.05 + 0.09j, 900.0, 0.05), Tie(1, -0.16 - 0.04j, -0.1 - 0.2j, 60.0))


def tied(rig: Rig) -> Rig:
    """With springs from rocker and coupler to the support, in each row."""
    return replace(rig, ties=TIES)


def in_package(rig: Rig, motor: Motor | None = None) -> eq.Machine:
    """The rig as a machine of the package; mounts are called 0, 1 ... and torsions t0, t1 ..."""
    body = rig.support
    pivot = (body.origin.real, body.origin.imag) if body.pivoted else None
    assert body.pivoted or body.origin == body.center
    mounts = {str(k): linear(mount) for k, mount in enumerate(rig.mounts)}
    mounts |= {f"t{k}": torsional(spring) for k, spring in enumerate(rig.torsions)}
    gauge = package.Gauge(place(rig.gauge), direction(rig.gauge_direction))
    machine = MACHINE.with_rows(
        package.Row(phase=row.phase, offset=(row.offset.real, row.offset.imag)) for row in rig.rows
    )
    machine = machine.with_support(
        mass=body.mass,
        center_of_mass=place(body.center),
        inertia=(body.inertia,),
        pivot=pivot,
        mounts=mounts,
        gauges={"gauge": gauge},
    )
    for number, tie in enumerate(rig.ties):
        machine = with_tie(machine, f"eye {number}", f"hook {number}", tie)
    return machine.with_drive(flywheel=rig.flywheel, motor=motor)


def with_tie(machine: eq.Machine, eye: str, hook: str, tie: Tie) -> eq.Machine:
    """With one spring; the links of the machine have their first joint in their origin."""
    link = BARS[tie.bar]
    points = {**machine.links[link].points, eye: (tie.at.real, tie.at.imag)}
    frame = {**machine.frame, hook: (tie.to.real, tie.to.imag)}
    spring = Spring(link, eye, hook, tie.stiffness, tie.free_length)
    machine = replace(machine.with_link(link, points=points), frame=frame)
    return machine.with_springs([*machine.springs, spring])


def place(point: complex) -> tuple[float, float, float]:
    return (point.real, point.imag, 0.0)


def direction(along: complex) -> tuple[float, float, float]:
    return (along.real, along.imag, 0.0)


def linear(mount: Mount) -> package.Mount:
    return package.Mount(
        place(mount.at),
        direction(mount.direction),
        stiffness=mount.stiffness,
        damping=mount.damping,
        preload=mount.preload,
        one_sided=mount.one_sided,
    )


def torsional(spring: Torsion) -> package.Mount:
    assert spring.preload is None
    return package.Mount(
        axis="pitch",
        torsional_stiffness=spring.stiffness,
        torsional_damping=spring.damping,
    )
