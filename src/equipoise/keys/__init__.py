"""Keys of files, declared once: a frozen dataclass says of each field what it is in its file.

::

    @declared
    class Spring(Frozen):
        stiffness: float = key("stiffness", "more than 0", example="2 kN/m", above=0)
        free_length: float = key("length", "at which it exerts nothing", default=0.0)

From this follow the checks of values made in Python (here), and reading, writing, the JSON Schema,
the tables of the documentation and access by path (`equipoise.schema`).  Rules between keys are
plain functions beside the class.
"""

from __future__ import annotations

from equipoise.keys.declaring import (
    REQUIRED,
    ROW,
    SCHEMA_VERSION,
    VERSION,
    Conditions,
    Frozen,
    Key,
    Keys,
    all_keys,
    declared,
    inside,
    key,
    keys_of,
    told_by,
)
from equipoise.keys.kinds import (
    MOST_WHOLE,
    NO_INERTIA,
    PLANES,
    Anything,
    Direction,
    File,
    Flag,
    Kind,
    Listing,
    Named,
    Number,
    OneOr,
    Planes,
    Point,
    Quantity,
    Record,
    Table,
    Tables,
    Text,
    Told,
    Whole,
    choice,
    innermost,
    items_of,
)
from equipoise.keys.values import changed, quantities_of, wrong_values

__all__ = [
    "MOST_WHOLE",
    "NO_INERTIA",
    "PLANES",
    "REQUIRED",
    "ROW",
    "SCHEMA_VERSION",
    "VERSION",
    "Anything",
    "Conditions",
    "Direction",
    "File",
    "Flag",
    "Frozen",
    "Key",
    "Keys",
    "Kind",
    "Listing",
    "Named",
    "Number",
    "OneOr",
    "Planes",
    "Point",
    "Quantity",
    "Record",
    "Table",
    "Tables",
    "Text",
    "Told",
    "Whole",
    "all_keys",
    "changed",
    "choice",
    "declared",
    "innermost",
    "inside",
    "items_of",
    "key",
    "keys_of",
    "quantities_of",
    "told_by",
    "wrong_values",
]
