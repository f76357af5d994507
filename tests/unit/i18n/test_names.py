"""Names that are too long for where they stand."""

from __future__ import annotations

from equipoise.i18n import without_middle


def test_names_that_end_differently_stay_apart_when_they_are_shortened() -> None:
    names = [f"left handle of the brush cutter, run {number}" for number in range(1, 12)]
    shown = [without_middle(name, 24) for name in names]
    assert len({*shown}) == len(names)
    for item, name in zip(shown, names, strict=True):
        begin, end = item.split("…")
        assert len(item) <= 24 and name.startswith(begin) and name.endswith(end)
    assert without_middle("exactly so long", 15) == "exactly so long"
    assert without_middle("exactly so long", 14) == "exactly…o long"
