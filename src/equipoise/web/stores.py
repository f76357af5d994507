"""A store of a study on the page: its designs as columns, and each of them as a machine."""

from __future__ import annotations

import json
import os
from collections.abc import Iterator, Mapping
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from equipoise.codegen.figures import COMPUTED, REASONS
from equipoise.dataclass import dataclass
from equipoise.errors import EquipoiseError, UsageError
from equipoise.folders import Folder
from equipoise.handheld.model import Tool
from equipoise.i18n import say, to_say
from equipoise.mechanism.parts.machine import Machine
from equipoise.schema.study_units import machine_of, owner_of, units_in
from equipoise.signals import Array
from equipoise.studies.evaluate import evaluator
from equipoise.studies.outcomes import feasible
from equipoise.studies.selection import best
from equipoise.studies.store import ABOUT, MARK, UNKNOWN, Store, open_store
from equipoise.studies.study import random_numbers
from equipoise.web.messages import JsonObject
from equipoise.web.replies import FloatBlock, Reply

MOST, BEST = 5_000, 50
"""Designs that a page is sent; of the best, those that are marked."""
STREAM = 12
"""Of random numbers by which designs are drawn where they are more."""
WHY: Mapping[int, str] = {
    1: to_say("does not assemble"),
    2: to_say("does not turn fully"),
    3: to_say("change point"),
    4: to_say("not a machine"),
    5: to_say("figures do not stand still"),
    6: to_say("cannot be computed"),
    7: to_say("no such figure"),
    UNKNOWN: to_say("not computed yet"),
}
"""Why a design has no figures, by the number of the reason."""
assert {*REASONS} - {COMPUTED} <= WHY.keys()


def is_store(path: str) -> bool:
    """Whether a path is that of a folder such as a store is."""
    return Path(path).is_dir()


def stores_in(folder: Path) -> list[str]:
    """Names of the stores that lie in a folder itself; links to elsewhere are left out."""
    try:
        return sorted(item.name for item in os.scandir(folder) if _looks_so(item))
    except OSError:
        return []


def _looks_so(entry: os.DirEntry[str]) -> bool:
    """Whether an entry of a folder is a store by what it says of itself."""
    try:
        if entry.name.startswith(".") or not entry.is_dir(follow_symlinks=False):
            return False
        return MARK in json.loads(Folder.at(entry).read(ABOUT))["attributes"]
    except (OSError, ValueError, LookupError, TypeError):
        return False


@dataclass(frozen=True, eq=False)
class StoreDesk:
    """A store that is open on a page."""

    store: Store

    @classmethod
    def load(cls, path: str) -> StoreDesk:
        """Of a folder; a `UsageError` where that is no store."""
        return cls(open_store(path))

    @property
    def name(self) -> str:
        """Of its folder."""
        return self.store.path.name

    def model(self, number: int) -> Machine | Tool:
        """One of its designs; a `UsageError` where there is none."""
        return machine_of(self.store, number)

    @cached_property
    def _own(self) -> Array | None:
        """Numbers and figures of the model itself (d + m,); None where they are not known."""
        study = owner_of(self.store)
        if study is None:
            return None
        try:
            outcome = evaluator(study)(study.own[None])
        except EquipoiseError:
            return None
        if outcome.reason[0] != COMPUTED:
            return None
        return np.hstack([study.own, outcome.figures[0]])

    @cached_property
    def _designs_to_draw(self) -> tuple[Array, Array, Array]:
        """Numbers of the designs that are drawn (P,), their rows (P, d + m), their reasons (P,)."""
        size = self.store.size
        chosen = np.arange(size)
        if size > MOST:
            some = random_numbers(1, STREAM).choice(size, MOST, replace=False)
            chosen = np.union1d(some, np.array(self._best, int))
        rows, reasons = [], []
        for start, block in self.store.in_blocks():
            stop = start + len(block.values)
            own = chosen[(chosen >= start) & (chosen < stop)] - start
            rows.append(np.hstack([block.values[own], block.outcome.figures[own]]))
            reasons.append(block.outcome.reason[own])
        return chosen, np.concatenate(rows), np.concatenate(reasons)

    @cached_property
    def _counts(self) -> tuple[int, Array]:
        """How many keep every limit, and how many have each reason (256,)."""
        good, reasons = 0, np.zeros(256, np.int64)
        for _, block in self.store.in_blocks():
            reasons += np.bincount(block.outcome.reason, minlength=256)
            figures = block.outcome.figures[block.outcome.reason == COMPUTED]
            good += int(np.sum(np.all(feasible(self.store.wishes, figures), axis=1)))
        return good, reasons

    def reply(self, seq: int | None) -> Reply:
        """Everything that a page shows of the store.

        Arrays are a column each, of the designs that are drawn: ``number``, ``reason`` (0 where a
        design has figures), ``kept`` (1 where it keeps every limit), then those of `columns`.
        """
        block = FloatBlock()
        numbers, rows, reasons = self._designs_to_draw
        figures = rows[:, len(self.store.numbers) :]
        inside = (reasons == COMPUTED) & np.all(feasible(self.store.wishes, figures), axis=1)
        block.add("number", numbers)
        block.add("reason", np.where(reasons == COMPUTED, 0, reasons))
        block.add("kept", inside)
        columns = [*self._columns()]
        for column, values in zip(columns, rows.T, strict=True):
            block.add(f"column.{column['name']}", values)
        good, counts = self._counts
        refused = [
            {"why": say(words), "code": code, "count": int(counts[code])}
            for code, words in WHY.items()
            if counts[code]
        ]
        content: JsonObject = {
            "type": "study",
            "seq": seq,
            "name": self.name,
            "title": self.store.title,
            "columns": columns,
            "own": None if self._own is None else [float(item) for item in self._own],
            "size": self.store.size,
            "drawn": len(numbers),
            "computed": int(counts[COMPUTED]),
            "kept": good,
            "limited": any(wish.limited for wish in self.store.wishes),
            "refused": refused,
            "best": self._best,
            "arrays": block.placement,
        }
        return Reply(content, block.data)

    @cached_property
    def _best(self) -> list[int]:
        """Numbers of the best designs, or of those nearest to the limits where none keeps them all;
        by the first figure where the study makes nothing small or large.
        """
        wishes = self.store.wishes
        by = None if any(wish.make for wish in wishes) else {wish.name: None for wish in wishes[:1]}
        try:
            return [int(design) for design in best(self.store, BEST, by, nearest=True).designs]
        except UsageError:
            return []

    def _columns(self) -> Iterator[JsonObject]:
        """What varies, then what came of it: what it is called, its unit, its limits."""
        units = units_in(self.store)
        for name in self.store.numbers:
            yield self._column(name, units[name], "number")
        for wish in self.store.wishes:
            ends = wish.at_least, wish.at_most
            limits: dict[str, Any] = {"limits": [*ends], "make": wish.make}
            yield self._column(wish.name, units[wish.name], "output") | limits

    def _column(self, name: str, unit: Any, kind: str) -> JsonObject:
        return {
            "name": name,
            "label": unit.called or name,
            "unit": unit.name,
            "factor": 1 / unit.factor,
            "kind": kind,
            "limits": [None, None],
            "make": None,
        }
