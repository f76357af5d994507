"""An interactive page in one file: the machine, its script, and all that a browser needs of them.

The script is that of `codegen.other_languages`: signals from the numbers of the model.  What the
page calls things, and in which units it shows them, is what the product does.
"""

from __future__ import annotations

import json
from base64 import b64encode
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cached_property, lru_cache
from html import escape
from typing import Any

import numpy as np

from equipoise.codegen.emit import moves_shared, pose_signals, signals_in_loops
from equipoise.codegen.kernel_script import extremes_script
from equipoise.codegen.other_languages import Script, javascript
from equipoise.codegen.steps import SURFACE
from equipoise.dataclass import dataclass
from equipoise.errors import UsageError
from equipoise.exchange.formats import Job
from equipoise.i18n import Note, catalogue, decimal_sign, localized, say, spoken
from equipoise.keys.paths import KeyPath
from equipoise.mechanism.assembly.family import can_vary
from equipoise.mechanism.assembly.reach import CHANGE_POINT
from equipoise.mechanism.kinematics.motion import Motion
from equipoise.mechanism.kinematics.tip import surface_of
from equipoise.mechanism.outputs.declared import GROUPS
from equipoise.mechanism.parts.balance import ROWS
from equipoise.mechanism.parts.machine import FRAME, Machine
from equipoise.quantities import FACTORS, KINDS, display, display_rules
from equipoise.quantities.numbers import Display, in_unit
from equipoise.results.analysis import Analysis, analyze
from equipoise.results.outputs import AnalysisOutput
from equipoise.results.result import words_of
from equipoise.schema.numbers import POLAR, FileNumber
from equipoise.schema.template import Template
from equipoise.signals import Array
from equipoise.symbols.scene import Scene
from equipoise.web.documents import ALONE, asset, data, document, script, style, wording_of
from equipoise.web.drawing import stage_of, ties_of
from equipoise.web.edits import movable
from equipoise.web.fields import CYCLE_SPEED, SECTIONS, measures_of
from equipoise.web.figures import listed_signals
from equipoise.web.following import extent_of
from equipoise.web.messages import JsonObject

PER_MINUTE = "1/min"
"""Unit of cycles a minute, where nothing turns that would have a speed in rpm."""


def export_bytes(job: Job) -> str:
    """The file's content.

    Raises
    ------
    UsageError : no script can be written of the machine, or the page has not been built.
    """
    if job.machine.support:
        job.leave_out(Note("the support and its mounts"))
    if job.machine.rows[1:]:
        job.leave_out(Note("in its drawing all rows but one"))
    job.leave_out_forces()
    job.leave_out_motor()
    machine = replace(job.machine, support=None, balance=None)
    page = Interactive(machine, job.crank_angle)
    notes = [*job.notes("page"), *map(localized, page.analysis.notes)]
    program = asset("interactive.js")
    own = wording_of(words_of(machine))["words"]
    words = dict(_said_by(program, spoken()))
    words |= {text: word for text, word in own.items() if _says(program, text)}
    speech = {"language": spoken(), "words": words, "decimal": decimal_sign()}
    body = (
        '<main id="equipoise-interactive"></main>',
        f"<noscript>{escape(say('This page needs JavaScript.'))}</noscript>",
        data("equipoise-machine", {**page.content, **speech, "notes": notes}),
        script(page.program, 'id="equipoise-states"'),
        script(program, 'type="module" id="equipoise-page"'),
    )
    return document(
        style(asset("interactive.css")),
        "\n".join(body),
        policy=ALONE,
        title=localized(machine.title),
        language=spoken(),
    )


@lru_cache(maxsize=3)
def _said_by(script: str, language: str) -> Mapping[str, str]:
    """Of all texts those that a script has, which takes longer than all else of a page."""
    return {text: word for text, word in catalogue(language).items() if _says(script, text)}


def _says(script: str, text: str) -> bool:
    """Whether a script has a text, which may stand there in quotes of either kind."""
    return text in script or json.dumps(text, ensure_ascii=False)[1:-1] in script


