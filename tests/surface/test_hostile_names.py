"""Texts of a model that are written as markup: they are shown as they stand, and nothing else."""

from __future__ import annotations

import ast
import re
import zipfile
from collections.abc import Callable
from html.parser import HTMLParser
from pathlib import Path
from xml.etree import ElementTree

import ezdxf
import mujoco
import openpyxl
import pytest
import scipy.io

from support.hostile import hostile_text
from surface.running import equipoise, example_text, succeeded

OWN = {"equipoise-machine", "equipoise-states", "equipoise-page"}
"""Scripts of an interactive file."""


class Markup(HTMLParser):
    """What a browser would run, or load from elsewhere; and all texts."""

    def __init__(self, text: str) -> None:
        super().__init__(convert_charrefs=True)
        self.wrong: list[object] = []
        self.texts: list[str] = []
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        given = dict(attrs)
        if tag in {"img", "iframe", "object", "embed"}:
            self.wrong.append(tag)
        if tag == "script" and given.get("id") not in OWN:
            self.wrong.append(given)
        for name, value in attrs:
            leads = name in {"href", "src", "xlink:href", "action", "data", "formaction", "srcdoc"}
            if name.startswith("on") or (leads and value and not value.startswith(("#", "data:"))):
                self.wrong.append((tag, name, value))

    def handle_data(self, data: str) -> None:
        self.texts.append(data)


@pytest.fixture
def hostile() -> None:
    Path("model.toml").write_text(hostile_text(), encoding="utf-8")


@pytest.mark.exhaustive(but=["words2-moving.svg", "words3-pictures/linkage.svg"])
@pytest.mark.usefixtures("hostile")
@pytest.mark.parametrize(
    ("words", "file"),
    [
        (("report", "model.toml", "-o", "page.html"), "page.html"),
        (("export", "model.toml", "-o", "machine.html"), "machine.html"),
        (("animate", "model.toml", "-o", "moving.svg"), "moving.svg"),
        (("plot", "model.toml", "--only", "linkage", "-o", "pictures"), "pictures/linkage.svg"),
    ],
)
def test_names_are_text(words: tuple[str, ...], file: str) -> None:
    succeeded(equipoise(*words))
    read = Markup(Path(file).read_text(encoding="utf-8"))
    assert read.wrong == []
    assert any("<script>window.x=1" in text for text in read.texts)


def _script_parts(path: Path) -> int:
    return sum(1 for _ in ast.walk(ast.parse(path.read_text(encoding="utf-8"))))


def _elements(data: str | bytes) -> int:
    return sum(1 for _ in ElementTree.fromstring(data).iter())


def _modelica_tokens(path: Path) -> list[str]:
    """What is neither text nor a name."""
    text = path.read_text(encoding="utf-8")
    return re.findall(r"[^\w\s]", re.sub(r'"(?:[^"\\]|\\.)*"', "", text))


def _fmu_variables(path: Path) -> int:
    with zipfile.ZipFile(path) as archive:
        return _elements(archive.read("modelDescription.xml"))


READERS: dict[str, Callable[[Path], object]] = {
    "xml": lambda path: mujoco.MjModel.from_xml_path(str(path)).body_mass.tolist(),
    "urdf": lambda path: _elements(path.read_bytes()),
    "py": _script_parts,
    "fmu": _fmu_variables,
    "mo": _modelica_tokens,
    "dxf": lambda path: len(ezdxf.readfile(path).modelspace()),
    "xlsx": lambda path: openpyxl.load_workbook(path).sheetnames,
    "mat": lambda path: scipy.io.loadmat(path)["equipoise"].dtype.names,
}
"""Of each format for other programs, what its own reader makes of a file."""


@pytest.mark.exhaustive(but=["py", "dxf", "mat", "urdf", "xml", "mo"])
@pytest.mark.usefixtures("hostile")
@pytest.mark.parametrize("ending", READERS)
def test_other_programs_read_the_same_machine_whatever_its_names(ending: str) -> None:
    Path("usual.toml").write_text(example_text("yamashita-1"), encoding="utf-8")
    read = []
    for name in ("model", "usual"):
        succeeded(equipoise("export", f"{name}.toml", "-o", f"{name}.{ending}"))
        read.append(READERS[ending](Path(f"{name}.{ending}")))
    assert read[0] == read[1]
    assert read[0]
