"""All results of a model file, each computed on first access."""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import field, replace
from functools import cached_property, wraps
from typing import TYPE_CHECKING, Any, ClassVar, TypeVar

from equipoise.dataclass import dataclass
from equipoise.errors import EquipoiseError, ModelError, UsageError, at_place
from equipoise.handheld.model import Tool
from equipoise.i18n import Note, in_each, localized, say, to_say
from equipoise.mechanism.parts.machine import Machine
from equipoise.quantities import in_si
from equipoise.results.analysis import ANGLES

if TYPE_CHECKING:
    import numpy as np

    from equipoise.balancing.balanced import Balanced
    from equipoise.handheld.design import ToolDesign
    from equipoise.handheld.hand_exposure import ToolExposure
    from equipoise.handheld.modes import ToolModes
    from equipoise.handheld.sweep import ToolSweep, Transmissions
    from equipoise.planting.summary import PlantingFigures
    from equipoise.results.analysis import Analysis
    from equipoise.running.run_results import DrivesRun, Run
    from equipoise.vibration.forced import Sweep
    from equipoise.vibration.free import FreeVibration
    from equipoise.vibration.response import Response

PartT = TypeVar("PartT")


@dataclass(frozen=True, eq=False)
class _ComputedParts:
    """Parts that cannot be computed are None, and `failed` keeps why."""

    dependents: ClassVar[tuple[str, ...]]
    """Parts that ask for all others."""

    failed: dict[str, Note] = field(default_factory=dict, init=False, repr=False)

    @property
    def owner(self) -> Machine | Tool:
        """What it is of."""
        owner: Machine | Tool = getattr(self, "machine", None) or getattr(self, "tool")  # noqa: B009
        return owner

    @property
    def notes(self) -> tuple[Note | str, ...]:
        """A sentence on each part that could not be computed, and why; computes all of them."""
        for part in self.dependents:
            getattr(self, part)
        return tuple(at_place(Note(part), why) for part, why in self.failed.items())


def part(name: str) -> Callable[[Callable[[Any], PartT]], cached_property[PartT | None]]:
    """A part that is computed when it is first asked for; None, with a note, where that fails."""

    def of(compute: Callable[[Any], PartT]) -> cached_property[PartT | None]:
        @wraps(compute)
        def part_or_none(self: _ComputedParts) -> PartT | None:
            try:
                return compute(self)
            except EquipoiseError as error:
                self.failed[name] = error.note
                return None

        return cached_property(part_or_none)

    return of


@dataclass(frozen=True, eq=False)
class Findings(_ComputedParts):
    """All results of a linkage, each computed on first access.

    machine : at the speed that is asked for.
    text : of its file.  file : its name.
    angles : crank angles in a turn.
    swings : that its crank cannot turn, and how far it is let swing; None where it can.
    """

    dependents = ("planting", "run", "sweep", "modes", "balanced")

    machine: Machine
    text: str
    file: str
    angles: int = ANGLES
    swings: Note | None = None

    @property
    def notes(self) -> tuple[Note | str, ...]:
        """That the crank cannot turn comes before what could not be computed."""
        return (*([] if self.swings is None else [self.swings]), *super().notes)

    @cached_property
    def analysis(self) -> Analysis:
        """Motion and forces; errors as `equipoise.analyze`."""
        from equipoise.results.analysis import analyze

        return analyze(self.machine, self.angles)

    @part(to_say("planting"))
    def planting(self) -> PlantingFigures | None:
        """Path of the finger over ground; None where nothing is planted."""
        from equipoise.planting.summary import plant

        return None if self.machine.planting is None else plant(self.machine)

    @part(to_say("run"))
    def run(self) -> Run | DrivesRun | None:
        """Run that the table ``[run]`` of the file asks for; None where there is none."""
        if self.machine.run is None:
            return None
        from equipoise.running.run import run

        return run(self.machine)

    @part(to_say("vibration"))
    def response(self) -> Response | None:
        """Vibration at the speed of the machine; None where it has no support."""
        from equipoise.vibration.forced import respond

        return None if self.machine.support is None else respond(self.machine)

    @part(to_say("vibration over speed"))
    def sweep(self) -> Sweep | None:
        """Vibration over speeds around that of the machine."""
        from equipoise.vibration.forced import COARSE, sweep_speed
        from equipoise.vibration.linear import around

        if self.response is None:
            return None
        ends = around(self.machine.drive, self.response.speed)
        return sweep_speed(self.machine, *ends, speeds=COARSE)

    @part(to_say("natural frequencies"))
    def modes(self) -> FreeVibration | None:
        """Free vibration on the support."""
        from equipoise.vibration.free import modes

        return None if self.machine.support is None else modes(self.machine)

    @part(to_say("balance"))
    def balanced(self) -> Balanced | None:
        """The machine balanced by its own plan, or by the remedy that helps most."""
        from equipoise.balancing.advice import advise

        return advise(self.machine)

    @property
    def helped(self) -> bool:
        """Whether balancing brings anything that is worth a change."""
        return self.balanced is not None and self.balanced.helps

    @cached_property
    def after(self) -> Findings | None:
        """Findings of the balanced machine; None where balancing brings nothing."""
        if self.balanced is None or not self.helped:
            return None
        return Findings(self.balanced.machine, self.text, self.file, self.angles)


