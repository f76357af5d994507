"""Runs of machines of any kind with two motors: what the work of all that acts comes to."""

from __future__ import annotations

from pathlib import Path

import pytest
import tomli_w

import equipoise as eq
from equipoise.errors import EquipoiseError
from equipoise.running.run_results import DrivesRun
from support import machines_any


@pytest.mark.exhaustive(but=["9", "14", "27"])  # two rows, a grown linkage, friction
@pytest.mark.parametrize("number", range(40))
def test_energy_is_in_balance(number: int, tmp_path: Path) -> None:
    """A machine that cannot run, or whose links come to a dead position, says so."""
    document, tables = machines_any.files(number, "motors even")
    for name, text in {"model.toml": tomli_w.dumps(document), **tables}.items():
        (tmp_path / name).write_text(text, encoding="utf-8")
    try:
        machine = eq.load(tmp_path / "model.toml")
        on_support = machine.support is not None and number % 2 == 0
        run = eq.run(machine, turns=0.2, support=on_support)
    except EquipoiseError:
        return
    assert isinstance(run, DrivesRun) or not machine.drives
    assert run.energy_error < 1e-9
    for contact in run.contacts:
        assert contact.end is None or contact.begin <= contact.end <= run.time[-1]
