"""`dataclass` as in the standard library, whose methods cost nothing before they are used.

The standard library writes the source of six methods for each class and compiles it when the class
is made, which was a quarter of what starting a command took: an analysis imports some 280 frozen
classes and makes objects of a third of them.  Here a constructor is compiled when the first object
is made, and what compares, prints and protects objects is the same code for all classes.
"""

from __future__ import annotations

import dataclasses
import sys
from collections.abc import Callable
from dataclasses import MISSING, Field, FrozenInstanceError, fields
from operator import attrgetter
from reprlib import recursive_repr
from typing import TYPE_CHECKING, Any

__all__ = ["Constructor", "dataclass", "remembered"]

if TYPE_CHECKING:
    from dataclasses import dataclass
    from functools import cached_property as remembered
else:

    def dataclass(
        cls: type | None = None,
        /,
        *,
        frozen: bool = False,
        init: bool = True,
        repr: bool = True,
        eq: bool = True,
        **others: Any,
    ) -> Any:
        """As `dataclasses.dataclass`; those that are not frozen are left to it."""

        def decorate(cls: type) -> type:
            if not frozen:
                return dataclasses.dataclass(cls, init=init, repr=repr, eq=eq, **others)
            # a missing docstring would be replaced by a signature
            cls.__doc__ = cls.__doc__ or cls.__name__
            cls = dataclasses.dataclass(cls, init=False, repr=False, eq=False, **others)
            own = fields(cls)
            methods: dict[str, Any] = _protected(cls, frozenset(item.name for item in own))
            if init:
                methods["__init__"] = Constructor(cls)
            if repr:
                methods["__repr__"] = _printed([item.name for item in own if item.repr])
            if eq:
                methods |= _compared(own)
                if "__eq__" in vars(cls) and vars(cls)["__hash__"] is None:
                    del cls.__hash__  # of a class that has no more than its own comparison
            for name, method in methods.items():
                if name not in vars(cls):
                    setattr(cls, name, method)
            return cls

        return decorate if cls is None else decorate(cls)

    class remembered(property):
        """A property that is computed once, and kept by its name in the object's ``memory``: a dict
        that copies of a frozen object may be given where its values hold for them too.
        """

        def __get__(self, instance: Any, owner: type | None = None) -> Any:
            if instance is None or self.fget is None:
                return self
            memory, name = instance.memory, self.fget.__name__
            if name not in memory:
                memory[name] = self.fget(instance)
            return memory[name]


class Constructor:
    """``__init__`` of a class until somebody asks for it, when it takes its own place."""

    def __init__(self, cls: type) -> None:
        self.cls = cls
        self.wrap: Callable[[Any], Any] = lambda function: function
        """What the constructor is given to, and returns what stands in its place."""

    def __get__(self, instance: object, owner: type | None = None) -> Any:
        function = self.wrap(_constructor(self.cls))
        if vars(self.cls).get("__init__") is self:
            self.cls.__init__ = function
        return function if instance is None else function.__get__(instance, owner)


class _Factory:
    """Stands in signatures where a default is made anew for each object."""

    def __repr__(self) -> str:
        return "<factory>"


_FACTORY = _Factory()


def _constructor(cls: type) -> Callable[..., None]:
    """The constructor of a frozen class: sets its fields, then calls ``__post_init__``."""
    own = [item for item in fields(cls) if item.init]
    alone = [item for item in own if item.kw_only]
    parameters = [*(_parameter(item) for item in own if not item.kw_only)]
    parameters += ["*", *(_parameter(item) for item in alone)] if alone else []
    lines = [f"  _set_field(self, {item.name!r}, {_value(item)})" for item in own]
    lines += [
        f"  _set_field(self, {item.name!r}, {_value(item)})"
        for item in fields(cls)
        if not item.init and (item.default_factory is not MISSING)
    ]
    lines += ["  self.__post_init__()"] if hasattr(cls, "__post_init__") else []
    known = {"_set_field": object.__setattr__, "_factory": _FACTORY}
    for item in fields(cls):
        known |= {f"_default_{item.name}": item.default, f"_make_{item.name}": item.default_factory}
    inner = f" def __init__({', '.join(['self', *parameters])}):\n" + "\n".join(lines or ["  pass"])
    text = f"def make({', '.join(known)}):\n{inner}\n return __init__"
    namespace: dict[str, Any] = {}
    module = sys.modules.get(cls.__module__)  # where names of types are looked up
    exec(text, {} if module is None else vars(module), namespace)
    function = namespace["make"](**known)
    function.__qualname__ = f"{cls.__qualname__}.__init__"
    function.__module__ = cls.__module__
    function.__annotations__ = {item.name: item.type for item in own} | {"return": None}
    return function  # type: ignore[no-any-return]


def _parameter(item: Field[Any]) -> str:
    if item.default is not MISSING:
        return f"{item.name}=_default_{item.name}"
    return f"{item.name}=_factory" if item.default_factory is not MISSING else item.name


def _value(item: Field[Any]) -> str:
    if item.default_factory is MISSING:
        return item.name
    new = f"_make_{item.name}()"
    return f"{new} if {item.name} is _factory else {item.name}" if item.init else new


def _protected(cls: Any, names: frozenset[str]) -> dict[str, Any]:
    def __setattr__(self: Any, name: str, value: Any) -> None:
        if type(self) is cls or name in names:
            raise FrozenInstanceError(f"cannot assign to field {name!r}")
        super(cls, self).__setattr__(name, value)

    def __delattr__(self: Any, name: str) -> None:
        if type(self) is cls or name in names:
            raise FrozenInstanceError(f"cannot delete field {name!r}")
        super(cls, self).__delattr__(name)

    return {"__setattr__": __setattr__, "__delattr__": __delattr__}


def _printed(names: list[str]) -> Callable[[Any], str]:
    @recursive_repr()
    def __repr__(self: Any) -> str:
        values = ", ".join(f"{name}={getattr(self, name)!r}" for name in names)
        return f"{type(self).__qualname__}({values})"

    return __repr__


def _compared(own: tuple[Field[Any], ...]) -> dict[str, Any]:
    """Two are equal where they are of one class and have equal values in their fields."""
    values = _values([item for item in own if item.compare])
    hashed = _values([item for item in own if (item.hash is None and item.compare) or item.hash])

    def __eq__(self: Any, other: object) -> Any:
        if other.__class__ is not self.__class__:
            return NotImplemented
        return values(self) == values(other)

    def __hash__(self: Any) -> int:
        return hash(hashed(self))

    return {"__eq__": __eq__, "__hash__": __hash__}


def _values(own: list[Field[Any]]) -> Callable[[Any], tuple[Any, ...]]:
    names = [item.name for item in own]
    if len(names) > 1:
        return attrgetter(*names)
    return lambda item: tuple(getattr(item, name) for name in names)
