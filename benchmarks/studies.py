"""Many designs, beside the ways in which they are computed elsewhere, and studies as a whole.

The objective is that of a four-bar: RMS over 360 crank angles of vertical shaking force, shaking
moment and drive torque.  All that compute it have to agree before any is timed.  Everything runs on
one thread, except where more are named; times are for one design.
"""

from __future__ import annotations

import one_thread  # noqa: F401  has to come before NumPy

# isort: split
import os
import tempfile
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
from statistics import median

import numpy as np

import c_loop
import equipoise as eq
import study_runs
from asked import Limit, Table, agree
from equipoise.balancing import Objective
from equipoise.codegen import backends
from equipoise.codegen.backends import run_loop
from equipoise.codegen.batch import Batch, all_angles, designs_of, grid_of
from equipoise.codegen.figures import Figure
from equipoise.codegen.gram import MassBatch
from equipoise.mechanism.assembly.linkage import assemble
from equipoise.mechanism.parts.gear_shapes import GearShape
from equipoise.mechanism.parts.laws import LengthLaw, LengthSegment
from equipoise.mechanism.parts.machine import Machine
from equipoise.schema.template import Template
from equipoise.studies.objective_map import MachineVariants, SingleValues, landscape
from peers import optional
from study_runs import ANGLES, MACHINE, SIGNALS, VARIED, designs
from timing import in_turn

sympy_four_bar = optional("sympy_four_bar", "sympy")
pinocchio_four_bar = optional("pinocchio_four_bar", "pinocchio")

WANTED = [Figure(signal, "rms") for signal in SIGNALS]
LIKE_FOUR_BAR = (
    "watt-six-bar", "stephenson-six-bar", "balance-geared-a", "geared-counterweight",
    "elliptic-quick-return", "cam-pusher", "straw-walker",
    "knife-drive",
)  # fmt: skip
"""`geared-counterweight` has its gear, and `cam-pusher` its cam, on a link that the crank moves
unevenly; `stephenson-six-bar` has a second dyad, on the coupler; `straw-walker` has
twice as many links, whose motion no design changes."""
LAWS = ("modified sine", "modified trapezoid", "s-curve")
BY_PIECES = {f"cam-pusher by {law}s": law for law in LAWS}
EXACT, CLOSE = 1e-12, 1e-9
"""Share to which the same arithmetic agrees, and other formulas."""
Array = np.ndarray
Times = Mapping[str, list[float]]


class Loop:
    """The bare loop over designs and crank angles, whose table is filled in beforehand."""

    def __init__(self, batch: Batch, values: Array) -> None:
        self.batch, self.source = batch, batch.source
        self.table = designs_of(batch.source, batch.base, batch.paths, values).table
        self.grid = grid_of(batch.source, all_angles(ANGLES, batch.turns))

    def __call__(self) -> Array:
        return run_loop(self.source, self.table, self.grid)

    def by_numpy(self) -> Array:
        """The same as where Numba is missing."""
        out = np.empty((len(self.table), len(self.source.gathered.columns)))
        backends.run_numpy(out, self.source, self.table, self.grid)
        return out


def batch_of(machine: Machine, paths: tuple[str, ...], wanted: list[Figure]) -> Batch:
    return Batch(machine, paths, wanted, angles=ANGLES, threads=1)


def timed(tasks: Mapping[str, tuple[Callable[[], object], int]], rounds: int) -> Times:
    """Seconds a design of tasks, each with the number of designs that it computes."""
    times = in_turn({name: task for name, (task, _) in tasks.items()}, rounds)
    return {name: [one / tasks[name][1] for one in each] for name, each in times.items()}


def show(title: str, times: Times) -> None:
    print(f"\n{title}")
    for name, each in times.items():
        print(f"{name:<64} {1e6 * min(each):9.3f} us   median {1e6 * median(each):9.3f} us")


# -- one design of a four-bar ----------------------------------------------------------------------


