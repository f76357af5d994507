"""Films, read back frame by frame and held to the motion they show."""

from __future__ import annotations

import os
import subprocess
import sys
from io import BytesIO
from typing import Any

import numpy as np
import pytest
from PIL import Image

import equipoise as eq
from equipoise.errors import UsageError
from equipoise.figures.film import gif, mp4
from equipoise.figures.stage import Stage
from equipoise.symbols.looks import DARK, LIGHT, in_turn
from equipoise.symbols.scene import Scene, clear_angle
from support.chosen import EXHAUSTIVE
from support.refusals import refused
from unit.animation.samples import analyzed, of_three_turns, prepared, shown

SMALL = {"seconds": 0.4, "width": 320}
"""Ten frames of a GIF, twelve of an MP4."""


OF_ANY_MEMORY = """
from hashlib import sha256
from equipoise import analyze, load
from equipoise.figures.film import mp4
from equipoise.symbols.scene import Scene
scene = Scene.of(analyze(load("yamashita-1"), 720).motion)
print(sha256(mp4(scene, traced=["P"], seconds=0.4, width=320)).hexdigest())
"""
"""Prints what the bytes of a film are, in a process of its own."""


# Other bytes in another process fail in `test_the_same_bytes_on_every_run` of
# surface/test_animate.py too.
@EXHAUSTIVE
def test_the_bytes_of_a_film_do_not_depend_on_what_was_in_memory() -> None:
    """glibc fills memory that is handed out with other bytes by this variable."""
    pytest.importorskip("av")
    command = [sys.executable, "-c", OF_ANY_MEMORY]
    actual = {
        subprocess.run(command, env={**os.environ, "MALLOC_PERTURB_": filled}, check=True,
                       capture_output=True, text=True, timeout=300).stdout
        for filled in ("0", "85")
    }  # fmt: skip
    assert len(actual) == 1 and len(actual.pop().strip()) == 64


def frames_of_gif(data: bytes) -> list[np.ndarray]:
    with Image.open(BytesIO(data)) as image:
        assert image.info["loop"] == 0
        actual = []
        for number in range(image.n_frames):
            image.seek(number)
            assert image.info["duration"] == 40
            actual.append(np.asarray(image.convert("RGB")))
        return actual


def frames_of_mp4(data: bytes) -> list[np.ndarray]:
    av = pytest.importorskip("av")
    with av.open(BytesIO(data)) as film:
        (stream,) = film.streams.video
        assert stream.codec_context.name == "h264"
        assert stream.average_rate == 30
        assert stream.pix_fmt == "yuv420p"
        frames = [frame.reformat(format="rgb24", src_colorspace=1) for frame in film.decode(stream)]
        return [frame.to_ndarray() for frame in frames]


def color(text: str) -> np.ndarray:
    return np.array([int(text[k : k + 2], 16) for k in (1, 3, 5)])


def check_tip(frames: list[np.ndarray], scene: Scene, shade: str, near: float) -> None:
    """The middle of the tip's sign has its colour where the motion has the tip."""
    stage = Stage(scene, None, len(frames), 320)
    tip = stage.at(shown(scene, scene.places["P"], len(frames)))
    for frame, place in zip(frames, tip, strict=True):
        assert frame.shape == (stage.height, 320, 3)
        result = frame[int(place.imag), int(place.real)].astype(float)
        assert abs(result - color(shade)).max() <= near
        assert abs(frame[0, 0] - color(LIGHT["paper"])).max() <= near


# Links in a film: the test below; bytes of films: tests/surface/test_animate.py.
@pytest.mark.exhaustive
def test_a_gif_shows_the_motion_in_steady_colors() -> None:
    _, scene, _ = analyzed("yamashita-1", 720)
    data = gif(scene, traced=["P"], **SMALL)
    assert data == gif(scene, traced=["P"], **SMALL)
    frames = frames_of_gif(data)
    assert len(frames) == 10
    check_tip(frames, scene, LIGHT["main"], 0)
    assert len({tuple(shade) for frame in frames for shade in frame.reshape(-1, 3)}) <= 256


