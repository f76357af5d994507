"""Films of a linkage: GIF, and MP4 with the extra `video`; the same bytes on every run."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Sequence
from io import BytesIO
from itertools import combinations, cycle, groupby, islice
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg, RendererAgg
from matplotlib.colors import to_rgb, to_rgba
from matplotlib.figure import Figure
from matplotlib.path import Path
from matplotlib.patheffects import withStroke
from matplotlib.transforms import Affine2D

from equipoise.errors import UsageError, needed
from equipoise.figures.animation import Moving, MovingGroup, PixelPath, laid_out, traced_in
from equipoise.figures.paint import settings
from equipoise.figures.stage import RATES, ForceArrow, check_seconds, check_width, in_a_turn
from equipoise.i18n import Note
from equipoise.signals import Array
from equipoise.symbols.looks import DARK, LIGHT, LOOKS, Colors, Look, in_turn
from equipoise.symbols.scene import clear_angle

if TYPE_CHECKING:
    from equipoise.symbols.scene import Scene

FrameProgress = Callable[[int, int], None]

MOST_PIXELS = 600_000_000
"""In all frames of a film, each taken as square."""
MOST_COLORS = 255
"""In a GIF, and the number of one that is not known yet."""
ENCODING = {"crf": "18", "threads": "1", "bf": "0", "mbtree": "0"}
"""Options of the encoder: how good, and that its bytes are the same on every run: x264 reads memory
that it has not set where it weighs macroblocks by later frames (`mbtree`), and where frames are
predicted from later ones."""
BT_709 = 1
"""Number of the standard by which players turn a film's brightness and hue into colours."""


def gif(
    scene: Scene,
    *,
    traced: Collection[str] = (),
    seconds: float = 2.0,
    width: int = 640,
    arrow: ForceArrow | None = None,
    dark: bool = False,
    progress: FrameProgress | None = None,
) -> bytes:
    """The whole cycle as a GIF that begins anew for ever.

    Parameters
    ----------
    traced : points whose path is drawn.
    seconds : for a turn of the crank.
    width : pixels.
    arrow : the shaking force, where it is wanted.
    dark : light lines on a dark ground.
    progress : called with how many frames are done, and how many there are.

    Raises
    ------
    UsageError : there is no such point, or too many pixels would have to be drawn.
    """
    from PIL import Image

    pieces = _prepared(scene, traced, seconds, "gif", width, arrow)
    colors = DARK if dark else LIGHT
    count = _in_a_cycle(pieces[0])
    check_frames(count * len(pieces), width)
    shades = Shades(pieces, colors)
    pictures = []
    for frame in _counted(_cycle(pieces, colors), count, progress):
        picture = Image.fromarray(shades.numbers(frame))
        picture.putpalette(shades.palette.tobytes())
        pictures.append(picture)
    file = BytesIO()
    first, others = pictures[0], pictures[1:]
    delay = 1000 // RATES["gif"]
    first.save(file, "GIF", save_all=True, append_images=others, duration=delay, loop=0)
    return file.getvalue()


def mp4(
    scene: Scene,
    *,
    traced: Collection[str] = (),
    seconds: float = 2.0,
    turns: int | None = None,
    width: int = 640,
    arrow: ForceArrow | None = None,
    dark: bool = False,
    progress: FrameProgress | None = None,
) -> bytes:
    """A film as MP4 (H.264); needs the extra `video`.

    turns : of the crank; the whole cycle if None.  The rest as in `gif`.

    Raises
    ------
    UsageError : as in `gif`, or the extra is missing.
    """
    av = needed("av", "a film as MP4")
    width += width % 2  # both sides are even, as hues are stored for two by two pixels
    pieces = _prepared(scene, traced, seconds, "mp4", width, arrow)
    whole = _in_a_cycle(pieces[0])
    count = whole if turns is None else max(1, round(whole * turns / pieces[0].stage.turns))
    check_frames(count * len(pieces), width)
    frames = islice(cycle(_cycle(pieces, DARK if dark else LIGHT)), count)
    file = BytesIO()
    with av.open(file, "w", "mp4", options={"fflags": "+bitexact"}) as film:
        stream = film.add_stream("libx264", RATES["mp4"], ENCODING)
        stream.width, stream.height = width, sum(piece.stage.height for piece in pieces)
        stream.pix_fmt = "yuv420p"
        for name in ("colorspace", "color_primaries", "color_trc"):
            setattr(stream.codec_context, name, BT_709)
        for number, frame in enumerate(_counted(frames, count, progress)):
            picture = av.VideoFrame.from_ndarray(frame, "rgb24")
            picture = picture.reformat(format="yuv420p", dst_colorspace=BT_709)
            picture.pts = number
            film.mux(stream.encode(picture))
        film.mux(stream.encode())
    return file.getvalue()


