"""The bundle of the live page names every package that it carries, with its license."""

from __future__ import annotations

import json
import re
import runpy
from pathlib import Path

import pytest

PAGE = Path(__file__).parents[3] / "page"
BUNDLE = runpy.run_path(str(PAGE / "bundle.py"))


def carried() -> set[str]:
    """What the sources import, and what those need; a package may be a bundle of its own."""
    names = set()
    for file in PAGE.glob("src/**/*.ts"):
        matches = re.findall(r'(?:from|import) "([^."][^"]*)"', file.read_text(encoding="utf-8"))
        names |= {"/".join(item.split("/")[: 1 + item.startswith("@")]) for item in matches}
    new = names
    while new:
        new = {inner for item in new for inner in about(item).get("dependencies", {})} - names
        names |= new
    return names


def about(name: str) -> dict[str, dict[str, str]]:
    path = PAGE / "node_modules" / name / "package.json"
    return json.loads(path.read_text(encoding="utf-8"))  # type: ignore[no-any-return]


def test_every_package_is_named_with_its_license() -> None:
    if not BUNDLE["is_fresh"]() or not (PAGE / "node_modules").is_dir():
        pytest.skip("there is no bundle of the live page, or an old one: make page")
    notice = (BUNDLE["BUNDLE"] / "THIRD-PARTY.txt").read_text(encoding="utf-8")
    assert re.findall(r"(?m)^(\S+) [\d.]+, license MIT$", notice) == sorted(carried())
    assert notice.count("Permission is hereby granted") == len(carried())
    assert notice.rstrip() in (BUNDLE["BUNDLE"] / "equipoise.js").read_text(encoding="utf-8")