@pytest.mark.parametrize(("kind", "near"), [("gif", 0), ("mp4", 60)])
def test_links_that_cover_each_other_are_below_each_other(kind: str, near: float) -> None:
    """Each walker has its tip where it is at the same instant as those of the others."""
    film, read = {"gif": (gif, frames_of_gif), "mp4": (mp4, frames_of_mp4)}[kind]
    _, scene, _ = analyzed("straw-walker", 720)
    tips = ["T1", "T2", "T3", "T4"]
    frames = read(film(scene, traced=tips, **SMALL))
    begin, top = clear_angle(scene), 0
    for (_, part), tip in zip(in_turn(scene, begin), tips, strict=True):
        stage = Stage(part, None, len(frames), 320, begin)
        places = stage.at(scene.places[tip])[stage.chosen[:-1] % 720]
        for frame, place in zip(frames, places, strict=True):
            shown = frame[top + int(place.imag), int(place.real)].astype(float)
            assert np.abs(shown - color(LIGHT["main"])).max() <= near
        top += stage.height
    assert {frame.shape[0] for frame in frames} == {top}
    with refused(UsageError, kind="point", given="T9"):
        film(scene, traced=["T9"], **SMALL)


def test_a_film_shows_the_motion() -> None:
    pytest.importorskip("av")
    _, scene, _ = analyzed("yamashita-1", 720)
    data = mp4(scene, traced=["P"], **SMALL)
    assert data == mp4(scene, traced=["P"], **SMALL)
    frames = frames_of_mp4(data)
    assert len(frames) == 12
    check_tip(frames, scene, LIGHT["main"], 45)  # hues are stored for two by two pixels


def test_a_film_takes_as_many_turns_as_given_and_has_even_sides() -> None:
    pytest.importorskip("av")
    _, scene, arrow = prepared(of_three_turns(60))
    texts: list[tuple[int, int]] = []
    options = {"seconds": 0.2, "width": 201, "arrow": arrow, "dark": True}
    whole = frames_of_mp4(mp4(scene, progress=lambda *count: texts.append(count), **options))
    assert len(whole) == 3 * 6
    assert texts == [(done, 18) for done in range(1, 19)]
    assert all(side % 2 == 0 for side in whole[0].shape[:2])
    assert abs(whole[0][0, 0] - color(DARK["paper"]).astype(float)).max() < 4
    longer = frames_of_mp4(mp4(scene, turns=4, **options))
    assert len(longer) == 4 * 6
    difference = abs(longer[18].astype(float) - longer[0])
    assert difference.mean() < 1  # after three turns all is as it was
    assert abs(longer[6].astype(float) - longer[0]).mean() > 2 * difference.mean()


def test_the_colors_and_the_ground_of_a_dark_gif() -> None:
    _, scene, arrow = analyzed("geared-counterweight", 720)
    frames = frames_of_gif(gif(scene, arrow=arrow, dark=True, seconds=0.4, width=640))
    assert len(frames) == 10
    for name in DARK.keys() - {"main", "soil", "earth"}:
        assert np.any(np.all(frames[3] == color(DARK[name]), axis=-1)), name


def test_part_of_a_turn_goes_there_and_back() -> None:
    motion = eq.move(eq.load("yamashita-1"), np.radians(np.linspace(20, 140, 121)))
    frames = frames_of_gif(gif(Scene.of(motion), traced=["P"], seconds=0.6, width=320))
    assert len(frames) == 2 * 5
    for k in range(1, 5):
        assert np.array_equal(frames[k], frames[-k])
    assert not np.array_equal(frames[0], frames[5])


@pytest.mark.parametrize("kind", [gif, mp4])
@pytest.mark.parametrize(
    ("options", "expected"),
    [
        ({"seconds": 500.0}, {"width": 640, "most": 1464}),
        ({"seconds": float("nan")}, {"most_seconds": 600}),
        ({"width": 50}, {"width": 50, "low": 100}),
        ({"traced": ["Q"]}, {"given": "Q"}),
    ],
)
def test_what_cannot_be_filmed_is_reported(
    kind, options: dict[str, object], expected: dict[str, Any]
) -> None:
    pytest.importorskip("av")
    _, scene, _ = analyzed("yamashita-1", 720 if "seconds" not in options else 30_000)
    with refused(UsageError, **expected):
        kind(scene, **options)


def test_there_are_as_many_crank_angles_as_frames() -> None:
    _, scene, _ = analyzed("yamashita-1", 90)
    with refused(UsageError, angles="90", frames="100"):
        gif(scene, seconds=4.0)


def test_a_missing_library_is_reported_with_the_command_that_installs_it(monkeypatch) -> None:
    monkeypatch.setitem(sys.modules, "av", None)
    _, scene, _ = analyzed("yamashita-1", 90)
    with refused(UsageError, command='pip install "equipoise[video]"', library="av"):
        mp4(scene)
