"""From an error to its page: in a notebook, and in what the live page is told."""

from __future__ import annotations

from contextlib import redirect_stdout
from io import StringIO

import pytest
from IPython.core.interactiveshell import InteractiveShell

import equipoise as eq
from equipoise.errors import EquipoiseError, ModelError, UsageError
from equipoise.schema.topics import errors
from equipoise.web.replies import refused

LONG_CRANK = 'eq.analyze(eq.load("yamashita-1").with_point("crank", "B", (0.1, 0)))'


def raised(source: str) -> EquipoiseError:
    """The error of a line."""
    with pytest.raises(EquipoiseError) as error:
        eval(source, {"eq": eq})
    return error.value


def test_a_notebook_shows_the_command_that_explains_an_error() -> None:
    """Below the traceback that IPython has for every error."""
    shell = InteractiveShell.instance(colors="nocolor")
    shown = StringIO()
    try:
        with redirect_stdout(shown):
            shell.run_cell(f"import equipoise as eq\n{LONG_CRANK}", store_history=False)
    finally:
        InteractiveShell.clear_instance()
    lines = shown.getvalue().strip().splitlines()
    assert lines[-1] == "more: equipoise explain the-crank-cannot-turn-fully"
    assert any("RangeError" in line and "cannot turn fully" in line for line in lines)


def test_the_live_page_gets_the_page_of_an_error() -> None:
    """Its address in the documentation, and its text where there is none."""
    content = refused(7, raised(LONG_CRANK)).content
    assert content["topic"] == "the-crank-cannot-turn-fully"
    title, text = content["cure"]
    assert title == errors()[content["topic"]].title
    assert "between" in text and "```" not in text and "](" not in text


def test_a_wrong_key_leads_to_its_table_and_other_errors_to_nothing() -> None:
    """Tables have an address, and no text beside it."""
    content = refused(1, ModelError("drive.speed", "wrong")).content
    assert content["topic"] == "drive" and "cure" not in content
    assert "topic" not in refused(2, UsageError("wrong")).content
    assert UsageError("wrong").explained_by == ""
