"""The support of a run on the command line, which goes before the table [run] of a file."""

from __future__ import annotations

from pathlib import Path

import pytest

from surface.running import example_text, read


@pytest.mark.parametrize("option", [None, True, False])
@pytest.mark.parametrize("in_file", [None, True, False])
def test_an_option_goes_before_the_file(
    option: bool | None, in_file: bool | None, tmp_path: Path
) -> None:
    file = tmp_path / "rig.toml"
    plan = "" if in_file is None else f"\n[run]\nsupport = {str(in_file).lower()}\n"
    file.write_text(example_text("balance-rig") + plan, encoding="utf-8")
    options = {None: [], True: ["--support"], False: ["--no-support"]}[option]
    values = read("run", str(file), "5 ms", *options)
    assert ("mounts" in values) == bool(in_file if option is None else option)
