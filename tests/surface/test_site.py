"""The documentation site: it has everything that there is to document, and its pages agree."""

from __future__ import annotations

import html
import importlib
import io
import re
import runpy
import shlex
from doctest import ELLIPSIS, NORMALIZE_WHITESPACE, DocTestParser, DocTestRunner
from pathlib import Path
from urllib.parse import urlsplit

import pytest

from equipoise.cli import COMMANDS, app
from equipoise.i18n import say, speaking
from equipoise.i18n.terms import MEANINGS, TERMS
from equipoise.schema.open_files import bundled
from support.languages import COMPLETE
from unit.test_public_names import NAMES

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"
PAGES = [*sorted(DOCS.rglob("*.md")), *(ROOT / name for name in ("README.md", "CONTRIBUTING.md"))]
GALLERY = {"en": "examples", "ja": "ja/examples", "ko": "ko/examples"}
lessons = runpy.run_path(str(DOCS / "site" / "lessons.py"))["lessons"]


def source(language: str) -> str:
    """The page of the gallery in a language, in Markdown."""
    return (DOCS / f"{GALLERY[language]}.md").read_text(encoding="utf-8")


def test_it_has_every_command_and_every_public_name(site: Path) -> None:
    text = (site / "commands.html").read_text(encoding="utf-8")
    assert [name for name in COMMANDS if f'id="equipoise-{name}"' not in text] == []
    names = "".join(page.read_text(encoding="utf-8") for page in site.glob("api/*.html"))
    ids = {match.rpartition(".")[2] for match in re.findall(r'<dt [^>]*id="([\w.]+)"', names)}
    assert {name.rpartition(".")[2] for name in NAMES} <= ids


FIRST = ("load", "analyze", "balance", "respond", "modes", "move", "plant", "report", "save")
"""Names that are used first."""


def test_public_names_stand_in_tables_and_have_examples(site: Path) -> None:
    """Each room lists its names with what they are, and each function its parameters."""
    for page in site.glob("api/*.html"):
        text = page.read_text(encoding="utf-8")
        described = len(re.findall(r'<dl class="py (?:class|function)">', text))
        names = re.search(r'<table class="names.*?</table>', text, re.DOTALL)
        assert names is not None and names[0].count("<tr") >= described, page.name
    text = "".join(page.read_text(encoding="utf-8") for page in site.glob("api/*.html"))
    blocks = re.split(r'(?=<dl class="py (?:class|function)">)', text)
    own = {
        key: block for block in blocks for key in re.findall(r'<dt [^>]*id="([\w.]+)"', block)[:1]
    }
    shown = {
        name.rpartition(".")[2] for name, block in own.items() if 'class="highlight-pycon' in block
    }
    assert {*FIRST} <= shown and len(shown) > 90
    assert re.search(r"<td>(?:(?!</td>).)*>angles<", own["equipoise.analyze"], re.DOTALL)


