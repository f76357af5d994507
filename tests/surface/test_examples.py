"""The scripts in `examples` run as they stand and print something."""

from __future__ import annotations

import runpy
from pathlib import Path

import pytest

SCRIPTS = sorted((Path(__file__).parents[2] / "examples").glob("*.py"))


@pytest.mark.exhaustive(
    but=["edit_and_save", "harmonics", "what_the_masses_do", "two_speeds", "first_look"]
)
@pytest.mark.parametrize("script", SCRIPTS, ids=lambda path: path.stem)
def test_script_runs(script: Path, capsys: pytest.CaptureFixture[str]) -> None:
    runpy.run_path(str(script), run_name="__main__")
    assert len(capsys.readouterr().out.splitlines()) >= 2


def test_there_are_scripts() -> None:
    assert len(SCRIPTS) >= 4
