"""A picture of a report before it has a place there: what draws it, and what is seen in it."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from functools import partial
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from equipoise.figures import Picture as Drawing
    from equipoise.results.charts import Chart


class PictureEntry(NamedTuple):
    """Name, caption, what draws it, what is seen in it, and whether a report has it in its
    appendix.
    """

    name: str
    caption: str
    draw: Callable[[], Drawing]
    seen: Callable[[], str] = str
    detail: bool = False


def pages(
    name: str,
    caption: str,
    make: Callable[[], Iterable[Chart]],
    headline: Callable[[], str] = str,
    detail: bool = False,
) -> Iterator[PictureEntry]:
    """What goes on over several pictures; how many, only their charts tell."""
    for number, chart in enumerate(make(), 1):
        if number == 1:
            yield PictureEntry(name, caption, partial(unchanged, chart), headline, detail)
        else:
            yield PictureEntry(
                f"{name}-{number}", caption, partial(unchanged, chart), detail=detail
            )


def unchanged(chart: Chart) -> Chart:
    return chart
