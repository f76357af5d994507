"""Pictures of odd machines, odd names, and texts that keep clear of each other."""

from __future__ import annotations

from itertools import combinations, pairwise
from xml.etree import ElementTree

import numpy as np
import pytest
from matplotlib.figure import Figure

from equipoise.figures.labels import Labels, spread
from equipoise.planting.summary import plant
from equipoise.plotting.crank import angle_step
from equipoise.plotting.planting import drawings
from equipoise.plotting.style import LARGE, SMALLEST, blank, heading, render, styled
from equipoise.symbols.scene import hull
from unit.plotting.samples import BUNDLED, drawn, long_cycle, odd_machines, one_link, texts, words


@pytest.mark.parametrize("kind", odd_machines())
def test_odd_machines(kind: str) -> None:
    figures = plant(odd_machines()[kind])
    for name, figure in drawings(figures).items():
        ElementTree.fromstring(render(figure, "svg"))
        check_texts(name, figure)
    told = words(drawings(figures)["path"])
    assert ("pick-up" in told and "release" in told) == (kind == "tray")
    assert ("other units" in told) == (kind == "two units")


def test_a_cycle_of_several_turns_is_drawn_whole() -> None:
    figures = plant(long_cycle())
    assert figures.curve.turns == 3
    axes = drawings(figures)["velocity"].axes[0]
    assert axes.get_xlim() == (0, 1080)
    assert [angle_step(turns) for turns in (1, 2, 3, 100)] == [30, 60, 90, 3600]
    assert angle_step(10**5) == 360 * 10**5


ODD_TITLES = (
    r"Costs $5 and $10, 100 % of \alpha_{1}^2 #&~ <b>'\"</b>",
    "田植機の植付機構 モデル一号",
    "이앙기 식부장치 🌾 עברית",
    "long " * 39,
)


@pytest.mark.parametrize("title", ODD_TITLES)
def test_odd_titles_and_names(title: str) -> None:
    """Nothing is read as a formula, and signs that no font has are no warning."""
    figures = plant(one_link(title, link="$cr_a$nk 軸", tip="$T_1$ 先"))
    for name, figure in drawings(figures).items():
        svg = render(figure, "svg")
        shown = "".join(ElementTree.fromstring(svg).itertext())
        assert title[:20] in shown, name
        check_texts(name, figure)
        if name == "path":
            render(figure, "png")
            render(figure, "pdf")
    assert "$T_1$ 先" in words(drawings(figures)["path"])


@pytest.mark.parametrize("name", BUNDLED)
def test_texts_keep_clear_of_each_other(name: str) -> None:
    for picture, figure in drawn(name).items():
        check_texts(picture, figure)


def check_texts(name: str, figure: Figure) -> None:
    """No text leaves the picture, and none covers another."""
    with styled():
        figure.draw_without_rendering()
        boxes = [(text.get_text(), text.get_window_extent()) for text in texts(figure)]
    width, height = figure.get_size_inches() * figure.dpi
    for text, box in boxes:
        assert box.x0 >= 0 and box.y0 >= 0 and box.x1 <= width and box.y1 <= height, (name, text)
    for (one, a), (other, b) in combinations(boxes, 2):
        across = min(a.x1, b.x1) - max(a.x0, b.x0)
        up = min(a.y1, b.y1) - max(a.y0, b.y0)
        assert across <= 1 or up <= 4, (name, one, other)


def test_texts_side_by_side() -> None:
    assert list(spread([1, 5, 9], [2, 2, 2], 0, 10)) == [1, 5, 9]
    placed = spread([5.2, 5.0, 5.1], [2, 1, 3], 0, 10)
    assert list(np.argsort(placed)) == [1, 2, 0]
    ordered = sorted(zip(placed, (2, 1, 3), strict=True))
    assert all(b - a >= (u + v) / 2 - 1e-6 for (a, u), (b, v) in pairwise(ordered))


def test_texts_without_room() -> None:
    crowd = spread([0, 0, 0], [5, 5, 5], 0, 10)
    assert np.all((crowd >= 2.5) & (crowd <= 7.5))
    axes = blank(1.0, 1.0).add_axes((0, 0, 1, 1))
    labels = Labels(axes)
    labels.reserve(0.5, 0.5, half=100)
    labels.put("no room", 0.5, 0.5, optional=True)
    assert not axes.texts
    labels.put("all the same", 0.5, 0.5)
    assert [text.get_text() for text in axes.texts if text.get_text()] == ["all the same"]


def test_hull() -> None:
    square = np.array([0, 1, 1 + 1j, 1j])
    assert list(hull(np.array([*square, 0.5 + 0.5j, 0.5, 1j]))) == list(square)
    assert list(hull(np.array([0, 0.5 + 0.5j, 1 + 1j]))) == [0, 1 + 1j]
    assert list(hull(np.array([2j, 2j]))) == [2j]


def test_long_headings_shrink_before_they_are_cut() -> None:
    with styled():
        figure = blank(6.0, 3.0)
        heading(
            figure, "Planting mechanism type II, to be found (Yamashita, Ichikawa)", "w" * 200, 0.8
        )
    title, what = figure.texts
    assert title.get_text().endswith("Ichikawa)") and title.get_fontsize() < LARGE
    assert what.get_text().endswith("w…") and what.get_fontsize() == SMALLEST
    assert all(text.get_window_extent().x1 <= figure.bbox.x1 for text in figure.texts)
