"""Machines that vibrate, and their pictures."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from math import pi

import numpy as np

import equipoise as eq
from equipoise.figures import pictures_of
from equipoise.mechanism.parts.machine import Machine
from equipoise.mechanism.parts.support import Gauge, Mount, Row
from equipoise.results.charts import Chart
from equipoise.vibration.forced import Sweep, respond, sweep_speed
from equipoise.vibration.response import Response
from unit.figures.samples import three_turns

RPM = 30 / pi
G = 9.80665
Drawn = dict[str, Chart]

MOUNTS = {
    "rear spring": Mount(point=(-0.3, -0.2), stiffness=9000, damping=30),
    "front spring": Mount(point=(0.4, -0.2), stiffness=7000, damping=40),
    "fore and aft": Mount(point=(0.4, 0.1), direction=0.0, stiffness=9000, damping=40),
    "float": Mount(point=(0.1, -0.25), stiffness=3000, damping=80, one_sided=True),
}
GAUGES = {
    "handle": Gauge(point=(-0.5, 0.4), direction=0.6),
    "seat": Gauge(point=(0.3, 0.3)),
    "tilt": Gauge(axis="pitch"),
}
ODD_MOUNTS = {
    "$x_1$ " + "long " * 30: Mount(point=(-0.3, -0.2), stiffness=9000),
    "右の浮き 100 % <b>'\"</b>": Mount(point=(0.4, -0.2), stiffness=7000),
    "a/b": Mount(point=(0.4, 0.0), direction=0.0, stiffness=9000),
}


def linkage() -> Machine:
    return eq.load("yamashita-1")


def rig() -> Machine:
    """A beam on a pivot, as in the paper of Yamashita, Ichikawa and Mori."""
    base = linkage()
    mass = sum(link.mass or 0.0 for link in base.links.values())
    return base.with_support(
        mass=25.0,
        center_of_mass=(-0.59, 0),
        pivot_inertia=2.152 * G - mass * 1.34**2,
        pivot=(-1.34, 0),
        mounts={
            "spring": Mount(point=(0.01, 0), stiffness=182 * G),
            "damper": Mount(axis="pitch", torsional_damping=0.333 * G),
        },
        gauges={"tip": Gauge(point=(0.16, 0))},
    )


def plane(base: Machine | None = None, **support: object) -> Machine:
    """A support that moves in the plane, on springs."""
    values = {"mass": 25.0, "center_of_mass": (0.1, 0.05), "inertia": (2.0,)}
    values |= {"mounts": MOUNTS, "gauges": GAUGES, **support}
    return (base or linkage()).with_support(**values)


def space(freedoms: tuple[str, ...] = ("heave", "roll", "pitch")) -> Machine:
    """Two rows side by side on four feet."""
    feet = {
        f"foot {x:g} {z:g}": Mount(point=(x, -0.2, z), stiffness=6000, damping=30)
        for x in (-0.3, 0.4)
        for z in (-0.2, 0.25)
    }
    return replace(linkage(), rows=(Row(lateral=-0.15), Row(lateral=0.15, phase=pi))).with_support(
        mass=30.0,
        center_of_mass=(0.1, 0.05, 0.0),
        inertia=(2.0, 2.5, 3.0),
        freedoms=freedoms,
        mounts=feet,
        gauges={
            "middle": Gauge(point=(0.2, 0.3, 0.0)),
            "left": Gauge(point=(0.2, 0.1, -0.3)),
            "right": Gauge(point=(0.2, 0.1, 0.3)),
            "rolling": Gauge(axis="roll"),
        },
    )


def long_cycle() -> Machine:
    """Linkages that are back after three turns."""
    return plane(three_turns())


def crowded() -> Machine:
    mounts = {
        f"m{k}": Mount(point=(-0.4 + 0.05 * k, -0.2), stiffness=1000 + 30 * k, damping=10)
        for k in range(11)
    }
    mounts["along"] = Mount(point=(0, 0), direction=0.0, stiffness=1e4, damping=10)
    gauges = {f"gauge number {k}": Gauge(point=(-0.4 + 0.06 * k, 0.3)) for k in range(11)}
    return plane(mounts=mounts, gauges=gauges)


def odd_names() -> Machine:
    base = replace(linkage(), title=r"Costs $5 and \alpha_{1}^2 <b>'\"</b> " + "long " * 20)
    gauges = {name: Gauge(point=(0.1, 0.3)) for name in ("a/b", "A|B", "CON: *?" + "長" * 150)}
    return plane(base, mounts=ODD_MOUNTS, gauges=gauges)


def falling() -> Machine:
    """Free to and fro, overdamped up and down, and top-heavy."""
    mounts = {
        name: Mount(point=(x, -0.2), stiffness=9000, damping=5000)
        for name, x in (("a", -0.05), ("b", 0.06))
    }
    return plane(center_of_mass=(0.0, 1.5), mounts=mounts, gauges={})


def dashed_and_lost(sweep: Sweep) -> Sweep:
    """As if some speeds had no steady state, and others none that is stable."""
    count = len(sweep.speed)
    lost = np.zeros(count, bool)
    lost[[5, 7]] = True
    lost[count // 2 : count // 2 + 6] = True
    stable = ~lost
    stable[10:20] = False
    gauges = {
        name: replace(
            curve,
            peak_to_peak=np.where(lost, np.nan, curve.peak_to_peak),
            velocity_rms=np.where(lost, np.nan, curve.velocity_rms),
        )
        for name, curve in sweep.gauges.items()
    }
    fluctuation = np.where(lost, np.nan, sweep.fluctuation)
    return replace(sweep, gauges=gauges, stable=stable, fluctuation=fluctuation)


@cache
def pictures(kind: str) -> Drawn:
    """All pictures of a machine that vibrates."""
    machine = MACHINES[kind]() if kind in MACHINES else eq.load(kind)
    support = machine.support
    assert support is not None
    drawn = pictures_of(respond(machine, SPEEDS.get(kind)))
    slow, fast = (-3.0, -60.0) if SPEEDS.get(kind, 1.0) < 0 else (3.0, 60.0)
    if kind != "falling":
        sweep = sweep_speed(machine, slow, fast, speeds=16 if kind == "rig" else 6)
        drawn |= named("sweep", pictures_of(sweep))
        if kind == "rig":
            drawn |= named("lost", pictures_of(dashed_and_lost(sweep)))
    if support.planar and kind in {"plane", "crowded", "walking-transplanter"}:
        driven = machine.drive.motor is not None
        transient = eq.simulate(machine, 0.5, drive=driven, samples=300)
        drawn |= named("rest", pictures_of(transient))
        if kind != "crowded":
            drawn |= named("exact", pictures_of(exact(kind)))
    return drawn


@cache
def exact(kind: str) -> Response:
    """A machine at its own speed by the exact model, with its motor where it has one."""
    machine = MACHINES[kind]() if kind in MACHINES else eq.load(kind)
    return respond(machine, model="exact", drive=machine.drive.motor is not None)


def named(prefix: str, drawn: Drawn) -> Drawn:
    return {f"{prefix} {name}": figure for name, figure in drawn.items()}


MACHINES = {
    "rig": rig,
    "plane": plane,
    "clockwise": plane,
    "space": space,
    "long cycle": long_cycle,
    "crowded": crowded,
    "odd names": odd_names,
    "falling": falling,
}
SPEEDS = {"clockwise": -21.0, "falling": 21.0}
KINDS = (*MACHINES, "riding-transplanter", "walking-transplanter")
