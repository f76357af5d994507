"""What a page is sent of a machine: plain values, and arrays in one block of 32-bit floats."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import lru_cache

import numpy as np

from equipoise.figures.motion import traced
from equipoise.i18n import localized, say, speaking, spoken
from equipoise.mechanism.dynamics.forces import assumed_masses
from equipoise.mechanism.outputs.declared import GROUPS, declared, guided, pinned
from equipoise.mechanism.parts.machine import Machine
from equipoise.quantities import Dimension, Display, display
from equipoise.results.analysis import Analysis
from equipoise.signals import Array, Periodic
from equipoise.web.drawing import circles_of, ground_of, moves_of, stage_of
from equipoise.web.edits import Computed, kept_with_first, movable, turning
from equipoise.web.figures import charts_of, least_of, signals_of
from equipoise.web.following import extent_of
from equipoise.web.measured_records import MeasuredSignals
from equipoise.web.messages import JsonObject
from equipoise.web.replies import FloatBlock
from equipoise.web.sketch import Sketch, forces_lack
from equipoise.web.view_state import arrows_of, points_of, record_values

MOST_ORDER = 20
"""Highest order of the spectra."""


def state_of(
    computed: Computed,
    spectra: Mapping[str, Array],
    before: Computed | None,
    wanted: Sequence[str] = (),
    against: Computed | None = None,
    arrows_at: str | None = None,
    record: MeasuredSignals | None = None,
) -> tuple[JsonObject, bytes]:
    """Everything that a page draws of a machine, without its figures and numbers.

    spectra : its amplitudes by order, see `spectra_of`.
    before : whose curves are drawn behind its own, if any's.
    wanted : names of further outputs that it draws, as far as there are such.
    against : the design whose figures stand beside its own, if any; `before` by default.
    arrows_at : a point of which velocity, acceleration and forces are drawn.
    record : that is drawn beside its own signals.
    """
    block = FloatBlock()
    moves_of(computed.scene, block)
    content = _drawing_of(computed)
    if computed.finished:
        content |= _signals(computed, spectra, before, wanted, block)
        content |= {
            "compared": (against or before) is not None,
            "record": record_values(record, computed, block),
            "arrows_at": arrows_at,
            "arrows": arrows_of(computed.analysis, arrows_at, block) if arrows_at else [],
            **ground_of(computed, block),
        }
    content["arrays"] = block.placement
    return content, block.data


def _drawing_of(computed: Computed) -> JsonObject:
    """What a page draws of any machine, with nothing in what only a finished one has."""
    draft, status = computed.design, status_of(computed)
    if isinstance(draft, Sketch):
        texts, size = draft.rest, draft.size
        stage = stage_of(computed.scene, [*draft.places])
    else:
        machine = computed.analysis.machine
        texts = {"title": machine.title, "description": machine.description}
        size = extent_of(machine)
        circles = circles_of(machine, computed.motion.linkage.joints)
        stage = stage_of(computed.scene, movable(machine), circles)
    length = display("length", [size])
    nothing: JsonObject = {
        key: [] for key in ("traced", "outputs", "charts", "orders", "notes", "points", "arrows")
    }
    return {
        "name": draft.name,
        "title": localized(texts["title"]),
        "description": localized(texts.get("description", "")),
        "length": {"unit": length.name, "factor": length.factor},
        "status": status,
        "scene": stage,
        "lacking": computed.lacks,
        "angles": 1,
        "turns": 1,
        "speed": 0,
        "first": "squares",
        "least": 0,
        "before": False,
        "compared": False,
        "record": None,
        "arrows_at": None,
        **nothing,
    }


def _signals(
    computed: Computed,
    spectra: Mapping[str, Array],
    before: Computed | None,
    wanted: Sequence[str],
    block: FloatBlock,
) -> JsonObject:
    """What a page draws of a finished machine over the crank angle; arguments as of `state_of`."""
    analysis = computed.analysis
    machine, motion = analysis.machine, analysis.motion
    signals = signals_of(analysis)
    _add_signals(block, signals, analysis, spectra)
    _add_outputs(block, analysis, wanted)
    if before is not None:
        old = signals_of(before.analysis)
        _add_signals(block, old, before.analysis, _spectra_before(before), "before.")
        _add_outputs(block, before.analysis, wanted, "before.")
    lacking = forces_lack(machine)
    return {
        "angles": len(computed.scene.crank_angle),
        "turns": motion.turns,
        "speed": motion.speed,
        "lacking": lacking,
        "shaken": machine.support is not None and not lacking,
        "traced": traced(motion),
        "first": first_of(machine)[0],
        "outputs": outputs_of(analysis),
        "charts": charts_of(analysis, signals),
        "least": least_of(signals),
        "orders": _orders(analysis),
        "notes": [
            *(localized(note) for note in (computed.along, computed.swings) if note),
            *(localized(note) for note in (assumed_masses(machine),) if note),
            *([lacking] if lacking else []),
        ],
        "held": localized(computed.limit_note) if computed.limit_note else None,
        "before": before is not None,
        "beside": machine.has_planes,
        "points": points_of(analysis),
    }


def outputs_of(analysis: Analysis) -> list[JsonObject]:
    """What can be drawn over the crank angle."""
    units = tuple((dimension, display(dimension)) for dimension in analysis.outputs.dimensions)
    groups = tuple(say(title) for title in GROUPS.values())
    several = len(analysis.machine.rows) > 1
    return _output_values(tuple(analysis.outputs.names), several, units, groups, spoken())


@lru_cache(16)
def _output_values(
    names: tuple[str, ...],
    several: bool,
    units: tuple[tuple[Dimension | None, Display], ...],
    groups: tuple[str, ...],
    language: str,
) -> list[JsonObject]:
    """Labels, units and groups of outputs, which stay from one move of a drag to the next."""
    by_dimension, headings = dict(units), dict(zip(GROUPS, groups, strict=True))
    with speaking(language):
        return [
            {
                "name": name,
                "label": output.say(item, several),
                "group": headings[output.group],
                "winds": output.dimension == "angle",
                "unit": by_dimension[output.dimension].name,
                "factor": by_dimension[output.dimension].factor,
            }
            for name in names
            for output, item in [declared(name) or (None, "")]
            if output is not None
        ]


def status_of(computed: Computed) -> JsonObject:
    """Status of a machine: its mobility, and a sentence on it.

    mobility : number of free motions.  text : a sentence: what moves, or what is missing.
    finished : whether it can be computed.  drive : the crank, if there is one that turns.
    stand : crank angle at which it was drawn, deg; None where it has not just been made.
    """
    draft, stand = computed.design, computed.stand
    if isinstance(draft, Sketch):
        mobility, text = draft.mobility, computed.lacks
        drive = draft.drive.link if draft.drive else None
    else:
        machine = computed.analysis.machine
        mobility, text = len(machine.driven), turning(machine)
        drive = machine.drive.crank or None
    return {
        "mobility": mobility,
        "text": text,
        "finished": computed.finished,
        "drive": drive,
        "stand": None if stand is None else float(np.degrees(stand)),
    }


def _add_outputs(
    block: FloatBlock, analysis: Analysis, names: Sequence[str], prefix: str = ""
) -> None:
    """Outputs that the page has asked for, in the unit in which it reads them."""
    for name in names:
        if name in analysis.outputs:
            block.add(f"{prefix}output.{name}", analysis.outputs[name].values_to_draw)


def _add_signals(
    block: FloatBlock,
    signals: dict[str, Array],
    analysis: Analysis,
    spectra: Mapping[str, Array],
    prefix: str = "",
) -> None:
    if prefix and signals:
        block.add(f"{prefix}crank_angle", analysis.crank_angle)
    for name, values in signals.items():
        block.add(f"{prefix}{name}", values)
    for name, sizes in spectra.items():
        block.add(f"{prefix}spectrum.{name}", sizes)


def spectra_of(analysis: Analysis, last: Mapping[str, Array] | None = None) -> Mapping[str, Array]:
    """Amplitude at each order that is shown, by name.

    last : of a machine that differs by little; returned unless names or orders are others.
    """
    if not analysis.has_forces:
        return {}
    turns = analysis.motion.turns
    ordered = [item for item in analysis.outputs.ordered if item.declared.compared]
    whole = signals_of(analysis).get("rows.shaking_force")
    names = [item.name for item in ordered]
    names += [] if whole is None else ["rows.shaking_force.x", "rows.shaking_force.y"]
    shape = (_places(turns) + 1,)
    if last is not None and [*last] == names and all(old.shape == shape for old in last.values()):
        return last
    motion = analysis.resolved.motion
    # No more orders than are drawn: where forces jump they are sums over thousands of crank angles.
    sizes = [
        *_sizes(motion.periodic(np.stack([item.resolved for item in ordered]), _places(turns)))
    ]
    if whole is not None:
        sizes += [_sizes(Periodic.of(part, turns)) for part in (whole.real, whole.imag)]
    return dict(zip(names, sizes, strict=True))


@kept_with_first
def _spectra_before(before: Computed) -> Mapping[str, Array]:
    """Spectra of a machine that stays while another is changed."""
    return spectra_of(before.analysis)


def _places(turns: int) -> int:
    """Places of orders in spectra, without that of order 0."""
    return MOST_ORDER * turns


def _sizes(signal: Periodic) -> Array:
    """Amplitude (..., P) at each place of spectra; 0 where there is no such order."""
    low_orders = signal.sizes[..., : _places(signal.turns) + 1]
    sizes = np.zeros((*low_orders.shape[:-1], _places(signal.turns) + 1))
    sizes[..., : low_orders.shape[-1]] = low_orders
    return sizes


def _orders(analysis: Analysis) -> list[float]:
    if not analysis.has_forces:
        return []
    turns = analysis.motion.turns
    return [number / turns for number in range(_places(turns) + 1)]


# -- what comes first ------------------------------------------------------------------------------


def first_of(machine: Machine) -> tuple[str, tuple[str, ...]]:
    """The charts that a page shows first, and the outputs that it draws: what a machine is for.

    On mounts that is what its gauges read; of a follower its motion; of a planting
    finger, or of a machine that moves one thing, its path and the shaking force; of one that moves
    one thing by way of another, such as a six-bar with a dwell, the motion of its output.
    """
    lifts = tuple(
        dict.fromkeys(
            _motion_of(machine, coupling.driven)
            for coupling in machine.couplings
            if coupling.contact == "surface"
        )
    )
    moved = [link for link in pinned(machine) if len(machine.links[link].points) > 1]
    moved += guided(machine)
    if machine.support is not None and not forces_lack(machine):
        return "answers", lifts
    if machine.planting is not None:
        return "squares", lifts
    if len(moved) < 2:
        return "output" if lifts else "squares", lifts
    slides = moved[-1] not in machine.links
    last = f"sliders.{moved[-1]}.travel" if slides else f"links.{moved[-1]}.angle"
    return "output", tuple(dict.fromkeys((last, *lifts)))


def _motion_of(machine: Machine, follower: str) -> str:
    """The output that is the motion of a follower: along its guide, or about its pin."""
    guides = (slider.name for slider in machine.sliders if slider.link == follower)
    guide = next(guides, None)
    return f"links.{follower}.angle" if guide is None else f"sliders.{guide}.travel"
