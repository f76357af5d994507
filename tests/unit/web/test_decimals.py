"""Numbers of the page with the decimal sign of a language, by its own TypeScript, run by Node."""

from __future__ import annotations

import json
import shutil
import subprocess
from pathlib import Path

import pytest

PAGE = Path(__file__).parents[3] / "page"
ESBUILD = PAGE / "node_modules" / ".bin" / "esbuild"
NODE = shutil.which("node")
SHOWN = {
    "33.5 mm": "33,5 mm",
    "−0.25": "−0,25",
    "1.5e-04": "1,5e-04",
    "(0.5, 12.25)": "(0,5, 12,25)",
    "P1.5 of 1.2.3 in a.1.5.toml": "P1.5 of 1.2.3 in a.1.5.toml",
}
TYPED = {
    "33,5 mm": "33.5 mm",
    " −0,25": "-0.25",
    "33.5 mm": "33.5 mm",
    "1,5e-3 m": "1.5e-3 m",
    "0, 1, 0": "0, 1, 0",
    "1,2,3": "1,2,3",
    "1.000,5 mm": "1.000,5 mm",
    "2 * length": "2 * length",
    "12,5°": "12.5°",
}
ASKED = """
import { asTyped, decimals, point } from "./format.mjs";
const [shown, typed] = %s;
const all = () => [shown.map(decimals), typed.map(asTyped)];
const before = all();
point(",");
console.log(JSON.stringify([before, all()]));
"""


@pytest.mark.skipif(NODE is None or not ESBUILD.exists(), reason="the page's tools are not here")
def test_numbers_are_shown_with_a_comma_and_typed_with_either(tmp_path: Path) -> None:
    source, built = PAGE / "src" / "format.ts", tmp_path / "format.mjs"
    subprocess.run([str(ESBUILD), str(source), f"--outfile={built}"], check=True, timeout=300)
    (tmp_path / "ask.mjs").write_text(ASKED % json.dumps([[*SHOWN], [*TYPED]]), encoding="utf-8")
    printed = subprocess.run(
        [str(NODE), "ask.mjs"],
        cwd=tmp_path,
        check=True,
        capture_output=True,
        text=True,
        timeout=300,
    ).stdout
    before, after = json.loads(printed)
    assert before == [[*SHOWN], [text.strip().replace("−", "-") for text in TYPED]]
    assert after == [[*SHOWN.values()], [*TYPED.values()]]
