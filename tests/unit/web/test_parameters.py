"""Named parameters on the page: they can be set, and numbers can be given from them."""

from __future__ import annotations

from cmath import phase
from math import radians
from pathlib import Path

import pytest

import equipoise as eq
from equipoise.errors import UsageError
from equipoise.schema.models import text_of
from equipoise.web.design import Design
from equipoise.web.fields import Scale, fields_of
from equipoise.web.session import Session
from support.refusals import refused
from unit.schema.test_parameters import FOUR_BAR
from unit.web.pages import Content, ask, edit, refusal, state
from unit.web.test_disk import session_of
from unit.web.test_tables import enter, group, tables


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
    content = {
        path: Scale.of(design()).field_message(value) for path, value in fields_of(design()).items()
    }
    assert content["links.rod.mass"]["text"] == "=weight"
    assert content["links.rod.mass"]["shown"] == "200 g"
    assert content["frame.points.D.x"]["text"] == "=base"
    assert content["parameters.crank"]["text"] == "30 mm"


def test_a_number_is_given_from_parameters_and_then_follows_them() -> None:
    fields = fields_of(design())
    given = fields["links.rod.mass"].typed(design(), "2*weight + 10 g")
    assert given.own.links["rod"].mass == 0.41
    assert 'mass = "=2*weight + 10 g"' in text_of(given.own, {})
    heavier = fields_of(given)["parameters.weight"].typed(given, "300 g")
    assert heavier.own.links["rod"].mass == 0.61


def test_a_length_between_points_follows_where_the_file_has_it_as_one_number() -> None:
    points = FOUR_BAR.replace(
        'points = ["A", "B"]\nlength = "=crank"',
        'points.A = ["0 mm", "0 mm"]\npoints.B = ["30 mm", "0 mm"]\npoints.P = ["9 mm", "4 mm"]',
    )
    own = Design("points", eq.loads(points))
    path = "links.crank.lengths.A-B"
    given = fields_of(own)[path].typed(own, "crank/3 + 15 mm")
    assert 'points.B = ["=crank/3 + 15 mm", "0 mm"]' in text_of(given.own, {})
    assert fields_of(given)[path].expression == "=crank/3 + 15 mm"
    longer = fields_of(given)["parameters.crank"].typed(given, "40 mm")
    assert longer.own.links["crank"].points["B"] == (eq.loads(points.replace(
        '["30 mm"', '["=40 mm/3 + 15 mm"')).links["crank"].points["B"])  # fmt: skip


OBLIQUE = FOUR_BAR.replace(
    'points = ["A", "B"]\nlength = "=crank"',
    'points.A = ["0 mm", "0 mm"]\npoints.B = ["30 mm", "0 mm"]\npoints.P = ["9 mm", "4 mm"]',
)


@pytest.mark.parametrize(
    ("path", "typed", "before", "after"),
    [
        ("links.crank.lengths.A-P", "crank/3", 0.01, 0.02),
        ("links.crank.directions.A-P", "=crank/(30 mm) * 20 deg", radians(20), radians(40)),
        ("counterweights.crank.mass", "2*weight", 0.4, 0.4),
        ("counterweights.crank.radius", "=crank", 0.03, 0.06),
    ],
)
def test_what_is_no_number_of_the_file_follows_on_the_page(
    path: str, typed: str, before: float, after: float
) -> None:
    """Lengths and directions of oblique lines, and counterweights, until set otherwise."""
    own = Design("points", eq.loads(OBLIQUE))
    given = fields_of(own)[path].typed(own, typed)
    field = fields_of(given)[path]
    assert field.value == pytest.approx(before)
    assert field.expression == "=" + typed.removeprefix("=")
    longer = fields_of(given)["parameters.crank"].typed(given, "60 mm")
    field = fields_of(longer)[path]
    assert field.value == pytest.approx(after)
    assert field.expression == "=" + typed.removeprefix("=")
    plain = field.typed(longer, field.value / 2)
    assert fields_of(plain)[path].expression is None
    again = fields_of(plain)["parameters.crank"].typed(plain, "30 mm")
    assert fields_of(again)[path].value == pytest.approx(after / 2)


