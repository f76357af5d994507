"""Tables that lie in CSV files beside a model, each declared by its class."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar

from equipoise.keys.declaring import Frozen
from equipoise.quantities import Dimension


class CsvTable(Frozen):
    """Columns of a CSV file; a class with a `sort` is known by it wherever such files are read.

    sort : what it is, as `File` names it, such as ``load``.
    forms : names of columns of each form that a file may have; they are the first fields, but for
        what reads and writes itself.
    columns : what those are that mean something else in other tables, with the unit that a header
        is shown with.
    rises : whether the first column does, from row to row.
    """

    sort: ClassVar[str] = ""
    forms: ClassVar[tuple[tuple[str, ...], ...]] = ()
    columns: ClassVar[Mapping[str, tuple[Dimension, str]]] = {}
    rises: ClassVar[bool] = True

    kinds: ClassVar[dict[str, Any]] = {}
    """All of them, by their sort."""

    def __init_subclass__(cls, **options: Any) -> None:
        super().__init_subclass__(**options)
        if cls.sort:
            CsvTable.kinds[cls.sort] = cls

    @classmethod
    def like(cls, first: str) -> Any:
        """The class whose columns, of which this is the first, mean something of their own."""
        named = (kind for kind in cls.kinds.values() if kind.forms[0][0] == first)
        return next((item for item in named if item.columns or not item.rises), cls)