def _prepared(
    scene: Scene,
    traced: Collection[str],
    seconds: float,
    kind: str,
    width: int,
    arrow: ForceArrow | None,
) -> list[Moving]:
    """The scene; or those below each other whose links would cover each other in one."""
    check_seconds(seconds)
    check_width(width)
    frames = in_a_turn(kind, seconds)
    begin = clear_angle(scene)
    pieces = [
        laid_out(part, traced_in(part, scene, traced), frames, width, arrow, begin)
        for _, part in in_turn(scene, begin)
    ]
    moving = pieces[0]
    if round(frames * moving.stage.turns) > (angles := len(scene.crank_angle)):
        raise UsageError(
            Note(
                "got {angles} crank angles, too few for {frames} frames in a turn; give "
                "more of them",
                angles=angles,
                frames=frames,
            )
        )
    return pieces


def _in_a_cycle(moving: Moving) -> int:
    """Frames until the motion is where it began; without a cycle it goes back the way it came."""
    steps = len(moving.stage.times) - 1
    return steps if moving.stage.closed else 2 * steps


def _cycle(pieces: Sequence[Moving], colors: Colors) -> Iterator[Array]:
    frame_parts = zip(*(draw_frames(piece, colors) for piece in pieces), strict=True)
    frames = (parts[0] if len(parts) == 1 else np.vstack(parts) for parts in frame_parts)
    if pieces[0].stage.closed:
        return frames
    there = list(frames)
    return iter(there + there[-2:0:-1])


def _counted(
    frames: Iterator[Array], count: int, progress: FrameProgress | None
) -> Iterator[Array]:
    for done, frame in enumerate(frames, 1):
        yield frame
        if progress is not None:
            progress(done, count)


# -- colours of a GIF ------------------------------------------------------------------------------


class Shades:
    """Every colour that is drawn with, and what lies between two of them where edges are smooth.

    All frames share them, so that nothing flickers.

    palette : (n, 3) uint8.
    """

    def __init__(self, pieces: Sequence[Moving], colors: Colors) -> None:
        named = sorted(set().union(*map(_colors, pieces)), key=list(colors).index)
        few = [np.frombuffer(bytes.fromhex(colors[name][1:]), np.uint8) for name in named]
        between = (MOST_COLORS - len(few)) * 2 // (len(few) * (len(few) - 1))
        parts = np.arange(1, between + 1)[:, None] / (between + 1)
        mixed = [
            item + (other.astype(float) - item) * parts for item, other in combinations(few, 2)
        ]
        self.palette = np.round(np.vstack([*few, *mixed])).astype(np.uint8)
        self._known = np.full(1 << 24, MOST_COLORS, np.uint8)

    def numbers(self, frame: Array) -> Array:
        """(height, width, 3) uint8 -> number of the nearest colour, (height, width) uint8."""
        codes = frame.astype(np.uint32) @ np.array([1 << 16, 1 << 8, 1], np.uint32)
        values = self._known[codes]
        new = np.unique(codes[values == MOST_COLORS])
        if not new.size:
            return values
        few = np.stack([new >> 16, new >> 8 & 255, new & 255], axis=-1).astype(np.int32)
        apart = few[:, None] - self.palette.astype(np.int32)
        self._known[new] = np.sum(apart**2, axis=-1).argmin(axis=-1)
        return self._known[codes]


def _colors(moving: Moving) -> set[str]:
    """Names of those that are drawn with."""
    looks = [LOOKS[stroke.role] for part in moving.parts for stroke in part.strokes]
    names = {name for look in looks for name in (look.fill, look.line) if name is not None}
    return names | {label.color for label in moving.labels} | {"paper"}


# -- how long, how large and how many frames a film may be -----------------------------------------


