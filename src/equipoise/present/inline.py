"""Pictures of Matplotlib as parts of a page: no names that clash, and the page's own colours."""

from __future__ import annotations

import re
from html import escape

from equipoise.figures.style import GRID, STUBBLE
from equipoise.symbols.looks import DARK, LIGHT

NAMES = {color: name for name, color in LIGHT.items()} | {GRID: "grid", STUBBLE: "stubble"}
"""Colour of a picture -> name of the page's property that takes its place."""
DARK_ONLY = {"grid": "#2b3138", "soil": "#332c20", "stubble": "#57492f", "earth": "#c9a774"}

_COLOR = re.compile("#[0-9a-f]{6}(?=[;\"' ])")
_USED = re.compile(r'(?:url\(#|href="#)([^)"]+)')
_NAME = re.compile(r' id="([^"]*)"')
_SPACE = re.compile(r"\n\s*")
_FAMILY = re.compile('font-family: [^;"]*; ?')


def inlined(svg: str, name: str, title: str) -> str:
    """A picture as a part of a page.

    name : no other picture of the page has it.  title : what it shows, for those who cannot see.
    """
    head, body = svg[svg.index("<svg") :].split(">", 1)
    body = re.sub(r"<metadata>.*?</metadata>", "", body, count=1, flags=re.DOTALL)
    body = re.sub(r"<defs>\s*<style.*?</style>\s*</defs>", "", body, count=1, flags=re.DOTALL)
    body = body.replace("xlink:href", "href")
    body = _FAMILY.sub("", body)
    used = set(_USED.findall(body))
    body = _NAME.sub(lambda found: _named(found[1], name) if found[1] in used else "", body)
    body = body.replace("url(#", f"url(#{name}-").replace('href="#', f'href="#{name}-')
    body = _COLOR.sub(lambda found: _colored(found[0]), body)
    width, height = re.findall(r'viewBox="0 0 ([0-9.]+) ([0-9.]+)"', head)[0]
    opening = (
        f'<svg xmlns="http://www.w3.org/2000/svg" role="img" aria-label="{escape(title)}" '
        f'viewBox="0 0 {width} {height}" style="--wide:{float(width):.0f}pt">'
    )
    return _SPACE.sub(" ", f"{opening}{body}").strip()


def _named(own: str, name: str) -> str:
    return f' id="{name}-{own}"'


def _colored(color: str) -> str:
    return f"var(--linkage-{NAMES[color]},{color})" if color in NAMES else color


def colors(dark: bool) -> str:
    """The properties of a page, as a style sheet has them."""
    chosen = {**DARK, **DARK_ONLY} if dark else {**LIGHT, **{v: k for k, v in NAMES.items()}}
    return ";".join(f"--linkage-{name}:{color}" for name, color in chosen.items())
