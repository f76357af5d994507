"""A language that is one catalogue file is known everywhere: commands, reports, page, schema."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

import equipoise

PACKAGE = Path(equipoise.__file__).parent
CATALOGUE = """\
[language]
name = "Latin"
decimal = ","
plural.one = "n = 1"
drawing_font = "roman.ttf"

[texts]
"shaking force" = "vis quassans"
"Undo" = "Revocare"
"mass" = "massa"
"crank speed" = "celeritas"
"""
ASKED = """\
import json, sys
from equipoise.cli import run
from equipoise.i18n import LANGUAGES
from equipoise.schema.schemas import json_schema
from equipoise.web.messages import message_of
from equipoise.web.session import Session

session = Session()
(spoken,) = session.receive(message_of({"type": "speak", "seq": 1, "languages": ["la-VA"]}))
print(json.dumps({"languages": LANGUAGES, "spoken": spoken.content, "schema": json_schema()}))
sys.exit(run(["report", "yamashita-1", "-o", "a.html", "--language", "la"]))
"""


@pytest.fixture
def package(tmp_path: Path) -> Path:
    """A folder with the package as it is, and one file more in it."""
    inside = tmp_path / "equipoise"
    texts = inside / "i18n"
    texts.mkdir(parents=True)
    for of, to in ((PACKAGE, inside), (PACKAGE / "i18n", texts)):
        for item in of.iterdir():
            if item.name not in ("i18n", "__pycache__"):
                (to / item.name).symlink_to(item)
    (texts / "la.toml").write_text(CATALOGUE, encoding="utf-8")
    return tmp_path


def run(package: Path, *arguments: str) -> str:
    environment = os.environ | {"PYTHONPATH": str(package)}
    done = subprocess.run(
        [sys.executable, *arguments],
        cwd=package, env=environment, capture_output=True, text=True, check=False, timeout=300,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_a_language_is_one_file(package: Path) -> None:
    content = json.loads(run(package, "-c", ASKED))
    assert content["languages"]["la"] == "Latin"
    spoken = content["spoken"]
    assert (spoken["language"], spoken["decimal"]) == ("la", ",")
    assert spoken["words"]["Undo"] == "Revocare"
    assert spoken["languages"] == content["languages"]
    assert '"la": {' in json.dumps(content["schema"])
    report = (package / "a.html").read_text(encoding="utf-8")
    assert '<html lang="la">' in report and "celeritas" in report


# Where it is not among the choices, the report above is refused too.
@pytest.mark.exhaustive
def test_help_names_it(package: Path) -> None:
    choices = run(package, "-m", "equipoise", "report", "--help")
    assert re.search(r"ko,\W+la\]", choices)
