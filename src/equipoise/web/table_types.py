"""Types of what a page is sent of the tables of a model file; see `equipoise.web.protocol`."""

from __future__ import annotations

from typing import Annotated, Any, Literal, NotRequired, TypedDict

Pair = tuple[float, float]


class AskingValues(TypedDict):
    """What is asked for: how, and in which unit."""

    kind: Literal[
        "quantity", "number", "text", "choice", "flag", "name", "place", "direction", "list",
        "names", "file", "wording",
    ]  # fmt: skip
    unit: NotRequired[str]
    options: NotRequired[list[str | int]]
    of: NotRequired[
        Annotated[Literal["link", "body", "point", "output"], "Of what it is the name."]
    ]
    on: NotRequired[
        Annotated[str | None, "The key of the same table that names the body of a point."]
    ]
    named: NotRequired[Annotated[bool, "Of places: or a point's name."]]
    space: NotRequired[Annotated[bool, "Of places: with z."]]
    axes: NotRequired[
        Annotated[str | None, "Of places: the key that names the link whose axes they are in."]
    ]
    item: NotRequired[AskingValues]
    sizes: NotRequired[Annotated[list[int], "How many there can be; none for one and more."]]
    bare: NotRequired[Annotated[bool, "Whether one stands without brackets."]]
    by: NotRequired[Annotated[AskingValues, "What names are of."]]
    listed: NotRequired[Annotated[bool, "Whether names alone may do."]]


class ControlValues(AskingValues):
    """A key of a table."""

    key: str
    word: str
    text: str
    required: bool
    default: Any | None
    example: Any | None


ConstantValues = TypedDict(
    "ConstantValues",
    {
        "const": NotRequired[Any],
        "enum": NotRequired[list[Any]],
        "type": NotRequired[str],
        "not": NotRequired["ConstantValues"],
    },
)
ConstantValues.__doc__ = "The values that a key has to have where a rule looks at it."

RuleValues = TypedDict(
    "RuleValues",
    {
        "required": NotRequired[list[str]],
        "properties": NotRequired[dict[str, Literal[False] | ConstantValues]],
        "allOf": NotRequired[list["RuleValues"]],
        "anyOf": NotRequired[list["RuleValues"]],
        "oneOf": NotRequired[list["RuleValues"]],
        "not": NotRequired["RuleValues"],
        "if": NotRequired["RuleValues"],
        "then": NotRequired["RuleValues"],
        "else": NotRequired["RuleValues"],
        "dependentRequired": NotRequired[dict[str, list[str]]],
        "dependentSchemas": NotRequired[dict[str, "RuleValues"]],
    },
)
RuleValues.__doc__ = "The part of a JSON Schema that states which keys go together."


class FormValues(TypedDict):
    """The keys of a table, and which of them go together."""

    controls: list[ControlValues]
    rule: RuleValues


class TableEntryValues(TypedDict):
    """A table of the file."""

    place: Annotated[str, "Its path in the file; empty of the whole file."]
    where: Annotated[str, "Its path, as refusals have it."]
    words: str
    values: dict[str, Any]
    below: Annotated[list[str], "Keys of the tables below it."]


class GroupValues(TypedDict):
    """Tables of one sort that a machine has, or can have."""

    place: Annotated[str, "Its path in the file; empty of the whole file."]
    where: str
    form: str
    many: Literal["one", "list", "named"]
    word: str
    text: str
    of: Annotated[str, "The entry that it belongs to."]
    needs: Annotated[str, "What has to be there first."]
    required: bool
    entries: list[TableEntryValues]
    result: NotRequired[Annotated[str, "What its entries are together."]]


class TablesValues(TypedDict):
    """The tables of the model file, and the forms in which they are asked for."""

    type: Literal["tables"]
    seq: int
    groups: list[GroupValues]
    forms: dict[str, FormValues]
    bodies: Annotated[
        dict[str, dict[str, Pair]], "Points of the frame and of links, in their own axes, m."
    ]
    outputs: Annotated[dict[str, str], "What outputs that balancing can take are called, by name."]
