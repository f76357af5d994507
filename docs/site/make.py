"""Make the documentation site, `build/docs/index.html`, which needs no network to be read.

    make docs

With ``--draft``, as tests of a change make it, each machine has its interactive file in one
language, and the contents of a page beside it leave out public names, which Sphinx would copy for
every page: a fifth of its time.

Pages of `docs` are laid out in `build/docs-source` beside what is made of the product itself: the
gallery, the commands, the public names, the scripts, the tutorials, the pictures of the theory.
"""

from __future__ import annotations

import gc
import os
import re
import shutil
import sys
from hashlib import sha256
from pathlib import Path

HERE = Path(__file__).parent
DOCS = HERE.parent
ROOT = DOCS.parent
SOURCE, BUILT = ROOT / "build" / "docs-source", ROOT / "build" / "docs"
AROUND = {
    **{name: name for name in ("README.md", "CONTRIBUTING.md", "CHANGELOG.md", "SECURITY.md")},
    "src/equipoise/errors.md": "errors.md",
}
"""Pages of the repository that the site has too, and what they are called there."""
MADE = {"examples": "scripts.md"}
"""Folders of the repository that have a page here."""
GALLERY = {"en": "examples.md", "ja": "ja/examples.md", "ko": "ko/examples.md"}
LONG = ("model-file.md", "recipes.md", "errors.md", "conformance.md")
"""Pages of which each part is a page on the site."""
TABLES_BELOW = re.compile(r"^## `\[", re.MULTILINE)
"""Headings of tables of the model file, each of which has a page of its own too."""
TWO_WAYS = re.compile(
    r"^(```(?:console|bash|sh|toml)\n(?:(?!```).*\n)+```)\n\n(```python\n(?:(?!```).*\n)+```)\n",
    re.MULTILINE,
)
"""A file or a command, and the same in Python."""
WIDE = re.compile(r"(?<=\S) {3,}# ")
"""Space before comments that stand below each other, which half of a page has not."""
EXTRA = "extra"
"""Folder of what Sphinx takes over as it is."""
SITE_ONLY = re.compile(r"<!-- site only\n(.*?)-->\n", re.DOTALL)
"""What is hidden in a page of the repository, for it goes to pages that only the site has."""
REPOSITORY_ONLY = re.compile(r"<!-- repository only -->\n.*?<!-- /repository only -->\n", re.DOTALL)
"""What is of no use on the site."""
FRAME = re.compile(r"<iframe .*?\n\n.*?\n\n(?=-->)", re.DOTALL)
"""An interactive file in a page, with what is said of it."""
ANCHOR = re.compile(r'<a id="([\w-]+)"></a>')
LINK = re.compile(r"\[((?:[^\[\]]|\[+[^\[\]]*\]+)*)\]\((?!\w+:|[#/])([^)#\s]+)(#[^)\s]*)?\)")


def linked(page: Path, written: str | None = None) -> str:
    """The text of a page, whose links go to pages of the site; of what has none, the name remains.

    written : its text, where the file is no Markdown.

    Raises
    ------
    FileNotFoundError : a link goes to no file of the repository.
    """

    def to(found: re.Match[str]) -> str:
        words, path, place = found[1], found[2], found[3] or ""
        target = Path(os.path.normpath(page.parent / path))
        name = target.relative_to(ROOT).as_posix()
        if name.startswith("docs/") or name in AROUND:
            inside = AROUND.get(name, name).removeprefix("docs/").replace(".ipynb", ".md")
        elif not target.exists():
            raise FileNotFoundError(f"{page}: there is no {path}")
        elif name not in MADE:
            return words if "`" in words else f"`{name}`"
        else:
            inside = MADE[name]
        here = page.parent.relative_to(DOCS) if page.is_relative_to(DOCS) else Path()
        return f"[{words}]({os.path.relpath(inside, here)}{place})"

    return LINK.sub(to, page.read_text(encoding="utf-8") if written is None else written)


