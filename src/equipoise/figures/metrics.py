"""How wide texts are, without drawing them: the widths of the signs of DejaVu Sans.

It is the font that everybody has who has Matplotlib; a browser that takes another one of its kind
sets texts at most a little narrower.
"""

from __future__ import annotations

from textwrap import wrap

from equipoise.figures.sheet import Box, Words

_WIDTHS = {
    0.28: "'ijlìíîïıł",
    0.3: "IJÌÍÎÏΙ",
    0.32: " ,.\u00a0·‘’",
    0.34: "/:;\\|¦ι",
    0.36: "f-",
    0.4: "()[]t!¡²³¹⁰⁴⁵⁶⁷⁸⁹",
    0.42: "rř",
    0.46: '"ªº',
    0.5: "*_`§¨¯°´¸–",
    0.53: "szśšźżž“”?¿⁻",
    0.55: "cçćčέεζ",
    0.57: "LŁΓνξFkκ",
    0.6: "vxyýÿγλςχPΡπτ•",
    0.62: "TYaoeèéêëęěÝàáâãäåāąòóôõöøőŸΤΥδθο«»",
    0.64: "ESbdghnpquÈÉÊËßñùúûüđğńňŚŞŠũūůűΕΞΣήηρσ$0123456789{}¢£¤¥µ¶βμ√",
    0.68: "KΚάαφψAVÀÁÂÃÄÅĄΑΔΛ",
    0.7: "BRXZŘŹŻŽΒΖΧCÇĆČ",
    0.75: "UÙÚÛÜŮŰHNÑŃŇΗΝΠΩ",
    0.79: "DGÐĎ&OQÒÓÔÕÖØŐΘΟΦΨ",
    0.84: "w∞#+<=>^~¬±×÷ω−≤≥→←≈MΜ",
    1.0: "%mæ@©®—…WŒœÆ¼½¾",
}
"""Over the size of type."""
_WIDTH = {sign: width for width, signs in _WIDTHS.items() for sign in signs}
_OTHER, _FULL, _EAST = 0.65, 1.0, 0x1100
"""Width of other signs, and of those of East Asia, which begin there."""
_BOLD = 1.12
UP, DOWN = 0.76, 0.22
"""Height above and depth below the base line, over the size of type."""
LEAST = 0.82
"""Share of its size to which a text is shrunk before it is cut."""
LAST = 12
"""Signs of a word that is left out as a whole, where a text is cut in it."""


def width_of(text: str, size: float, bold: bool = False) -> float:
    """Points."""
    ems = sum(
        _WIDTH[sign] if sign in _WIDTH else _FULL if ord(sign) >= _EAST else _OTHER for sign in text
    )
    return ems * size * (_BOLD if bold else 1.0)


def box_of(words: Words) -> Box:
    """Left, top, right and bottom of a text on its sheet."""
    wide = width_of(words.text, words.size, words.bold)
    before = {"start": 0.0, "middle": 0.5, "end": 1.0}[words.anchor] * wide
    up, down = UP * words.size, DOWN * words.size
    if words.turned:
        return words.x - up, words.y + before - wide, words.x + down, words.y + before
    return words.x - before, words.y - up, words.x - before + wide, words.y + down


def fitted(text: str, room: float, size: float, bold: bool = False) -> str:
    """A text cut to some points."""
    if width_of(text, size, bold) <= room:
        return text
    while text and width_of(text + "…", size, bold) > room:
        share = room / width_of(text + "…", size, bold)
        text = text[: max(0, min(len(text) - 1, int(len(text) * share)))]
    whole = text.rpartition(" ")[0] if " " in text[-LAST:] else text
    return f"{whole.rstrip()}…"


def set_in(text: str, room: float, size: float, bold: bool = False) -> tuple[str, float]:
    """A text and its size: shrunk a little, then cut, so that it fits into some points."""
    wide = width_of(text, size, bold)
    if wide > room:
        size *= max(LEAST, 0.99 * room / wide)
    return fitted(text, room, size, bold), size


def lines_of(text: str, room: float, size: float, most: int) -> list[str]:
    """A text in lines that fit into some points; the last of them is cut where there is more."""
    if width_of(text, size) <= room:
        return [text]
    count = int(len(text) * room / width_of(text, size))
    while count > LAST:
        lines = wrap(text, count) or [""]
        if all(width_of(line, size) <= room for line in lines[:most]):
            break
        count -= 1
    else:
        lines = [text]
    if len(lines) > most:
        lines = [*lines[: most - 1], " ".join(lines[most - 1 :])]
    return [fitted(line, room, size) for line in lines]
