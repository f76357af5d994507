"""An interactive file without a browser: its own functions, run by Node."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
from pathlib import Path
from typing import Any

NODE = shutil.which("node")
BLOCK = r'<script[^>]* id="equipoise-{}">(.*?)</script>'
RUN = """
import {{ Drawing, Machine, moved, outside, toml, typed, withLength }} from "./page.mjs";
import {{ readFileSync, writeFileSync }} from "node:fs";
const data = JSON.parse(readFileSync("machine.json", "utf8"));
const program = readFileSync("states.js", "utf8") + "; return {{ states, extremes }};";
const {{ states, extremes }} = new Function(program)();
const machine = new Machine(data, states, extremes);
const solution = machine.solve(machine.base);
const given = {given};
const answer = (() => {{ {body} }})();
writeFileSync("answer.json", JSON.stringify(answer));
"""


def block(html: str, name: str) -> str:
    """The content of one of the file's scripts."""
    match = re.search(BLOCK.format(name), html, re.DOTALL)
    assert match is not None
    return match[1]


def evaluated(html: str, body: str, folder: Path, given: Any = None) -> Any:
    """What a JavaScript function body returns in the file.

    It has the `machine`, its `solution` as it is, and what is `given`.
    """
    (folder / "page.mjs").write_text(block(html, "page"), encoding="utf-8")
    (folder / "machine.json").write_text(block(html, "machine"), encoding="utf-8")
    (folder / "states.js").write_text(block(html, "states"), encoding="utf-8")
    run = folder / "run.mjs"
    run.write_text(RUN.format(given=json.dumps(given), body=body), encoding="utf-8")
    assert NODE is not None
    done = subprocess.run(
        [NODE, run.name], cwd=folder, capture_output=True, text=True, timeout=300, check=False
    )
    assert done.returncode == 0, done.stderr
    return json.loads((folder / "answer.json").read_text(encoding="utf-8"))
