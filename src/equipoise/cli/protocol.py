"""The command `mcp`: the commands as tools, by the Model Context Protocol."""

from __future__ import annotations

import os
from base64 import b64encode
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from cyclopts import CycloptsError

from equipoise import __version__
from equipoise.cli.options import wants
from equipoise.errors import EquipoiseError, UsageError, needed, unknown
from equipoise.folders import Folder

if TYPE_CHECKING:
    from mcp.server.lowlevel import Server
    from mcp.types import CallToolResult, ImageContent, ListToolsResult

    from equipoise.cli.tools import Tool

PICTURES = {".png": "image/png", ".svg": "image/svg+xml", ".gif": "image/gif"}
MOST_PICTURES = 8
"""In an answer; the others are named."""
ADVICE = (
    "Files are named from one folder; names of bundled models (tool examples) stand for files too. "
    "Quantities are texts with units, such as '250 rpm' and '60 mm'. Begin with new or examples."
)
ANSWER = {
    "type": "object",
    "properties": {
        "values": {"type": "object", "description": "in SI units and radians"},
        "units": {"type": "object", "description": "of each kind of quantity and output"},
        "files": {"type": "array", "items": {"type": "string"}},
    },
    "required": ["values", "units", "files"],
}


def mcp(*, folder: Annotated[str, wants("FOLDER")] = ".") -> None:
    """Offer the commands as tools to a program, by the Model Context Protocol on standard streams.

    Parameters
    ----------
    folder
        Whose files are read and written; none outside of it are.
    """
    needed("mcp.server.stdio", "the Model Context Protocol")
    import anyio

    if not os.path.isdir(folder):
        raise UsageError(f"--folder: got {folder!r}; give a folder that is there")
    os.chdir(folder)
    os.environ["EQUIPOISE_PROGRESS"] = "off"
    anyio.run(_serve, Path.cwd().resolve())


async def _serve(folder: Path) -> None:
    from mcp.server.stdio import stdio_server

    server = server_of(folder)
    async with stdio_server() as (read, write):
        await server.run(read, write, server.create_initialization_options())


def server_of(folder: Path) -> Server[Any]:
    """What answers a program: each tool is a command, run one after the other in a folder."""
    import anyio.to_thread
    from mcp import types
    from mcp.server.lowlevel import Server

    from equipoise.cli.tools import tools

    known, one_by_one = tools(), anyio.Lock()

    async def listed(*_: Any) -> ListToolsResult:
        return types.ListToolsResult(
            tools=[
                types.Tool(
                    name=name,
                    description=tool.help,
                    input_schema=tool.schema(),
                    output_schema=ANSWER,
                )
                for name, tool in known.items()
            ]
        )

    async def called(_: Any, call: types.CallToolRequestParams) -> CallToolResult:
        async with one_by_one:
            ask = partial(answered, known, call.name, call.arguments or {}, folder)
            return await anyio.to_thread.run_sync(ask)

    return Server(
        "equipoise",
        version=__version__,
        instructions=ADVICE,
        on_list_tools=listed,
        on_call_tool=called,
    )


def answered(
    known: dict[str, Tool], name: str, given: dict[str, Any], folder: Path
) -> CallToolResult:
    """What a tool tells, with its pictures; what is wrong is told in the product's sentence."""
    from mcp import types

    from equipoise.cli.tools import shown, units_of

    try:
        if name not in known:
            raise UsageError(unknown(name, known, "command"))
        answer = known[name].answer(given, folder)
    except (EquipoiseError, CycloptsError) as error:
        return types.CallToolResult(content=[types.TextContent(text=str(error))], is_error=True)
    names = [shown(path, folder) for path in answer.written]
    return types.CallToolResult(
        content=[types.TextContent(text=answer.text), *_pictures(answer.written)],
        structured_content={
            "values": answer.values,
            "units": units_of(answer.values),
            "files": names,
        },
    )


def _pictures(written: tuple[Path, ...]) -> list[ImageContent]:
    from mcp import types

    drawn = [path for path in written if path.suffix.lower() in PICTURES][:MOST_PICTURES]
    return [
        types.ImageContent(
            data=b64encode(Folder.without_links(path.parent).read(path.name)).decode(),
            mime_type=PICTURES[path.suffix.lower()],
        )
        for path in drawn
    ]
