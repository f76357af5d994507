"""Figures of a machine before and after a change, and which of them got worse."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import replace

from equipoise.balancing.cylinder_phasing import PhasedRows, PhaseObjective
from equipoise.balancing.objectives import measured
from equipoise.dataclass import dataclass
from equipoise.errors import EquipoiseError, ModelError, ResponseError
from equipoise.mechanism.outputs.declared import GROUPS, declared
from equipoise.mechanism.parts.balance import GAUGES, ROWS, WITHIN, Balance, Objective, Statistic
from equipoise.mechanism.parts.machine import Machine
from equipoise.planting.summary import plant
from equipoise.results.analysis import Analysis
from equipoise.results.outputs import AnalysisOutput, unit_of_measure
from equipoise.vibration.forced import respond

ALIKE = 9
"""Digits by which growths are ordered, so that rounding does not decide between figures that grew
alike, as peak and peak to peak of a signal that reaches as far up as down."""
WORSE = 0.01
"""Relative growth from which a figure counts as worse."""
SMALL = 0.1
"""Of the largest figure of its unit before: the growth of what was less is measured by that one."""
FAINT = 1e-4
"""Of the largest figure of its unit: what is smaller is nobody's concern."""
NOTHING = 1e-6
"""Of the largest figure of its kind: an optimum is known to about 1e-7, so that masses which would
cancel leave as much of a figure where there is nothing."""
IMPORTANT = tuple(dict.fromkeys(("gauges", "rows", *GROUPS)))
"""Groups of outputs in the order in which a reader asks for them."""

BeforeAndAfter = tuple[float, float]
"""A value before and after."""


@dataclass(frozen=True)
class Worse:
    """A figure that got larger by more than `WORSE`: of several measures the one that grew most.

    objective : its output, its measure, and where it is read.  group : of the output.
    weight : the growth of what grew most of its measures when it is weighed: over the value before,
        or where that is small over the largest before of its unit; none of a component, which its
        vector weighs.
    """

    objective: Objective
    group: str
    before: float
    after: float
    weight: float

    @property
    def growth(self) -> float:
        """Over the value before; endless where there was nothing."""
        return self.after / self.before - 1 if self.before > 0 else float("inf")


def worse_of(
    before: Mapping[str, float],
    after: Mapping[str, float],
    aims: Mapping[Objective, BeforeAndAfter],
) -> tuple[Worse, ...]:
    """Every figure that got worse, the important ones first, and the worst first among these.

    Parameters
    ----------
    before, after : from `figures_of`.  aims : what was made small.
    """
    pairs = dict(aims)
    for name, old in before.items():
        output, _, measure = name.rpartition(".")
        if output:
            pairs[Objective(output, measure)] = (old, after.get(name, 0.0))  # type: ignore[arg-type]
    largest: dict[str, float] = {}
    usual: dict[str, float] = {}
    for item, pair in pairs.items():
        unit = _unit(item)
        usual[unit] = max(usual.get(unit, 0.0), pair[0])
        largest[kin(unit)] = max(largest.get(kin(unit), 0.0), *pair)
    result = []
    for item, (old, new) in pairs.items():
        unit = _unit(item)
        if new > (1 + WORSE) * old and new > FAINT * largest[kin(unit)]:
            there = old if old > FAINT * new else 0.0
            scale = old if old > SMALL * usual[unit] else usual[unit]
            weight = 0.0 if _is_part(item) else (new - old) / scale if scale else float("inf")
            result.append(Worse(item, _group_of(item.output), there, new, weight))
    result.sort(key=lambda growth: (IMPORTANT.index(growth.group), -round(growth.growth, ALIKE)))
    worses: dict[tuple[str, tuple[float, ...], str | None], Worse] = {}
    for grown in result:
        aim = grown.objective
        key = aim.output, aim.speeds, aim.about
        most = worses.setdefault(key, grown)
        worses[key] = replace(most, weight=max(most.weight, grown.weight))
    return tuple(worses.values())


def _is_part(objective: Objective) -> bool:
    known = declared(objective.output)
    return known is not None and known[0].part in ("x", "y")


def _group_of(output: str) -> str:
    known = declared(output)
    return known[0].group if known is not None else output.partition(".")[0]


def _unit(objective: Objective) -> str:
    """SI unit of a figure; of all gauges the same."""
    gauge = objective.output.startswith("gauges.")
    return "gauges" if gauge else unit_of_measure(objective.output, objective.measure)


