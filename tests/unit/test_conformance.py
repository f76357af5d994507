"""The conformance page: what the tests hold, as they declare it.

Write it anew with ``PYTHONPATH=tests python tests/unit/test_conformance.py``.
"""

from __future__ import annotations

import importlib
import re
from collections import Counter
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
import pytest

from support import sources
from support.conformance import DECLARED, TESTS, Agreement, Printed, Source, number

PAGE = TESTS.parent / "docs" / "conformance.md"
SOURCES = [one for one in vars(sources).values() if isinstance(one, Source)]
Rows = dict[Source, list[Printed | Agreement]]

HEAD = """# Conformance

Every published number that Equipoise is held against, every other program and every second route,
with what comes out here. The tests write this page and hold each row of it: `make test` fails where
one is no longer met.

Of the printed numbers {printed} are met as they are printed; {explained} are not, and it is told
why; {slips} are slips of the print. Another {drawn} are drawn in print without being told as
numbers. Printed equations are held by {equations} tests, and {agreements} rows compare with other
programs and second routes.

Each digit of a computed number is held; where ± stands, it lies so near to the one in front. A
deviation is what is computed less what is printed; a dash says that the printed digits are met.
Differences from other programs are parts of the largest value, or of a thousandth of all forces
where an output vanishes. Names such as `lee-kim-a` are those of [bundled machines](examples.md),
and such as `curve.height` those of figures that commands tell.
"""
CONTENTS = (
    "| source | met | explained | slips | drawn | tests of equations | comparisons |\n"
    "|---|---|---|---|---|---|---|"
)
NUMBERS = (
    "| case | quantity | where | printed | computed | deviation | why |\n"
    "|---|---|---|---|---|---|---|"
)
AT_MOST = "difference at most, of the largest value"
EQUATIONS = f"| equations | what they give | {AT_MOST} |\n|---|---|---|"
PROGRAMS = f"| case | compared | {AT_MOST} |\n|---|---|---|"
MACHINES = f"| case | {AT_MOST} |\n|---|---|"
SLIPS = "| source | where | slip in print, and what holds |\n|---|---|---|"


def declared() -> Rows:
    """All rows by source, in the order of the tests; their modules are imported if need be."""
    known = {path for path, _ in DECLARED}
    for path in sorted(TESTS.rglob("test_*.py")):
        text = path.read_text(encoding="utf-8")
        if str(path) not in known and "from support.sources import" in text:
            importlib.import_module(".".join(path.relative_to(TESTS).with_suffix("").parts))
    rows: Rows = {source: [] for source in SOURCES}
    for _, (source, more) in sorted(DECLARED.items()):
        rows[source] += more
    return {source: told for source, told in rows.items() if told}


def page(rows: Rows) -> str:
    """The page, as Markdown."""
    parts = [HEAD.format(**counts(rows)), "## Contents\n", CONTENTS]
    for one, told in rows.items():
        kinds = " | ".join(str(count or "") for count in counts({one: told}).values())
        parts.append(f"| [{one.name}](#{anchor(one.name)}) | {kinds} |")
    parts.append("\nThe last section lists the [slips in print](#slips-in-print).")
    for source, told in rows.items():
        parts.append(f"\n## {source.name}\n\n{' '.join(source.text.split())}\n")
        parts += sections(told)
    parts += ["\n## Slips in print\n", SLIPS, *slips(rows)]
    return "\n".join(parts) + "\n"


def counts(rows: Rows) -> dict[str, int]:
    """How many rows of each kind there are."""
    every = [row for told in rows.values() for row in told]
    numbers = [row for row in every if isinstance(row, Printed)]
    others = [row for row in every if isinstance(row, Agreement)]
    told = [row for row in numbers if row.printed and not row.slip]
    return {
        "printed": sum(not row.differs for row in told),
        "explained": sum(row.differs for row in told),
        "slips": sum(row.slip for row in numbers),
        "drawn": sum(not row.printed for row in numbers),
        "equations": sum(bool(row.place) for row in others),
        "agreements": sum(not row.place for row in others),
    }


