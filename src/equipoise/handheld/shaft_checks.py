"""What is wrong with the values of a shaft."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise

from equipoise.errors import ModelError
from equipoise.handheld.shaft import Section, Shaft, Tube
from equipoise.i18n import Note
from equipoise.mechanism.checks import numbered
from equipoise.quantities import Measured


def wrong_shaft(shaft: Shaft) -> Iterator[ModelError]:
    """Everything that is wrong with the values of a shaft."""
    yield from _wrong_profile("shaft", shaft.profile, shaft)
    for where, segment in numbered("shaft.segments", shaft.segments):
        if not 0 <= segment.start < segment.stop <= shaft.length:
            yield ModelError(
                where,
                Note(
                    "goes from {start} to {stop}; give a part of the shaft, which goes from "
                    "{end} to {length}",
                    start=Measured(segment.start, "length"),
                    stop=Measured(segment.stop, "length"),
                    end=Measured(0.0, "length", limit=True),
                    length=Measured(shaft.length, "length"),
                ),
            )
        yield from _wrong_profile(where, segment.profile, shaft)
    ordered = sorted(numbered("shaft.segments", shaft.segments), key=lambda place: place[1].start)
    for (before, first), (where, second) in pairwise(ordered):
        if second.start < first.stop:
            yield ModelError(
                where,
                Note(
                    "begins at {start}, where {before} still goes on to {stop}; parts must not "
                    "overlap",
                    start=Measured(second.start, "length"),
                    before=before,
                    stop=Measured(first.stop, "length"),
                ),
            )


def _wrong_profile(where: str, profile: Section | Tube, shaft: Shaft) -> Iterator[ModelError]:
    if isinstance(profile, Section):
        if shaft.theory == "timoshenko" and profile == profile.section("euler-bernoulli"):
            yield ModelError(
                f"{where}.bending_stiffness",
                Note(
                    "does not determine the shear stiffness; with theory timoshenko give the "
                    "dimensions of a tube, outer_diameter and material"
                ),
            )
        return
    inner, outer, ratio = profile.inner_diameter, profile.outer_diameter, profile.poisson_ratio
    if inner >= outer:
        yield ModelError(
            f"{where}.inner_diameter",
            Note(
                "got {inner} inside of {outer}; give less than that",
                inner=Measured(inner, "length", "mm"),
                outer=Measured(outer, "length", "mm"),
            ),
        )
    if not 0 <= ratio <= 0.5:
        yield ModelError(
            f"{where}.poisson_ratio",
            Note("got {ratio:g}; give a number from 0 to 0.5", ratio=ratio),
        )