def scales_of(
    before: Mapping[str, float], after: Mapping[str, float], units: Mapping[str, str]
) -> dict[str, float]:
    """Of each figure by name, the largest of its kind before or after, as of all forces.

    units : SI unit of each figure; what has none here is left out.
    """
    largest: dict[str, float] = {}
    for name, unit in units.items():
        top = max(before.get(name, 0.0), after.get(name, 0.0))
        largest[kin(unit)] = max(largest.get(kin(unit), 0.0), top)
    return {name: largest[kin(unit)] for name, unit in units.items()}


def kin(unit: str) -> str:
    """Unit of what figures come from, among which one may be nothing but rounding."""
    return "N m" if unit == "J" else unit


def merged(plan: Balance, values: Mapping[str, BeforeAndAfter]) -> dict[Objective, BeforeAndAfter]:
    """Aims of a plan before and after; of one that is read at several speeds the loudest.

    values : of each objective, by its name.
    """

    groups: dict[Objective, list[Objective]] = {}
    for objective in plan.objectives:
        groups.setdefault(replace(objective, speeds=(), weight=1.0), []).append(objective)
    by_name: dict[Objective, BeforeAndAfter] = {}
    for first, *others in groups.values():
        speeds = tuple(speed for item in (first, *others) for speed in item.speeds)
        pairs = [values[item.name] for item in (first, *others)]
        old, new = (max(each) for each in zip(*pairs, strict=True))
        by_name[replace(first, speeds=speeds)] = (old, new)
    return by_name


def figure_of(objective: Objective, rows: int, figures: Collection[str]) -> str | None:
    """The name among figures of what an objective asks for; None where it is none of them.

    rows : of the machine, which add up in all but what acts within one of them.
    """
    if objective.about or objective.orders or objective.speeds:
        return None
    inner = rows < 2 or objective.output.startswith((GAUGES, *WITHIN))
    name = f"{'' if inner else ROWS}{objective.output}.{objective.measure}"
    return name if name in figures else None


# -- figures before and after ----------------------------------------------------------------------


def figures_of(analysis: Analysis) -> dict[str, float]:
    """Figures at constant speed by name, such as ``shaking_force.rms``, but for those of planting;
    SI units.

    Moments are about the drive's pivot; areas are under the absolute value over 360 deg, in J.
    """
    figures = {"mass": analysis.machine.mass}
    for output in analysis.outputs:
        for measure in output.declared.compared if output.declared.is_of_row else ():
            figures[f"{output.name}.{measure}"] = _measured(analysis, output, measure)
    return figures | _of_rows(analysis) | _of_support(analysis.machine)


def _measured(analysis: Analysis, output: AnalysisOutput, measure: Statistic) -> float:
    """A measure of an output as an analysis has it, which sees where forces jump."""
    whole = analysis.resolved
    values = output.declared.component(output.declared.vector(whole, output.item))
    return measured(values, measure, whole.motion.sampling)


def _of_rows(analysis: Analysis) -> dict[str, float]:
    """Figures of all rows together, where there are several; 0 where the rows cancel."""
    rows, figures = PhasedRows(analysis.machine), {}
    for output in analysis.outputs:
        item = output.declared
        for measure in item.compared if item.needs == "rows" else ():
            objective = Objective(output.name.removeprefix(ROWS), measure)
            term = PhaseObjective(objective, rows.signals(objective))
            value = term.without_rounding(_measured(analysis, output, measure))
            figures[f"{output.name}.{measure}"] = value
    return figures


def _of_support(machine: Machine) -> dict[str, float]:
    figures: dict[str, float] = {}
    if machine.support is None:
        return figures
    try:
        gauges = respond(machine).gauges
    except (ModelError, ResponseError):  # without a steady state gauges have no figures
        return figures
    for name, gauge in gauges.items():
        figures[f"gauges.{name}.peak_to_peak"] = float(gauge.displacement.peak_to_peak)
        figures[f"gauges.{name}.ripple"] = float(gauge.displacement.vibration_rms)
    return figures


def planting_of(machine: Machine) -> dict[str, float]:
    """Figures of the tip's path by name, such as ``planting.curve.height``; SI units.

    Balancing must not change them, and they take far longer than all others.
    """
    if machine.planting is None:
        return {}
    try:
        figures = plant(machine).figures
    except EquipoiseError:  # a tip that never reaches the soil has no figures, and still shakes
        return {}
    return {f"planting.{name}": value for name, value in figures.items()}
