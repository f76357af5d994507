"""Links so slender that what is computed of rigid ones misleads."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from math import inf, pi

from equipoise.i18n import Note, to_say
from equipoise.mechanism.dynamics.section_loads import ADDED, added_share, bending_frequency
from equipoise.mechanism.parts.links import Link
from equipoise.quantities import number, percent


def slender_links(links: Mapping[str, Link], speed: float) -> Iterator[Note]:
    """Links, by name, of which this is so at a speed of the crank, rad/s."""
    for name, link in links.items():
        frequency = bending_frequency(link)
        if frequency is None or not speed:
            continue
        share = added_share(frequency, speed)
        if share <= ADDED:
            continue
        ratio = number(2 * pi * frequency / abs(speed), digits=3)
        if share == inf:
            yield Note(
                to_say(
                    "the {link} bends at {ratio} times the crank's speed, within its first two "
                    "orders: balancing by rigid links misleads; make it stiffer or lighter"
                ),
                link=name,
                ratio=ratio,
            )
        else:
            yield Note(
                to_say(
                    "the {link} has its first natural frequency at {ratio} times the crank's "
                    "speed: bending adds {share} % to forces of twice that speed, which balancing "
                    "by rigid links does not see"
                ),
                link=name,
                ratio=ratio,
                share=percent(share),
            )
