"""What is wrong with a plan of balancing, told of the option that asked for it.

A file's own plan is checked when it is read; what is wrong later comes from an option.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import contextmanager

from equipoise.errors import ModelError, UsageError

OF_TABLES = {
    "moves": "--move-cm",
    "masses": "a counterweight",
    "geared": "--geared-counterweight",
    "phases": "--phases",
    "objectives": "--objective",
    "limits": "--limit",
    "added_mass": "--limit",
}
OF_KEYS = {
    "shape": "--shape",
    "radius": "--radius",
    "mass": "--mass",
    "at_most": "--at-most",
    "thickness": "--thickness",
    "density": "--material",
    "material": "--material",
    "ratio": "--ratio",
    "pitch_radius": "--pitch-radius",
}
"""Keys of weights that are options of their own."""
PLAIN = ("link", "driver", "output", "measure", "at_most", "")
"""Keys that go without saying."""
PLACE = re.compile(r"balance\.(?P<table>\w+)(\[\d+\])?\.?(?P<key>\w*)(\[\d+\])?")


@contextmanager
def told_of_options() -> Iterator[None]:
    """Name the option instead of the place in a file that does not have it."""
    try:
        yield
    except ModelError as error:
        place = PLACE.fullmatch(error.where)
        if place is None or place["table"] not in OF_TABLES:
            raise
        raise UsageError(f"{_option(place['table'], place['key'])}: {error.what}") from error


def _option(table: str, key: str) -> str:
    if table in {"masses", "geared"} and key in OF_KEYS:
        return OF_KEYS[key]
    option = OF_TABLES[table]
    return option if key in PLAIN else f"{option}: {key}"
