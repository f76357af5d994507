"""What every kind of value is, and what every table is read to."""

from __future__ import annotations

from typing import Any, ClassVar

from equipoise.i18n import Note


class TableRecord:
    """What a table of a file is read to, and holds by the names of its fields."""

    wanted: ClassVar[Note] = Note("such an object")

    @classmethod
    def checked(cls, value: Any) -> Any:
        """The value of a field that holds such an object; a `TypeError` where it is none."""
        if not isinstance(value, TableRecord):
            raise TypeError
        return value


class Kind:
    """What a value is: `check` takes one that Python gives, `wanted` says what it has to be."""

    wanted: Note

    def check(self, value: Any) -> Any:
        """The value as it is kept.

        Raises
        ------
        TypeError, ValueError, OverflowError : it is something else.
        """
        return value
