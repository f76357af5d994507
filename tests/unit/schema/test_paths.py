"""One notation of a path everywhere: in files, studies, loops, on the page and in messages."""

from __future__ import annotations

import json

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import equipoise as eq
from equipoise.errors import ModelError
from equipoise.keys.paths import KeyPath, with_values
from equipoise.schema.template import Template
from equipoise.studies.evaluate import evaluator
from equipoise.web.design import Design
from equipoise.web.fields import fields_of
from support.refusals import refused

NAMES = st.text(st.characters(codec="utf-8", exclude_characters="\x00"), min_size=1, max_size=80)
PATHS = st.lists(NAMES, min_size=1, max_size=4).flatmap(
    lambda keys: st.tuples(
        st.just(keys[0]), *(st.one_of(st.just(key), st.integers(0, 999)) for key in keys[1:])
    )
)


@given(PATHS)
def test_what_is_written_is_read_as_the_same(steps: tuple[str | int, ...]) -> None:
    path = KeyPath(steps)
    assert KeyPath.parse(str(path)) == path == steps


def test_a_path_reads_and_writes_its_value_and_leaves_the_rest() -> None:
    document = {"springs": [{"stiffness": 1}, {"stiffness": 2}], "links": {"arm 2": {"mass": 3}}}
    before = json.dumps(document)
    path = KeyPath.parse("springs[2].stiffness")
    assert path.read(document) == 2
    changed = path.write(document, 5)
    assert path.read(changed) == 5 and changed["links"] is document["links"]
    assert KeyPath.parse('links."arm 2".mass').read(changed) == 3
    both = with_values(document, {path: 6, KeyPath.parse("springs[1].stiffness"): 7})
    assert both["springs"] == [{"stiffness": 7}, {"stiffness": 6}]
    assert json.dumps(document) == before


@pytest.mark.parametrize("text", ["", ".", "springs[0].x", "a..b", "a[", "[x]", 'a."b', "a]"])
def test_what_is_no_path(text: str) -> None:
    with refused(ModelError, text):
        KeyPath.parse(text)


def test_the_page_has_the_numbers_by_the_paths_of_studies() -> None:
    """But for what a page alone knows: lengths between points, and its counterweights."""
    template = Template.load("yamashita-1")
    shown = fields_of(Design("", template.base()))  # type: ignore[arg-type]
    own = {"lengths", "directions", "counterweights"}
    paths = [path for path in shown if own.isdisjoint(KeyPath.parse(path))]
    assert len(paths) > 10
    for path in paths:
        assert shown[path].value == pytest.approx(template.number(path)[0], rel=1e-12), path


def test_the_old_spelling_of_a_place_in_a_list_gets_the_right_one() -> None:
    template = Template.load("cam-pusher")
    with refused(ModelError, "springs.1.stiffness", name="springs[1].stiffness"):
        template.number("springs.1.stiffness")


def test_links_with_odd_names_are_computed_in_loops() -> None:
    """By quotes as messages write them; the loop has the figures of each machine by itself."""
    text = Template.load("yamashita-1").text.replace("links.coupler]", 'links."rod, long"]')
    template = Template(text)
    path = 'links."rod, long".mass'
    study = eq.studies.Study(
        title="",
        model=template,
        vary=(eq.design.Variable(path, eq.design.Range(0.1, 0.3)),),
        outputs=(eq.studies.Output("shaking_force.y.rms"),),
        sampling=eq.studies.Sampling("sobol", 8),
    )
    compute = evaluator(study)
    assert getattr(compute, "compiled", False)
    values = np.array([[0.12], [0.28]])
    for row, (figure,) in zip(values, compute(values).figures, strict=True):
        machine = template.machine({path: float(row[0])})
        wanted = eq.analyze(machine).summary["shaking_force.y"].rms  # type: ignore[arg-type]
        assert figure == pytest.approx(wanted, rel=1e-3)