@dataclass(frozen=True)
class Interactive:
    """A machine as an interactive page holds it.

    crank_angle : at which it is shown first, rad.
    """

    machine: Machine
    crank_angle: float = 0.0

    @cached_property
    def analysis(self) -> Analysis:
        """The machine as it is, at the crank angles that `equipoise analyze` takes."""
        return analyze(self.machine)

    @property
    def motion(self) -> Motion:
        """At the crank angles that resolve where forces jump."""
        return self.analysis.resolved.motion

    @cached_property
    def outputs(self) -> list[AnalysisOutput]:
        """Outputs that a script can have, and what all rows have together."""
        outputs = {
            output.name: output
            for output in self.analysis.outputs
            if output.declared.array or output.declared.summed
        }
        rows = [output for name, output in outputs.items() if name.startswith(ROWS)]
        known = signals_in_loops(self.motion.linkage, outputs)
        return [*rows, *(outputs[name] for name in known)]

    @cached_property
    def template(self) -> Template:
        return Template.of(self.machine)

    @cached_property
    def script(self) -> Script:
        """Signals of the outputs and poses, from all numbers from which they can be written.

        Raises
        ------
        UsageError : there is none.
        """
        linkage = self.motion.linkage
        try:
            signals = [output.name for output in self.outputs if not output.name.startswith(ROWS)]
            names = [*signals, *pose_signals(linkage)]
            plain = javascript(linkage, names)
        except UsageError as error:
            refusal = Note(
                "an interactive page computes in the browser, which this machine does not let it: "
                "{why}; give another format",
                why=error.note,
            )
            raise UsageError(refusal) from error
        known = {path: number.value for path, number in self._candidates.items()}
        return self._with_numbers(names, known) or plain

    @property
    def program(self) -> str:
        """Source of the script's ``states``, and of ``extremes`` of their curves."""
        return self.script.text + extremes_script(jumps=self.motion.sampling is not None)

    def _with_numbers(self, names: Sequence[str], numbers: Mapping[str, float]) -> Script | None:
        """A script of as many of the numbers as can be handed to one; None of none."""
        written = [*self._written(names, [*numbers.items()])]
        while written:
            try:
                return javascript(self.motion.linkage, names, dict(written))
            except UsageError:
                written = written[: len(written) // 2]
        return None

    def _written(
        self, names: Sequence[str], numbers: list[tuple[str, float]]
    ) -> Iterator[tuple[str, float]]:
        """Those of some numbers from which the signals can be written, by halves that can."""
        if not numbers:
            return
        try:
            javascript(self.motion.linkage, names, dict(numbers))
        except UsageError:
            if len(numbers) > 1:
                middle = len(numbers) // 2
                yield from self._written(names, numbers[:middle])
                yield from self._written(names, numbers[middle:])
        else:
            yield from numbers

    @cached_property
    def _candidates(self) -> dict[str, FileNumber]:
        """Numbers of the model that may be columns, by their paths.

        Lengths that have to agree with others, as where joints hold more than the motion needs, are
        none of them.
        """
        columns, numbers, linkage = {}, self.template.numbers(), self.motion.linkage
        for path, number in numbers.items():
            steps = KeyPath.parse(path)
            if steps[-1] in POLAR and str(steps.parent / "x") in numbers:
                continue  # the same point by its coordinates
            if can_vary(self.machine, path) and not moves_shared(linkage, [path]):
                columns[path] = number
        return columns

    # -- what the page knows -----------------------------------------------------------------------

    @cached_property
    def content(self) -> JsonObject:
        """All that the page knows of the machine, as JSON has it; arrays are 64-bit floats."""
        motion, script, scene = self.motion, self.script, self.scene
        length = display("length", [extent_of(self.machine)])
        sampling = motion.sampling
        theta = motion.crank_angle
        content: JsonObject = {
            "title": localized(self.machine.title),
            "description": localized(self.machine.description),
            "rules": display_rules(),
            "length": {"unit": length.name, "factor": length.factor},
            "turns": motion.turns if motion.whole_cycle else 1,
            "speed": motion.speed,
            "begin": float(np.degrees(self.crank_angle)),
            "angles": len(theta),
            "theta": _floats(theta if sampling is None else sampling.at),
            "shares": None if sampling is None else _floats(sampling.shares),
            "edges": None if sampling is None else _floats(sampling.edges),
            "shown": None if sampling is None else sampling.curve_places.tolist(),
            "frames": None if sampling is None else sampling.grid.tolist(),
            "grid": _floats(script.grid(theta)),
            "rows": [*self._rows()],
            "flywheel": self.machine.drive.flywheel,
            "acceleration": motion.acceleration,
            "design": self._design(),
            "soil": self._soil(),
            "names": script.names,
            "outputs": [*self._outputs()],
            "fields": [*self._fields()],
            "measures": [*self._measures()],
            "margins": self._margins(),
            "least": CHANGE_POINT,
            "links": {
                name: {"points": [*link.points], "places": dict(link.points), "sized": _sized(link)}
                for name, link in self.machine.links.items()
            },
            "sliders": [
                {
                    "name": slider.name,
                    "point": slider.point,
                    "on": slider.on,
                    "link": slider.link,
                    "direction": slider.direction,
                }
                for slider in self.machine.sliders
            ],
            "driven": [drive.link for drive in self.machine.driven],
            "crank": self.machine.drive.link if self.machine.has_crank else None,
            "scene": stage_of(scene, movable(self.machine)),
            "ties": ties_of(scene, self.analysis.motion),
        }
        return content

    def _design(self) -> list[float]:
        """What the script takes: the numbers of the model, or what it finds in the linkage."""
        script = self.script
        if not script.paths:
            return [*map(float, script.numbers(self.motion.linkage))]
        numbers = [float(self._candidates[path].value) for path in script.paths]
        return [*numbers, surface_of(self.machine)] if SURFACE in script.cyclic else numbers

    def _soil(self) -> JsonObject | None:
        """Tips and depth by which the page finds the height of the soil's surface; None where there
        is no soil, or the file gives that height.
        """
        planting, place = self.machine.planting, self.script.cyclic.get(SURFACE)
        if place is None or planting is None or planting.surface is not None:
            return None
        heights = [f"points.{arm.tip}.y" for arm in planting.every_arm]
        return {"place": place, "heights": heights, "depth": planting.depth}

    @cached_property
    def scene(self) -> Scene:
        return Scene.of(self.analysis.motion)

    def _rows(self) -> Iterator[JsonObject]:
        """Rows on one shaft: where each is, and its crank angles; none where there is one."""
        for row in self.machine.rows if len(self.machine.rows) > 1 else ():
            grid = self.script.grid(self.motion.crank_angle + row.phase)
            yield {"grid": _floats(grid), "offset": row.offset, "lateral": row.lateral}

    def _outputs(self) -> Iterator[JsonObject]:
        """What can be drawn over the crank angle, and of what figures are reported."""
        groups = {group: say(title) for group, title in GROUPS.items()}
        first = listed_signals()
        for output in self.outputs:
            yield {
                "name": output.name,
                "label": output.label(),
                "group": groups[output.group],
                "kind": output.group,
                **_unit_content(display(output.dimension)),
                "summed": bool(output.declared.summed),
                "first": output.name in first,
            }

    def _fields(self) -> Iterator[JsonObject]:
        """Every number of the script, in its order."""
        template = self.template
        numbers = self._candidates
        for path in self.script.paths:
            number, steps = numbers[path], KeyPath.parse(path)
            unit = _unit(number, template.unit(path))
            key = template.key(path)
            is_cycle_speed = path == "drive.speed" and not self.machine.crank_turns
            per_minute = is_cycle_speed and self.machine.turns_given == 1
            printed_unit = _per_minute(unit) if per_minute else unit
            yield {
                "path": path,
                "steps": [*steps],
                "label": say(CYCLE_SPEED) if is_cycle_speed else localized(template.words(path)),
                "heading": str(steps[1]) if steps[0] == "links" else _section(str(steps[0])),
                "value": float(number.value),
                **_unit_content(printed_unit),
                "written": unit.unit,
                "units": _factors(number),
                "least": key and key.at_least,
                "above": key and key.above,
                "below": key and key.below,
            }

    def _measures(self) -> Iterator[JsonObject]:
        """Lengths between points of bodies whose places are numbers of the script."""
        paths = {*self.script.paths}
        bodies = {FRAME: self.machine.frame}
        bodies |= {name: link.points for name, link in self.machine.links.items()}
        for body, points in bodies.items():
            where = KeyPath((FRAME, "points") if body == FRAME else ("links", body, "points"))
            for measure in measures_of(points):
                start, end = where / measure.start, where / measure.moves
                if measure.dimension == "length" and {str(end / "x"), str(end / "y")} <= paths:
                    yield {
                        "label": measure.label,
                        "heading": _section(FRAME) if body == FRAME else body,
                        "start": measure.start,
                        "moves": measure.moves,
                        "from": str(start),
                        "path": str(end),
                        "fixed": points[measure.start],
                        **_unit_content(in_unit("mm")),
                        "units": _factors(FileNumber(measure.value, "length")),
                    }

    def _margins(self) -> list[list[str]]:
        """Of each margin among the signals, the links that it joins."""
        groups = [
            group
            for group in self.motion.linkage.groups
            if group.margin is not None and not group.through
        ]
        return [[*groups[dyad].links] for dyad in self.script.source.watched]


def _section(name: str) -> str:
    return say(SECTIONS.get(name, name))


def _sized(link: Any) -> str:
    """How the lengths of a link are given: by ``points``, a ``length`` or ``sides``."""
    return "length" if link.length is not None else "sides" if link.sides else "points"


def _unit(number: FileNumber, unit: str) -> Display:
    if number.share:
        return Display("%", 100.0)
    if number.dimension is None:
        return Display("", 1.0)
    return in_unit(unit)


def _per_minute(unit: Display) -> Display:
    """The unit of a speed with which nothing turns, by its cycles and not its turns."""
    return replace(unit, unit=PER_MINUTE) if unit.unit == "rpm" else unit


def _factors(number: FileNumber) -> dict[str, float]:
    """SI units in each unit in which a number may be typed."""
    if number.dimension is None:
        return {"%": 0.01} if number.share else {}
    return {unit: float(FACTORS[unit]) for unit in KINDS[number.dimension].units}


def _unit_content(unit: Display) -> JsonObject:
    return {"unit": unit.name, "factor": unit.factor}


def _floats(values: Array) -> str:
    """64-bit floats, little-endian, in base 64."""
    return b64encode(np.ascontiguousarray(values, "<f8").tobytes()).decode()