@pytest.mark.documentation
def test_examples_of_public_names_do_what_they_show(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """Each by itself, though it is taken out of a page."""
    monkeypatch.syspath_prepend(str(DOCS / "site"))
    names = importlib.import_module("names")
    samples = {sample.lines for sample in names.samples_of(names.every_name()).values()}
    monkeypatch.chdir(tmp_path)
    assert len(samples) > 40
    for lines in samples:
        test = DocTestParser().get_doctest("\n".join([*lines, ""]), {}, lines[-1], None, 0)
        said = io.StringIO()
        flags = ELLIPSIS | NORMALIZE_WHITESPACE
        result = DocTestRunner(verbose=False, optionflags=flags).run(test, out=said.write)
        assert result.failed == 0, said.getvalue()


def test_options_and_values_stand_as_they_are_typed(site: Path) -> None:
    """Two hyphens are no dash, and quotes of a value are those of a shell."""
    for page in site.rglob("*.html"):
        assert re.findall(r".{20}[–—][a-z].{20}", page.read_text(encoding="utf-8")) == [], page.name
    text = (site / "commands.html").read_text(encoding="utf-8")
    assert re.findall(r".{20}[“”‘].{20}", text) == []
    assert "With --json: add the contributions to every force by cause and by link." in text


def test_the_glossary_has_every_term_and_its_meaning_in_every_language(site: Path) -> None:
    """As the catalogues say it, and none in English where it is to be in another language."""
    text = (site / "glossary.html").read_text(encoding="utf-8")
    cells = re.findall(r"<strong>(.*?)</strong>(?:<br>)?(.*?)(?:</p>)?</td>", text)
    shown = {(html.unescape(term), html.unescape(meaning)) for term, meaning in cells}
    for language in COMPLETE:
        for term, meaning in (TERMS | MEANINGS).items():
            with speaking(language):
                said, means = say(term, name="B"), say(meaning)
            assert (said, means) in shown, said  # A(8) is called so in every language
            assert language == "en" or means != meaning


def test_every_table_of_the_model_file_has_a_page(site: Path) -> None:
    """Those in other tables too."""
    text = (DOCS / "model-file.md").read_text(encoding="utf-8")
    headings = re.findall(r"^##+ `(\[.+\])`$", text, re.MULTILINE)
    pages = [page.read_text(encoding="utf-8") for page in (site / "model-file").rglob("*.html")]
    tops = [re.findall(r"<h1>(?:<code.*?>)?(.*?)<a class", page)[0] for page in pages]
    shown = {re.sub("<.*?>", "", top) for top in tops}
    assert len(headings) > 40
    assert [heading for heading in headings if heading not in shown] == []


@pytest.mark.parametrize("language", GALLERY)
def test_the_gallery_has_every_example_with_its_picture(site: Path, language: str) -> None:
    page = site / f"{GALLERY[language]}.html"
    text = page.read_text(encoding="utf-8")
    assert f'lang="{language}"' in text.partition("<head>")[0]
    body = text[text.index("<article") : text.index("</article")]
    pictures = re.findall(r'<img alt="[^"]+" loading="lazy" src="([^"]+\.svg)"', body)
    assert len(pictures) == len(bundled())
    assert all((page.parent / picture).is_file() for picture in pictures)
    reported = lessons(source(language))
    assert {*reported} == {*bundled()}
    assert [name for name in reported if f">{name}<" not in body] == []


def test_every_machine_of_the_gallery_opens_live(site: Path) -> None:
    """By its file where there is one, and by the live page of the site around it."""
    names = set[str]()
    for language, name in GALLERY.items():
        page = site / f"{name}.html"
        text = page.read_text(encoding="utf-8")
        files = re.findall(r'<a class="open-live" href="([^"]+)"', text)
        assert len(files) == len([*(site / "live" / language).glob("*.html")]) > 10
        for file in files:
            live = (page.parent / file).read_text(encoding="utf-8")
            assert f'<html lang="{language}">' in live and "function states(" in live
        names |= {Path(item).stem for item in files}
        top = "../" if language == "en" else "../../"
        pages = re.findall(r'<a class="open-page" hidden href="([^"]+)"', text)
        assert pages == [f"{top}#example={name}" for name in lessons(source(language))]
    assert len(names) > 30


@pytest.mark.parametrize("name", bundled())
def test_what_is_to_be_tried_is_a_command(name: str) -> None:
    """With options that it has."""
    _, to_try = lessons((DOCS / "examples.md").read_text(encoding="utf-8"))[name]
    words = shlex.split(to_try.strip("`"))
    assert words[0] == "equipoise"
    app.parse_args(words[1:], exit_on_error=False, print_error=False)


@pytest.mark.parametrize("folder", ["", "ja", "ko"])
def test_the_first_hour_writes_the_file_that_is_bundled(folder: str) -> None:
    """Every line of its tables, comments aside."""
    page = (DOCS / folder / "first-machine.md").read_text(encoding="utf-8")
    tables = "".join(re.findall(r"```toml\n(.*?)```", page, re.DOTALL))
    written = re.sub(r" +#.*| {2,}", "", tables).replace("\n\n", "\n").splitlines()
    there = bundled()["sieve"].read_text("utf-8").splitlines()
    assert [line for line in written if line not in there and "title" not in line] == []


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.relative_to(ROOT).as_posix())
def test_links_to_other_sites_are_addresses(page: Path) -> None:
    """They are not asked for; those between pages are checked when the site is made."""
    for link in re.findall(r"\]\((\w+:[^)]*)\)", page.read_text(encoding="utf-8")):
        address = urlsplit(link)
        assert address.scheme == "https" and "." in address.netloc and " " not in link, link
