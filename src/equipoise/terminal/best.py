"""What `equipoise best` prints: the best designs of a store, in the units of its files."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from equipoise.terminal.designs import columns_of, designs_table, limits, wanted

if TYPE_CHECKING:
    from equipoise.schema.study_units import Unit
    from equipoise.studies.design_space import Output
    from equipoise.studies.selection import Best


def print_best(
    found: Best, title: str, outputs: Sequence[Output], units: Mapping[str, Unit]
) -> None:
    """What is best of how many, within which limits, and the designs."""
    print(title)
    told = limits(outputs, units)
    within = f", {found.kept} keep every limit" if told else ""
    print(f"{found.stored} designs: {found.computed} have figures{within}")
    if told:
        print(f"limits: {', '.join(told)}")
    if len(found.by) > 1:
        print(f"{found.front} designs that no other beats in everything")
    print(best_table(found, units))


def best_table(found: Best, units: Mapping[str, Unit]) -> str:
    """The designs, the best first."""
    what = "Designs that no other beats" if len(found.by) > 1 else "The best designs"
    columns = columns_of(found.numbers, found.values, found.outputs, found.figures)
    order = dict.fromkeys((*found.by, *found.outputs, *found.numbers))
    told = {name: columns[name] for name in order}
    labels = [str(design) for design in found.designs]
    return designs_table(f"{what}; {wanted(found.by)}", labels, told, units)