@dataclass(frozen=True, eq=False)
class ToolFindings(_ComputedParts):
    """All results of a hand-held tool, each computed on first access.

    tool : working at the speed that is asked for.
    text : of its file.  file : its name.
    """

    dependents = ("modes", "sweep", "exposure", "design")

    tool: Tool
    text: str
    file: str

    @part(to_say("natural frequencies"))
    def modes(self) -> ToolModes | None:
        """Free vibration."""
        from equipoise.handheld.modes import vibrate_tool
        from equipoise.handheld.sweep import MODES

        return vibrate_tool(self.tool, MODES)

    @part(to_say("speeds"))
    def speeds(self) -> np.ndarray[Any, Any] | None:
        """Speeds of the engine (N,), rad/s, denser about resonances; None without an operation."""
        from equipoise.handheld.sweep import SPEEDS, default_speeds, speeds_between

        ends = default_speeds(self.tool)
        return None if ends is None else speeds_between(self.tool, *ends, SPEEDS)

    @part(to_say("vibration over speed"))
    def sweep(self) -> ToolSweep | None:
        """The tool over these speeds."""
        from equipoise.handheld.sweep import sweep_tool

        if self.speeds is None or not self.tool.stations:
            return None
        return sweep_tool(self.tool, self.speeds)

    @property
    def transmission(self) -> Transmissions | None:
        """Of a unit force to what holds the tool."""
        return None if self.sweep is None else self.sweep.transmissions

    @part(to_say("exposure"))
    def exposure(self) -> ToolExposure | None:
        """What the hands get; None where nothing shakes the tool or no hand holds it."""
        from equipoise.handheld.hand_exposure import expose_tool

        if self.speeds is None or not self.tool.excitations or not self.tool.grips:
            return None
        return expose_tool(self.tool, self.speeds)

    @part(to_say("design"))
    def design(self) -> ToolDesign | None:
        """What to change, where the file asks for it."""
        from equipoise.handheld.design import design_tool

        return None if self.tool.design is None else design_tool(self.tool)

    @part(to_say("exposure after the change"))
    def exposure_after(self) -> ToolExposure | None:
        """What the hands get of the changed tool; None where the file asks for no change."""
        from equipoise.handheld.hand_exposure import expose_tool

        if self.design is None or self.exposure is None or self.speeds is None:
            return None
        return expose_tool(self.design.better, self.speeds)


SHOWN_SWINGING = to_say(", swinging as its crank cannot turn fully")


def find(
    model: str | os.PathLike[str] | Machine | Tool,
    *,
    angles: int = ANGLES,
    speed: float | str | None = None,
    swings: bool = False,
) -> Findings | ToolFindings:
    """All results of a machine or a tool, each computed on first access.

    model : the machine or tool, the path of its file, or the name of a bundled example.
    angles : crank angles in a turn.
    speed : of the crank, or of the tool's engine, rad/s or a text; the model's where not given.
    swings : whether a crank that cannot turn is shown swinging, which the title then says.

    Raises
    ------
    ModelError : the file is wrong, or a study.
    UsageError : the tool has no speed that could be another.
    """
    from equipoise.mechanism.kinematics.swinging import swing

    given, text, name = _with_text(model)
    speed = in_si(speed, "angular speed", "speed")
    if isinstance(given, Tool):
        return ToolFindings(_at_speed(given, speed), text, name)
    machine = given if speed is None else given.with_drive(speed=speed)
    result = swing(machine) if swings else None
    if result is None:
        return Findings(machine, text, name, angles)
    title = in_each(machine.title, lambda own: f"{own}{say(SHOWN_SWINGING)}")
    return Findings(replace(result.machine, title=title), text, name, angles, result.note)


def _with_text(
    model: str | os.PathLike[str] | Machine | Tool,
) -> tuple[Machine | Tool, str, str]:
    """A machine or a tool, the text of its file, and the name of that; without a file its title,
    and no text where it has what no file can hold.
    """
    from equipoise.schema.files import printable
    from equipoise.schema.models import dumped, loads_linkage, loads_tool
    from equipoise.schema.open_files import kind_of_text, opened

    if isinstance(model, Machine | Tool):
        try:
            return model, dumped(model), localized(model.title)
        except ModelError:
            return model, "", localized(model.title)
    file = opened(model)
    read = loads_tool if kind_of_text(file.text) == "tool" else loads_linkage
    name = printable(os.path.basename(model))
    return read(file.text, file.source, file.folder), file.text, name


def _at_speed(tool: Tool, speed: float | None) -> Tool:
    if speed is None:
        return tool
    if tool.operation is None:
        raise UsageError(Note("the tool has no speed of its engine; add the table [operation]"))
    if not speed > 0:
        raise UsageError(
            Note("got {speed:g} rad/s for the speed of the engine; give more than 0", speed=speed)
        )
    return replace(tool, operation=replace(tool.operation, speed=speed))
