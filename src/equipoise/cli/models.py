"""The files that commands are given, and what is loaded from each."""

from __future__ import annotations

from dataclasses import replace
from pkgutil import resolve_name
from typing import TYPE_CHECKING, Annotated, Any

from cyclopts import Parameter

from equipoise.cli.options import file_named
from equipoise.cli.outputs import sources_of
from equipoise.dataclass import dataclass
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

    load : name of the function that loads it, in the package, which is imported late; where it is
        empty the command gets the name.
    owner : of the one that gives in whose units and words the command speaks; if empty, what is
        loaded.
    example : a bundled file with which such commands have results to show.
    in_parts : whether other files are read with it, such as tables of loads.
    """

    load: str = ""
    owner: str = ""
    example: str = ""
    in_parts: bool = False

    def loaded(self, file: str) -> Any:
        """What the command gets."""
        return resolve_name(f"equipoise.{self.load}")(file) if self.load else file

    def owner_of(self, loaded: Any) -> Any:
        """In whose units and words it speaks; None where it has to load that itself."""
        if self.owner:
            return resolve_name(f"equipoise.{self.owner}")(loaded)
        return loaded if self.load else None

    def reads(self, loaded: Any, file: str) -> list[str]:
        """All files from which it was read."""
        return sources_of(loaded, file) if self.in_parts else [file]


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
    BundledFile: TypeAlias = str
else:
    LINKAGE = LoadedFile("schema.models.load_linkage", example="yamashita-1", in_parts=True)
    PLANTING, SUPPORT = (
        replace(LINKAGE, example=name) for name in ("transplanter", "yamashita-rig")
    )
    TOOL = LoadedFile("schema.models.load_tool", example="brush-cutter", in_parts=True)
    STUDY = LoadedFile("schema.studies.load_study", example="study-of-lengths")
    STORE = LoadedFile("studies.store.open_store", "schema.study_units.owner_of")
    NAMED, NAMED_MODEL = LoadedFile(), LoadedFile(example="yamashita-1")

    def _file(text: str, loaded: LoadedFile, name: str = "FILE") -> Any:
        return Annotated[str, file_named(text, name), loaded]

    LinkageFile = _file("Path of a model file", LINKAGE)
    PlantingFile = _file("Path of a model file with a table [planting]", PLANTING)
    SupportFile = _file("Path of a model file with a table [support]", SUPPORT)
    PlannedFile = Annotated[str, Parameter(name="FILE"), LINKAGE]
    ToolFile = _file("Path of a tool's file, with a table [shaft]", TOOL)
    DesignFile = _file("Path of a tool's file, with a table [design]", TOOL)
    StudyFile = _file("Path of a study file", STUDY, "STUDY")
    TolerancedFile = _file("Path of a study file whose numbers have tolerances", STUDY, "STUDY")
    OpenedStore = Annotated[
        str, Parameter(name="STORE", help='Path of a store, as "equipoise sweep" makes it.'), STORE
    ]
    BundledFile = Annotated[str, NAMED]
    ModelFile = _file("Path of a model file", NAMED_MODEL)
    AnyFile = _file("Path of a model file or a study file", NAMED_MODEL)
