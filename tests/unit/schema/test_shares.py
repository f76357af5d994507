"""Shares of a value before: read, refused, and written without loss."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from equipoise.errors import UsageError
from equipoise.schema.numbers import format_share, parse_share
from support.refusals import refused


def test_shares() -> None:
    assert parse_share("80 %") == 0.8
    assert parse_share("112.5 %") == 1.125
    assert parse_share("80 N") is None
    assert format_share(0.8) == "80 %"
    for text in ("80%", "80 % ", "x %", "%", "8,5 %"):
        with refused(UsageError, given=text):
            parse_share(text)
    with refused(UsageError, text="'1e40 %'"):
        parse_share("1e40 %")


@given(st.floats(1e-28, 1e28))
def test_any_share_survives(share: float) -> None:
    assert parse_share(format_share(share)) == share
