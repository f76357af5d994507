"""Examples of public names: statements of the pages, which tests run, with all that they need.

Of every place where a page uses a name the shortest is taken: the statement itself, and those
before it that define what it uses.
"""

from __future__ import annotations

import ast
import builtins
import re
from collections.abc import Iterable, Iterator
from doctest import DocTestParser
from pathlib import Path
from typing import NamedTuple

PACKAGE = "equipoise"
BLOCK = re.compile(r"^```python\n(>>>.*?)^```$", re.MULTILINE | re.DOTALL)
FILE = re.compile(r"[\w-]+\.(?:toml|csv|zarr|html|py|txt|json|xml|urdf|dxf|svg|fmu|npz|parquet)")
LONGEST = 24
"""Lines of an example, above which it is none."""


class Statement(NamedTuple):
    """A statement of a page.

    shown : as it stands there, with what it prints.  uses : public names, such as
    ``equipoise.balancing.Objective``.  needs, gives : variables.
    """

    shown: str
    uses: frozenset[str]
    needs: frozenset[str]
    gives: frozenset[str]

    @property
    def prints(self) -> bool:
        """Whether something is shown below it."""
        return self.shown != without_output(self.shown)


class Sample(NamedTuple):
    """An example.  page : where it is from, without its ending."""

    page: str
    lines: tuple[str, ...]


def samples(pages: Iterable[Path], public: Iterable[str]) -> dict[str, Sample]:
    """The shortest example of each public name that a page uses, of those that show something.

    public : names by which users have them, such as ``equipoise.load``.
    """
    wanted, best = frozenset(public), dict[str, tuple[tuple[bool, int], Sample]]()
    for page in pages:
        read = list(statements(page.read_text(encoding="utf-8")))
        for at, statement in enumerate(read):
            if not statement.uses & wanted:
                continue
            end = at if statement.prints else shown_by(read, at)
            lines = with_needed(read[: end + 1], at)
            rank = (not read[end].prints, len(lines))
            for name in statement.uses & wanted if lines else ():
                if name not in best or rank < best[name][0]:
                    best[name] = rank, Sample(page.stem, lines)
    return {name: sample for name, (_, sample) in best.items()}


def shown_by(read: list[Statement], at: int) -> int:
    """The next statement that prints what a statement gives, as long as that is not given anew."""
    for later in range(at + 1, len(read)):
        if read[at].gives & read[later].needs and read[later].prints:
            return later
        if read[at].gives & read[later].gives:
            break
    return at


def statements(text: str) -> Iterator[Statement]:
    """The statements of a page, in their order; those that fail on purpose are left out."""
    called: dict[str, str] = {}
    written: set[str] = set()
    for block in BLOCK.finditer(text):
        for example in DocTestParser().get_examples(block[1]):
            tree = ast.parse(example.source)
            files = {*files_in(tree)}
            # whatever wrote a file that the page has named before is needed
            there = {name for name in files if name in text[: block.start()]} | (files & written)
            written |= files
            called |= dict(imported(tree))
            names = [node for node in ast.walk(tree) if isinstance(node, ast.Name)]
            gives = {node.id for node in names if isinstance(node.ctx, ast.Store)} | {
                *imports(tree)
            }
            needs = {node.id for node in names if isinstance(node.ctx, ast.Load)}
            gives |= {*changed(tree)}
            own = {one.arg for one in ast.walk(tree) if isinstance(one, ast.arg)} | inner(tree)
            if example.exc_msg is None:
                lines = example.source.rstrip().splitlines()
                shown = [f">>> {lines[0]}", *(f"... {line}" for line in lines[1:])]
                yield Statement(
                    "\n".join([*shown, *example.want.rstrip().splitlines()]),
                    frozenset(used(tree, called)),
                    frozenset(needs - own - {*dir(builtins)} | there),
                    frozenset(gives - inner(tree) | files - there),
                )


def files_in(tree: ast.AST) -> Iterator[str]:
    """Names of files."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Constant) and FILE.fullmatch(str(node.value)):
            yield str(node.value)


def changed(tree: ast.AST) -> Iterator[str]:
    """Variables of which an item is set, as in ``values[0] = 1``: they are needed, and given."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Subscript) and isinstance(node.ctx, ast.Store):
            yield from [node.value.id] if isinstance(node.value, ast.Name) else []


def inner(tree: ast.AST) -> set[str]:
    """Variables of comprehensions, which nothing else sees."""
    loops = (node for node in ast.walk(tree) if isinstance(node, ast.comprehension))
    return {
        name.id for loop in loops for name in ast.walk(loop.target) if isinstance(name, ast.Name)
    }


def imports(tree: ast.AST) -> Iterator[str]:
    """Variables that imports give."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Import | ast.ImportFrom):
            yield from (one.asname or one.name.partition(".")[0] for one in node.names)


def imported(tree: ast.AST) -> Iterator[tuple[str, str]]:
    """Variables that stand for something of the package, and what they stand for."""
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and (node.module or "").startswith(PACKAGE):
            yield from ((one.asname or one.name, f"{node.module}.{one.name}") for one in node.names)
        elif isinstance(node, ast.Import):
            for one in node.names:
                if one.name.startswith(PACKAGE):
                    yield one.asname or one.name, one.name


def used(tree: ast.AST, called: dict[str, str]) -> Iterator[str]:
    """Names of the package in a statement."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Attribute | ast.Name):
            head, dot, rest = ast.unparse(node).partition(".")
            if head in called:
                yield f"{called[head]}{dot}{rest}"


def with_needed(statements: list[Statement], use: int) -> tuple[str, ...]:
    """The last statement and those before it that it needs; empty where that is too long.

    use : the one that an example is looked for, which is taken too.
    """
    *above, last = statements
    needed, taken = set(last.needs), [last.shown]
    for at, statement in reversed(list(enumerate(above))):
        if needed & statement.gives or at == use:
            needed |= statement.needs
            needed -= statement.gives - statement.needs
            taken.insert(0, without_output(statement.shown))
    lines = tuple("\n".join(taken).splitlines())
    return () if needed or len(lines) > LONGEST else lines


def without_output(shown: str) -> str:
    """A statement alone."""
    return "\n".join(
        line for line in shown.splitlines() if line.startswith((">>> ", "... ", "..."))
    )
