"""The command line.  Results go to standard output, everything else to standard error.

Exit status: 0 done, 2 something the user can mend (one sentence says what), 130 interrupted.
"""

from __future__ import annotations

import gc
import io
import os
import shutil
import signal
import sys
from collections import Counter
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from importlib.util import find_spec
from threading import Event, Thread, Timer
from time import monotonic
from types import CodeType
from typing import TYPE_CHECKING

from cyclopts import App, CycloptsError, Parameter

from equipoise import __version__
from equipoise.atomic_files import transaction
from equipoise.cli.help import Laid
from equipoise.errors import EquipoiseError, UsageError, at_place
from equipoise.i18n import Note, say
from equipoise.interrupts import answered, check, recorded
from equipoise_command import INTERRUPTED

if TYPE_CHECKING:
    from rich.console import Console

    from equipoise.cli.runner import FinishedCommand


app = App(
    name="equipoise",
    help="Motion and forces of planar linkages: analyse, balance, put on mounts, optimize.",
    version=__version__,
    help_format="plaintext",
    help_formatter=Laid(),
    default_parameter=Parameter(negative=""),
    suppress_keyboard_interrupt=False,
)

MODULES = {
    "balance:app": ["balance"],
    "designs": ["best", "search"],
    "exchange": ["export"],
    "explaining": ["explain"],
    "files": ["check", "completion", "examples", "new", "schema", "serve"],
    "handheld:app": ["tool"],
    "exchange:import_file": ["import"],
    "linkage": ["analyze", "modes", "respond", "run", "simulate"],
    "linkage:planting": ["plant"],
    "measured": ["decay", "exposure"],
    "pictures:app": ["plot"],
    "protocol": ["mcp"],
    "reports": ["animate", "report"],
    "site": ["site"],
    "sweep": ["resume", "sweep", "tolerance"],
}
"""Module here, and what a command is called there if not like itself -> its commands."""
COMMANDS = {name: place for place, names in MODULES.items() for name in names}


def _path(name: str, place: str) -> str:
    """Where a command is: module and what is imported of it."""
    module, _, what = place.partition(":")
    return f"equipoise.cli.{module}:{what or name}"


for _name in sorted(COMMANDS):  # each is imported when it is run
    app.command(_path(_name, COMMANDS[_name]), name=_name)

LEAST, MOST = 40, 1000
"""Signs in a line below which no help is laid out, since in one or two it would never end; and
beyond which nobody has a terminal, while each line may be filled up.
"""


def run(arguments: Sequence[str] | None = None) -> int:
    """Run a command; returns the exit status."""
    with recorded():
        return _run(arguments)


def _run(arguments: Sequence[str] | None) -> int:
    try:
        given = sys.argv[1:] if arguments is None else arguments
        _prepare(given)
        with recorded(), transaction(), _signs_of_life(given):
            check_repeated(given)
            finished = answered_by(arguments)
            if finished is not None:
                finished.give()
            if sys.stdout is not None:  # None where the shell has closed it
                sys.stdout.flush()
            check()
    except (EquipoiseError, CycloptsError) as error:
        return _refuse(error)
    except MemoryError as error:
        from equipoise.limits import out_of_memory

        return _refuse(out_of_memory(error))
    except KeyboardInterrupt as interrupt:  # whoever has more to say raises it again with words
        answered()
        words = _one_line("; ".join([say("interrupted"), *map(str, interrupt.args)]))
        print(f"equipoise: {words}", file=sys.stderr)
        return INTERRUPTED
    except BrokenPipeError:  # the reader, such as `head`, has seen enough
        _drop_output()
    except OSError as error:  # everything else that can fail says so itself
        _drop_output()
        return _refuse(UsageError(_mishap(error)))
    return 0


def answered_by(arguments: Sequence[str] | None) -> FinishedCommand | None:
    """What the command of a command line returns; None of help, and of what serves a person."""
    finished: FinishedCommand | None = app(
        arguments, exit_on_error=False, print_error=False, result_action="return_value"
    )
    return finished


def _prepare(given: Sequence[str]) -> None:
    """Fit the output to the terminal, and load what the help lists."""
    columns, lines = shutil.get_terminal_size()
    if columns > MOST or "COLUMNS" in os.environ:  # for every library that asks, and may take a 0
        os.environ["COLUMNS"] = str(min(columns, MOST))
    if "LINES" in os.environ:  # Rich takes every sign that is called a digit, such as a superscript
        os.environ["LINES"] = str(min(lines, MOST))
    app.console = _console(LEAST) if columns < LEAST else None
    if not given or given[0].startswith("-"):  # the help has a line of each command
        for name, place in sorted(COMMANDS.items()):
            del app[name]
            app.command(_path(name, place), name=name, help=_summary(name, place))


def _summary(name: str, place: str) -> str:
    """First line of what a command says of itself, for which its module need not be run."""
    module, _, what = place.partition(":")
    spec = find_spec(f"equipoise.cli.{module}")
    code = spec.loader.get_code(spec.name)  # type: ignore[union-attr]
    functions = (item for item in code.co_consts if isinstance(item, CodeType))
    function = next(item for item in functions if item.co_name in (what, name))
    text = function.co_consts[0]
    return text.partition("\n")[0] if isinstance(text, str) else ""  # where Python drops texts


