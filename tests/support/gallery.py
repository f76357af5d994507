"""Every picture of every bundled model on one page, to be looked at in one sitting.

Tests keep what they draw; at the end of a session the page is made of all that is there, in
``build/gallery/index.html``.  It is read on wide and narrow screens and on paper, and in grey.
"""

from __future__ import annotations

import json
import re
import shutil
from collections.abc import Iterable
from contextlib import suppress
from dataclasses import asdict, dataclass
from html import escape
from pathlib import Path

FOLDER = Path(__file__).parents[2] / "build" / "gallery"
LIST = "pictures.json"
SIZE = re.compile(r'<svg[^>]* viewBox="0 0 ([\d.]+) ([\d.]+)"')
STYLE = """\
body { margin: 1rem; font: 0.8rem/1.3 system-ui, sans-serif; color: #1a1a1a; background: #fff }
h1 { font-size: 1.3rem } h2 { font-size: 1rem; margin: 1.6rem 0 0.4rem; break-after: avoid }
nav, ul { display: grid; gap: 0.2rem 0.7rem }
nav { grid-template-columns: repeat(auto-fill, minmax(21rem, 1fr)) }
ul { grid-template-columns: repeat(auto-fill, minmax(10.5rem, 1fr)); padding: 0; list-style: none }
li { break-inside: avoid; overflow-wrap: anywhere } img { width: 100%; height: auto }
a { color: #0060a8; text-decoration: none }
main.grey:target img { filter: grayscale(1) }
@media (max-width: 30rem) { nav { grid-template-columns: 1fr } }
@media print { nav, .ways { display: none } ul { grid-template-columns: repeat(4, 1fr) } }
"""


@dataclass(frozen=True)
class Kept:
    """A picture of a source: a model, or a command; kind : by which pictures are put together."""

    name: str
    kind: str
    svg: str


def keep(source: str, pictures: Iterable[Kept]) -> None:
    """Keep the pictures of a source, instead of those that it had."""
    folder = FOLDER / re.sub(r"\W+", "-", source)
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    texts = []
    for picture in pictures:
        (folder / f"{picture.name}.svg").write_text(picture.svg, encoding="utf-8")
        texts.append(
            {**asdict(picture), "svg": f"{folder.name}/{picture.name}.svg", "source": source}
        )
        texts[-1]["size"] = SIZE.search(picture.svg).groups()  # type: ignore[union-attr]
    whole = folder / f"{LIST}.tmp"  # another session may read it to make its page
    whole.write_text(json.dumps(texts), encoding="utf-8")
    whole.replace(folder / LIST)


def keep_files(source: str, folder: Path) -> None:
    """Keep the pictures that a command has written."""
    keep(
        source,
        [
            Kept(path.stem, re.sub(r"-\d+$", "", path.stem), path.read_text(encoding="utf-8"))
            for path in sorted(folder.glob("*.svg"))
        ],
    )


def write_page() -> None:
    """The page of all that is kept."""
    kinds: dict[str, list[str]] = {}
    for path in sorted(FOLDER.glob(f"*/{LIST}")):
        with suppress(FileNotFoundError):  # another session draws them anew
            for load in json.loads(path.read_text(encoding="utf-8")):
                kinds.setdefault(load["kind"], []).append(_item(load))
    if not kinds:
        return
    count = sum(map(len, kinds.values()))
    links = "\n".join(
        f'<a href="#{number}">{escape(kind)} ({len(items)})</a>'
        for number, (kind, items) in enumerate(kinds.items())
    )
    parts = "\n".join(
        f'<h2 id="{number}">{escape(kind)}</h2>\n<ul>\n{"".join(items)}</ul>'
        for number, (kind, items) in enumerate(kinds.items())
    )
    page = f"""\
<!doctype html>
<html lang="en">
<meta charset="utf-8">
<meta name="viewport" content="width=device-width">
<title>Pictures of the bundled models</title>
<style>
{STYLE}</style>
<main class="grey" id="grey">
<h1>{count} pictures of the bundled models</h1>
<p class="ways"><a href="#grey">in grey</a> · <a href="#">in colour</a></p>
<nav>
{links}
</nav>
{parts}
</main>
"""
    (FOLDER / "index.html").write_text(page, encoding="utf-8")


def _item(item: dict[str, str]) -> str:
    width, height = item["size"]
    text = f"{item['name']} · {item['source']}"
    size = f'width="{width}" height="{height}"'
    picture = f'<img src="{item["svg"]}" alt="" {size} loading="lazy">'
    return f'<li><a href="{item["svg"]}">{picture}{escape(text)}</a></li>\n'
