"""The command `mcp`: the commands as tools, by the Model Context Protocol."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from base64 import b64encode
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager, suppress
from dataclasses import asdict, field
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from equipoise import __version__
from equipoise.cli.options import wants
from equipoise.cli.worker import ToolCall, ToolReply
from equipoise.dataclass import dataclass
from equipoise.errors import UsageError, at_place, needed
from equipoise.folders import Folder
from equipoise.i18n import Note

if TYPE_CHECKING:
    from anyio import CapacityLimiter
    from anyio.abc import Process
    from mcp.server.lowlevel import Server
    from mcp.types import CallToolResult, ImageContent, ListToolsResult

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
    """Serve the commands as tools to other programs, by the Model Context Protocol.

    Parameters
    ----------
    folder
        Folder whose files may be read and written; no others are.
    """
    needed("mcp.server.stdio", "the Model Context Protocol")
    import anyio

    if not os.path.isdir(folder):
        raise UsageError(
            at_place("--folder", Note("got {folder!r}; give a folder that is there", folder=folder))
        )
    os.chdir(folder)
    os.environ["EQUIPOISE_PROGRESS"] = "off"
    anyio.run(_serve, Path.cwd().resolve())


async def _serve(folder: Path) -> None:
    """Answer until the input ends, and then leave nothing that computes."""
    import anyio
    from mcp.server.stdio import stdio_server

    async with workers_in(folder) as workers, stdio_server() as (read, write):
        server = server_of(workers)
        async with anyio.create_task_group() as tasks:
            incoming, passed = anyio.create_memory_object_stream[Any](0)

            async def pass_on() -> None:
                async with incoming, read:
                    async for message in read:
                        await incoming.send(message)
                tasks.cancel_scope.cancel()  # calls under way too: nobody waits for them

            tasks.start_soon(pass_on)
            await server.run(passed, write, server.create_initialization_options())


def server_of(workers: Workers) -> Server[Any]:
    """What answers a program: each tool is a command, run in a process of its own."""
    from mcp import types
    from mcp.server.lowlevel import Server

    from equipoise.cli.tools import tools

    known = tools()

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
        long = call.name in known and known[call.name].long
        reply = await workers.answer(call.name, call.arguments or {}, long)
        return result_of(reply, workers.folder)

    return Server(
        "equipoise",
        version=__version__,
        instructions=ADVICE,
        on_list_tools=listed,
        on_call_tool=called,
    )


def result_of(reply: ToolReply, folder: Path) -> CallToolResult:
    """A reply as the protocol wants it, with its pictures."""
    from mcp import types

    from equipoise.cli.tools import name_in_folder, units_of

    if reply.wrong:
        return types.CallToolResult(content=[types.TextContent(text=reply.text)], is_error=True)
    written = tuple(map(Path, reply.files))
    return types.CallToolResult(
        content=[types.TextContent(text=reply.text), *_pictures(written)],
        structured_content={
            "values": reply.values,
            "units": units_of(reply.values),
            "files": [name_in_folder(path, folder) for path in written],
        },
    )


# -- processes that compute ------------------------------------------------------------------------

LONG_CALLS, SHORT_CALLS = 2, 4
"""Calls that are computed at a time, of commands that may take minutes and of the others."""
GRACE = 0.5
"""s in which a call that is cancelled may put its files in order, before it is killed."""


@asynccontextmanager
async def workers_in(folder: Path) -> AsyncIterator[Workers]:
    """Processes that answer calls in a folder; all of them end in the end."""
    import anyio

    workers = Workers(folder, anyio.CapacityLimiter(LONG_CALLS), anyio.CapacityLimiter(SHORT_CALLS))
    try:
        yield workers
    finally:
        with anyio.CancelScope(shield=True):
            for process in workers.waiting:
                process.kill()
                await process.aclose()


@dataclass(frozen=True)
class Workers:
    """Runs each call in a process; one that took long takes its memory with it when it ends.

    waiting : processes that have imported the commands already.
    """

    folder: Path
    long: CapacityLimiter
    short: CapacityLimiter
    waiting: list[Process] = field(default_factory=list)

    async def answer(self, name: str, given: dict[str, Any], long: bool) -> ToolReply:
        """What a tool answers; where this is cancelled, the work ends.

        long : whether it may take minutes; such calls wait for each other, and others do not.
        """
        import anyio

        async with self.long if long else self.short:
            process, sketch = self.waiting.pop() if self.waiting else await self._start(), b""
            try:
                if not self.waiting:  # so that the next call need not wait for imports
                    self.waiting.append(await self._start())
                sketch = await _asked(process, ToolCall(name, given, str(self.folder)))
            finally:
                if sketch and not long and len(self.waiting) < SHORT_CALLS:
                    self.waiting.append(process)
                else:
                    with anyio.CancelScope(shield=True):
                        await _end(process)
        if not sketch:
            return ToolReply(DIED.format(status=process.returncode), {}, (), wrong=True)
        return ToolReply(**json.loads(sketch))

    async def _start(self) -> Process:
        import anyio

        words = [sys.executable, "-m", "equipoise.cli.worker"]
        return await anyio.open_process(words, stderr=subprocess.DEVNULL, cwd=self.folder)


async def _asked(process: Process, call: ToolCall) -> bytes:
    """The line that a process answers; empty where it has died."""
    import anyio

    assert process.stdin is not None and process.stdout is not None
    parts = list[bytes]()
    with suppress(anyio.BrokenResourceError, anyio.EndOfStream):
        await process.stdin.send(f"{json.dumps(asdict(call))}\n".encode())
        while not (parts and parts[-1].endswith(b"\n")):
            parts.append(await process.stdout.receive())
        return b"".join(parts)
    return b""


DIED = (
    "the command ended without an answer (status {status}), perhaps for want of memory; ask for "
    "less at once"
)


async def _end(process: Process) -> None:
    """End a process: interrupted first, so that its files are in order, and killed then."""
    import anyio

    if process.returncode is None and os.name == "posix":
        with suppress(ProcessLookupError):
            process.send_signal(signal.SIGINT)
        with anyio.move_on_after(GRACE):
            await process.wait()
    if process.returncode is None:
        with suppress(ProcessLookupError):
            process.kill()
    await process.aclose()


def _pictures(written: tuple[Path, ...]) -> list[ImageContent]:
    from mcp import types

    picture_files = [path for path in written if path.suffix.lower() in PICTURES][:MOST_PICTURES]
    return [
        types.ImageContent(
            data=b64encode(Folder.without_links(path.parent).read(path.name)).decode(),
            mime_type=PICTURES[path.suffix.lower()],
        )
        for path in picture_files
    ]
