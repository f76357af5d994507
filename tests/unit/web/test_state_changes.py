"""States as a worker hands them to its page: what has changed since the one before."""

from __future__ import annotations

import json
import shutil
import subprocess
from pathlib import Path
from typing import Any

import pytest

from equipoise.web.replies import Reply, StateChanges, changes
from equipoise.web.worker import Foreground
from unit.web.pages import unpacked

ROOT = Path(__file__).parents[3]
ESBUILD = ROOT / "page" / "node_modules" / "esbuild"

Values = dict[str, Any]


def put_together(before: Values, text: Values) -> Values:
    """What `changed` of page/src/site/wire.ts does."""
    now = {key: value for key, value in text.items() if key != "since"}
    since = text["since"]
    now |= {key: before[key] for key in since["same"]}
    for key, items in since["items"].items():
        now[key] = [*before[key]]
        for number, item in items:
            now[key][number] = item
    return now | {key: put_together(before[key], part) for key, part in since["inside"].items()}


def states() -> tuple[list[Values], list[Values]]:
    """States in full, and as they are sent, of an edit of each kind and of another machine."""
    page, whole, sent = Foreground(), list[Values](), list[Values]()
    of = page._changes.of

    def both(reply: Reply) -> Reply:
        if reply.content["type"] == "state":
            whole.append(json.loads(json.dumps(reply.content)))
        return of(reply)

    page._changes.of = both  # type: ignore[method-assign]
    mass = {"set": "links.crank.mass", "text": "2 kg"}
    drag = {"move": "C", "at": 10, "to": [0.05, 0.06]}
    asked: list[tuple[str, Values]] = [
        ("open", {"example": "yamashita-1"}),
        ("edit", {"label": "mass", "edits": [mass], "commit": False}),
        ("edit", {"label": "mass", "edits": [mass]}),
        ("edit", {"label": "drag", "edits": [drag], "commit": False}),
        ("undo", {}),
        ("open", {"example": "slider-crank-engine"}),
        ("open", {"new": True}),
    ]
    for seq, (kind, values) in enumerate(asked):
        page.take(json.dumps({"type": kind, "seq": seq, **values}))
        while (reply := page.step()) is not None:
            reported = unpacked(reply)[0]
            sent += [reported] if reported["type"] == "state" else []
    return whole, sent


def test_states_are_put_together_from_what_has_changed() -> None:
    whole, sent = states()
    assert len(whole) == len(sent) >= 6
    page: Values = {}
    for full, text in zip(whole, sent, strict=True):
        page = put_together(page, text)
        assert page == full
    sizes = [[len(json.dumps(state)) for state in kind] for kind in (whole, sent)]
    assert sizes[1][1] < 0.3 * sizes[0][1]  # a mass that is tried


def test_the_page_puts_them_together_in_the_same_way(tmp_path: Path) -> None:
    node = shutil.which("node")
    if node is None or not ESBUILD.is_dir():
        pytest.skip("Node and esbuild are not installed")
    whole, sent = states()
    script = """
        const { build } = require(process.argv[1]);
        const [, , wire, file] = process.argv;
        build({ entryPoints: [wire], bundle: true, format: "cjs", write: false }).then((done) => {
          const module = { exports: {} };
          new Function("module", "exports", done.outputFiles[0].text)(module, module.exports);
          const sent = JSON.parse(require("fs").readFileSync(file, "utf8"));
          let page = {};
          const all = sent.map((told) => (page = module.exports.changed(page, told)));
          process.stdout.write(JSON.stringify(all));
        });
    """
    (tmp_path / "sent.json").write_text(json.dumps(sent), encoding="utf-8")
    wire = ROOT / "page" / "src" / "site" / "wire.ts"
    command = [node, "-e", script, str(ESBUILD), str(wire), str(tmp_path / "sent.json")]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    assert json.loads(done.stdout) == whole


def test_lists_are_sent_whole_where_most_of_them_differs() -> None:
    reported = changes({"a": [1, 2, 3], "b": [1, 2]}, {"a": [1, 2, 4], "b": [3, 4], "c": None})
    since = {"same": [], "items": {"a": [[2, 4]]}, "inside": {}}
    assert reported == {"since": since, "b": [3, 4], "c": None}


def test_other_messages_are_left_as_they_are() -> None:
    reply = Reply({"type": "answered", "seq": 3})
    assert StateChanges().of(reply) is reply
