"""Named parameters on the page: they can be set, and numbers can be given from them."""

from __future__ import annotations

import pytest

import equipoise as eq
from equipoise.errors import UsageError
from equipoise.schema.models import text_of
from equipoise.web.design import Design
from equipoise.web.fields import Scale, fields_of
from unit.schema.test_parameters import FOUR_BAR


def design() -> Design:
    return Design("four-bar", eq.loads(FOUR_BAR))


def test_a_parameter_moves_all_that_is_worked_out_from_it() -> None:
    fields = fields_of(design())
    assert [path for path in fields if path.startswith("parameters.")] == [
        "parameters.crank",
        "parameters.weight",
    ]
    changed = fields["parameters.crank"].typed(design(), "32 mm")
    assert changed.own == eq.loads(FOUR_BAR.replace('"30 mm"', '"32 mm"'))
    assert changed.own.frame["D"] == (0.128, 0.0)


def test_a_number_that_is_worked_out_shows_by_what() -> None:
    told = {path: Scale.of(design()).told(one) for path, one in fields_of(design()).items()}
    assert told["links.rod.mass"]["text"] == "=weight"
    assert told["links.rod.mass"]["shown"] == "200 g"
    assert told["frame.points.D.x"]["text"] == "=base"
    assert told["parameters.crank"]["text"] == "30 mm"


def test_a_number_is_given_from_parameters_and_then_follows_them() -> None:
    fields = fields_of(design())
    given = fields["links.rod.mass"].typed(design(), "2*weight + 10 g")
    assert given.own.links["rod"].mass == 0.41
    assert 'mass = "=2*weight + 10 g"' in text_of(given.own, {})
    heavier = fields_of(given)["parameters.weight"].typed(given, "300 g")
    assert heavier.own.links["rod"].mass == 0.61


def test_a_number_that_is_typed_plainly_stops_following() -> None:
    plain = fields_of(design())["links.rod.mass"].typed(design(), "250 g")
    assert 'mass = "250 g"' in text_of(plain.own, {})
    assert fields_of(plain)["links.rod.mass"].expression is None


def test_an_unknown_name_is_refused() -> None:
    with pytest.raises(UsageError, match="no parameter is called 'wieght'"):
        fields_of(design())["links.rod.mass"].typed(design(), "=2*wieght")
