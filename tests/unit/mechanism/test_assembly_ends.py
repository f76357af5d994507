"""Assembly ends by construction: each group is of links that no other has, and reads what others
before it have written; sides are tried without asking for sides again.
"""

from __future__ import annotations

from collections import UserDict
from collections.abc import Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import tomli_w

import equipoise as eq
from equipoise.errors import EquipoiseError, MobilityError, ModelError
from equipoise.mechanism.assembly import assembly_modes, linkage
from equipoise.mechanism.assembly.linkage import assemble
from equipoise.mechanism.assembly.steps import initial_state
from support import machines_any
from support.chosen import few
from unit.mechanism.build import ORIGIN, crank_rocker, heavy


class Traced(UserDict[str, Any]):
    """A state that keeps which names were read, and which were written."""

    def __init__(self, state: Mapping[str, Any]) -> None:
        self.read: set[str] = set()
        self.written: set[str] = set()
        super().__init__(state)

    def __getitem__(self, name: str) -> Any:
        self.read.add(name)
        return super().__getitem__(name)

    def __setitem__(self, name: str, value: Any) -> None:
        self.written.add(name)
        super().__setitem__(name, value)


def grown(first: int, folder: Path) -> Iterator[eq.Machine]:
    """Machines from nothing that can be assembled."""
    for seed in range(first, first + 20):
        document, tables = machines_any.files(seed)
        for name, text in {"model.toml": tomli_w.dumps(document), **tables}.items():
            (folder / name).write_text(text, encoding="utf-8")
        try:
            machine = eq.load(folder / "model.toml")
            assemble(machine)
        except EquipoiseError:
            continue
        yield machine


@pytest.mark.parametrize("first", few(range(0, 160, 20), (0,)))
def test_each_group_reads_what_was_solved_before_it(first: int, tmp_path: Path) -> None:
    count = 0
    for machine in grown(first, tmp_path):
        try:
            angles = np.array([0.0, 0.1])
            solved = eq.move(machine, angles).linkage
        except EquipoiseError:  # which cannot reach these angles
            continue
        links = [link for group in solved.groups for link in group.links]
        assert len(links) == len({*links})
        driven = {machine.drive.link, *(drive.link for drive in machine.drives)} - {*links}
        assert {*links} | driven == {*machine.links, *solved.joints.riders}
        start = initial_state(machine, angles)
        start |= {f"reference({name})": solved.cycle.reference(name, angles)
                  for name in solved.needed_references}  # fmt: skip
        state = Traced(start)
        with np.errstate(all="ignore"):
            for step in solved.motion:
                known = {*state}
                state.read, state.written = set(), set()
                step.run(state)  # type: ignore[arg-type]
                assert state.read <= known
                assert state.written
                count += 1
    assert count > 20


# Two dyads that share a point: tests/surface/test_serve.py.
@pytest.mark.exhaustive
@pytest.mark.parametrize("first", few(range(0, 160, 20), (0,)))
def test_sides_are_tried_without_asking_for_sides_again(
    first: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Two dyads that shared a name asked for each other's sides without an end."""
    decided, grouped = assembly_modes.decided, linkage._grouped
    asking, rounds = [], []

    def ask(*given: Any) -> Any:
        assert not asking, "asked while it is asked"
        asking.append(True)
        try:
            return decided(*given)
        finally:
            asking.pop()

    def group(*given: Any, **more: Any) -> Any:
        rounds.append(True)
        return grouped(*given, **more)

    monkeypatch.setattr(assembly_modes, "decided", ask)
    monkeypatch.setattr(linkage, "_grouped", group)
    asked = 0
    for machine in grown(first, tmp_path):
        bare = replace(machine, assembly={}, position=None)
        rounds.clear()
        try:
            assemble(bare)
        except EquipoiseError as error:
            asked += isinstance(error, ModelError) and error.where.startswith("assembly")
        assert len(rounds) <= 2 + 2**assembly_modes.MOST_TRIED
    assert asked > 3


def test_links_that_only_hold_each_other_are_refused() -> None:
    """A ring that needs itself to be solved, beside a crank that drives nothing of it."""
    base = crank_rocker()
    ring = {
        "ring 1": heavy(P=ORIGIN, Q=(0.3, 0.0)),
        "ring 2": heavy(Q=ORIGIN, R=(0.3, 0.0)),
        "ring 3": heavy(R=ORIGIN, P=(0.3, 0.0)),
    }
    with pytest.raises(MobilityError) as caught:
        assemble(replace(base, links={**base.links, **ring}))
    assert "\n" not in str(caught.value).partition("give")[0]
    assert "ring 1" in str(caught.value)
