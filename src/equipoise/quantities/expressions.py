"""Quantities that are typed as sums and products: ``2*100 g``, ``=33.5 mm + 2 mm``.

Python's own grammar is read, with every quantity as one name in it; only numbers, names, brackets
and + - * / are taken.  Arithmetic is decimal, so that 33.5 mm + 2 mm is the float nearest to
0.0355.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Mapping
from decimal import Decimal, InvalidOperation, localcontext
from math import isfinite

from equipoise.errors import UsageError
from equipoise.i18n import Note
from equipoise.quantities.reading import NUMBER, parse, pattern, plain_unit, start_of_range, too_far
from equipoise.quantities.units import FACTORS, HUGE, KINDS, TINY, Dimension

LONGEST = 200
"""Signs of an expression."""
DIGITS = 60
"""Digits carried: enough that only the last step, to a float, rounds."""
OPERATORS = re.compile(r"[*/()=]|(?<![eE])[+-]")
"""What a plain quantity does not have: signs between its parts."""

Amount = tuple[Decimal, int]
"""A number, and how many times the dimension is in it: 0 of a plain number, 1 of a quantity."""


def parse_expression(text: str, dimension: Dimension) -> float:
    """Read a quantity, or a sum or product of quantities and numbers that is one.

    Parameters
    ----------
    text : such as ``"33.5 mm"``, ``"2*100 g"`` or ``"=(33.5 mm + 2 mm)/2"``.
    dimension : of each quantity in it, and of the result.

    Returns
    -------
    float
        In SI units and radians.

    Raises
    ------
    UsageError
        One sentence: what was given and what would be right.
    """
    if re.fullmatch(pattern(dimension), text) or not _is_expression(text):
        return parse(text, dimension)
    shown = text if len(text) <= 60 else f"{text[:57]}..."
    with localcontext() as context:
        context.prec = DIGITS
        try:
            value, times = _value(_tree(text, dimension), _amounts(text, dimension))
        except (SyntaxError, ValueError, RecursionError, MemoryError, InvalidOperation) as error:
            raise UsageError(_wrong(shown, dimension)) from error
        except ZeroDivisionError as error:
            raise UsageError(Note("got {text!r}, which divides by 0", text=shown)) from error
    if times == 0:
        raise UsageError(
            Note(
                "got {text!r}, which has no unit; give {noun}, such as {example!r}",
                text=shown,
                noun=Note(KINDS[dimension].noun),
                example=KINDS[dimension].example,
            )
        )
    number = float(value)
    if times != 1:
        raise UsageError(_wrong(shown, dimension))
    if not isfinite(number) or abs(number) > HUGE or 0 < abs(number) < TINY:
        raise UsageError(too_far(shown))
    return number


def parse_number(text: str) -> float:
    """Read a number without a unit, or a sum or product of such numbers.

    Parameters
    ----------
    text : such as ``"0.15"`` or ``"=0.3/2"``.

    Raises
    ------
    UsageError
        One sentence: what was given and what would be right.
    """
    shown = text if len(text) <= 60 else f"{text[:57]}..."
    wrong = UsageError(Note('got {text!r}; give a plain number, such as "0.15"', text=shown))
    if len(text) > LONGEST:
        raise wrong
    with localcontext() as context:
        context.prec = DIGITS
        try:
            tree = ast.parse(text.strip().removeprefix("=").strip(), mode="eval").body
            number = float(_value(tree, {})[0])
        except (SyntaxError, ValueError, RecursionError, MemoryError, InvalidOperation) as error:
            raise wrong from error
        except ZeroDivisionError as error:
            raise UsageError(Note("got {text!r}, which divides by 0", text=shown)) from error
    if not isfinite(number) or abs(number) > HUGE or 0 < abs(number) < TINY:
        raise UsageError(too_far(shown))
    return number


def _is_expression(text: str) -> bool:
    if len(text) > LONGEST or start_of_range(text):
        return False
    return bool(OPERATORS.search(text.strip()[1:]) or text[:1] in "=(")


def _wrong(text: str, dimension: Dimension) -> Note:
    """What is wrong with an expression, and what would be right."""
    unit = KINDS[dimension].example.partition(" ")[2]
    return Note(
        'got {text!r}, which is no sum or product that gives {noun}; write it as "2*100 {unit}" or '
        '"33.5 {unit} + 2 {unit}"',
        text=text,
        noun=Note(KINDS[dimension].noun),
        unit=unit,
    )


def _pieces(text: str, dimension: Dimension) -> list[tuple[str, str]]:
    """The text in pieces: quantities and units behind brackets, and what is between them."""
    units = pattern(dimension).partition(") +(")[2].removesuffix(")$")
    quantity = re.compile(rf"(?P<number>{NUMBER.removeprefix('[+-]?')}) *(?P<unit>{units})(?![\w^])"
                          rf"|(?<=\)) *(?P<bare>{units})(?![\w^])")  # fmt: skip
    found, end = [], 0
    for match in quantity.finditer(text):
        found.append((text[end : match.start()], ""))
        number = match["number"] or ""
        found.append((number, plain_unit(match["unit"] or match["bare"])))
        end = match.end()
    return [*found, (text[end:], "")]


def _tree(text: str, dimension: Dimension) -> ast.expr:
    """The expression, each quantity in it a name: ``_0``, ``_1`` and so on."""
    written = ""
    for number, (piece, unit) in enumerate(_pieces(text.strip().removeprefix("="), dimension)):
        written += piece if not unit else f"_{number}" if piece else f"*_{number}"
    return ast.parse(written.strip(), mode="eval").body


def _amounts(text: str, dimension: Dimension) -> Mapping[str, Amount]:
    """The quantities by these names, in SI units."""
    pieces = _pieces(text.strip().removeprefix("="), dimension)
    return {
        f"_{number}": (Decimal(piece or 1) * Decimal(FACTORS[unit]), 1)
        for number, (piece, unit) in enumerate(pieces)
        if unit
    }


def _value(node: ast.expr, amounts: Mapping[str, Amount]) -> Amount:
    """The amount of a part of an expression; a ValueError where it has none."""
    if isinstance(node, ast.Name) and node.id in amounts:
        return amounts[node.id]
    if isinstance(node, ast.Constant) and type(node.value) in (int, float):
        return Decimal(repr(node.value)), 0
    if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.UAdd | ast.USub):
        value, times = _value(node.operand, amounts)
        return (-value if isinstance(node.op, ast.USub) else value), times
    if not isinstance(node, ast.BinOp):
        raise ValueError(ast.dump(node)[:60])  # noqa: TRY004 - of what was typed
    (one, of_one), (other, of_other) = (_value(part, amounts) for part in (node.left, node.right))
    if isinstance(node.op, ast.Mult):
        return one * other, of_one + of_other
    if isinstance(node.op, ast.Div):
        if other == 0:
            raise ZeroDivisionError
        return one / other, of_one - of_other
    if not isinstance(node.op, ast.Add | ast.Sub) or of_one != of_other:
        raise ValueError
    return (one + other if isinstance(node.op, ast.Add) else one - other), of_one
