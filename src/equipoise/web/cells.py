"""Cells of a notebook, one after the other in one namespace, without a notebook's programs.

The documentation's tutorials are run by it: where their pages are made, and by readers in the
browser, where a worker has it (`page/src/site/worker.ts`).
"""

from __future__ import annotations

import ast
import io
import json
import os
from contextlib import redirect_stdout
from dataclasses import asdict
from typing import Any, Literal

from equipoise.dataclass import dataclass
from equipoise.errors import EquipoiseError
from equipoise.schema.topics import known_topic

NAME = "<cell>"
"""Of the source, in tracebacks."""


@dataclass(frozen=True)
class CellOutput:
    """What a cell prints or shows.

    kind : ``text``; ``html``, of a result or picture; or ``error``.
    topic : of an error, what `equipoise explain` knows about it; empty if nothing.
    """

    kind: Literal["text", "html", "error"]
    content: str
    topic: str = ""


class CellRunner:
    """A namespace in which cells run, as in a notebook's kernel."""

    def __init__(self) -> None:
        self.missing: str | None = None
        """A package that has to be loaded before the cell is run again."""
        self._unavailable: set[str] = set()
        self._namespace: dict[str, Any] = {"__name__": "__main__"}

    def lacks(self, package: str) -> None:
        """Note that a package cannot be loaded."""
        self._unavailable.add(package)

    def run(self, source: str) -> list[CellOutput]:
        """Run a cell; the value of a last expression is shown after what is printed.

        Raises
        ------
        ModuleNotFoundError : a package is missing that could still be loaded, `missing`.
        """
        self.missing = None
        printed, outputs = io.StringIO(), list[CellOutput]()
        try:
            with redirect_stdout(printed):
                value = self._value_of(source)
                if value is not None:
                    outputs = [self._shown(value)]
        except ModuleNotFoundError as error:
            self._ask_for(error)
            outputs = [CellOutput("error", str(error))]
        except EquipoiseError as error:
            topic = known_topic(error.topic)
            outputs = [CellOutput("error", f"{type(error).__name__}: {error}", topic)]
        except Exception as error:  # whatever a reader types
            outputs = [CellOutput("error", f"{type(error).__name__}: {error}")]
        text = printed.getvalue()
        return [CellOutput("text", text)] * bool(text) + outputs

    def run_in_page(self, source: str) -> str | None:
        """Run a cell; its outputs in JSON, None where a package is missing."""
        try:
            return json.dumps([asdict(output) for output in self.run(source)])
        except ModuleNotFoundError:
            return None

    def _ask_for(self, error: ModuleNotFoundError) -> None:
        """Name the package that could be loaded, and raise the error again."""
        package = (error.name or str(error)).partition(".")[0]
        if package not in self._unavailable:
            self.missing = package
            raise error

    def _value_of(self, source: str) -> Any:
        """The value of the last statement, where it is an expression that no semicolon hides."""
        tree = ast.parse(source, NAME)
        last = tree.body[-1] if tree.body else None
        if not isinstance(last, ast.Expr) or source.rstrip().endswith(";"):
            exec(compile(tree, NAME, "exec"), self._namespace)
            return None
        first = ast.Module(tree.body[:-1], [])
        exec(compile(first, NAME, "exec"), self._namespace)
        return eval(compile(ast.Expression(last.value), NAME, "eval"), self._namespace)

    def _shown(self, value: Any) -> CellOutput:
        """A value as a notebook shows it; as text where no package for more can be loaded."""
        os.environ.setdefault("MPLBACKEND", "agg")
        try:
            if hasattr(value, "savefig"):
                return CellOutput("html", _svg(value))
            if hasattr(value, "_repr_html_") and (text := value._repr_html_()):
                return CellOutput("html", text)
        except ModuleNotFoundError as error:
            self._ask_for(error)
        return CellOutput("text", f"{value!r}\n")


def _svg(figure: Any) -> str:
    """A figure of Matplotlib, the same bytes for the same picture."""
    picture = io.StringIO()
    figure.savefig(picture, format="svg", metadata={"Date": None}, bbox_inches="tight")
    text = picture.getvalue()
    return text[text.index("<svg") :]
