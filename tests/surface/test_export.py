"""`equipoise export`: where files go, and what is refused in a sentence."""

from __future__ import annotations

from pathlib import Path

import pytest

from surface.running import command_lines, equipoise, refuses, succeeded
from unit.schema.samples import FOUR_BAR

REFUSED = {
    "export": {
        "yamashita-1": "--out: missing; give the name of a file",
        "yamashita-1 -o x.docx": "--out: got 'x.docx'; give the name of a file that ends in one of",
        "yamashita-1 -o x": "--out: got 'x'; give the name of a file that ends in one of .xml,",
        "yamashita-1 -o x.xml --format mjfc": "--format: no format is called 'mjfc'; did",
        "yamashita-1 -o no/x.xml": "--out: no/x.xml: there is no such folder; make it, or choose",
        "yamashita-1 -o x.xml --kept": "--kept: it goes with a store; leave it out",
        ". -o x.csv --balanced": "--balanced: a file of CSV holds the designs of a store",
        "yamashita-1 -o x.parquet": "--out: Parquet is for designs of a store; give one of mjcf,",
        "yamashita-1 -o x.csv": "yamashita-1: links.crank.section: missing; loads along a link",
        "yamashita-1 -o x.inp --link cranc": "no link is called 'cranc'; did you mean",
        "yamashita-1 -o x.xml --link crank": "--link: it goes with loads along a link, in the form",
        "yamashita-1 -o x.mat --angles 3": "--angles: it goes with loads along a link, in the",
        "yamashita-1 -o x.inp --angles 3 --at '1 deg'": "--at and --angles were given; give one",
        ". -o x.csv --link crank": "--link: it goes with loads along a link, in the formats inp,",
        "no.zarr -o x.csv": "no.zarr: there is no such store; make it by: equipoise sweep",
        ". -o x.xlsx": "--out: Excel is for machines; give one of csv, parquet",
        "yamashita-1 -o x.mat --at '1 deg'": "--at: a file of MATLAB is the same at every",
        "brush-cutter -o x.xml": "brush-cutter.toml: this is the file of a tool",
        "no.toml -o x.xml": "no.toml: there is no such file",
    },
}


@command_lines(REFUSED)
def test_refused(line: str, said: str) -> None:
    refuses(line, said)


def test_a_format_by_name_and_a_note(tmp_path: Path) -> None:
    path = tmp_path / "model.mjcf"
    done = equipoise("export", "transplanter", "-o", path, "--format", "mjcf", "--at", "30 deg")
    assert succeeded(done) == ""
    assert done.err == f"note: the file leaves out the soil's force\nwrote {path}\n"
    assert path.read_text("utf-8").startswith("<mujoco")


def test_results_are_written_anew_and_models_never(tmp_path: Path) -> None:
    path, other = tmp_path / "mine.xml", tmp_path / "other.toml"
    path.write_text("something else", "utf-8")
    succeeded(equipoise("export", "yamashita-1", "-o", path))
    assert path.read_text("utf-8").startswith("<mujoco")
    other.write_text(FOUR_BAR, "utf-8")
    refused = equipoise("export", "yamashita-1", "-o", other, "--format", "mjcf")
    assert "other.toml is there already, and may be a model; give another name" in refused.err
    assert other.read_text("utf-8") == FOUR_BAR


@pytest.mark.exhaustive(but=["mat"])
@pytest.mark.parametrize("ending", ["fmu", "xlsx", "mat"])
def test_forces_that_are_left_out_are_reported(ending: str, tmp_path: Path) -> None:
    model = tmp_path / "m.toml"
    model.write_text(FOUR_BAR, "utf-8")
    printed = equipoise("export", model, "-o", tmp_path / f"m.{ending}").err
    assert "note: the file leaves out all forces: forces need mass, center_of_mass and" in printed


def test_a_tree_of_joints_lacks_the_soil(tmp_path: Path) -> None:
    printed = equipoise("export", "transplanter", "-o", tmp_path / "t.urdf").err
    assert "note: the file leaves out the soil's force\n" in printed
