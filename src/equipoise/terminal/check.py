"""What `equipoise check` prints."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from equipoise.mechanism.advice import remarks
from equipoise.mechanism.linkage import assemble
from equipoise.terminal.tables import PER_RPM, number

if TYPE_CHECKING:
    from equipoise.mechanism.linkage import Linkage
    from equipoise.mechanism.model import Machine


def print_check(machine: Machine) -> None:
    """How the linkage is built up, and what to look at again."""
    linkage = assemble(machine)
    cycle = linkage.cycle
    print(machine.title)
    drive = machine.drive
    print(
        f"{len(machine.links)} moving links, one free motion; driven: {drive.link} at "
        f"{number(drive.speed / PER_RPM)} rpm about {linkage.pivot}"
    )
    for row in _build_up(linkage):
        print(f"  {row}")
    turns = "one turn" if cycle.turns == 1 else f"{cycle.turns} turns"
    print(f"the crank turns fully; the motion repeats after {turns}")
    for remark in remarks(linkage):
        print(f"note: {remark}")
    print("ready to be analysed")


HOW = {
    "dyad": "dyad",
    "geared": "geared",
    "loops": "by Newton's method on the loop equations",
}


def _build_up(linkage: Linkage) -> Iterable[str]:
    for group in linkage.groups:
        links = " and ".join(group.links)
        joints = ", ".join(
            f"{r.name} ({r.kind} on {r.by})" if r.kind != "slider" else f"{r.name} (slider)"
            for r in group.reactions
        )
        yield f"{links}: {HOW[group.kind]}; joints {joints}"
