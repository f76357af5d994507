"""Runs the snippets of README.md and of docs: one test a page, in a directory of its own.

Python blocks are run as they stand, with ``>>>`` as doctests; in console blocks the output of every
line that begins with ``$ equipoise`` is compared with what follows.  The snippets of a page
share their names and files, as a reader types them one after the other.  The notebooks of
`docs/tutorials` are run cell by cell, in the way in which the site runs them.
"""

from __future__ import annotations

import io
import os
import runpy
import shlex
import signal
from collections.abc import Iterator
from contextlib import chdir, redirect_stderr, redirect_stdout
from doctest import ELLIPSIS, NORMALIZE_WHITESPACE, OutputChecker
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest
from hypothesis import settings
from sybil import Example, Sybil
from sybil.example import SybilFailure
from sybil.parsers.markdown import CodeBlockParser, PythonCodeBlockParser

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # each worker has a core, not all of them
os.environ["EQUIPOISE_PROGRESS"] = "off"  # a busy machine must not change what a command prints
if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:  # as a shell starts what runs behind it
    signal.signal(signal.SIGINT, signal.default_int_handler)  # commands that tests stop must hear
settings.register_profile("equipoise", deadline=None)  # time is measured in benchmarks, not here
settings.load_profile("equipoise")

ROOT = Path(__file__).parent
FLAGS = ELLIPSIS | NORMALIZE_WHITESPACE


def run_commands(example: Example) -> str | None:
    """Run the commands of a console block; tell the first whose output is not what is shown."""
    from equipoise.cli import run

    for part in f"\n{example.parsed}".split("\n$ equipoise ")[1:]:
        command, _, shown = part.partition("\n")
        out, err = io.StringIO(), io.StringIO()
        with redirect_stdout(out), redirect_stderr(err):
            run(shlex.split(command))
        if not OutputChecker().check_output(shown, out.getvalue(), FLAGS):
            return f"equipoise {command} printed\n{out.getvalue()}{err.getvalue()}"
    return None


SNIPPETS = Sybil(
    parsers=[
        PythonCodeBlockParser(doctest_optionflags=FLAGS),
        CodeBlockParser(language="console", evaluator=run_commands),
    ]
)


class Snippets(pytest.Item):
    """All snippets of one page, in order: split up, they could not run side by side."""

    def runtest(self) -> None:
        with TemporaryDirectory() as folder, chdir(folder):
            for example in SNIPPETS.parse(self.path):
                example.evaluate()

    def repr_failure(self, excinfo: pytest.ExceptionInfo[BaseException]) -> str:  # type: ignore[override]
        if isinstance(excinfo.value, SybilFailure):
            return str(excinfo.value)
        return str(super().repr_failure(excinfo))

    def reportinfo(self) -> tuple[Path, int, str]:
        return self.path, 0, f"snippets of {self.path.name}"


class Page(pytest.File):
    """A Markdown page."""

    def collect(self) -> Iterator[Snippets]:
        snippets = Snippets.from_parent(self, name="snippets")
        snippets.add_marker("documentation")
        yield snippets


class NotebookCells(pytest.Item):
    """All cells of a notebook, in order."""

    def runtest(self) -> None:
        tutorials = runpy.run_path(str(ROOT / "docs" / "site" / "tutorials.py"))
        notebook = tutorials["Notebook"](self.path)
        notebook.run()
        assert all(cell["outputs"] for cell in notebook.cells if cell["cell_type"] == "code")

    def reportinfo(self) -> tuple[Path, int, str]:
        return self.path, 0, f"cells of {self.path.name}"


class NotebookFile(pytest.File):
    """A notebook."""

    def collect(self) -> Iterator[NotebookCells]:
        cells = NotebookCells.from_parent(self, name="cells")
        cells.add_marker("documentation")
        cells.add_marker("exhaustive")  # a change runs them once, for the site
        yield cells


def pytest_collect_file(file_path: Path, parent: pytest.Collector) -> pytest.File | None:
    """Collect README.md, and the pages and notebooks of docs."""
    if file_path.suffix == ".ipynb" and ROOT / "docs" in file_path.parents:
        return NotebookFile.from_parent(parent, path=file_path)
    if file_path == ROOT / "README.md" or (
        file_path.suffix == ".md" and ROOT / "docs" in file_path.parents
    ):
        return Page.from_parent(parent, path=file_path)
    return None
