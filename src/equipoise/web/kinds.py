"""What sort of machine each is: its part of the gallery, and words that it is found by."""

from __future__ import annotations

from collections.abc import Iterator

from equipoise.i18n import say, speaking, to_say
from equipoise.mechanism.parts.machine import Machine

KINDS = (
    to_say("Planting mechanisms"),
    to_say("Linkages"),
    to_say("Gears, belts, racks and cams"),
    to_say("Machines on mounts"),
    to_say("Machines to balance"),
)
"""Parts of the gallery, in their order."""
BARS = {
    4: to_say("four-bar linkage"),
    6: to_say("six-bar linkage"),
    8: to_say("eight-bar linkage"),
}
"""Linkages without sliding joints by the number of their bars, the frame among them."""


def kind_of(machine: Machine) -> int:
    """Return which of `KINDS` a machine is; of several the last."""
    has = (
        machine.planting is not None,
        True,
        bool(machine.couplings),
        machine.support is not None,
        machine.balance is not None,
    )
    others = [at for at, found in enumerate(has) if found and at != 1]
    return max(others, default=1)


def search_words(machine: Machine) -> str:
    """Return the words that a machine is found by beside its title and description, in English and
    in the language that is spoken.
    """
    texts = [*_features(machine)]
    spoken = [say(text) for text in texts]
    with speaking("en"):
        english = [say(text) for text in texts]
    return " ".join(dict.fromkeys((*spoken, *english)))


def _features(machine: Machine) -> Iterator[str]:
    """What a machine has, and what it is by its build."""
    yield KINDS[kind_of(machine)]
    couplings = bool(machine.couplings)
    if not machine.sliders and not couplings:
        bars = BARS.get(len(machine.links) + 1)
        if bars is not None:
            yield bars
    if machine.sliders:
        yield to_say("slider on a straight line")
    if len(machine.sliders) == 1 and len(machine.links) == 3 and not couplings:
        yield to_say("slider-crank")
    for has, text in (
        (machine.gears, to_say("gears")),
        (machine.belts, to_say("belts")),
        (machine.racks, to_say("racks")),
        (machine.cams, to_say("cams")),
        (machine.springs, to_say("springs")),
        (machine.support, to_say("mounts and gauges")),
        (machine.drive.between, to_say("hydraulic cylinder")),
        (machine.rows, to_say("several rows")),
    ):
        if has:
            yield text