def sections(rows: Sequence[Printed | Agreement]) -> Iterator[str]:
    """The tables of a source."""
    tables: dict[str, list[str]] = {NUMBERS: [], EQUATIONS: []}
    often = Counter(row.what for row in rows)
    for row in rows:
        if isinstance(row, Printed):
            tables[NUMBERS].append(number_line(row))
        elif row.place:
            tables[EQUATIONS].append(f"| {row.place} | {row.what} | {power(row.within)} |")
        elif often[row.what] == 1:
            line = f"| {row.case} | {row.what} | {power(row.within)} |"
            tables.setdefault(PROGRAMS, []).append(line)
        else:
            head = f"Compared: {row.what}.\n\n{MACHINES}"
            tables.setdefault(head, []).append(f"| {row.case} | {power(row.within)} |")
    tables[EQUATIONS].sort(key=lambda line: [int(one) for one in re.findall(r"\d+", line)])
    for head, lines in tables.items():
        if lines:
            yield "\n".join([head, *lines]) + "\n"


def power(within: float) -> str:
    """A small number, such as 2e-8."""
    return f"{within:.0e}".replace("e-0", "e-")


def number_line(row: Printed) -> str:
    """A printed number as a line of its table."""
    what = f"{row.what}, {row.unit}" if row.unit else row.what
    why = f"slip: {row.why}" if row.slip else row.why if row.differs else ""
    near = row.within and not row.computed
    told = f"{row.told} ± {power(row.within)}" if near else row.told
    cells = (row.case, what, row.place, row.printed or "drawn", told, deviation(row), why)
    return f"| {' | '.join(cells)} |"


def deviation(row: Printed) -> str:
    """How far off a number is, in its unit and in parts of what is printed."""
    if row.bound or not row.printed or not (row.differs or row.slip):
        return "–"
    size = float(abs(number(row.printed)))
    if not size or row.unit in ("deg", "%"):
        return f"{row.off:+f}"
    share = 100 * float(row.off) / size
    return f"{row.off:+f} ({share:+.{1 if abs(share) < 10 else 0}f} %)"


def slips(rows: Rows) -> Iterator[str]:
    """What is wrong in print: numbers, equations, words."""
    for source, told in rows.items():
        for row in told:
            if isinstance(row, Printed) and row.slip:
                said = f"{row}: {row.printed} for {row.told} {row.unit}".strip()
                yield f"| {source.name} | {row.place} | {said}; {row.why} |"
            elif isinstance(row, Agreement) and row.slip:
                yield f"| {source.name} | {row.place} | {row.slip} |"
        for slip in source.slips:
            yield f"| {source.name} | | {slip} |"


def anchor(name: str) -> str:
    """What a heading is called in links."""
    return "".join(sign for sign in name.lower().replace(" ", "-") if sign.isalnum() or sign == "-")


# -- tests -----------------------------------------------------------------------------------------


def test_page_is_what_the_tests_declare() -> None:
    assert PAGE.read_text(encoding="utf-8") == page(declared()), __doc__


def row(printed: str, computed: str = "", **more: Any) -> Printed:
    return Printed("case", "what", "Table 1", printed, computed, **more)


@pytest.mark.parametrize(
    ("told", "found"),
    [
        (row("12.4"), 12.449),
        (row("12.4", "12.415"), 12.4154),
        (row("360", "355", unit="deg", within=25, why="flat"), -5.0),
        (row("over 90", "95.7"), 95.66),
        (row("", "1.238"), [1.2381, 1.2379]),
        (row("1800", "1613", why="a misreading", slip=True), 1613.2),
    ],
)
def test_a_row_holds_every_digit_told(told: Printed, found: Any) -> None:
    told.hold(found)
    for value in np.ravel(found):
        with pytest.raises(AssertionError, match=f"is not {told.told}"):
            told.hold([value, value + 1.1 * 10.0 ** number(told.told).as_tuple().exponent])


@pytest.mark.parametrize(
    ("printed", "computed", "more"),
    [
        ("12.4", "12.46", {}),
        ("12.4", "12.46", {"within": 0.1}),
        ("12.4", "13.0", {"within": 0.1, "why": "read off"}),
        ("1800", "1613", {"slip": True}),
        ("over 90", "89", {}),
        ("under 1.0", "1.2", {}),
    ],
)
def test_a_difference_is_told_why(printed: str, computed: str, more: dict[str, Any]) -> None:
    with pytest.raises(ValueError, match="nothing says why"):
        row(printed, computed, **more)


if __name__ == "__main__":
    PAGE.write_text(page(declared()), encoding="utf-8")
