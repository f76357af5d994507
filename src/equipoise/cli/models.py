"""The files that commands are given, and what is loaded from each."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Annotated, Any

from cyclopts import Parameter

from equipoise.cli.options import file_named
from equipoise.cli.outputs import sources_of
from equipoise.errors import ModelError, UsageError

if TYPE_CHECKING:
    from typing import TypeAlias

    from equipoise.handheld.model import Tool
    from equipoise.mechanism.parts.machine import Machine
    from equipoise.studies.store import Store
    from equipoise.studies.study import Study


@dataclass(frozen=True)
class LoadedFile:
    """What stands for the name of a file: the command gets what is loaded from it.

    load : from its name.  reads : all files from which that was read, of it and its name.
    owner : of it, in whose units and words the command speaks.  example : a bundled file of which
    such commands have something to tell.
    """

    load: Callable[[str], Any]
    reads: Callable[[Any, str], list[str]] = lambda _, file: [file]
    owner: Callable[[Any], Any] = lambda loaded: loaded
    example: str = ""


def linkage_of(file: str, speed: float | None = None) -> Machine:
    """The machine of a file, whose crank turns at another speed where one is given, rad/s."""
    from equipoise.schema.models import load_linkage

    return at_speed(load_linkage(file), speed)


def tool_of(file: str) -> Tool:
    """The tool of a file."""
    from equipoise.schema.models import load_tool

    return load_tool(file)


def study_of(file: str) -> Study:
    """The study of a file."""
    from equipoise.schema.studies import load_study

    return load_study(file)


def store_of(path: str) -> Store:
    """An open store."""
    from equipoise.studies.store import open_store

    return open_store(path)


def owner_of(store: Store) -> Study | None:
    """The study of a store, in whose units and words it is told; None where it cannot be read."""
    from equipoise.schema import study_units

    return study_units.owner_of(store)


def at_speed(machine: Machine, speed: float | None) -> Machine:
    """A machine whose crank turns at the speed of an option, rad/s, where one is given.

    Raises
    ------
    UsageError : its crank cannot turn so, whatever file it is from.
    """
    try:
        return machine if speed is None else machine.with_drive(speed=speed)
    except ModelError as error:
        raise UsageError(error.note).like(error) from error


if TYPE_CHECKING:
    LinkageFile: TypeAlias = Machine
    PlantingFile: TypeAlias = Machine
    SupportFile: TypeAlias = Machine
    PlannedFile: TypeAlias = Machine
    ToolFile: TypeAlias = Tool
    DesignFile: TypeAlias = Tool
    StudyFile: TypeAlias = Study
    TolerancedFile: TypeAlias = Study
    OpenedStore: TypeAlias = Store
    AnyFile: TypeAlias = str
    ModelFile: TypeAlias = str
    NamedFile: TypeAlias = str
else:
    LINKAGE = LoadedFile(linkage_of, sources_of, example="yamashita-1")
    TOOL = LoadedFile(tool_of, sources_of, example="brush-cutter")
    STUDY = LoadedFile(study_of, example="study-of-lengths")
    NAMED = LoadedFile(str, owner=lambda _: None)
    NAMED_MODEL = replace(NAMED, example="yamashita-1")
    LinkageFile = Annotated[str, file_named("Path of a model file"), LINKAGE]
    PlantingFile = Annotated[
        str,
        file_named("Path of a model file with a table [planting]"),
        replace(LINKAGE, example="transplanter"),
    ]
    SupportFile = Annotated[
        str,
        file_named("Path of a model file with a table [support]"),
        replace(LINKAGE, example="yamashita-rig"),
    ]
    PlannedFile = Annotated[str, Parameter(name="FILE"), LINKAGE]
    ToolFile = Annotated[str, file_named("Path of a tool's file, with a table [shaft]"), TOOL]
    DesignFile = Annotated[str, file_named("Path of a tool's file, with a table [design]"), TOOL]
    StudyFile = Annotated[str, file_named("Path of a study file", "STUDY"), STUDY]
    TolerancedFile = Annotated[
        str, file_named("Path of a study file whose numbers have tolerances", "STUDY"), STUDY
    ]
    OpenedStore = Annotated[
        str,
        Parameter(name="STORE", help='Path of a store, as "equipoise sweep" makes it.'),
        LoadedFile(store_of, lambda *_: [], owner_of),
    ]
    NamedFile = Annotated[str, NAMED]
    ModelFile = Annotated[str, file_named("Path of a model file"), NAMED_MODEL]
    AnyFile = Annotated[str, file_named("Path of a model file or a study file"), NAMED_MODEL]
