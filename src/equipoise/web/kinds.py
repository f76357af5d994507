"""What sort of machine each is: its part of the gallery, and words that it is found by."""

from __future__ import annotations

from collections.abc import Iterator

from equipoise.i18n import say, speaking, to_say
from equipoise.mechanism.parts.couplings import coupling_kinds
from equipoise.mechanism.parts.element_kinds import part_kinds
from equipoise.mechanism.parts.machine import Machine
from equipoise.mechanism.parts.sliders import Slider

BARS = {
    4: to_say("four-bar linkage"),
    6: to_say("six-bar linkage"),
    8: to_say("eight-bar linkage"),
}
"""Linkages without sliding joints by the number of their bars, the frame among them."""


def sections(of: type[Machine] = Machine) -> tuple[str, ...]:
    """Return the headings of the gallery in their order, in the language that is spoken.

    of : class of machines whose kinds of couplings have a section of their own.
    """
    coupled = say(", ").join(say(kind.group) for kind in coupling_kinds(of).values())
    return (
        say("Planting mechanisms"),
        say("Linkages"),
        coupled[:1].upper() + coupled[1:],
        say("Machines on mounts"),
        say("Machines to balance"),
    )


def section_of(machine: Machine) -> int:
    """Return which of `sections` a machine is in; of several the last."""
    fits = (
        machine.planting is not None,
        True,
        bool(machine.couplings),
        machine.support is not None,
        machine.balance is not None,
    )
    others = [index for index, fit in enumerate(fits) if fit and index != 1]
    return max(others, default=1)


def search_words(machine: Machine) -> str:
    """Return the words that a machine is found by beside its title and description, in English and
    in the language that is spoken.
    """
    spoken = [*_features(machine)]
    with speaking("en"):
        english = [*_features(machine)]
    return " ".join(dict.fromkeys((*spoken, *english)))


def _features(machine: Machine) -> Iterator[str]:
    """What a machine has, and what it is by its build, in the language that is spoken."""
    yield sections(type(machine))[section_of(machine)]
    couplings = bool(machine.couplings)
    bars = BARS.get(len(machine.links) + 1)
    if bars is not None and not machine.sliders and not couplings:
        yield say(bars)
    if machine.sliders:
        yield say(Slider.group)
    if len(machine.sliders) == 1 and len(machine.links) == 3 and not couplings:
        yield say("slider-crank")
    for table, kind in part_kinds(type(machine)).items():
        if getattr(machine, table):
            yield say(kind.group)
    for drive in machine.driven:
        if drive.group:
            yield say(drive.group)
    if machine.support is not None:
        yield say("mounts and gauges")
    if machine.rows:
        yield say("several rows")
