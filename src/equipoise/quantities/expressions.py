"""Quantities given as sums and products: ``2*100 g``, ``=33.5 mm + 2 mm``, ``=crank/2``.

Python's own grammar is read, with every quantity as one name in it; only numbers, names, brackets
and + - * / are taken.  Arithmetic is decimal, so that 33.5 mm + 2 mm is the float nearest to
0.0355.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Callable, Mapping
from dataclasses import field
from decimal import Decimal, InvalidOperation, localcontext
from functools import cache
from math import isfinite
from types import MappingProxyType
from unicodedata import normalize

from equipoise.dataclass import dataclass
from equipoise.errors import UsageError, meant
from equipoise.i18n import Note
from equipoise.quantities.reading import (
    NUMBER,
    parse,
    pattern,
    plain_unit,
    start_of_range,
    too_far,
    unit_pattern,
)
from equipoise.quantities.units import FACTORS, HUGE, KINDS, OF_UNIT, TINY, Dimension

LONGEST = 200
"""Characters of an expression."""
DIGITS = 60
"""Digits carried: enough that only the last step, to a float, rounds."""
OPERATORS = re.compile(r"[*/()=]|(?<![eE])[+-]")
"""What a plain quantity does not have: signs between its parts."""


@dataclass(frozen=True)
class Amount:
    """A number in SI units with all its digits.

    powers : how often each dimension is in it; empty of a plain number.
    """

    number: Decimal
    powers: Mapping[Dimension, int] = field(default_factory=dict)

    @property
    def dimension(self) -> Dimension | None:
        """Of a quantity; None of a plain number.

        Raises
        ------
        ValueError : it is neither, such as a product of two lengths.
        """
        match [*self.powers.items()]:
            case []:
                return None
            case [(dimension, 1)]:
                return dimension
        raise ValueError

    def times(self, other: Amount, power: int) -> Amount:
        """The product with another amount (`power` 1), or the quotient by it (-1)."""
        number = self.number * other.number if power == 1 else self.number / other.number
        powers = dict(self.powers)
        for dimension, count in other.powers.items():
            powers[dimension] = powers.get(dimension, 0) + power * count
        return Amount(number, {dimension: count for dimension, count in powers.items() if count})

    def plus(self, other: Amount, sign: int) -> Amount:
        """The sum with another amount of the same dimension, or the difference (`sign` -1)."""
        if self.powers != other.powers:
            raise ValueError
        return Amount(self.number + sign * other.number, self.powers)


NamedAmounts = Mapping[str, Amount]
"""What names in an expression stand for."""
NO_NAMES: NamedAmounts = MappingProxyType({})


def parse_expression(text: str, dimension: Dimension, names: NamedAmounts = NO_NAMES) -> float:
    """Read a quantity, or a sum or product of quantities and numbers that is one.

    Parameters
    ----------
    text : such as ``"33.5 mm"``, ``"2*100 g"`` or ``"=(33.5 mm + crank)/2"``.
    dimension : of the result.
    names : amounts that the text may name.

    Returns
    -------
    float
        In SI units and radians.

    Raises
    ------
    UsageError
        One sentence: what was given and what would be right.
    """
    if re.fullmatch(pattern(dimension), text) or not is_expression(text):
        return parse(text, dimension)
    amount = _amount(text, names, lambda short: _no_quantity(short, dimension))
    if not amount.powers and not names.keys() & names_in(text):
        raise UsageError(
            Note(
                "got {text!r}, which has no unit; give {noun}, such as {example!r}",
                text=_short(text),
                noun=Note(KINDS[dimension].noun),
                example=KINDS[dimension].example,
            )
        )
    if amount.powers != {dimension: 1}:
        kind, short = KINDS[dimension], _short(text)
        otherwise = _no_quantity(short, dimension)
        raise UsageError(_another(short, amount, Note(kind.noun), kind.example, otherwise))
    return _float(amount, text)


def parse_number(text: str, names: NamedAmounts = NO_NAMES) -> float:
    """Read a number without a unit, or a sum or product of such numbers.

    Parameters
    ----------
    text : such as ``"0.15"`` or ``"=0.3/2"``.
    names : amounts that the text may name.

    Raises
    ------
    UsageError
        One sentence: what was given and what would be right.
    """
    amount = _amount(text, names, _no_number)
    if amount.powers:
        short = _short(text)
        raise UsageError(_another(short, amount, Note("a plain number"), "0.15", _no_number(short)))
    return _float(amount, text)


def parse_amount(text: str, names: NamedAmounts = NO_NAMES) -> Amount:
    """Read a quantity of any dimension or a plain number, or a sum or product that is either.

    Parameters
    ----------
    text : such as ``"33.5 mm"``, ``"0.15"`` or ``"=2*crank + 3 mm"``.
    names : amounts that the text may name.

    Raises
    ------
    UsageError
        One sentence: what was given and what would be right.
    """
    plain = re.fullmatch(rf"{NUMBER} *([^\W\d_].*)", text)
    if plain is not None and (dimension := OF_UNIT.get(plain_unit(plain[1]))) is not None:
        _ = parse(text, dimension)  # which says what is wrong, such as a space that is missing
    amount = _amount(text, names, _no_amount)
    try:
        _ = amount.dimension
    except ValueError as error:
        raise UsageError(_no_amount(_short(text))) from error
    _ = _float(amount, text)
    return amount


def is_expression(text: str) -> bool:
    """Whether a text is meant as a sum or product, and not as one quantity."""
    if start_of_range(text):
        return False
    return bool(OPERATORS.search(text.strip()[1:]) or text[:1] in "=(")


# -- what is wrong ---------------------------------------------------------------------------------


def _short(text: str) -> str:
    return text if len(text) <= 60 else f"{text[:57]}..."


def _no_quantity(text: str, dimension: Dimension) -> Note:
    unit = KINDS[dimension].example.partition(" ")[2]
    return Note(
        'got {text!r}, which is no sum or product that gives {noun}; write it as "2*100 {unit}" or '
        '"33.5 {unit} + 2 {unit}"',
        text=text,
        noun=Note(KINDS[dimension].noun),
        unit=unit,
    )


def _another(text: str, amount: Amount, wanted: Note, example: str, otherwise: Note) -> Note:
    """What is said of an expression that gives an amount of another kind than is wanted.

    otherwise : of one that gives what has no name, such as a product of two lengths.
    """
    try:
        dimension = amount.dimension
    except ValueError:
        return otherwise
    return Note(
        "got {text!r}, which gives {given}; give {wanted}, such as {example!r}",
        text=text,
        given=Note("a plain number") if dimension is None else Note(KINDS[dimension].noun),
        wanted=wanted,
        example=example,
    )


def _no_number(text: str) -> Note:
    return Note('got {text!r}; give a plain number, such as "0.15"', text=text)


def _no_amount(text: str) -> Note:
    return Note(
        "got {text!r}, which is neither a quantity nor a number; give such as "
        '"33.5 mm", "0.15" or "=2*33.5 mm"',
        text=text,
    )


def _float(amount: Amount, text: str) -> float:
    number = float(amount.number)
    if not isfinite(number) or abs(number) > HUGE or 0 < abs(number) < TINY:
        raise UsageError(too_far(_short(text)))
    return number


# -- reading ---------------------------------------------------------------------------------------


def _amount(text: str, names: NamedAmounts, wrong: Callable[[str], Note]) -> Amount:
    """What an expression comes to; `wrong` says what is wrong where it is none."""
    short = _short(text)
    if len(text) > LONGEST:
        raise UsageError(
            Note(
                "got {text!r}, which has {count} characters; give at most {most}",
                text=short,
                count=len(text),
                most=LONGEST,
            )
        )
    with localcontext() as context:
        context.prec = DIGITS
        try:
            tree, quantities = _tree(text)
            for name in sorted(_names_in(tree) - quantities.keys() - names.keys()):
                raise UsageError(_unknown(short, name, names, wrong))
            return _value(tree, {**names, **quantities})
        except (SyntaxError, ValueError, RecursionError, MemoryError, InvalidOperation) as error:
            raise UsageError(wrong(short)) from error
        except ZeroDivisionError as error:
            raise UsageError(Note("got {text!r}, which divides by 0", text=short)) from error


def _unknown(text: str, name: str, names: NamedAmounts, wrong: Callable[[str], Note]) -> Note:
    """What is said of a name that stands for nothing."""
    if not names:
        return wrong(text)
    right = meant(name, [*names]) or Note("there are {names}", names=", ".join(sorted(names)))
    return Note(
        "got {text!r}, but no parameter is called {name!r}; {right}",
        text=text,
        name=name,
        right=right,
    )


@cache
def _quantities() -> re.Pattern[str]:
    """A quantity of any dimension, or a unit behind a bracket."""
    units = unit_pattern(OF_UNIT)
    number = NUMBER.removeprefix("[+-]?")
    return re.compile(
        rf"(?<![\w.])(?P<number>{number}) *(?P<unit>{units})(?![\w^])"
        rf"|(?<=\)) *(?P<bare>{units})(?![\w^])"
    )


def _tree(text: str) -> tuple[ast.expr, dict[str, Amount]]:
    """The expression, each quantity in it as a name, ``_0``, ``_1`` and so on; and these names."""
    quantities: dict[str, Amount] = {}

    def as_name(match: re.Match[str]) -> str:
        name, unit = f"_{len(quantities)}", plain_unit(match["unit"] or match["bare"])
        number = Decimal(match["number"] or 1) * Decimal(FACTORS[unit])
        quantities[name] = Amount(number, {OF_UNIT[unit]: 1})
        return name if match["number"] else f"*{name}"

    if "#" in text:  # what follows would be left out as a comment of Python's
        raise SyntaxError(text)
    written = _quantities().sub(as_name, text.strip().removeprefix("="))
    return ast.parse(written.strip(), mode="eval").body, quantities


def spelled(name: str) -> str:
    """A name as Python's grammar has it, which takes all forms of a letter for the same.

    Keyboards write the micro sign, which it reads as the Greek letter, and half-width kana.
    """
    return normalize("NFKC", name)


def names_in(text: str) -> set[str]:
    """The names in an expression; none where it cannot be read."""
    if len(text) > LONGEST:
        return set()
    try:
        tree, quantities = _tree(text)
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return set()
    return _names_in(tree) - quantities.keys()


def _names_in(tree: ast.expr) -> set[str]:
    return {node.id for node in ast.walk(tree) if isinstance(node, ast.Name)}


def _value(node: ast.expr, names: NamedAmounts) -> Amount:
    """The amount of a part of an expression; a ValueError where it has none."""
    match node:
        case ast.Name(id=name) if name in names:
            return names[name]
        case ast.Constant(value=number) if type(number) in (int, float):
            return Amount(Decimal(repr(number)))
        case ast.UnaryOp(op=ast.UAdd() | ast.USub() as sign, operand=operand):
            value = _value(operand, names)
            return Amount(-value.number, value.powers) if isinstance(sign, ast.USub) else value
        case ast.BinOp(left=left, op=sign, right=right):
            return _joined(_value(left, names), sign, _value(right, names))
    raise ValueError(ast.dump(node)[:60])


def _joined(left: Amount, sign: ast.operator, right: Amount) -> Amount:
    match sign:
        case ast.Mult():
            return left.times(right, 1)
        case ast.Div() if right.number == 0:
            raise ZeroDivisionError
        case ast.Div():
            return left.times(right, -1)
        case ast.Add():
            return left.plus(right, 1)
        case ast.Sub():
            return left.plus(right, -1)
    raise ValueError(ast.dump(sign))
