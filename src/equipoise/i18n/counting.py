"""Words by a count, such as ``1 design`` and ``2 designs``, as each language has them.

A text with a count and a noun has one template in the code, in the plural: ``{count} designs``.
The English catalogue has its other forms, and tells by which placeholder these go where that is not
``count``; a catalogue of a language whose head has rules of plural gives a table of forms in place
of a text: ``{ one = "{count} Entwurf", other = "{count} Entwürfe" }``.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from functools import cache
from types import MappingProxyType
from typing import Any

from equipoise.i18n.languages import KNOWN, content

BY, OTHER = "by", "other"
USUAL = "count"
"""The placeholder that a form goes by where the English catalogue names none."""
_RELATION = re.compile(r"n(?: % (\d+))? (!?=) ([\d.,]+)")


def category(language: str, count: int) -> str:
    """The category of a count, such as ``one``, by the rules in the head of a catalogue."""
    plural = KNOWN[language].plural
    return next((name for name, rule in plural.items() if _holds(rule, count)), OTHER)


def _holds(rule: str, count: int) -> bool:
    """Whether a rule of CLDR, such as ``n % 10 = 1 and n % 100 != 11``, holds for a whole count."""
    return any(
        all(_is_so(relation, count) for relation in either.split(" and "))
        for either in rule.split(" or ")
    )


def _is_so(relation: str, count: int) -> bool:
    match = _RELATION.fullmatch(relation.strip())
    if match is None:
        raise ValueError(f"{relation!r} is no rule of plural; such as 'n % 10 = 2..4' is one")
    divisor, sign, ranges = match.groups()
    rest = count % int(divisor) if divisor else count
    ends = (part.partition("..") for part in ranges.split(","))
    inside = any(int(low) <= rest <= int(high or low) for low, _, high in ends)
    return inside == (sign == "=")


@cache
def texts(language: str) -> Mapping[str, str]:
    """English text -> text in a language, in the form of a count that is ``other``."""
    return {
        text: said if isinstance(said, str) else said.get(OTHER, text)
        for text, said in content(language)["texts"].items()
    }


@cache
def counted(language: str) -> Mapping[str, Mapping[str, str]]:
    """English text -> its forms in a language by category, and at ``by`` the placeholder."""
    of = {
        text: said.get(BY, USUAL)
        for text, said in content("en")["texts"].items()
        if not isinstance(said, str)
    }
    return {
        text: {OTHER: text, **said, BY: of.get(text, USUAL)}
        for text, said in content(language)["texts"].items()
        if not isinstance(said, str)
    }


_NONE: Mapping[str, str] = MappingProxyType({})


def form_of(text: str, values: Mapping[str, Any], language: str) -> str | None:
    """The form of a text for the count among its values; None where it has no forms."""
    forms = counted(language).get(text, _NONE)
    if not forms:
        return None
    count = str(values.get(forms[BY], "")).strip()
    number = int(count) if count.isdecimal() else None
    name = OTHER if number is None else category(language, number)
    return forms.get(name, forms[OTHER])
