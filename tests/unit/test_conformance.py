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
from support.conformance import (
    DECLARED,
    KINDS,
    TESTS,
    Agreement,
    Cause,
    Observation,
    Printed,
    Source,
    number,
)

DOCS = TESTS.parent / "docs"
PAGE, TRUST = DOCS / "conformance.md", DOCS / "trust.md"
MARKED = re.compile("(?<=<!-- printed numbers -->).*?(?=<!-- /printed numbers -->)", re.DOTALL)
SOURCES = [var for var in vars(sources).values() if isinstance(var, Source)]
Rows = dict[Source, list[Printed | Agreement]]

TOTALS = (
    "of {told} printed numbers of papers, standards and textbooks {met} are met as they are "
    "printed; {explained} are not, for a cause that is computed too and gives the printed digits; "
    "{open} are not, and why is open; {slip} are slips of the print"
)
HEAD = """# Conformance

Every published number that Equipoise is held against, every other program and every second route,
with what comes out here. The tests write this page and hold each row of it: `make test-all`
fails where one is no longer met.

{totals}. Another {drawn} are
drawn in print without being told as numbers. Printed equations are held by {equations} tests, and
{agreements} cases are compared with other programs and second routes.

What stands where:

- **case**: the machine, by the name of a [bundled one](examples.md) where it is one.
- **quantity**: by the name that commands have for it, such as `curve.height`, or in words; and its
  unit.
- **where**: in the source.
- **computed**: what comes out here. Each digit is held; where ± stands, it lies so near to the
  printed number.
- **off by**: what is computed less what is printed.
- **why**: a cause, which a test computes: what it gives, or the range that it leaves, meets the
  printed digits. *Half a digit* of a table is the range that is left where each of its numbers may
  be off by half of its last digit. *Open* is what no cause is known of, *slip* what is wrong in
  print; what is said of either is computed by a test as well.
- **at most**: the largest difference, as a part of the largest value, or of a thousandth of all
  forces where an output vanishes.
"""
CONTENTS = (
    "| source | met | explained | open | slips | drawn | tests of equations | compared cases |\n"
    "|---|---|---|---|---|---|---|---|"
)
NUMBERS = {
    "Not met as printed": "| case | quantity | where | printed | computed | off by | why |\n"
    "|---|---|---|---|---|---|---|",
    "Met as printed": "| case | quantity | where | printed | computed |\n|---|---|---|---|---|",
    "Drawn in print": "| case | quantity | where | computed |\n|---|---|---|---|",
}
EQUATIONS = "| equations | what they give | at most |\n|---|---|---|"
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
    return {source: reported for source, reported in rows.items() if reported}


def page(rows: Rows) -> str:
    """The page, as Markdown."""
    parts = [
        HEAD.format(totals=totals(rows).capitalize(), **counts(rows)),
        "## Contents\n",
        CONTENTS,
    ]
    for key, text in rows.items():
        kinds = " | ".join(str(count or "") for count in counts({key: text}).values())
        parts.append(f"| [{key.name}](#{anchor(key.name)}) | {kinds} |")
    parts.append("\nThe last section lists the [slips in print](#slips-in-print).")
    for source, text in rows.items():
        parts.append(f"\n## {source.name}\n\n{' '.join(source.text.split())}\n")
        parts += sections(text)
    parts += ["\n## Slips in print\n", SLIPS, *slips(rows)]
    return "\n".join(parts) + "\n"


def totals(rows: Rows) -> str:
    """What is counted of printed numbers, in a sentence: the one place that counts them."""
    of = counts(rows)
    reported = sum(of[kind] for kind in KINDS if kind != "drawn")
    return TOTALS.format(told=reported, **of)


def counts(rows: Rows) -> dict[str, int]:
    """How many rows of each kind there are."""
    every = [row for text in rows.values() for row in text]
    kinds = Counter(row.kind for row in every if isinstance(row, Printed))
    others = [row for row in every if isinstance(row, Agreement)]
    return {
        **{kind: kinds[kind] for kind in KINDS},
        "equations": sum(bool(row.place) for row in others),
        "agreements": sum(not row.place for row in others),
    }


def sections(rows: Sequence[Printed | Agreement]) -> Iterator[str]:
    """The tables of a source, and what it is compared with as a list."""
    tables: dict[str, list[str]] = {name: [] for name in NUMBERS}
    equations: list[str] = []
    compared: dict[tuple[str, str], list[str]] = {}
    for row in rows:
        if isinstance(row, Printed):
            name = {"met": "Met as printed", "drawn": "Drawn in print"}.get(row.kind)
            name = name or "Not met as printed"
            tables[name].append(f"| {' | '.join(cells(row))} |")
        elif row.place:
            equations.append(f"| {row.place} | {row.what} | {power(row.within)} |")
        else:
            compared.setdefault((row.what, power(row.within)), []).append(row.case)
    for name, lines in tables.items():
        if lines:
            yield "\n".join([f"**{name}**\n", NUMBERS[name], *lines]) + "\n"
    if equations:
        equations.sort(key=lambda line: [int(match) for match in re.findall(r"\d+", line)])
        yield "\n".join(["**Equations**\n", EQUATIONS, *equations]) + "\n"
    if compared:
        yield "\n".join(
            f"- **{what}**, {within} at most. {'; '.join(cases)}."
            for (what, within), cases in compared.items()
        )


