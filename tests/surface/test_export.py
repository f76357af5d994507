"""`equipoise export`: where files go, and what is refused in a sentence."""

from __future__ import annotations

from pathlib import Path

from surface.running import command_lines, equipoise, refuses, succeeded

REFUSED = {
    "export": {
        "yamashita-1": "--out: missing; give the name of a file",
        "yamashita-1 -o x.docx": "--out: got 'x.docx'; give the name of a file that ends in one of",
        "yamashita-1 -o x": "--out: got 'x'; give the name of a file that ends in one of .xml,",
        "yamashita-1 -o x.xml --format mjfc": "--format: no format is called 'mjfc'; did",
        "yamashita-1 -o no/x.xml": "--out: no/x.xml: there is no such folder; make it, or choose",
        "yamashita-1 -o x.xml --kept": "--kept: it goes with a store; leave it out",
        "yamashita-1 -o x.csv --balanced": "--balanced: a file of CSV holds the designs of a store",
        "yamashita-1 -o x.csv": "yamashita-1: there is no such store; make it by: equipoise sweep",
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
