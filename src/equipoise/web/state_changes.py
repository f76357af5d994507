"""What has changed in the state of a machine since the one before, as a worker hands it its page.

Most of a state stays from one move of a drag to the next.  To write it as JSON, and to read that,
takes longer in a browser than to compare it.  `page/src/site/wire.ts` puts states together again.
"""

from __future__ import annotations

from typing import Any

from equipoise.web.replies import Reply

Values = dict[str, Any]
ALWAYS = ("type", "seq")
"""Keys by which a message is known; they are never left out."""
MOST = 0.5
"""Share of a list that may differ; beyond it the list is sent as a whole."""


class StateChanges:
    """Leaves out of each state what the page has from the one before."""

    def __init__(self) -> None:
        self._last: Values = {}

    def of(self, reply: Reply) -> Reply:
        """A reply as it is sent: of a state the changes, of all else the whole."""
        if reply.content["type"] != "state":
            return reply
        last, self._last = self._last, reply.content
        always = {key: reply.content[key] for key in ALWAYS}
        return Reply(always | changes(last, reply.content), reply.buffer)


def changes(before: Values, now: Values) -> Values:
    """The keys of `now` that differ, and what of the others there is to do.

    same : keys whose values are those of before.
    items : by the key of a list, the numbers of items that differ, each with the new one.
    inside : by the key of an object, its changes.
    """
    result: Values = {}
    same, items, inside = list[str](), Values(), Values()
    for key, value in now.items():
        old = before.get(key)
        if key in before and (old is value or old == value):
            same.append(key)
        elif isinstance(value, dict) and isinstance(old, dict) and old:
            inside[key] = changes(old, value)
        elif (differing := _differing(old, value)) is not None:
            items[key] = differing
        else:
            result[key] = value
    return {"since": {"same": same, "items": items, "inside": inside}, **result}


def _differing(old: object, value: object) -> list[list[Any]] | None:
    """Items of a list that differ, with their numbers; None where it is sent as a whole."""
    if not (isinstance(value, list) and isinstance(old, list) and len(old) == len(value)):
        return None
    pairs = enumerate(zip(old, value, strict=True))
    result = [[number, item] for number, (other, item) in pairs if other != item]
    return result if len(result) <= MOST * len(value) else None
