"""Build hook: puts the bundle of the live page, and the man page where docs/man.py has written it,
into wheels and source distributions.
"""

from __future__ import annotations

import runpy
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

MAN = Path(__file__).parent / "build" / "man" / "equipoise.1"
PAGE = runpy.run_path(str(Path(__file__).parent / "page" / "bundle.py"))


class PageHook(BuildHookInterface[Any]):
    """Bundles the page before files are collected; `artifacts` in pyproject.toml takes it in."""

    def dependencies(self) -> list[str]:
        """Ask for Node as a Python package where it is needed and not installed."""
        return [] if PAGE["is_fresh"]() or PAGE["node_and_npm"]() else [PAGE["NODE"]]

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Bundle; an editable install goes on without, as `equipoise serve` says what to do."""
        try:
            self.app.display_info(PAGE["bundle"]())
        except PAGE["BundleError"] as error:
            if version != "editable":
                self.app.abort(f"The live page could not be bundled: {error}")
            self.app.display_warning(f"Installed without the live page: {error}")
        if self.target_name == "wheel" and MAN.is_file():
            build_data["shared_data"][str(MAN)] = "share/man/man1/equipoise.1"
