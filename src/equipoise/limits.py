"""How much memory may be used: a limit that can be raised, and a sentence where it is too little.

``EQUIPOISE_MEMORY`` in the environment raises it, such as ``EQUIPOISE_MEMORY="8 GB"``, and
``EQUIPOISE_OUTPUTS`` how many outputs a study may have.
"""

from __future__ import annotations

import gc
import os
import re
import sys
from math import prod
from typing import Any

from equipoise.errors import UsageError
from equipoise.i18n import Note

VARIABLE = "EQUIPOISE_MEMORY"
USUAL = 2 * 2**30
"""bytes: what a laptop can spare beside everything else."""
THREAD = 16 * 2**20
"""bytes that a thread of a library takes for itself, one a processor."""
OUTPUTS, USUAL_OUTPUTS = "EQUIPOISE_OUTPUTS", 1000
"""Outputs of a study: each is an array of the store, which takes some 7 ms to begin."""
DIGITS = 9
"""Of a number of outputs."""
UNITS = {"": 1, "k": 10**3, "m": 10**6, "g": 10**9, "t": 10**12}
BINARY = {"": 1, "k": 2**10, "m": 2**20, "g": 2**30, "t": 2**40}


def memory_limit() -> int:
    """Bytes that may be used.

    Raises
    ------
    UsageError : the variable of the environment is no size.
    """
    text = os.environ.get(VARIABLE, "")
    if not text.strip():
        return USUAL
    match = re.fullmatch(r"\s*([0-9.]+)\s*([kmgt]?)(i?)b?\s*", text, re.IGNORECASE)
    try:
        size = float(match[1]) * (BINARY if match[3] else UNITS)[match[2].lower()] if match else 0.0
    except ValueError:
        size = 0.0
    if not 1 <= size < sys.maxsize:
        raise UsageError(
            Note(
                '{variable}: got {text!r}; give the memory that may be used, such as "8 GB"',
                variable=VARIABLE,
                text=text,
            )
        )
    return int(size)


def most_outputs() -> int:
    """Outputs that one study may have.

    Raises
    ------
    UsageError : the variable of the environment is no whole number above 0.
    """
    text = os.environ.get(OUTPUTS, "").strip() or str(USUAL_OUTPUTS)
    if not (text.isascii() and text.isdigit() and len(text) <= DIGITS and int(text)):
        raise UsageError(
            Note(
                "{variable}: got {text!r}; give how many outputs a study may have, such as 5000",
                variable=OUTPUTS,
                text=text,
            )
        )
    return int(text)


def limit_process() -> None:
    """Keep this process, and those that it starts, below the limit, where the system can.

    What asks for more gets a `MemoryError`, instead of memory that other programs need.
    """
    limit = memory_limit() + THREAD * (os.cpu_count() or 1)
    if sys.platform != "linux":
        return
    import resource

    soft, hard = resource.getrlimit(resource.RLIMIT_DATA)
    ends = [limit, *(item for item in (soft, hard) if item != resource.RLIM_INFINITY)]
    resource.setrlimit(resource.RLIMIT_DATA, (min(ends), hard))


def check_memory(size: float, what: Note) -> None:
    """Refuse what needs more memory than may be used.

    Parameters
    ----------
    size : bytes that are needed at once.
    what : needs them, with the numbers that it follows from, such as ``12 turns at 40000 angles``.

    Raises
    ------
    UsageError : they are too many; the sentence gives the size and the limit, and how to raise it.
    """
    limit = memory_limit()
    if size > limit:
        raise UsageError(
            Note(
                "{what}: needs {size} of memory, and {limit} may be used; ask for less, or set "
                '{variable}="{enough}"',
                what=what,
                size=size_text(size),
                limit=size_text(limit),
                variable=VARIABLE,
                enough=_enough(size),
            )
        )


def check_room(size: float, what: Note) -> None:
    """Refuse what needs more memory at once than is left, for libraries that abort without it.

    Parameters and errors as of `check_memory`.
    """
    check_memory(size + _in_use(), what)


def _in_use() -> int:
    """Bytes that count towards the limit of this process; 0 where it has none."""
    if sys.platform != "linux":
        return 0
    import resource

    if resource.getrlimit(resource.RLIMIT_DATA)[0] == resource.RLIM_INFINITY:
        return 0
    with open("/proc/self/status", encoding="ascii") as status:
        data = re.search(r"VmData:\s+(\d+) kB", status.read())
    return 0 if data is None else 1024 * int(data[1])


def out_of_memory(error: MemoryError) -> UsageError:
    """What to say of an array that found no room.

    The error loses its traceback: what its frames hold is given back, without which there may be no
    room for the sentence either.
    """
    error.__traceback__ = error.__context__ = None
    gc.collect()
    shape: Any = getattr(error, "shape", None)
    kind: Any = getattr(error, "dtype", None)
    needed = 0 if shape is None or kind is None else prod(shape) * kind.itemsize
    size: Note = Note("more")
    if needed > memory_limit():
        size = Note("{size} in one piece", size=size_text(needed))
    elif needed:
        size = Note("{size} beside what it holds already", size=size_text(needed))
    return UsageError(
        Note(
            "not enough memory: needs {size}, and {limit} may be used; ask for fewer crank angles, "
            'speeds, turns or designs at once, or set {variable}="{enough}"',
            size=size,
            limit=size_text(memory_limit()),
            variable=VARIABLE,
            enough=_enough(needed + memory_limit()),
        )
    )


def size_text(size: float) -> str:
    """Bytes in words."""
    unit = next((name for name in ("GiB", "MiB") if size >= BINARY[name[0].lower()]), "KiB")
    return f"{size / BINARY[unit[0].lower()]:.3g} {unit}"


def _enough(size: float) -> str:
    """A limit that is enough for so many bytes."""
    return f"{max(1, round(1.5 * size / 10**9))} GB"
