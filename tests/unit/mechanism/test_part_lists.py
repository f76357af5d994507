"""The lists of parts of a machine follow from the kinds that are there."""

from __future__ import annotations

import pkgutil
from collections.abc import Iterator
from importlib import import_module
from pathlib import Path

from equipoise.mechanism import parts
from equipoise.mechanism.parts import part_lists
from equipoise.mechanism.parts.couplings import Coupling
from equipoise.mechanism.parts.element_kinds import ForceElement, PartKind
from equipoise.mechanism.parts.joint_kinds import JointKind

FILE = Path(part_lists.__file__)
BASES = (JointKind, Coupling, ForceElement)
HEAD = '''"""Lists of parts that a machine may have, one of each kind in this package.

Written by ``PYTHONPATH=tests python tests/unit/mechanism/test_part_lists.py`` from the kinds.
"""

from __future__ import annotations

from equipoise.keys import Frozen, KeyTable, Tables, declared, key
'''
CLASS = '''

# fmt: off
@declared
class PartLists(Frozen):
    """Parts of a machine that declare themselves."""

'''
FIELD = """\
    {name}: tuple[{kind}, ...] = key(
        Tables(KeyTable({kind})), {kind}.list_text, default=(), kw_only=True)
"""


def kinds() -> Iterator[type[PartKind]]:
    for module in pkgutil.iter_modules(parts.__path__, f"{parts.__name__}."):
        for item in vars(import_module(module.name)).values():
            own = isinstance(item, type) and item.__module__ == module.name
            if own and issubclass(item, PartKind) and "list_name" in vars(item):
                yield item


def text() -> str:
    every = [*kinds()]
    imports = sorted(f"from {kind.__module__} import {kind.__name__}\n" for kind in every)
    fields = [
        FIELD.format(name=kind.list_name, kind=kind.__name__)
        for base in BASES
        for kind in sorted(every, key=lambda item: (item.order, item.list_name))
        if issubclass(kind, base)
    ]
    return "".join((HEAD, *imports, CLASS, *fields))


def test_every_kind_has_its_list() -> None:
    assert FILE.read_text(encoding="utf-8") == text()


if __name__ == "__main__":
    FILE.write_text(text(), encoding="utf-8")