def test_two_of_a_line_follow_together() -> None:
    own = Design("points", eq.loads(OBLIQUE))
    for path, typed in (("lengths.A-P", "crank/3"), ("directions.A-P", "crank/(30 mm) * 20 deg")):
        own = fields_of(own)[f"links.crank.{path}"].typed(own, typed)
    longer = fields_of(own)["parameters.crank"].typed(own, "60 mm")
    place = complex(*longer.own.links["crank"].points["P"])
    assert (abs(place), phase(place)) == pytest.approx((0.02, radians(40)))


def test_a_number_that_is_typed_plainly_stops_following() -> None:
    plain = fields_of(design())["links.rod.mass"].typed(design(), "250 g")
    assert 'mass = "250 g"' in text_of(plain.own, {})
    assert fields_of(plain)["links.rod.mass"].expression is None


def test_an_unknown_name_is_refused() -> None:
    with refused(UsageError, name="wieght"):
        fields_of(design())["links.rod.mass"].typed(design(), "=2*wieght")


# -- in a session ----------------------------------------------------------------------------------

SUMS = FOUR_BAR.replace('"20 kg mm^2"', '"=2*10 kg mm^2"').replace('"5 deg"', '"=2 deg + 3 deg"')
"""Expressions without names too."""


@pytest.fixture
def session(tmp_path: Path) -> Session:
    (tmp_path / "model.toml").write_text(SUMS, encoding="utf-8")
    return session_of(tmp_path / "model.toml")


def saved(session: Session, tmp_path: Path) -> str:
    after, _ = ask(session, "save", seq=1)
    assert state(after).content["file"]["saved"]
    return (tmp_path / "model.toml").read_text(encoding="utf-8")


def test_what_is_saved_has_its_expressions_still(session: Session, tmp_path: Path) -> None:
    edit(session, {"set": "parameters.crank", "text": "32 mm"})
    edit(session, {"set": "links.rocker.mass", "text": "2*weight - 10 g"})
    changed = SUMS.replace('"30 mm"', '"32 mm"').replace('"=weight*1.5"', '"=2*weight - 10 g"')
    assert saved(session, tmp_path) == changed


def test_forms_keep_expressions_and_take_new_ones(session: Session, tmp_path: Path) -> None:
    for entry in group(tables(session), "links")["entries"]:
        enter(session, entry["place"], entry["values"])
    rod = group(tables(session), "links")["entries"][1]
    enter(session, rod["place"], {**rod["values"], "mass": "=3*weight"}, name="coupler")
    rocker = group(tables(session), "links")["entries"][2]
    enter(
        session,
        rocker["place"],
        {**rocker["values"], "mass": "weight + 5 g", "inertia": "2*3 kg mm^2"},
    )
    text = SUMS.replace("links.rod", "links.coupler").replace('"=weight"', '"=3*weight"')
    text = text.replace('"=weight*1.5"', '"=weight + 5 g"').replace(
        'mm"]\ninertia = "300 kg', 'mm"]\ninertia = "6 kg'
    )
    assert saved(session, tmp_path) == text


def test_parameters_come_and_go_in_the_form_of_the_whole(session: Session) -> None:
    (whole,) = group(tables(session), "")["entries"]
    parameters: Content = whole["values"]["parameters"]
    assert parameters == {"crank": "30 mm", "base": "=4*crank", "weight": "200 g"}
    more = {**parameters, "crank": "40 mm", "ratio": 0.5}
    enter(session, [], {**whole["values"], "parameters": more})
    assert session.shown.design.own.frame["D"] == (0.16, 0.0)
    assert edit(session, {"set": "parameters.ratio", "text": "0.6"}).field("parameters.ratio")
    less = {"crank": "40 mm", "base": "160 mm"}
    said = refusal(enter(session, [], {**whole["values"], "parameters": less}))
    assert "no parameter is called 'weight'; there are base, crank" in said
    assert session.shown.design.own.parameters["ratio"] == 0.6
