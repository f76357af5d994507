"""Numbers with the decimal sign of a language, wherever they are shown.

Numbers become texts with a point, as files have them.  Where such a text reaches a reader, as a
value in a sentence (`equipoise.i18n.say`), in a cell, on an axis or in a drawing, its numbers get
the sign of the language that is spoken.  What stands in quotes keeps its point, since it is a name
or to be typed.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from functools import cache
from string import Formatter
from typing import Any

POINT = "."
NUMBER = r"(?<![\w.])(?<!\w-)([0-9]+)\.([0-9]+)(?=(?:e[+-]?[0-9]+)?(?![\w]|\.\w))"
"""One that stands alone: not of a name, a version or the name of a file."""
QUOTED = r"\"[^\"]*\"|'[^']*'|`[^`]*`|“[^”]*”|„[^“]*“|‘[^’]*’|‚[^‘]*‘|«[^»]*»|「[^」]*」"
"""What stands in quotes: names, and what is to be typed."""
_PARTS = re.compile(f"(?P<quoted>{QUOTED})|{NUMBER}")
_FIELD = re.compile(r"\{(?:[^{}]|\{[^{}]*\})*\}")


class SaidText(str):
    """A text that has been said, whose numbers are as they are to be."""

    __slots__ = ()


def with_sign(text: str, sign: str) -> str:
    """A text whose numbers have another decimal sign than a point; those in quotes keep theirs."""
    if sign == POINT or POINT not in text or isinstance(text, SaidText):
        return text

    def changed(part: re.Match[str]) -> str:
        return part[0] if part["quoted"] else f"{part[2]}{sign}{part[3]}"

    return SaidText(_PARTS.sub(changed, text))


class _Filler(Formatter):
    """Fills values into a template whose numbers have a decimal sign of their own."""

    def __init__(self, sign: str) -> None:
        self.sign = sign

    def get_value(self, key: int | str, args: Any, kwargs: Mapping[str, Any]) -> Any:
        return kwargs[str(key)]

    def convert_field(self, value: Any, conversion: Any) -> Any:
        # what is quoted is a name or typed, so that its points stay
        return (
            super().convert_field(value, conversion)
            if conversion is None
            else SaidText(super().convert_field(value, conversion))
        )

    def format_field(self, value: Any, format_spec: str) -> Any:
        if isinstance(value, SaidText):
            return format(str(value), format_spec)
        return str(with_sign(format(value, format_spec), self.sign))


@cache
def _split(template: str) -> tuple[tuple[bool, str], ...]:
    """Parts of a template, and of each whether it stands in quotes."""
    hidden = _FIELD.sub(lambda field: "0" * len(field[0]), template)
    parts: list[tuple[bool, str]] = []
    end = 0
    for quoted in re.finditer(QUOTED, hidden):
        parts += [(False, template[end : quoted.start()]), (True, template[slice(*quoted.span())])]
        end = quoted.end()
    return (*parts, (False, template[end:]))


def filled(template: str, values: Mapping[str, Any], sign: str) -> str:
    """A template with its values, whose numbers have a decimal sign, but for those in quotes."""
    if sign == POINT:
        return template.format(**values)
    fill = _Filler(sign)
    texts = (
        part.format(**values) if quoted else fill.vformat(part, (), values)
        for quoted, part in _split(template)
    )
    return SaidText("".join(texts))
