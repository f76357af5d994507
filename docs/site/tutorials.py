"""The pages of the tutorials, which are notebooks: their cells are run and shown with outputs.

On a web host beside the live page a reader can change the cells and run them again, by the Python
that the live page has: see `static/cells.js`.
"""

from __future__ import annotations

import html
import json
import os
from collections.abc import Callable
from contextlib import chdir
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from equipoise.web.cells import CellOutput, CellRunner

FAILS = "raises-exception"
"""Tag of a cell that shows an error, as Jupyter has it."""
NOTE = """```{raw} html
<p class="tutorial-note"><a href="%s" download>Download this notebook</a><span
class="runs-here" hidden>; or change a cell here and press Run, which loads Python into this
page</span>. Its outputs are those of this version.</p>
```"""
RUN = '<button type="button" class="run-cell" hidden>Run</button>'


class Notebook:
    """A notebook file.  outputs : of its cells of code, in their order."""

    def __init__(self, file: Path) -> None:
        self.content: dict[str, Any] = json.loads(file.read_text(encoding="utf-8"))
        self.cells: list[dict[str, Any]] = self.content["cells"]

    def run(self) -> None:
        """Run all cells in a folder of their own.

        Raises
        ------
        RuntimeError : a cell fails that should not, or does not fail that should.
        """
        cells = CellRunner()
        os.environ.setdefault("MPLBACKEND", "agg")
        with TemporaryDirectory() as folder, chdir(folder):
            for number, cell in enumerate(self.cells, 1):
                if cell["cell_type"] != "code":
                    continue
                cell["outputs"] = [output_of(one) for one in cells.run("".join(cell["source"]))]
                failed = [one for one in cell["outputs"] if one["output_type"] == "error"]
                if bool(failed) != (FAILS in cell["metadata"].get("tags", ())):
                    said = failed[0]["evalue"] if failed else "no error, and one is expected"
                    raise RuntimeError(f"cell {number}: {said}")

    def page(self, file: Path, linked: Callable[[Path, str], str]) -> str:
        """The page, in Markdown; linked : a text of the file with links to pages of the site."""
        parts = []
        for cell in self.cells:
            source = "".join(cell["source"])
            is_code = cell["cell_type"] == "code"
            parts.append(cell_of(cell, source) if is_code else linked(file, source))
        return "\n\n".join([parts[0], NOTE % file.name, *parts[1:], ""])


def output_of(output: CellOutput) -> dict[str, Any]:
    """An output as a notebook file has it."""
    if output.kind == "text":
        return {"output_type": "stream", "name": "stdout", "text": output.content}
    if output.kind == "error":
        name, _, sentence = output.content.partition(": ")
        about = {"ename": name, "evalue": sentence, "traceback": [output.content]}
        return {"output_type": "error", **about, "topic": output.topic}
    return {"output_type": "display_data", "data": {"text/html": output.content}, "metadata": {}}


def cell_of(cell: dict[str, Any], source: str) -> str:
    """A cell of code with its outputs, in Markdown."""
    outputs = "".join(map(as_html, cell["outputs"]))
    shown = f'{RUN}<div class="cell-outputs" aria-live="polite">{outputs}</div>'
    return (
        f":::{{container}} cell\n```python\n{source}\n```\n\n````{{raw}} html\n{shown}\n````\n:::"
    )


def as_html(output: dict[str, Any]) -> str:
    """An output as the page shows it."""
    if output["output_type"] == "display_data":
        return f'<div class="cell-html" tabindex="0">{output["data"]["text/html"]}</div>'
    if output["output_type"] == "stream":
        return f'<pre class="cell-text" tabindex="0">{html.escape(output["text"])}</pre>'
    more = f'<p><a href="../explain/{output["topic"]}.html">What to do about it</a></p>'
    said = html.escape("".join(output["traceback"]))
    return f'<pre class="cell-error" tabindex="0">{said}</pre>{more * bool(output["topic"])}'


def tutorials(folder: Path, into: Path, linked: Callable[[Path, str], str]) -> dict[str, str]:
    """The pages of all notebooks of a folder, which are written with their outputs too.

    into : where the files stand beside their pages.  linked : as of `Notebook.page`.
    """
    into.mkdir(parents=True)
    pages = {}
    for file in sorted(folder.glob("*.ipynb")):
        notebook = Notebook(file)
        notebook.run()
        pages[f"tutorials/{file.stem}.md"] = notebook.page(file, linked)
        for cell in notebook.cells:
            for output in cell.get("outputs", ()):
                output.pop("topic", None)
        text = json.dumps(notebook.content, ensure_ascii=False, indent=1)
        (into / file.name).write_text(f"{text}\n", encoding="utf-8")
    return pages
