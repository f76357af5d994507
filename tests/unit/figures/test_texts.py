"""Texts that keep clear of each other."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from equipoise.figures.sheet import Labels, Sheet, Text, spread
from equipoise.symbols.scene import hull


def test_texts_side_by_side() -> None:
    assert list(spread([1, 5, 9], [2, 2, 2], 0, 10)) == [1, 5, 9]
    placed = spread([5.2, 5.0, 5.1], [2, 1, 3], 0, 10)
    assert list(np.argsort(placed)) == [1, 2, 0]
    ordered = sorted(zip(placed, (2, 1, 3), strict=True))
    assert all(b - a >= (u + v) / 2 - 1e-6 for (a, u), (b, v) in pairwise(ordered))


def test_texts_without_room() -> None:
    crowd = spread([0, 0, 0], [5, 5, 5], 0, 10)
    assert np.all((crowd >= 2.5) & (crowd <= 7.5))
    sheet = Sheet(72.0, 72.0)
    labels = Labels(sheet, (0.0, 0.0, 72.0, 72.0))
    labels.reserve(36.0, 36.0, half=100)
    assert not labels.put(36.0, 36.0, Text("no room", "#000000", optional=True))
    assert not sheet.words
    assert labels.put(36.0, 36.0, Text("all the same", "#000000"))
    assert [words.text for words in sheet.words] == ["all the same"]


def test_hull() -> None:
    square = np.array([0, 1, 1 + 1j, 1j])
    assert list(hull(np.array([*square, 0.5 + 0.5j, 0.5, 1j]))) == list(square)
    assert list(hull(np.array([0, 0.5 + 0.5j, 1 + 1j]))) == [0, 1 + 1j]
    assert list(hull(np.array([2j, 2j]))) == [2j]
