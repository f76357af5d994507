"""A kind of requirement of one's own is one class; balance, searches, fits and the page take it."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

import equipoise as eq
from equipoise.design.requirements import Requirement
from equipoise.errors import ModelError
from equipoise.keys.declaring import all_keys, keys_of
from equipoise.keys.requirement_kinds import REQUIREMENT_KINDS, RequirementKind
from equipoise.schema.targets import read_targets
from equipoise.studies import sweep
from equipoise.web.desk import begun
from equipoise.web.gallery import opened_file
from support.refusals import refused
from surface.running import example_text
from unit.web.pages import Session, ask
from unit.web.test_stores import ask as ask_desk
from unit.web.test_stores import column


class NoFurtherFromZero(RequirementKind):
    """The figure may be no further from 0 than a value, to either side."""

    key, description = "within", "how far from 0 it may be"

    def ends(self, value: float) -> tuple[float, float]:
        return -value, value


@pytest.fixture
def added() -> Iterator[None]:
    def forget() -> None:  # which keys a table has
        for known in (keys_of, all_keys):
            known.cache_clear()  # type: ignore[attr-defined]

    REQUIREMENT_KINDS["within"] = NoFurtherFromZero()
    forget()
    yield
    del REQUIREMENT_KINDS["within"]
    forget()


STUDY = """
schema = 1
title = "Masses"
model = "yamashita-1"
vary = [{ path = "links.crank.mass", range = ["100 g", "400 g"] }]
sampling = { method = "sobol", designs = 64 }
outputs = [
    { value = "shaking_force.y.mean", within = "0.01 N" },
    { value = "shaking_force.y.max", make = "largest", within = "16 N" },
]
"""


def test_a_study_file_asks_for_it_and_a_search_keeps_it(added: None) -> None:
    study = eq.loads(STUDY)
    force = study.outputs[1]
    assert (force.at_least, force.at_most, force.limited) == (-16.0, 16.0, True)
    free = eq.loads(STUDY.replace(', within = "16 N"', ""))
    few = {"population": 8, "generations": 8}
    kept, unbound = (eq.studies.search(item, **few).figures[0, 1] for item in (study, free))
    assert 15.0 < kept <= 16.0 < unbound
    assert eq.loads(eq.dumps(study)).outputs == study.outputs
    made = eq.studies.Study(
        title="",
        model=study.model,
        vary=study.vary,
        outputs=study.outputs,
        sampling=study.sampling,
    )
    assert 'within = "16.00 N"' in eq.dumps(made) or 'within = "16 N"' in eq.dumps(made)


def test_the_page_shows_which_designs_keep_it(added: None, tmp_path: Path) -> None:
    sweep(eq.loads(STUDY), tmp_path / "masses.zarr", workers=1)
    _, text = ask_desk(begun(str(tmp_path / "masses.zarr"))(), "ready")
    assert [entry["limits"] for entry in text.content["columns"]] == [
        [None, None], [-0.01, 0.01], [-16.0, 16.0],
    ]  # fmt: skip
    highest = column(text, "column.shaking_force.y.max")
    np.testing.assert_array_equal(column(text, "kept") == 1, highest <= 16.0)
    assert 0 < text.content["kept"] < 64


PLAN = (
    example_text("yamashita-1")
    + """
[[balance.masses]]
link = "crank"
at = "A"
shape = "any"
radius = "40 mm"

[[balance.objectives]]
output = "shaking_force.y"

[[balance.limits]]
output = "drive_torque"
measure = "peak"
"""
)


def limit() -> float:
    """A peak torque below what is left where nothing limits it, N m."""
    free = eq.balance(eq.loads(PLAN.partition("[[balance.limits]]")[0])).machine
    return float(f"{0.9 * eq.analyze(free).summary['drive_torque'].peak:.6g}")


def test_balance_keeps_it_as_it_keeps_an_upper_limit(added: None) -> None:
    most = limit()
    text = f'"{most} N m"'
    machine = eq.loads(PLAN + f"within = {text}\n")
    assert machine.balance is not None and machine.balance.limits[0].asks[0][0] == "within"
    actual, wanted = eq.balance(machine), eq.balance(eq.loads(PLAN + f"at_most = {text}\n"))
    assert actual.cost == pytest.approx(wanted.cost, rel=1e-9)
    reached = eq.analyze(actual.machine, 720).summary["drive_torque"].peak
    assert reached == pytest.approx(most, rel=1e-5)
    assert eq.loads(eq.dumps(machine)).balance == machine.balance


def test_the_page_balances_within_it(added: None, tmp_path: Path) -> None:
    path = tmp_path / "limited.toml"
    path.write_text(PLAN + f'within = "{limit()} N m"\n', encoding="utf-8")
    session = Session()
    session.open(opened_file(path))
    ask(session, "ready")
    reply, _ = ask(session, "balance")
    balanced = eq.balance(eq.load(path))
    aim = reply.content["aims"][0]
    assert aim["after"] == pytest.approx(balanced.after["shaking_force.y.rms"], rel=1e-3)


def test_a_target_file_asks_a_search_of_geometry_for_it(added: None, tmp_path: Path) -> None:
    path = tmp_path / "targets.toml"
    goal_text = 'schema = 1\n[[goals]]\nfigure = "curve.height"\nwithin = "0.2 m"\n'
    path.write_text(goal_text, encoding="utf-8")
    (goal,) = read_targets(path, ["curve.height"]).goals
    assert goal == Requirement("curve.height", within=0.2)
    assert goal.satisfied(np.array([-0.3, -0.1, 0.2, 0.21])).tolist() == [False, True, True, False]


def test_without_it_there_is_no_such_key() -> None:
    with refused(ModelError, "outputs[1].within", given="within"):
        eq.loads(STUDY)
    with refused(eq.EquipoiseError, given="within"):
        Requirement("curve.height", within=0.2)


def test_what_bounds_nothing_from_above_is_refused_by_balance(added: None) -> None:
    limit = eq.balancing.Limit(eq.balancing.Objective("drive_torque"), at_least=1.0)
    machine = eq.load("balance-crank")
    plan = eq.balancing.Balance(limits=(limit,))
    with refused(ModelError, "balance.limits[1]"):
        machine.with_balance(plan)