def beside_c(table: Table, folder: Path) -> None:
    """The bare loop beside the same arithmetic in C."""
    version = c_loop.gcc()
    if version is None:
        table.remark("kernel beside C", "gcc is not installed")
        return
    loop = Loop(batch_of(MACHINE, tuple(VARIED), WANTED), designs(4096))
    tasks = {"kernel": (loop, 4096)}
    for flags in c_loop.FLAGS:
        in_c = c_loop.compiled(loop.source, flags, folder)
        name = " ".join(["gcc", version, *flags])
        if end := c_loop.crashes(in_c, loop.table[:64], loop.grid):
            table.remark(name, f"left out: what it compiled ends with {end} on this processor")
            continue
        agree(name, in_c(loop.table, loop.grid), loop(), EXACT)
        tasks[name] = (lambda in_c=in_c: in_c(loop.table, loop.grid), 4096)
    if len(tasks) == 1:
        return
    times = timed(tasks, 25)
    show(f"bare loop, table filled in; gcc with {' '.join(c_loop.ALWAYS)} as well", times)
    best = min((name for name in times if name != "kernel"), key=lambda name: min(times[name]))
    table.ratio(f"kernel / C by {best}", times["kernel"], times[best], Limit(1.2))


def beside_peers(table: Table) -> None:
    """From numbers to figures, beside SymPy, Pinocchio and the loop run by NumPy."""
    batch, values = batch_of(MACHINE, tuple(VARIED), WANTED), designs(16_384)
    right, _ = batch(values)
    tasks = {"equipoise": (lambda: batch(values), len(values))}
    few = values[:256]
    if sympy_four_bar is not None:
        form = sympy_four_bar.Form(MACHINE, tuple(VARIED), ANGLES)
        for name, at_once in {
            "SymPy, arrays that stay in cache": 8192 // ANGLES,
            "SymPy, all designs at once": len(few),
            "SymPy, one design at a time": 1,
        }.items():
            agree(name, form(few, at_once), right[: len(few)], CLOSE)
            tasks[name] = (lambda n=at_once: form(few, n), len(few))
    if pinocchio_four_bar is not None:
        tree = pinocchio_four_bar.FourBar(
            MACHINE, {"coupler": 0, "rocker": 1, "crank": 2}, {"rocker": 3}, ANGLES
        )
        for name, task in {
            "Pinocchio, all angles in a call": tree,
            "Pinocchio, one angle in a call": tree.one_by_one,
        }.items():
            agree(name, task(few), right[: len(few)], CLOSE)
            tasks[name] = (lambda task=task: task(few), len(few))
    loop = Loop(batch, few)
    agree("the loop by NumPy", loop.by_numpy(), loop(), EXACT)
    tasks["without Numba: the loop by NumPy"] = (loop.by_numpy, len(few))
    times = timed(tasks, 9)
    show("from numbers to figures", times)
    limits = {"SymPy": Limit(70, False), "Pinocchio": Limit(200, False)}
    for name in list(tasks)[1:]:
        limit = next((one for start, one in limits.items() if name.startswith(start)), None)
        table.ratio(f"{name} / equipoise", times[name], times["equipoise"], limit)
    for peer, loaded in (("SymPy", sympy_four_bar), ("Pinocchio", pinocchio_four_bar)):
        if loaded is None:
            table.remark(f"{peer} / equipoise", f"{peer} is not installed")


