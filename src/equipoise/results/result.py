"""What all results share: they are plain data, tables, pictures, and blocks that show them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import fields
from importlib import import_module
from typing import TYPE_CHECKING, Any, ClassVar, cast

import numpy as np

from equipoise.results.data import dataset_of, frame_of

if TYPE_CHECKING:
    import pandas
    import xarray

    from equipoise.results.blocks import Block

Values = dict[str, Any]
Array = np.ndarray[Any, Any]
PLAIN = (str, int, float, np.ndarray)


class Result:
    """Base of all results.

    A result has `to_dict`, its machine-readable output in SI units, and `blocks`, what it shows;
    tables, pictures and notebooks follow from these.
    """

    @property
    def title(self) -> str:
        """Of the machine, tool or study that it tells of."""
        owners = (getattr(self, name, None) for name in ("machine", "original", "tool", "study"))
        return next((str(one.title) for one in owners if one is not None), "")

    def to_dict(self) -> Values:
        """The machine-readable output, in SI units: dicts, numbers and arrays.

        Where a result does not say more, its fields that are plain values.
        """
        told = {one.name: getattr(self, one.name) for one in fields(cast("Any", self))}
        return {name: value for name, value in told.items() if isinstance(value, PLAIN)}

    records: ClassVar[str] = ""
    """Entry of `to_dict` with a dict for each of its records, where it is a list of such."""

    def columns(self) -> list[tuple[str, str, Array]]:
        """Name, SI unit and values of the columns of its CSV file, over the first of them.

        Empty where it has none.
        """
        return []

    shown_in: ClassVar[str] = ""
    """Module that tells what it shows; ``blocks`` of its room where not given."""

    def blocks(self, **options: Any) -> Sequence[Block]:
        """What it shows, in the language that is spoken."""
        module = self.shown_in or f"{type(self).__module__.split('.')[1]}.blocks"
        return tuple(_room(module).SHOWS[type(self).__name__](self, **options))

    @property
    def summary(self) -> Mapping[str, Any]:
        """The figures of it that matter most."""
        return {
            name: value for name, value in self.to_dict().items() if isinstance(value, int | float)
        }

    def to_dataset(self) -> xarray.Dataset:
        """Its arrays as an `xarray.Dataset`, by dotted path; loads xarray."""
        return dataset_of(self)

    def to_frame(self) -> pandas.DataFrame:
        """Its arrays as columns of a `pandas.DataFrame`; loads pandas."""
        return frame_of(self)

    def plot(self, *names: str) -> Any:
        """Its pictures by name, all if none is named, as `matplotlib.figure.Figure`s."""
        return _room("figures").plot(self, *names)

    def __repr__(self) -> str:
        title = f" {self.title!r}" if self.title else ""
        return f"<{type(self).__name__}{title}>"

    def _repr_html_(self) -> str:
        """What a notebook shows."""
        return str(_room("present").html_of(self))


def _room(name: str) -> Any:
    """A room above this one, by name and only when it is wanted: results know no renderer."""
    return import_module(f"equipoise.{name}")