def lay_out(source: Path, *, draft: bool) -> None:
    """Write every page and picture that Sphinx reads; draft : as of `write_live`."""
    from commands import commands
    from gallery import gallery
    from glossary import glossary
    from live import write_live
    from names import names
    from pictures import draw, draw_narrow, for_both_widths
    from split import split
    from topics import write_topics
    from tutorials import tutorials

    source.mkdir(parents=True)
    notebooks = tutorials(DOCS / "tutorials", source / EXTRA / "tutorials", linked)
    pages = {
        **{page.relative_to(DOCS).as_posix(): linked(page) for page in DOCS.rglob("*.md")},
        **{name: linked(ROOT / path) for path, name in AROUND.items()},
        **notebooks,
        **names(),
        "commands.md": commands(),
        "scripts.md": scripts(),
        "glossary.md": glossary(),
    }
    for page in LONG:
        pages = split(pages, page)
    for page in sorted(pages):
        if TABLES_BELOW.search(pages[page]) and page.startswith("model-file/"):
            pages = split(pages, page)
    pages = {name: side_by_side(text) for name, text in pages.items()}
    write_topics(pages, source / EXTRA)
    live = write_live(source / EXTRA, GALLERY, draft=draft)
    shown = gallery({language: pages[page] for language, page in GALLERY.items()}, live)
    if not any(live.values()):
        pages["index.md"] = FRAME.sub("", pages["index.md"])
    pages |= {GALLERY[language]: text for language, text in shown.items()}
    draw(pages.values(), source)
    draw_narrow(pages.values(), source)
    for name, text in pages.items():
        path = source / name
        path.parent.mkdir(parents=True, exist_ok=True)
        marked = ANCHOR.sub(r"(\1)=\n", REPOSITORY_ONLY.sub("", text))
        whole = for_both_widths(SITE_ONLY.sub(r"\1", marked), source)
        path.write_text(whole, encoding="utf-8")
    shutil.copytree(DOCS / "pictures", source / "pictures")
    shutil.copy(DOCS / "api.txt", source)


def side_by_side(text: str) -> str:
    """A page on which a file or a command stands beside the same in Python, where there is room."""

    def halves(both: re.Match[str]) -> str:
        first, second = (WIDE.sub("  # ", half) for half in both.groups())
        return (
            "::::{grid} 1 1 2 2\n:gutter: 2\n:class-container: two-ways\n\n"
            f":::{{grid-item}}\n{first}\n:::\n\n:::{{grid-item}}\n{second}\n:::\n::::\n"
        )

    return TWO_WAYS.sub(halves, text)


def scripts() -> str:
    """The page of the scripts for common tasks."""
    parts = ["# Scripts", "Short programs for common tasks, in `examples` of the repository."]
    for file in sorted((ROOT / "examples").glob("*.py")):
        text = file.read_text(encoding="utf-8").rstrip()
        parts += [f"## {file.stem.replace('_', ' ').capitalize()}", f"```python\n{text}\n```"]
    return "\n\n".join([*parts, ""])


def digest() -> str:
    """What the site is made of: the same as what it was made of last, if nothing has changed."""
    folders = ("docs", "examples", "src")
    files = [file for folder in folders for file in (ROOT / folder).rglob("*.*") if file.is_file()]
    page = "interactive.js"  # which every interactive file carries
    kept = [one for one in files if one.suffix not in {".pyc", ".js", ".map"} or one.name == page]
    every = sorted([*kept, *(ROOT / name for name in AROUND)])
    return sha256(b"".join(map(Path.read_bytes, every))).hexdigest()


def main(*, draft: bool) -> int:
    """Make the site anew, unless nothing has changed; returns 0 if Sphinx warns of nothing.

    draft : as of this module; a whole site that is there will do.
    """
    from sphinx.cmd.build import main as sphinx

    gc.set_threshold(100_000, 50, 50)  # Sphinx keeps what it makes: to look for garbage takes 16 s

    stamp, whole = BUILT / "made-of.txt", digest()
    now = f"{whole} draft" if draft else whole
    if not stamp.exists() or stamp.read_text(encoding="utf-8") not in (now, whole):
        for old in (SOURCE, BUILT):
            shutil.rmtree(old, ignore_errors=True)
        lay_out(SOURCE, draft=draft)
        extra = f"-Dhtml_extra_path={SOURCE / EXTRA}"
        options = ["--quiet", "--fail-on-warning", f"-c{HERE}", f"-d{SOURCE}/.read", extra]
        options += ["-Dtoc_object_entries=0"] * draft
        if status := sphinx([*options, str(SOURCE), str(BUILT)]):
            return status
        stamp.write_text(now, encoding="utf-8")
    print(f"open {BUILT / 'index.html'}")
    return 0


if __name__ == "__main__":
    sys.path[:0] = [str(HERE), str(ROOT / "src")]
    sys.exit(main(draft="--draft" in sys.argv))