def other_machines(table: Table) -> None:
    """The same three figures of other machines, and joint forces, beside those of the four-bar."""
    tasks = {"four-bar": (Loop(batch_of(MACHINE, tuple(VARIED), WANTED), designs(2048)), 2048)}
    like = {name: eq.load(name) for name in LIKE_FOUR_BAR} | with_pieces()
    for name, machine in like.items():
        batch = batch_of(machine, ("drive.speed",), WANTED)
        speeds = machine.drive.speed * np.linspace(1.0, 1.2, 512)[:, None]
        agree(name, batch(speeds[:1])[0], analyzed(machine), CLOSE)
        tasks[name] = (Loop(batch, speeds), 512 * batch.turns)
    twin, across = eq.load("twin-engine"), [*WANTED, Figure("rocking_moment", "rms")]
    paths = tuple(f"links.{name}.plane" for name in twin.links if name != "crank")
    planes = [twin.links[path.split(".")[1]].plane for path in paths] * np.linspace(1, 1.2, 512)[
        :, None
    ]
    batch = batch_of(twin, paths, across)
    right = [*analyzed(twin), eq.analyze(twin, ANGLES).summary["rocking_moment"].rms]
    agree("twin-engine", batch(planes[:1])[0], right, CLOSE)
    beside = "twin-engine, whose planes vary, with its rocking moment"
    tasks[beside] = (Loop(batch, planes), 512)
    shaped = with_shapes()
    for name, machine in shaped.items():
        paths = tuple(f"gears[{k}].shape.eccentricity" for k in range(1, 1 + len(machine.gears)))
        batch = batch_of(machine, paths, WANTED)
        near = machine.gears[0].shape.eccentricity * np.linspace(1.0, 1.2, 512)[:, None]
        agree(name, batch(near[:1].repeat(len(paths), 1))[0], analyzed(machine), CLOSE)
        tasks[name] = (Loop(batch, near.repeat(len(paths), 1)), 512 * batch.turns)
    joints = [f"joints.{name}" for name, _ in assemble(MACHINE).named_reactions]
    wanted = [*WANTED, *(Figure(joint, "rms") for joint in joints)]
    with_joints = "four-bar with the force in every joint"
    tasks[with_joints] = (Loop(batch_of(MACHINE, tuple(VARIED), wanted), designs(2048)), 2048)
    times = timed(tasks, 25)
    show(f"bare loop, a turn of {ANGLES} crank angles", times)
    for name in like:
        own = {"stephenson-six-bar": 2.4, "cam-pusher": 2.5} | dict.fromkeys(BY_PIECES, 2.5)
        limit = Limit(own.get(name, 2.2))
        table.ratio(f"{name} / four-bar", times[name], times["four-bar"], limit)
    table.ratio(f"{beside} / four-bar", times[beside], times["four-bar"], Limit(2.5))
    for name in shaped:
        table.ratio(f"{name} / four-bar", times[name], times["four-bar"], Limit(2.5))
    by_loops(table)
    table.ratio(f"{with_joints} / without", times[with_joints], times["four-bar"])


def with_pieces() -> dict[str, Machine]:
    """A cam whose law has eight to sixteen pieces: two rises and falls, and two rests."""
    base = eq.load("cam-pusher")
    (cam,) = base.cams
    ways = ((120, 0.012), (60, 0.012), (120, 0.0), (60, 0.0))
    found = {}
    for name, law in BY_PIECES.items():
        parts = tuple(LengthSegment(np.radians(over), to, law) for over, to in ways)
        found[name] = replace(base, cams=(replace(cam, lift=LengthLaw(segments=parts)),))
    return found


def with_shapes() -> dict[str, Machine]:
    """Machines whose gears have eccentricities: on a carrier, and on a link that a dyad moves."""
    planting = eq.load("rotary-transplanter")
    in_air = replace(planting, planting=replace(planting.planting, soil=None))
    base = eq.load("geared-counterweight")
    ellipse = GearShape("elliptic", eccentricity=0.3)
    gear = replace(base.gears[0], ratio=-0.5, teeth=None, shape=ellipse)
    return {
        "rotary-transplanter in air, whose eccentricities vary": in_air,
        "geared-counterweight by ellipses, whose eccentricity varies": replace(base, gears=(gear,)),
    }


