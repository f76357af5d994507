"""A machine whose links, points and texts all are markup, as a stranger may send it."""

from __future__ import annotations

import tomllib
from typing import Any

import tomli_w

from surface.running import example_text

HOSTILE = (
    '"><script>window.x=1</script><img src=x onerror="window.x=1"> \'onload=x\' '
    "javascript:window.x=1 ]]> </style></svg>&amp; \\ ${x} %s */"
)


def hostile_text(name: str = "yamashita-1") -> str:
    """A bundled model file whose names and texts are markup that would set `window.x`."""
    content = tomllib.loads(example_text(name))
    named = {"frame": content["frame"], **content["links"]}
    names = {*content["links"], *(point for part in named.values() for point in part["points"])}

    def changed(value: Any) -> Any:
        if isinstance(value, dict):
            return {text(key): changed(item) for key, item in value.items()}
        return [changed(item) for item in value] if isinstance(value, list) else text(value)

    def text(value: Any) -> Any:
        return f"{value}{HOSTILE}" if isinstance(value, str) and value in names else value

    return tomli_w.dumps(changed(content) | {"title": HOSTILE, "description": HOSTILE})