def power(within: float) -> str:
    """A small number, such as 2e-8."""
    return f"{within:.0e}".replace("e-0", "e-")


def cells(row: Printed) -> list[str]:
    """A printed number as a line of the table of its kind."""
    what = f"{row.what}, {row.unit}" if row.unit else row.what
    near = row.within and not row.computed
    reported = f"{row.told} ± {power(row.within)}" if near else row.told
    if row.kind == "drawn":
        return [row.case, what, row.place, reported]
    line = [row.case, what, row.place, row.printed, reported]
    if row.kind == "met":
        return line
    kind = "" if row.kind == "explained" else f"{row.kind}: "
    return [*line, deviation(row), f"{kind}{row.why}"]


def deviation(row: Printed) -> str:
    """How far off a number is, in its unit and in parts of what is printed."""
    size = float(abs(number(row.printed)))
    if not size or row.unit in ("deg", "%"):
        return f"{row.off:+f}"
    share = 100 * float(row.off) / size
    return f"{row.off:+f} ({share:+.{1 if abs(share) < 10 else 0}f} %)"


def slips(rows: Rows) -> Iterator[str]:
    """What is wrong in print: numbers, equations, words."""
    for source, text in rows.items():
        for row in text:
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


def trust(rows: Rows) -> str:
    """The page on trust, with what is counted of printed numbers."""
    return MARKED.sub(totals(rows), TRUST.read_text(encoding="utf-8"))


def test_page_is_what_the_tests_declare() -> None:
    assert PAGE.read_text(encoding="utf-8") == page(declared()), __doc__


def test_trust_counts_as_the_page_does() -> None:
    text = TRUST.read_text(encoding="utf-8")
    assert len(MARKED.findall(text)) == 1
    assert text == trust(declared()), __doc__


def test_a_printed_number_stands_once() -> None:
    for source, text in declared().items():
        often = Counter((row.case, row.what, row.place) for row in text if isinstance(row, Printed))
        assert [key for key, count in often.items() if count > 1] == [], source.name


MISREAD = Observation("a misreading", lambda: True)


def row(printed: str, computed: str = "", **more: Any) -> Printed:
    return Printed("case", "what", "Table 1", printed, computed, **more)


@pytest.mark.parametrize(
    ("told", "found"),
    [
        (row("12.4"), 12.449),
        (row("12.4", "12.415"), 12.4154),
        (row("360", "355", unit="deg", why=Observation("flat", lambda: True)), -5.0),
        (row("over 90", "95.7"), 95.66),
        (row("", "1.238"), [1.2381, 1.2379]),
        (row("1800", "1613", why=MISREAD, slip=True), 1613.2),
    ],
)
def test_a_row_holds_every_reported_digit(told: Printed, found: Any) -> None:
    told.hold(found)
    for value in np.ravel(found):
        with pytest.raises(AssertionError, match=f"is not {told.told}"):
            told.hold([value, value + 1.1 * 10.0 ** number(told.told).as_tuple().exponent])


@pytest.mark.parametrize(
    ("printed", "computed", "more"),
    [
        ("12.4", "12.46", {}),
        ("12.4", "12.46", {"within": 0.1}),
        ("1800", "1613", {"slip": True}),
        ("1800", "1613", {"why": "a misreading that nothing computes"}),
        ("over 90", "89", {}),
        ("under 1.0", "1.2", {}),
    ],
)
def test_a_difference_is_reported_why(printed: str, computed: str, more: dict[str, Any]) -> None:
    with pytest.raises(ValueError, match="nothing says why"):
        row(printed, computed, **more)


def test_what_is_known_of_a_difference_is_computed() -> None:
    """Of open rows and of slips."""
    for slip in (False, True):
        row("1800", "1613", why=MISREAD, slip=slip).check_cause()
        untrue = row("1800", "1613", why=Observation("a rounding", lambda: False), slip=slip)
        with pytest.raises(AssertionError, match="not so: a rounding"):
            untrue.check_cause()


@pytest.mark.parametrize(
    ("printed", "unit", "gives", "holds"),
    [
        ("12.4", "", 12.44, True),
        ("12.4", "", 12.46, False),
        ("12.4", "", [11.9, 12.37], True),
        ("12.4", "", [11.9, 12.34], False),
        ("12.4", "", [12.46, 13.0], False),
        ("359", "deg", [-2.0, 1.0], True),
        ("359", "deg", [0.6, 1.0], False),
    ],
)
def test_a_cause_meets_the_printed_digits(printed: str, unit: str, gives: Any, holds: bool) -> None:
    reported = row(printed, "20", unit=unit, why=Cause("as read", lambda: gives))
    assert reported.kind == "explained"
    if holds:
        reported.check_cause()
        return
    with pytest.raises(AssertionError, match="as read gives"):
        reported.check_cause()


if __name__ == "__main__":
    every = declared()
    PAGE.write_text(page(every), encoding="utf-8")
    TRUST.write_text(trust(every), encoding="utf-8")