def by_loops(table: Table) -> None:
    """A linkage without an order of dyads beside one with: the loop, and a first analysis."""
    names = ("class-three", "stephenson-six-bar")
    tasks, first = {}, {}
    for name in names:
        machine = eq.load(name)
        batch = batch_of(machine, ("drive.speed",), WANTED)
        speeds = machine.drive.speed * np.linspace(1.0, 1.2, 2048)[:, None]
        agree(name, batch(speeds[:1])[0], analyzed(machine), CLOSE)
        tasks[name] = (lambda batch=batch, speeds=speeds: batch(speeds), len(speeds))
        first[name] = (lambda machine=machine: eq.analyze(replace(machine), ANGLES), 1)
    for what, each in {"a study": tasks, "a first analysis": first}.items():
        times = timed(each, 15)
        show(f"{what}, {ANGLES} crank angles", times)
        limit = Limit(5) if each is tasks else None
        table.ratio(f"{what}: {' / '.join(names)}", *(times[name] for name in names), limit)


def analyzed(machine: Machine) -> list[float]:
    """The three figures of one machine by the steps that NumPy runs."""
    summary = eq.analyze(machine, ANGLES).summary  # which knows where forces jump
    return [summary[signal].rms for signal in SIGNALS]


def masses(table: Table) -> None:
    """Designs that differ in masses alone: all twelve numbers of the links vary."""
    paths = tuple(
        f"links.{link}.{key}"
        for link in MACHINE.links
        for key in ("mass", "inertia", "center_of_mass.x", "center_of_mass.y")
    )
    base = [x for b in MACHINE.links.values() for x in (b.mass, b.inertia, *b.center_of_mass)]
    spread = 1 + 0.1 * np.random.default_rng(1).standard_normal((200_000, len(base)))
    values = np.clip(spread, 0.5, 1.5) * base
    batch = MassBatch(MACHINE, paths, WANTED, ANGLES)
    agree(
        "masses alone",
        batch(values[:1000])[0],
        batch_of(MACHINE, paths, WANTED)(values[:1000])[0],
        CLOSE,
    )
    times = timed({"masses alone": (lambda: batch(values), len(values))}, 25)["masses alone"]
    table.value("masses alone, 12 numbers", [1e9 * one for one in times], "ns", Limit(100))


def maps(table: Table) -> None:
    """A map of a million machines that differ in masses, beside the machines one by one."""
    paths = ("links.coupler.center_of_mass.x", "links.crank.mass")
    model = Template.load("yamashita-1")
    x, y = np.linspace(-0.06, 0.06, 1000), np.linspace(0.1, 0.5, 1000)
    some = np.stack([np.tile(x[::200], 5), np.repeat(y[::200], 5)], axis=1)
    for measure in ("ripple", "peak"):
        of = Objective("shaking_force.y" if measure == "ripple" else "shaking_force", measure)
        single = SingleValues(MachineVariants(model, {}), of, paths)
        found = landscape(model, dict(zip(paths, (x, y), strict=True)), of)
        agree(f"map, {measure}", found.values[::200, ::200].ravel(), single(some), CLOSE)
        tasks = {
            "map": (
                lambda of=of: landscape(model, dict(zip(paths, (x, y), strict=True)), of),
                10**6,
            ),
            "one by one": (lambda single=single: single(some), len(some)),
        }
        times = timed(tasks, 3)
        table.ratio(f"map, {measure}: a point / one machine", times["map"], times["one by one"])


def main() -> None:
    """Print what was measured."""
    busy = (
        ", ".join(f"{load:.1f}" for load in os.getloadavg()) if hasattr(os, "getloadavg") else "?"
    )
    print(f"{os.cpu_count()} processors; load before (1, 5 and 15 minutes): {busy}")
    table = Table()
    with tempfile.TemporaryDirectory() as folder:
        beside_c(table, Path(folder))
    beside_peers(table)
    other_machines(table)
    masses(table)
    maps(table)
    for part in (study_runs.first_call, study_runs.stored, study_runs.memory, study_runs.cluster):
        part(table)
    print()
    table.print()


if __name__ == "__main__":
    main()
