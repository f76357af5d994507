"""The command line.  Results go to standard output, everything else to standard error.

Exit status: 0 done, 2 something the user can mend (one sentence says what), 130 interrupted.
"""

from __future__ import annotations

import gc
import io
import os
import re
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING, Annotated

from cyclopts import App, CycloptsError, Parameter

import equipoise
from equipoise.errors import EquipoiseError, MobilityError, ModelError, MotionError, UsageError

if TYPE_CHECKING:
    from equipoise.mechanism.model import Machine

FILE = Parameter(name="FILE", negative="")
OPTION = Parameter(negative="")
SIGNED = Parameter(negative="", allow_leading_hyphen=True)

app = App(
    name="equipoise",
    help="How a planar linkage moves, what that does to its frame, drive and joints.",
    version=equipoise.__version__,
    default_parameter=OPTION,
    suppress_keyboard_interrupt=False,
)


@app.command(name="examples")
def examples_() -> None:
    """List the bundled model files; their names can stand for FILE everywhere."""
    from equipoise.io.models import examples

    found = examples()
    width = max(map(len, found))
    for name, title in found.items():
        print(f"{name:<{width}}  {title}")


@app.command
def check(file: Annotated[str, FILE], /) -> None:
    """Check a model file and tell how the linkage is built up.

    Parameters
    ----------
    file
        Path of a model file, or the name of a bundled example.
    """
    from equipoise.io.models import load
    from equipoise.terminal import print_check

    machine = load(file)
    with _naming(file):
        print_check(machine)


@app.command
def analyze(
    file: Annotated[str, FILE],
    /,
    *,
    angles: Annotated[str, SIGNED] = "360",
    speed: Annotated[str | None, SIGNED] = None,
    acceleration: Annotated[str | None, SIGNED] = None,
    about: Annotated[str | None, SIGNED] = None,
    json: bool = False,
    split: bool = False,
    csv: str | None = None,
) -> None:
    """Motion, shaking force and moment, drive torque and every joint force over a turn.

    Parameters
    ----------
    file
        Path of a model file, or the name of a bundled example.
    angles
        Number of crank angles a turn, or the angles: "0 deg, 45 deg, 90 deg".
    speed
        Speed of the crank instead of the file's, such as "250 rpm".
    acceleration
        Acceleration of the crank instead of the file's, such as "10 rad/s^2".
    about
        Point about which moments are taken: a point of the frame, or "10 mm, 20 mm".
    json
        Print one JSON object in SI units, and nothing else.
    split
        With --json: add every force by cause and by link.
    csv
        Write every signal against crank angle to this file.
    """
    from equipoise import pipeline
    from equipoise.io.models import load

    machine = load(file)
    if split and not json:
        raise UsageError("--split belongs to --json; give both")
    if csv is not None:
        _check_target(csv, file, machine)
    arguments = (
        _angles(angles),
        None if speed is None else _quantity("--speed", speed, "angular speed"),
        None
        if acceleration is None
        else _quantity("--acceleration", acceleration, "angular acceleration"),
        None if about is None else _place(machine, about),
    )
    with _naming(file):
        analysis = pipeline.analyze(machine, *arguments)
    if csv is not None:
        from equipoise.io.output import to_csv, write

        write(csv, to_csv(analysis))
        print(f"wrote {csv}", file=sys.stderr)
    if json:
        from equipoise.io.output import to_json

        print(to_json(analysis, split))
    else:
        from equipoise.terminal import print_analysis

        print_analysis(analysis)


@app.command
def schema() -> None:
    """Print the JSON Schema of the model file, for editors."""
    import json

    from equipoise.io.models import json_schema

    print(json.dumps(json_schema(), indent=2))


@app.command
def new(file: Annotated[str, FILE] = "machine.toml", /) -> None:
    """Write a commented model file to start from.

    Parameters
    ----------
    file
        Where to write it; a file that is there already is left alone.
    """
    from importlib.resources import files

    from equipoise.io.output import write

    start = files("equipoise").joinpath("io", "start.toml").read_text(encoding="utf-8")
    write(file, start, replace=False)
    print(f"wrote {file}; next: equipoise analyze {file}", file=sys.stderr)


@contextmanager
def _naming(file: str) -> Iterator[None]:
    """Put the file's name in front of what turns out wrong with its machine."""
    try:
        yield
    except (ModelError, MobilityError, MotionError) as error:
        from equipoise.io.files import printable

        raise EquipoiseError(f"{printable(file)}: {error}") from error


def _angles(text: str) -> int | list[float]:
    from equipoise.io.units import parse

    if re.fullmatch("[+-]?[0-9]{1,20}", text):
        return int(text)
    try:
        return [parse(part.strip(), "angle") for part in text.split(",")]
    except UsageError as error:
        raise UsageError(
            f'--angles: {error}; give a number, or angles such as "0 deg, 45 deg"'
        ) from error


def _quantity(option: str, text: str, dimension: str) -> float:
    from equipoise.io.units import parse

    try:
        return parse(text, dimension)  # type: ignore[arg-type]
    except UsageError as error:
        raise UsageError(f"{option}: {error}") from error


def _check_target(path: str, file: str, machine: Machine) -> None:
    """Results must not take the place of what they come from."""
    if not path:
        raise UsageError("--csv: got an empty name; give the name of a file")
    tables = (load.table.file for load in machine.loads if load.table is not None)
    sources = [file, *(os.path.join(os.path.dirname(file), table) for table in tables)]
    if os.path.exists(path) and any(
        os.path.exists(source) and os.path.samefile(source, path) for source in sources
    ):
        raise UsageError(f"--csv: {path} is what is to be analysed; give another name")


def _place(machine: Machine, text: str) -> str | tuple[float, float]:
    if "," not in text or text in machine.frame:
        return text
    parts = [_quantity("--about", part.strip(), "length") for part in text.split(",")]
    if len(parts) != 2:
        raise UsageError(f'--about: got {text!r}; give a point, or x and y: "10 mm, 20 mm"')
    return parts[0], parts[1]


def run(arguments: Sequence[str] | None = None) -> int:
    """Run a command; returns the exit status."""
    try:
        app(
            arguments,
            exit_on_error=False,
            print_error=False,
            result_action="return_value",
        )
        if sys.stdout is not None:  # None where the shell has closed it
            sys.stdout.flush()
    except (EquipoiseError, CycloptsError) as error:
        print(f"equipoise: {_one_line(str(error))}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        print("equipoise: interrupted", file=sys.stderr)
        return 130
    except BrokenPipeError:  # the reader, such as `head`, has seen enough
        _drop_output()
    except OSError as error:  # everything else that can fail says so itself
        _drop_output()
        print(f"equipoise: the output cannot be written ({error.strerror})", file=sys.stderr)
        return 2
    return 0


def _drop_output() -> None:
    """Leave nothing that the interpreter would try to write at its end."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def _one_line(text: str) -> str:
    from equipoise.io.files import printable

    text = " ".join(text.splitlines())
    text = text if len(text) <= 2000 else f"{text[:1000]} ... {text[-900:]}"
    return "".join(map(printable, text))


def main() -> None:
    """Entry point of the command `equipoise`."""
    gc.disable()  # collecting garbage between imports takes a twentieth of a short command's time
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):  # a title may have letters the terminal lacks
            stream.reconfigure(errors="backslashreplace")
    sys.exit(run())
