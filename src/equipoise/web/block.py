"""Arrays of a message, in one block of 32-bit floats."""

from __future__ import annotations

from dataclasses import field
from typing import Any

import numpy as np

from equipoise.dataclass import dataclass

Array = np.ndarray[Any, Any]
Values = dict[str, Any]


@dataclass
class FloatBlock:
    """Arrays one behind the other, as 32-bit floats, and where each begins.

    An array that is added under several names is there once.
    """

    places: dict[str, tuple[int, int]] = field(default_factory=dict)
    parts: list[Array] = field(default_factory=list)
    size: int = 0
    added: dict[int, tuple[Array, tuple[int, int]]] = field(default_factory=dict)

    def add(self, name: str, values: Array) -> None:
        """Add real (N,) values, or complex ones as (2 N,): x and y in turn."""
        if id(values) in self.added:
            self.places[name] = self.added[id(values)][1]
            return
        flat = np.ascontiguousarray(values).ravel()
        if np.iscomplexobj(flat):
            flat = flat.view(float)
        self.parts.append(flat)
        self.places[name] = (self.size, flat.size)
        self.added[id(values)] = values, self.places[name]  # which keeps the array, and so its id
        self.size += flat.size

    @property
    def placement(self) -> dict[str, list[int]]:
        """Offset and length of each array, in numbers."""
        return {name: list(place) for name, place in self.places.items()}

    @property
    def data(self) -> bytes:
        """All arrays, little-endian."""
        if not self.parts:
            return b""
        with np.errstate(over="ignore"):  # what no drawing could show
            return np.concatenate(self.parts, dtype="<f4", casting="unsafe").tobytes()
