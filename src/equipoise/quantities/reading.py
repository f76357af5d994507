"""Quantities at the door: strict text to SI floats, and back, also in sentences.

The grammar is number, space, unit; the units are an explicit list for each dimension.  Conversion
is in decimal arithmetic, so that ``parse("33.5 mm", "length")`` is the float nearest to 0.0335.
What is wrong with a text is said in one sentence: what was given and what would be right.

What checks a machine knows floats in SI units.  Who wrote ``"-12 mm"`` into a file looks for -12
mm, so a sentence keeps its numbers as `Measured` values, and where the file is read each gets the
text that stands there (`as_written`).
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from contextlib import suppress
from dataclasses import replace
from decimal import Decimal, localcontext
from functools import cache
from math import floor, isfinite, log10
from operator import eq
from typing import Any, overload

from equipoise.dataclass import dataclass
from equipoise.errors import UsageError, at_place
from equipoise.i18n import Note, to_say
from equipoise.quantities.numbers import chosen_unit, in_unit
from equipoise.quantities.units import FACTORS, HUGE, KINDS, SI, TINY, Dimension, QuantityKind

# -- grammar ---------------------------------------------------------------------------------------

NUMBER = r"[+-]?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:[eE][+-]?[0-9]{1,3})?"
_SEPARATOR = "(?: | ?[*\N{MIDDLE DOT}] ?)"
POWERS = {"2": "\N{SUPERSCRIPT TWO}", "3": "\N{SUPERSCRIPT THREE}"}
"""Exponents in units, and the sign for each that is read too."""


@cache
def pattern(dimension: Dimension) -> str:
    """Regular expression of exactly the texts that `parse` reads, in ECMA 262 syntax."""
    return f"^({NUMBER}) +({unit_pattern(KINDS[dimension].units)})$"


def unit_pattern(units: Iterable[str]) -> str:
    """Regular expression of the ways in which units can be written, the longest first."""
    written = [unit.replace(" ", _SEPARATOR) for unit in units]
    for digit, raised in POWERS.items():
        power = f"(?:(?:\\^|\\*\\*){digit}|{raised})"
        written = [unit.replace(f"^{digit}", power) for unit in written]
    return "|".join(sorted(written, key=len, reverse=True))


def plain_unit(unit: str) -> str:
    """Return the unit as the lists have it."""
    unit = unit.replace("**", "^")
    for digit, raised in POWERS.items():
        unit = unit.replace(raised, f"^{digit}")
    return re.sub(" ?[*\N{MIDDLE DOT}] ?", " ", unit)


_NAMES = {
    "\N{DEGREE SIGN}": "deg",
    '"': "in",
    **dict.fromkeys(
        ("1/min", "min^-1", "min-1", "r/min", "rev/min", "rot/min", "tr/min", "u/min", "upm",
         "rev per min", "revolutions per minute"), "rpm"),
    **dict.fromkeys(("rps", "r/s", "rev/s", "u/s"), "turn/s"),
    "\N{MICRO SIGN}m": "um",
    "\N{GREEK SMALL LETTER MU}m": "um",
    "kp": "kgf",
    "kph": "km/h",
}  # fmt: skip
_WORDS = {
    word: symbol
    for symbol, words in {
        "deg": "degree degrees", "rad": "radian radians", "turn": "turns rev revs revolutions",
        "in": "inch inches", "ft": "feet foot", "lb": "lbs pound pounds", "g": "gram grams gramm",
        "kg": "kgs kilo kilos kilogram kilograms kilogramm", "t": "ton tons tonne tonnes",
        "m": "meter meters metre metres", "N": "newton newtons", "s": "sec secs second seconds",
        "mm": "millimeter millimeters millimetre millimetres", "min": "mins minute minutes",
        "cm": "centimeter centimeters centimetre centimetres", "h": "hr hrs hour hours",
    }.items()
    for word in words.split()
}  # fmt: skip
"""Other spellings of units, and of the parts of such, only to suggest the right one."""
_POINTED = {
    **dict.fromkeys(("up", "upward", "upwards", "vertical"), "90"),
    **dict.fromkeys(("down", "downward", "downwards"), "-90"),
    **dict.fromkeys(("right", "forward", "horizontal"), "0"),
    **dict.fromkeys(("left", "backward"), "180"),
}
"""Directions in words, and the angle of each from the x axis, deg."""
_RANGE = re.compile(
    rf"(?P<low>{NUMBER})(?: *(?P<own>[^\W\d_]\S*?))??"
    r" *(?:\.{2,3}|[-\N{EN DASH}\N{EM DASH}~:]| to | bis | and ) *"
    rf"{NUMBER} *(?P<unit>[^\W\d_].*)"
)
"""Two quantities, of which the first may leave its unit to the second."""


def described(given: object) -> str:
    """Name a wrong value by its sort, in words of the model file."""
    if isinstance(given, bool):
        return "true" if given else "false"
    if isinstance(given, str):
        return _quoted(given)
    if isinstance(given, int | float):
        return Note("the number {number}", number=_shown(_digits(given)))
    if isinstance(given, dict):
        return Note("a table")
    if isinstance(given, list | tuple):
        return Note("a list of {count}", count=len(given))
    return Note("nothing") if given is None else f"{_shown(str(given))}"


def _bare_number(given: object) -> str:
    """What was given in place of a quantity that has to have a unit, in words."""
    if isinstance(given, int | float) and not isinstance(given, bool):
        return Note("the bare number {number}", number=_shown(_digits(given)))
    return described(given)


def _digits(number: int | float) -> str:
    try:
        return repr(number)
    except ValueError:  # Python refuses to print integers of more than 4300 digits.
        return "of thousands of digits"


def _shown(text: str) -> str:
    return text if len(text) <= 60 else f"{text[:57]}..."


def _quoted(text: str) -> str:
    return repr(_shown(text))


def too_far(text: str) -> Note:
    """Complain of an impossible size."""
    return Note("got {text}, which no machine can have; give a usual size", text=_quoted(text))


DECIMAL_COMMA = re.compile(r"([+-]?[0-9]*),([0-9]*(?:[eE][+-]?[0-9]{1,3})?)")
"""A number with a comma for its point."""
_GROUPS = [
    # a sign that may separate thousands, and one that may then be the decimal sign
    re.compile(rf"([+-]?[1-9][0-9]{{0,2}}(?:{apart}[0-9]{{3}}){some})(?:{decimal}([0-9]*))?")
    for apart, some, decimal in (
        (",", "+", r"\."), (r"\.", "{2,}", ","), (r"\.", "+(?=,)", ","),
        ("[ '_\N{RIGHT SINGLE QUOTATION MARK}\N{NO-BREAK SPACE}\N{NARROW NO-BREAK SPACE}]", "+",
         "[.,]"),
    )
]  # fmt: skip


def readings(number: str) -> tuple[str, str]:
    """What a number is if its comma is the decimal sign, and if signs in it separate thousands.

    Each is empty where it cannot be read so.
    """
    pointed = ".".join(match.groups()) if (match := DECIMAL_COMMA.fullmatch(number)) else ""
    grouped = next(filter(None, (form.fullmatch(number) for form in _GROUPS)), None)
    digits = re.sub("[^0-9+-]", "", grouped[1]) if grouped else ""
    whole = f"{digits}.{grouped[2]}" if grouped and grouped[2] else digits
    return pointed if re.fullmatch(NUMBER, pointed) else "", whole


def separators_note(number: str, unit: str = "") -> str:
    """Say what a number with commas or separators of thousands may be; empty where it has none.

    unit : written behind each reading, in quotes.
    """
    decimal, whole = (
        f'"{reading} {unit}"' if reading and unit else reading for reading in readings(number)
    )
    if decimal and whole:
        return Note(
            "a comma may be the decimal sign or separate thousands; write {decimal} or {whole}",
            decimal=decimal,
            whole=whole,
        )
    if whole:
        return Note("leave out what separates thousands: {whole}", whole=whole)
    if decimal:
        return Note("the decimal sign is a point, not a comma: {decimal}", decimal=decimal)
    return ""


def usual_unit(unit: str, dimension: Dimension) -> str:
    """A unit as the lists have it where it is another spelling of one, such as a degree sign."""
    other = _spelled(unit)
    return other if other in KINDS[dimension].units else unit


TOPIC = "a-unit-is-missing-or-wrong"
"""What `equipoise explain` knows about quantities that cannot be read."""


def wrong_text(text: str, dimension: Dimension) -> Note:
    """Complain of a text outside the grammar of its dimension."""
    return got(_quoted(text), _right(text, dimension)).about(TOPIC)


def got(given: object, right: str) -> Note:
    """Say what was given, and what would be right."""
    return Note("got {given}; {right}", given=given, right=right)


def _right(text: str, dimension: Dimension) -> str:
    """What to give instead of a text outside the grammar of its dimension."""
    kind = KINDS[dimension]
    if low := start_of_range(text):
        noun = Note(kind.noun)
        return Note('{noun} is wanted, not a range; give one such as "{low}"', noun=noun, low=low)
    parts = re.fullmatch(r"(.*[0-9.,]) *([^\s0-9.,].*)", text)
    known = parts is not None and plain_unit(parts[2]) in kind.units
    if parts is not None and known and (name := separators_note(*parts.groups())):
        return name
    whole = re.fullmatch(rf"({NUMBER})( *)(\S.*)", text)
    if whole is None:
        return _number_complaint(text, kind)
    number, space, unit = whole.groups()
    if not space and re.fullmatch(r"[0-9.,_xXoObBeE\s]+.*", unit) and not _known(unit):
        return _number_complaint(text, kind)
    if not space and plain_unit(unit) in kind.units:
        return Note(
            'put a space between number and unit: "{number} {unit}"',
            number=number,
            unit=plain_unit(unit),
        )
    return _unit_complaint(unit, number, dimension)


def start_of_range(text: str) -> str:
    """The first quantity of what is written as a range, such as ``100-300 rpm``; empty where text
    is none.  A unit after the second quantity stands for both.
    """
    match = _RANGE.fullmatch(text.strip())
    if match is None:
        return ""
    unit = plain_unit(_spelled(match["own"] or match["unit"]))
    return f"{match['low']} {unit}" if _known(unit) else ""


def _number_complaint(text: str, kind: QuantityKind) -> str:
    such = Note('such as "{example}"', example=kind.example)
    if kind is KINDS["angle"] and (angle := _POINTED.get(text.strip().lower())):
        return Note('did you mean "{number} {unit}"?', number=angle, unit="deg")
    if re.fullmatch(NUMBER, text.strip()):
        return Note("the unit is missing; give {noun}, {such}", noun=Note(kind.noun), such=such)
    if kind is KINDS["density"] and text.strip().isalpha():
        return Note(
            'give number and unit, {such}; to name a material, write material = "{name}" instead '
            "(of gears gear_material)",
            such=such,
            name=text.strip(),
        )
    if re.match(r"[+-]?[0-9]+,[0-9]+", text.strip()):
        return _comma_complaint(text.strip(), kind)
    return Note(_number_slip(text), such=such)


def _number_slip(text: str) -> str:
    """What is wrong with a text that has no number as it should be; ``such`` follows."""
    if re.match(r"[+-]?(nan|inf)", text, re.IGNORECASE):
        return to_say("give a finite number and a unit, {such}")
    if not re.search(r"\d", text):
        return to_say("give number and unit, {such}")
    if text != text.strip():
        return to_say("leave out the space before or after it, {such}")
    return to_say(
        "write the number with the digits 0 to 9, a decimal point and at most an exponent, then a "
        "space and the unit, {such}"
    )


def _comma_complaint(text: str, kind: QuantityKind) -> str:
    such = kind.example
    if pointed := readings(text)[0]:
        such = f"{pointed} {kind.example.partition(' ')[2]}"
    return Note('write it with a decimal point and a unit, such as "{such}"', such=such)


def _unit_complaint(unit: str, number: str, dimension: Dimension) -> str:
    kind = KINDS[dimension]
    wanted = Note("{noun} is wanted: {units}", noun=Note(kind.noun), units=", ".join(kind.units))
    plain = plain_unit(unit)
    if plain == "Hz" and dimension == "angular speed":
        return Note(
            'Hz is ambiguous between turns and radians; give "{turns} turn/s" or "{rpm} rpm"',
            turns=number,
            rpm=_plain(60 * Decimal(number)),
        )
    if plain in kind.units:
        return Note('write "{number} {unit}"', number=number, unit=plain)
    if meant := unit_meant(unit, dimension):
        return Note('did you mean "{number} {unit}"?', number=number, unit=meant)
    other = _known(plain) or next((KINDS[kind] for kind in KINDS if unit_meant(unit, kind)), None)
    if other is not None:
        of = Note(other.noun)
        unit_text = plain if plain in other.units else _quoted(unit)
        return Note("{unit} is the unit of {of}; {wanted}", unit=unit_text, of=of, wanted=wanted)
    return Note("there is no unit {unit} here; {wanted}", unit=_quoted(unit), wanted=wanted)


def _plain(value: Decimal) -> str:
    """A decimal without trailing zeros, with an exponent only where many zeros would stand."""
    exact = value.normalize()
    return f"{exact:f}" if -6 < exact.adjusted() < 9 else f"{exact:e}"


def unit_meant(unit: str, dimension: Dimension) -> str:
    """The unit of a dimension that another spelling of it means; nothing where none does."""
    units = KINDS[dimension].units
    name = _spelled(unit)
    bare = _bare(name)
    if name in units:
        return name
    alike = (known for known in units if bare and _bare(known) == bare)
    meant = (known for known in alike if not _is_mega_for_milli(known, name))
    return max(meant, key=lambda known: sum(map(eq, _letters(known), _letters(name))), default="")


def _letters(unit: str) -> str:
    return re.sub(r"[\W\d_]", "", unit)


def _is_mega_for_milli(known: str, given: str) -> bool:
    """Whether a unit has M where a text, in which case has a meaning, has m, such as ``mNm``."""
    return known.startswith("M") and given.startswith("m") and given != given.lower()


def _spelled(unit: str) -> str:
    """A unit with symbols for words, such as ``m/s`` for ``metres/sec``."""
    plain = unit.strip().lower()
    if plain in _NAMES:
        return _NAMES[plain]
    return re.sub(r"[^\W\d_]+", lambda word: _WORDS.get(word[0].lower(), word[0]), unit.strip())


def _known(unit: str) -> QuantityKind | None:
    return next((kind for kind in KINDS.values() if unit in kind.units), None)


def _bare(unit: str) -> str:
    for digit, raised in POWERS.items():
        unit = unit.replace(raised, digit)
    return re.sub(r"[^0-9a-z/]", "", unit.lower())


_DIGITS = 60
"""Digits carried in conversions: enough that only the last step, to a float, rounds."""


def parse(text: object, dimension: Dimension) -> float:
    """Read a quantity such as ``"33.5 mm"``.

    Parameters
    ----------
    text : number, space, unit; anything else is refused.
    dimension : what it has to be.

    Returns
    -------
    float
        In SI units and radians, the float nearest to what the text says.

    Raises
    ------
    UsageError
        One sentence: what was given and what would be right.
    """
    if not isinstance(text, str):
        example = KINDS[dimension].example
        right = Note('give number and unit in quotes, such as "{example}"', example=example)
        raise UsageError(got(_bare_number(text), right).about(TOPIC))
    match = re.fullmatch(pattern(dimension), text)
    if match is None:
        raise UsageError(wrong_text(text, dimension))
    with localcontext() as context:
        context.prec = _DIGITS
        value = float(Decimal(match[1]) * Decimal(FACTORS[plain_unit(match[2])]))
    if not isfinite(value) or abs(value) > HUGE or 0 < abs(value) < TINY:
        raise UsageError(too_far(text))
    return value


@overload
def in_si(value: float | str, dimension: Dimension, name: str = "") -> float: ...


@overload
def in_si(value: None, dimension: Dimension, name: str = "") -> None: ...


def in_si(value: float | str | None, dimension: Dimension, name: str = "") -> float | None:
    """A quantity in SI units, of a text such as ``"300 rpm"`` or of the number that it is already.

    name : of the argument, for the error of `parse`.
    """
    if not isinstance(value, str):
        return value
    try:
        return parse(value, dimension)
    except UsageError as error:
        raise UsageError(at_place(name, error.note) if name else error.note) from None


def format_exact(value: float, dimension: Dimension) -> str:
    """Write a value in its handiest unit, such that `parse` gives back exactly the same float.

    Parameters
    ----------
    value : in SI units and radians; finite.
    dimension : what it is.

    Returns
    -------
    str
        ``"33.5 mm"`` for 0.0335 m; where no usual unit gives a short number, the SI unit with as
        many digits as the float needs.  A unit that is chosen goes before the usual ones.
    """
    value = float(value)
    kind = KINDS[dimension]
    chosen = chosen_unit(dimension)
    units = [*kind.printed] if chosen is None else [*dict.fromkeys((chosen, *kind.printed))]
    if value == 0:
        return f"0 {units[0]}"
    short = [text for unit in units if (text := _short(value, unit))]
    return min(short, key=_clumsiness, default=f"{value!r} {kind.si}")


def _clumsiness(text: str) -> tuple[bool, int]:
    """Powers of ten go last, and then long numbers."""
    number, _, _ = text.partition(" ")
    return "e" in number, len(number)


def rounded(value: float, unit: str, digits: int) -> str:
    """Write a value in a given unit with so many significant digits at most."""
    return f"{_digits_of(_rounded(value, unit, digits))} {unit}"


def _short(value: float, unit: str) -> str | None:
    """`value` in `unit` if at most 15 digits give the same float back."""
    number = _rounded(value, unit, 15)
    with localcontext() as context:
        context.prec = _DIGITS
        exact = float(number * Decimal(FACTORS[unit])) == value
    return f"{_digits_of(number)} {unit}" if exact else None


def _rounded(value: float, unit: str, digits: int) -> Decimal:
    with localcontext() as context:
        context.prec = _DIGITS
        exact = Decimal(value) / Decimal(FACTORS[unit])
        context.prec = digits
        return (+exact).normalize()


def _digits_of(number: Decimal) -> str:
    return f"{number:f}" if -5 <= number.adjusted() < 9 else str(number).lower()


DIGITS, SHORT = 12, 9
"""Significant ones that are kept, and those of a number that somebody may have meant in SI."""
MEANT, ROUNDING = 6, 1e-8
"""Digits of a number that is meant where another differs by no more than this share from it: what a
program finds at a limit of 100 mm is 99.999999637 mm."""
OTHER: dict[Dimension, str] = {"angle": "deg", "angular speed": "rpm"}
"""Units of files that are no power of ten of the SI unit."""


def clean(value: float, dimension: Dimension | None = None) -> float:
    """A value (SI units, radians) of 12 digits, in the unit in which a file has it."""
    plain = float(f"{value:.{DIGITS}g}")
    if dimension is None or not TINY < abs(value) < HUGE:
        return plain
    unit = chosen_unit(dimension) or OTHER.get(dimension, SI[dimension])
    meant = parse(rounded(value, unit, MEANT), dimension)
    if abs(meant - value) <= ROUNDING * abs(value):
        return meant
    short = plain == float(f"{value:.{SHORT}g}")
    return plain if short else parse(rounded(value, unit, DIGITS), dimension)


def clean_place(place: complex, size: float = 0.0, digits: int = DIGITS) -> tuple[float, float]:
    """Coordinates (m) whose last digit is such a one of the longer of them, or of a size."""
    longest = max(abs(place.real), abs(place.imag), size)
    if not longest or not isfinite(longest):
        return place.real, place.imag
    last = digits - 1 - floor(log10(longest))
    return round(place.real, last) + 0.0, round(place.imag, last) + 0.0


@dataclass(frozen=True)
class Measured:
    """A quantity in a sentence.

    Attributes
    ----------
    value : in SI units and radians.
    dimension : what it is; None for a number without a unit.
    unit : in which it stands where nobody has written it; the SI unit if empty, degrees of angles.
    limit : whether it is set here, so that no equal number of a file is meant.
    """

    value: float
    dimension: Dimension | None
    unit: str = ""
    limit: bool = False

    def __str__(self) -> str:
        if self.dimension is None:
            return f"{self.value:g}"
        unit = self.unit or ("deg" if self.dimension == "angle" else SI[self.dimension])
        return f"{in_unit(unit).factor * self.value:g} {unit}"


def with_measured(sentence: Note, change: Callable[[Measured], Any]) -> Note:
    """A sentence with other values for the quantities in it."""

    return sentence.with_values(lambda item: change(item) if isinstance(item, Measured) else item)


def as_written(sentence: Note, texts: Iterable[str]) -> Note:
    """A sentence with each quantity as it was written, and what else is of its dimension, such as
    a limit, in the unit of the first of those.

    texts : of a file, such as ``"-12 mm"``, whatever they are of; of equal quantities the first
        counts.
    """
    written = [*texts]
    units: dict[Dimension | None, str] = {}

    def typed(amount: Measured) -> Any:
        if amount.dimension is None or amount.limit:
            return amount
        for text in written:
            match = re.fullmatch(pattern(amount.dimension), text)
            with suppress(UsageError):
                if match and parse(text, amount.dimension) == amount.value:
                    units.setdefault(amount.dimension, plain_unit(match[2]))
                    short = f"{float(match[1]):g} {match[2]}"  # of -1.0 kg, as programs write it
                    return short if parse(short, amount.dimension) == amount.value else text
        return amount

    def alike(amount: Measured) -> Any:
        return replace(amount, unit=units.get(amount.dimension, amount.unit))

    return with_measured(with_measured(sentence, typed), alike)