def check_frames(count: int, width: int) -> None:
    """Raise `UsageError` if that is too much to draw."""
    most = MOST_PIXELS // width**2
    if count > most:
        raise UsageError(
            Note(
                "the film has {count} frames; {width} pixels wide it can have {most}: "
                "give a shorter time, fewer turns, or a smaller width",
                count=count,
                width=width,
                most=most,
            )
        )


Brushed = tuple[Any, Path, Any]
"""Brush, path, and colour of the inside or none."""
DOTS = 72
"""An inch, so that a point is a pixel."""


def draw_frames(moving: Moving, colors: Colors = LIGHT) -> Iterator[Array]:
    """Frames of the motion, each (height, width, 3) uint8; none of them twice."""
    stage = moving.stage
    canvas: Any = RendererAgg(stage.width, stage.height, DOTS)  # type: ignore[no-untyped-call]
    behind, before = (
        [(part, list(_brushed(canvas, part, colors, stage.unit))) for part in parts]
        for parts in (moving.behind, moving.before)
    )
    texts, cover = _texts(moving, colors)
    upright = Affine2D().scale(1, -1).translate(0, stage.height)
    image = np.asarray(canvas.buffer_rgba())
    ground = [round(255 * part) for part in to_rgba(colors["paper"])]

    def draw(parts: list[tuple[MovingGroup, list[Brushed]]], instant: int) -> None:
        for part, strokes in parts:
            placed = _placed(part, instant) + upright
            for brush, path, fill in strokes:
                canvas.draw_path(brush, path, placed, fill)

    for instant in range(len(stage.times) - stage.closed):
        image[:] = ground
        draw(behind, instant)
        draw(before, instant)
        image[cover] = np.round(texts + (1 - texts[:, 3:] / 255) * image[cover])
        yield image[..., :3].copy()


def _placed(part: MovingGroup, instant: int) -> Affine2D:
    moves = part.moves
    if moves is None:
        return Affine2D()
    place = moves.place[instant]
    stretched = Affine2D().scale(moves.stretch[instant], 1)
    return stretched.rotate(moves.angle[instant]).translate(place.real, place.imag)


def _brushed(canvas: Any, part: MovingGroup, colors: Colors, unit: float) -> Iterator[Brushed]:
    for role, run in groupby(part.strokes, lambda stroke: stroke.role):
        look = LOOKS[role]
        path = Path.make_compound_path(*map(_path, run))
        fill = None if look.fill is None else to_rgb(colors[look.fill])
        yield _brush(canvas, look, colors, unit), path, fill


def _path(shape: PixelPath) -> Path:
    if shape.radius:
        return Path.circle((shape.points[0].real, shape.points[0].imag), shape.radius)
    corners = np.column_stack([shape.points.real, shape.points.imag])
    return Path(np.vstack([corners, corners[:1]]), closed=True) if shape.closed else Path(corners)


def _brush(canvas: Any, look: Look, colors: Colors, unit: float) -> Any:
    brush = canvas.new_gc()
    brush.set_snap(False)  # lines that move must not jump from pixel to pixel
    brush.set_joinstyle("round")
    brush.set_capstyle("butt" if look.dashes or look.flat else "round")
    brush.set_linewidth(look.width * unit if look.line else 0)
    brush.set_foreground(colors[look.line or "ink"])
    if look.dashes:
        brush.set_dashes(0, [length * unit for length in look.dashes])
    return brush


def _texts(moving: Moving, colors: Colors) -> tuple[Array, Array]:
    """Pixels (P, 4) that texts cover, their colours already weighed, and which (height, width)."""
    stage = moving.stage
    with settings():
        figure = Figure(figsize=(stage.width / DOTS, stage.height / DOTS), dpi=DOTS)
        figure.patch.set_alpha(0)
        canvas: Any = FigureCanvasAgg(figure)
        for label in moving.labels:
            figure.text(
                label.place.real / stage.width,
                1 - label.place.imag / stage.height,
                label.text,
                fontsize=stage.size_of_type,
                color=colors[label.color],
                ha={"start": "left", "middle": "center", "end": "right"}[label.anchor],
                va="center",
                path_effects=[withStroke(linewidth=3 * stage.unit, foreground=colors["paper"])],
            )
        canvas.draw()
    image = np.asarray(canvas.buffer_rgba()).astype(float)
    cover = image[..., 3] > 0
    pixels = image[cover]
    pixels[:, :3] *= pixels[:, 3:] / 255
    return pixels, cover
