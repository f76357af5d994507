"""Blocks that `equipoise check` prints for a study."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from equipoise.codegen.backends import engine, processors
from equipoise.codegen.figures import COMPUTED, REASONS
from equipoise.errors import lacking
from equipoise.i18n import Note, say, to_say
from equipoise.quantities.numbers import rate_told, time_told
from equipoise.results.blocks import Block, Cell, FileText, Notes, Table, Text
from equipoise.signals import Array
from equipoise.studies.blocks import Units, in_unit, labelled, spread_told, unit_in
from equipoise.studies.evaluate import evaluator
from equipoise.studies.outcomes import Evaluator, Outcome, estimated
from equipoise.studies.run import Route
from equipoise.studies.sampling import samples
from equipoise.studies.searching import LEAST_POPULATION, breeding_time, search_size
from equipoise.studies.study import SLOW_CHUNK
from equipoise.studies.tolerances import machines_of

if TYPE_CHECKING:
    from equipoise.studies.study import Study

HOW = {
    "numba": to_say("computed many at once, in compiled loops"),
    "numpy": to_say("computed many at once, by NumPy"),
}
"""How designs are computed, by what computes them."""
SLOW = to_say("computed one after the other")


def study_blocks(study: Study, units: Units, file: str) -> Iterator[Block]:
    """Everything about a study that can be told before it is computed."""
    compute = evaluator(study)
    own = study.own
    outcome = compute(own[None])
    sampling = study.sampling
    yield Text(say("model: {title}", title=study.model.base().title))
    template = to_say("{count} designs, {method}, seed {seed}")
    if sampling.method == "grid":
        template = to_say("{count} designs, {method}")
    yield Text(say(template, count=study.size, method=sampling.method, seed=sampling.seed))
    varied = _varied(study, units, own)
    yield Table.of("What varies", ("", "path", "model", "in the study"), varied)
    for correlation in study.correlations:
        yield Text(
            say(
                "correlation of {first} and {second}, coefficient {coefficient:g}",
                first=correlation.first,
                second=correlation.second,
                coefficient=correlation.coefficient,
            )
        )
    heads = ("", "of", "model", "at least", "at most", "make")
    yield Table.of("What is computed", heads, _computed(study, units, outcome))
    compiled = getattr(compute, "compiled", False)
    yield Text(say(HOW[engine()] if compiled else SLOW))
    yield from map(Text, _times(study, compute))
    if outcome.reason[0] != COMPUTED:
        reason = Note(REASONS[int(outcome.reason[0])])
        yield Notes((Note("the model itself has no figures ({reason})", reason=reason),))
    yield FileText("", "\n".join(_ready(study, file)))


def _times(study: Study, compute: Evaluator) -> Iterator[str]:
    """How long each command that takes the study needs at most, and what that was taken from."""
    route = Route(study)
    estimate = estimated(route, study.size, route.chunk, processors())
    yield say(
        "time for all: {total} on {processors}; measured: {rate} on one, with {designs}",
        total=_about(estimate.seconds),
        processors=say("{count} processors", count=estimate.workers),
        rate=rate_told(estimate.rate),
        designs=say("{count} designs", count=estimate.designs),
    )

    def sample_outcome(designs: range) -> Outcome:
        return compute(samples(study, designs.start, len(designs)))

    if _is_searched(study) and study.size >= LEAST_POPULATION:
        population, generations = search_size(study)
        most = population * generations
        seconds = estimated(sample_outcome, most, population, 1).seconds
        seconds += generations * breeding_time(study, population)
        yield say(
            "time for a search of at most {count} designs, {generations} generations of "
            "{population}: {time}",
            count=most,
            generations=generations,
            population=population,
            time=_about(seconds),
        )
    if _is_tolerance(study):
        most = machines_of(study)
        estimate = estimated(sample_outcome, study.size, min(study.chunk, SLOW_CHUNK), 1)
        seconds = estimate.seconds * most / study.size
        template = to_say("time for equipoise tolerance, of {count} machines: {time}")
        yield say(template, count=most, time=_about(seconds))


def _about(seconds: float) -> str:
    return say("about {time}", time=time_told(seconds)) if seconds >= 1 else say("less than 1 s")


def _is_searched(study: Study) -> bool:
    aimed = bool(study.objectives) and not any(item.spread.tolerance for item in study.vary)
    return aimed and not lacking("a search")


def _is_tolerance(study: Study) -> bool:
    return all(item.spread.tolerance for item in study.vary)


def _varied(study: Study, units: Units, own: Array) -> Iterator[tuple[Cell, ...]]:
    for variable, value in zip(study.vary, own.tolist(), strict=True):
        unit = unit_in(units, variable.path)
        spread = spread_told(variable.spread, unit)
        yield labelled(unit), variable.path, in_unit(value, unit), spread


def _computed(study: Study, units: Units, outcome: Outcome) -> Iterator[tuple[Cell, ...]]:
    for output, figure in zip(study.outputs, outcome.figures[0].tolist(), strict=True):
        unit = unit_in(units, output.name)
        ends = (in_unit(end, unit) for end in (output.at_least, output.at_most))
        own = in_unit(figure, unit)
        yield labelled(unit), output.of, own, *ends, output.make or ""


def _ready(study: Study, file: str) -> Iterator[str]:
    """Commands that take it, and what those lack that might."""
    yield lacking("a sweep") or _ready_for(f"equipoise sweep {file} -o designs.zarr")
    if _is_tolerance(study):
        yield _ready_for(f"equipoise tolerance {file}")
    if study.objectives and not any(item.spread.tolerance for item in study.vary):
        yield lacking("a search") or _ready_for(f"equipoise search {file}")


def _ready_for(command: str) -> str:
    return say("ready for: {command}", command=command)
