"""What is wrong with a quantity, in one sentence: what was given and what would be right."""

from __future__ import annotations

import re

from equipoise.quantities.units import KINDS, NUMBER, POWERS, Dimension, Kind, pattern, plain_unit

_NAMES = {
    "\N{DEGREE SIGN}": "deg",
    "degree": "deg",
    "degrees": "deg",
    "radian": "rad",
    "radians": "rad",
    "inch": "in",
    "inches": "in",
    '"': "in",
    "feet": "ft",
    "foot": "ft",
    "lbs": "lb",
    "1/min": "rpm",
    "r/min": "rpm",
    "rev/min": "rpm",
    "rev/s": "turn/s",
    "\N{MICRO SIGN}m": "um",
    "\N{GREEK SMALL LETTER MU}m": "um",
    "kp": "kgf",
}
"""Other spellings, only to suggest the right one."""


def not_text(given: object, dimension: Dimension) -> str:
    """Complain of a value that is no text."""
    right = f'give number and unit in quotes, such as "{KINDS[dimension].example}"'
    if isinstance(given, int | float) and not isinstance(given, bool):
        return f"got the bare number {_shown(_digits(given))}; {right}"
    return f"got {described(given)}; {right}"


def described(given: object) -> str:
    """Name a wrong value by its sort, in words of the model file."""
    if isinstance(given, bool):
        return "true" if given else "false"
    if isinstance(given, str):
        return _quoted(given)
    if isinstance(given, int | float):
        return f"the number {_shown(_digits(given))}"
    if isinstance(given, dict):
        return "a table"
    if isinstance(given, list | tuple):
        return f"a list of {len(given)}"
    return "nothing" if given is None else f"{_shown(str(given))}"


def _digits(number: int | float) -> str:
    try:
        return repr(number)
    except ValueError:  # Python refuses to print integers of more than 4300 digits.
        return "of thousands of digits"


def _shown(text: str) -> str:
    return text if len(text) <= 60 else f"{text[:57]}..."


def _quoted(text: str) -> str:
    return repr(_shown(text))


def too_far(text: str) -> str:
    """Complain of an impossible size."""
    return f"got {_quoted(text)}, which no machine can have; give a usual size"


def wrong_text(text: str, dimension: Dimension) -> str:
    """Complain of a text outside the grammar of its dimension."""
    kind, got = KINDS[dimension], f"got {_quoted(text)}"
    if re.fullmatch(pattern(dimension), mended := text.replace(",", ".")):
        return f'{got}; the decimal sign is a point, not a comma: "{mended}"'
    whole = re.fullmatch(rf"({NUMBER})( *)(\S.*)", text)
    if whole is None:
        return f"{got}; {_number_complaint(text, kind)}"
    number, space, unit = whole.groups()
    if not space and re.fullmatch(r"[0-9.,_xXoObBeE\s]+.*", unit) and not _known(unit):
        return f"{got}; {_number_complaint(text, kind)}"
    if not space and plain_unit(unit) in kind.units:
        return f'{got}; put a space between number and unit: "{number} {plain_unit(unit)}"'
    return f"{got}; {_unit_complaint(unit, number, dimension)}"


def _number_complaint(text: str, kind: Kind) -> str:
    such = f'such as "{kind.example}"'
    if not text.strip():
        return f"give number and unit, {such}"
    if re.fullmatch(NUMBER, text.strip()):
        return f"the unit is missing; give {kind.noun}, {such}"
    if text != text.strip():
        return f"leave out the space before or after it, {such}"
    if re.match(r"[+-]?[0-9]+,[0-9]+", text):
        return f"the decimal sign is a point, not a comma, {such}"
    if re.match(r"[+-]?(nan|inf)", text, re.IGNORECASE):
        return f"give a finite number and a unit, {such}"
    return (
        "write the number with the digits 0 to 9, a decimal point and at most an exponent, then a "
        f"space and the unit, {such}"
    )


def _unit_complaint(unit: str, number: str, dimension: Dimension) -> str:
    kind = KINDS[dimension]
    wanted = f"{kind.noun} is wanted: {', '.join(kind.units)}"
    plain = plain_unit(unit)
    if plain == "Hz" and dimension == "angular speed":
        return 'Hz does not tell turns from radians; give "50 turn/s" or "3000 rpm"'
    if plain in kind.units:
        return f'write "{number} {plain}"'
    meant = _meant(unit, kind)
    if meant is not None:
        return f'did you mean "{number} {meant}"?'
    other = _known(plain)
    if other is not None:
        return f"{plain} is the unit of {other.noun}; {wanted}"
    return f"there is no unit {_quoted(unit)} here; {wanted}"


def _known(unit: str) -> Kind | None:
    return next((kind for kind in KINDS.values() if unit in kind.units), None)


def _meant(unit: str, kind: Kind) -> str | None:
    name = _NAMES.get(unit.strip().lower())
    if name in kind.units:
        return name
    bare = _bare(unit)
    return next((known for known in kind.units if bare and _bare(known) == bare), None)


def _bare(unit: str) -> str:
    for digit, raised in POWERS.items():
        unit = unit.replace(raised, digit)
    return re.sub(r"[^0-9a-z/]", "", unit.lower())