MOST_REPEATED = 200
"""Times that an option may be given: the time to read them grows with the square of it."""


def check_repeated(words: Sequence[str]) -> None:
    """Refuse a command line on which an option is repeated too often.

    Raises
    ------
    UsageError : the sentence names the option and how often it was given.
    """
    options = Counter(word.partition("=")[0] for word in words if word.startswith("--"))
    for name, count in options.most_common(1):
        if count > MOST_REPEATED:
            raise UsageError(
                at_place(
                    name,
                    Note(
                        "given {count} times; give it {most_repeated} times at most, and run the "
                        "command again for the others",
                        count=count,
                        most_repeated=MOST_REPEATED,
                    ),
                )
            )


def _mishap(error: OSError) -> Note:
    """What the system has refused, where nobody nearer to it says so."""
    from equipoise.folders import is_nowhere

    if isinstance(error, FileNotFoundError) and is_nowhere():
        return Note(
            "the current folder does not exist any more; go to another, and run it again there"
        )
    if error.filename is not None:
        return Note(
            "{filename!r} cannot be used ({strerror})",
            filename=error.filename,
            strerror=error.strerror,
        )
    return Note("the output cannot be written ({strerror})", strerror=error.strerror)


def _refuse(error: Exception) -> int:
    """Say what the user can mend; returns the exit status."""
    sentence, lines = str(error), tuple[str, ...]()
    if isinstance(error, EquipoiseError):
        sentence, lines = error.sentence, error.lines
    hints = _hints(error) if isinstance(error, EquipoiseError) else ()
    if lines:  # which are pasted with all that stands below them
        hints = tuple(f"# {line}" for line in hints)
    message = f"equipoise: {_one_line(sentence)}"
    print(message, *map(_one_line, lines), *hints, sep="\n", file=sys.stderr)
    return 2


def _hints(error: EquipoiseError) -> tuple[str, ...]:
    """The command that explains an error; nothing where there is no more to say."""
    command = error.explained_by
    return (say("more: {command}", command=command),) if command else ()


SIGN, RAREST = 5.0, 50.0
"""s without output, after which a line states that work goes on; then twice as long each time, up
to the second."""


@contextmanager
def _signs_of_life(given: Sequence[str]) -> Iterator[None]:
    """Print a line now and then while a command computes without other output."""
    silent = os.environ.get("EQUIPOISE_PROGRESS") == "off" or sys.stderr is None
    if silent or given[:1] in (["serve"], ["mcp"]):  # which wait
        yield
        return
    ended, begun = Event(), monotonic()

    def print_waiting() -> None:
        wait, value = SIGN, begun
        while not ended.wait(max(value + wait - monotonic(), 0.0)):
            progress = sys.modules.get("equipoise.cli.progress")
            if progress is not None and progress.last_line() > value:
                value = progress.last_line()
                continue
            share = "" if progress is None else progress.so_far()
            words = say("still computing, {time} s", time=f"{monotonic() - begun:.0f}")
            print("; ".join(filter(None, [words, share])), file=sys.stderr)
            wait, value = min(2 * wait, RAREST), monotonic()

    thread = Thread(target=print_waiting, daemon=True)
    thread.start()
    try:
        yield
    finally:
        ended.set()
        thread.join()


def _console(width: int) -> Console:
    from rich.console import Console

    return Console(width=width)


def _drop_output() -> None:
    """Leave nothing that the interpreter would try to write at its end."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def _one_line(text: str) -> str:
    from equipoise.schema.files import printable

    text = " ".join(text.splitlines())
    text = text if len(text) <= 2000 else f"{text[:1000]} ... {text[-900:]}"
    return "".join(map(printable, text))


ONE_THREAD = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")
"""What libraries of linear algebra read when NumPy is imported: how many threads they may take."""


def main() -> None:
    """Entry point of the command `equipoise`."""
    for name in ONE_THREAD:  # for matrices as small as ours more threads only wait for each other
        os.environ.setdefault(name, "1")
    _collect_later()
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):  # a title may have letters the terminal lacks
            stream.reconfigure(errors="backslashreplace")
    if sys.argv[1:2] != ["serve"]:  # which starts browsers, and computes little at a time
        _limit_memory()
    status = run()
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # everything is done, and only Python has to end
    if status == INTERRUPTED:  # objects that were half made cannot be given up in silence
        sys.unraisablehook = lambda _: None
    sys.exit(status)


def _limit_memory() -> None:
    from equipoise.limits import limit_process

    try:
        limit_process()
    except EquipoiseError as error:
        sys.exit(_refuse(error))


IMPORTS = 0.5
"""s in which nearly all that a command makes are modules."""


def _collect_later() -> None:
    """Collect garbage from when modules are imported on, which saves short commands a tenth."""
    gc.disable()
    timer = Timer(IMPORTS, gc.enable)
    timer.daemon = True
    timer.start()
