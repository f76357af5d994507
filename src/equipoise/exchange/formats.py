"""What a machine can be written as, a declaration each; all that lists them follows from these."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import field
from typing import TYPE_CHECKING, Literal

from equipoise.dataclass import dataclass
from equipoise.errors import UsageError
from equipoise.i18n import Note, localized, say, to_say
from equipoise.mechanism.assembly.joints import Structure
from equipoise.mechanism.dynamics.forces import massless
from equipoise.mechanism.parts.element_kinds import Element, PartKind, named_function, part_kinds
from equipoise.mechanism.parts.machine import Machine

if TYPE_CHECKING:
    from equipoise.balancing.workshop import Change


@dataclass(frozen=True)
class Format:
    """One kind of file.

    name : as `format` takes it.  module : that makes it, in this package; the one of its name here
    if not given.
    ending : of its files, with the dot.  needs : a library of the extra `exchange`.
    holds : what is in it, with ``{parts}`` for the kinds of parts that it has.
    of_store : whether it is of the designs of a study, not of a machine.
    posed : whether it shows the machine at a crank angle, or begins there.
    turns : whether it turns the driven link all the way round at constant speed.
    by_kind : whether it has code for each kind of parts that it holds (`PartKind.exports`), beside
    that for pins, guides and what turns two links in a fixed ratio.
    evaluates : whether it holds motions that have no formula.
    rubs : whether it holds friction in joints, or what follows from it.
    drags : whether it holds damping and drag of joints, which nothing presses on.
    tightens : whether its pins bear the tension of belts and chains.
    worded : whether it has sentences for readers, in their language.
    pushes : whether it holds drives that push, and their strokes.
    of_link : whether it holds the loads along one link, at one crank angle or at several.
    cuts : whether a workshop cuts by it, so that counterweights have whole sizes.
    """

    name: str
    ending: str
    title: str
    holds: str
    needs: str = ""
    of_store: bool = False
    posed: bool = True
    turns: bool = False
    by_kind: bool = False
    evaluates: bool = True
    module: str = ""
    rubs: bool = True
    drags: bool = False
    tightens: bool = True
    of_link: bool = False
    pushes: bool = False
    worded: bool = False
    cuts: bool = False

    def has(self, part: PartKind) -> bool:
        """Whether it holds a part."""
        if self.by_kind:
            return part.in_fixed_ratio or self.name in part.exports
        return self.evaluates or part.has_formula

    def has_kind(self, kind: type[PartKind]) -> bool:
        """Whether it holds parts of a kind, at least the simplest."""
        if self.by_kind:
            return kind.fixes_ratio or self.name in kind.exports
        return self.evaluates or kind.by_formula

    @property
    def contents(self) -> str:
        """What is in it, in words."""
        kinds = (kind for kind in part_kinds(Machine).values() if self.has_kind(kind))
        return self.holds.format(parts=", ".join(kind.group for kind in kinds))

    @property
    def maker(self) -> str:
        """Name of the module that makes it, which may stand in a room above this one."""
        return f"equipoise.{self.module or f'exchange.{self.name}'}"


FORMATS: Mapping[str, Format] = {
    item.name: item
    for item in (
        Format(
            "mjcf",
            ".xml",
            "MuJoCo (MJCF)",
            "bodies, pins, sliders, {parts}, as far as they are linear, damping and drag of "
            "joints, constant loads, rows, the support on its mounts, the drive at constant speed",
            turns=True,
            by_kind=True,
            rubs=False,
            drags=True,
            tightens=False,
        ),
        Format(
            "exudyn",
            ".py",
            "Exudyn",
            "a script that builds and runs bodies, pins, sliders, {parts}, constant loads, rows, "
            "the support on its mounts in the plane, the drive at constant speed",
            turns=True,
            by_kind=True,
            rubs=False,
            tightens=False,
        ),
        Format(
            "urdf",
            ".urdf",
            "robots (URDF)",
            "the tree: links with masses, hinges and slides with their damping and drag, {parts}, "
            "each of two joints; loops are cut",
            by_kind=True,
            rubs=False,
            drags=True,
            tightens=False,
        ),
        Format(
            "fmu",
            ".fmu",
            "co-simulation (FMI 2.0)",
            "motion and forces as outputs, speed and acceleration of the crank as inputs; {parts}, "
            "constant loads; C sources, and a library where a C compiler is found",
            turns=True,
            evaluates=False,
            rubs=False,
        ),
        Format(
            "modelica",
            ".mo",
            "Modelica",
            "one flat model: equations of motion of each link, pins, sliders, {parts}, constant "
            "loads, the drive at constant speed",
            turns=True,
            by_kind=True,
            rubs=False,
            tightens=False,
        ),
        Format(
            "dxf",
            ".dxf",
            "drawing (DXF)",
            "the linkage at a crank angle, paths of its points, pitch circles of gears, strands of "
            "belts, racks, surfaces of cams and the curves of their rollers' centres, parts to be "
            "cut: outlines and holes of links made of bodies, and of counterweights, with "
            "measures, thickness, material and mass; in mm",
            needs="ezdxf",
            worded=True,
            cuts=True,
        ),
        Format(
            "pdf",
            ".pdf",
            "workshop drawing (PDF)",
            "a sheet of A4 for each of these parts, to scale: outline, measures, holes, thickness, "
            "material, mass",
            posed=False,
            module="figures.workshop_sheet",
            worded=True,
            cuts=True,
        ),
        Format(
            "svg",
            ".svg",
            "parts (SVG)",
            "the same parts to be cut, at 1:1",
            posed=False,
            worded=True,
            cuts=True,
        ),
        Format(
            "xlsx",
            ".xlsx",
            "Excel",
            "links and points, figures of every output, all signals over crank angle with their "
            "units, charts of them, and what to change where it was balanced",
            needs="xlsxwriter",
            posed=False,
        ),
        Format(
            "mat",
            ".mat",
            "MATLAB",
            "a struct of links and points, figures of every output, and all signals with units",
            posed=False,
        ),
        Format(
            "html",
            ".html",
            "interactive page (HTML)",
            "one file that computes in a browser, without server or network: joints to drag, "
            "numbers to change, forces, torque and charts that follow at once",
            module="web.interactive",
            worded=True,
            rubs=False,
            pushes=True,
        ),
        Format(
            "inp",
            ".inp",
            "finite elements (CalculiX, Abaqus)",
            "a link with a section as beam elements, loaded by inertia, weight and all joints: a "
            "step for each crank angle asked for, or for that of the largest stress",
            of_link=True,
        ),
        Format(
            "link-loads",
            ".csv",
            "loads along a link (CSV)",
            "axial force, shear force, bending moment and stress along a link with a section, at "
            "every crank angle",
            of_link=True,
            module="exchange.link_loads",
        ),
        Format("csv", ".csv", "CSV", "all designs of a store", of_store=True),
        Format("parquet", ".parquet", "Parquet", "all designs of a store", of_store=True),
    )
}
"""By name."""

Angles = int | Sequence[float] | None
"""Crank angles, as an analysis takes them; None for those that suit a format."""


LEFT_OUT = {
    "file": to_say("note: the file leaves out {part}"),
    "drawing": to_say("note: the drawing leaves out {part}"),
    "page": to_say("This page leaves out {part}."),
}
"""What is said of each thing that is left out, by what is written."""


@dataclass(frozen=True)
class Job:
    """What is to be written.

    crank_angle : at which it is drawn, rad.
    changes : that balancing made of it; None where it was not balanced.
    link : whose loads are written; the only one with a section if None.
    angles : at which they are, a number of them in a turn or the angles, rad; as suits the format
        if None.
    sizes : how the sizes of counterweights differ from those of balancing; empty if they do not.
    left_out : what the format does not hold, as it goes on.
    """

    machine: Machine
    crank_angle: float = 0.0
    changes: tuple[Change, ...] | None = None
    link: str | None = None
    angles: Angles = None
    sizes: str = ""
    left_out: list[Note] = field(default_factory=list)

    def notes(self, of: Literal["file", "drawing", "page"]) -> Iterator[str]:
        """Lines about what was written: what it leaves out, and how sizes were rounded."""
        yield from (say(LEFT_OUT[of], part=localized(part)) for part in self.left_out)
        if self.sizes:
            yield say("note: {note}", note=localized(self.sizes))

    def writers(self, format: str) -> Iterator[Callable[..., None]]:
        """Functions that write parts of the machine into a format, one for each kind that has
        one there (`PartKind.exports`), in the order of the model file.
        """
        for table, kind in part_kinds(type(self.machine)).items():
            if format in kind.exports and getattr(self.machine, table):
                yield named_function(kind.exports[format])

    def leave_out(self, what: Note) -> None:
        """Report, once, what the file does not hold."""
        if what not in self.left_out:
            self.left_out.append(what)

    def leave_out_table(self, part: Element) -> None:
        """Note that elements of a kind have no tables in the format."""
        self.leave_out(Note("{parts} with a table", parts=Note(part.group)))

    def leave_out_forces(self) -> None:
        """Note that there are no forces where links lack masses."""
        if missing := massless(self.machine):
            self.leave_out(Note("all forces: {missing}", missing=missing))

    def need_every_joint(self, joints: Structure) -> None:
        """Refuse a machine whose joints state the same more than once.

        Raises
        ------
        UsageError : they do.
        """
        if joints.surplus:
            raise UsageError(
                Note(
                    "the linkage is overconstrained, so the equations of this format have no "
                    "unique solution; give another format, or remove redundant cranks or guides"
                )
            )

    def leave_out_support(self) -> None:
        """Note that one linkage on solid ground is all that there is."""
        if self.machine.support:
            self.leave_out(Note("the support"))
        if self.machine.rows[1:]:
            self.leave_out(Note("all rows but one"))

    def leave_out_soil(self) -> None:
        """Note that soil forces are left out."""
        if self.machine.in_soil:
            self.leave_out(Note("the soil's force"))

    def leave_out_planes(self) -> None:
        """Note that everything lies in one plane."""
        if self.machine.has_planes:
            self.leave_out(Note("the planes of links beside each other, and their bearings"))

    def leave_out_motor(self) -> None:
        """Note that the drive has a given speed, and no motor."""
        drive = self.machine.drive
        if drive.motor:
            self.leave_out(Note("the motor: the drive turns at constant speed"))
        if drive.acceleration:
            self.leave_out(Note("the drive's acceleration: the drive turns at constant speed"))
