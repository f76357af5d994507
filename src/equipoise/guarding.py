"""Public functions and constructors refuse arguments of a wrong name or type in a sentence.

Rooms attach their names by `attach`, which guards every function by what it declares: nobody has
to check that a machine is one.  What is in order passes by the names of its classes alone.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from functools import cache, partial, wraps
from importlib import import_module
from inspect import Parameter, Signature, isclass, isfunction, signature
from typing import Any

from lazy_loader import attach_stub

from equipoise.dataclass import Constructor
from equipoise.errors import CallError, unknown

LazyAttributes = tuple[Callable[[str], Any], Callable[[], list[str]], list[str]]
Accepts = Callable[[Any], bool]


def _is_number(value: Any) -> bool:
    return hasattr(type(value), "__float__") and getattr(value, "ndim", 0) == 0


def _may_be_numbers(value: Any) -> bool:
    """Functions look at what they take for numbers themselves, some of one for several."""
    item = type(value)
    return value is None or any(hasattr(item, name) for name in ("__iter__", "__float__"))


def _is_list(value: Any) -> bool:
    return hasattr(type(value), "__iter__") and not isinstance(value, str | bytes)


PLAIN: dict[str, tuple[Accepts, str]] = {
    "None": (lambda value: value is None, ""),
    "bool": (lambda value: not isinstance(value, str), "True or False"),
    "int": (lambda value: hasattr(type(value), "__index__"), "a whole number"),
    "float": (_is_number, "a number in SI units"),
    "complex": (lambda value: hasattr(type(value), "__complex__") or _is_number(value), ""),
    "str": (lambda value: isinstance(value, str), "a text"),
    "os.PathLike[str]": (lambda value: hasattr(type(value), "__fspath__"), "a path"),
    "Sequence": (_is_list, "a list"),
    "Iterable": (_is_list, "a list"),
    "Any": (lambda _: True, ""),
}
"""What is declared -> whether a value is that, and what to say of it."""
NUMBERS = ("Array", "np.ndarray", "Sequence[float]", "Sequence[str]", "Vector")
"""How arrays are declared."""
NAMED = (Parameter.POSITIONAL_OR_KEYWORD, Parameter.KEYWORD_ONLY)
"""Kinds of parameters that have one value each, which may be given by name."""
READ = {"Machine", "Tool", "Study"}
"""What `load` gives."""
ROOMS = ("", "mechanism", "handheld", "studies", "balancing", "vibration", "planting", "measured")


def attach(package: str, file: str) -> LazyAttributes:
    """The names of the stub beside a file, each imported when it is first used; see `lazy_loader`.

    Functions are guarded: they raise a `UsageError` where an argument is none of theirs.
    """
    find, names, every = attach_stub(package, file)

    def __getattr__(name: str) -> Any:
        function = find(name)
        if isfunction(function):
            function = vars(sys.modules[package])[name] = guarded(function)
        return function

    return __getattr__, names, every


@cache
def guarded(function: Callable[..., Any]) -> Callable[..., Any]:
    """The function, which says what is wrong with its arguments.

    It takes the function's place in its module, where `pickle` looks for it.
    """
    call = _guarded(function)
    setattr(sys.modules[function.__module__], function.__name__, call)
    return call


def _guarded(function: Callable[..., Any]) -> Callable[..., Any]:
    if hasattr(function, "__wrapped__"):
        return function
    name, declared = function.__name__, signature(function)
    parameters = declared.parameters
    plain = [place for place, parameter in parameters.items() if parameter.kind in NAMED]
    required = {place for place in plain if parameters[place].default is Parameter.empty}
    in_order = [place for place in plain if parameters[place].kind is not Parameter.KEYWORD_ONLY]
    accepted: set[tuple[str, type]] = set()

    @wraps(function)
    def call(*args: Any, **kwargs: Any) -> Any:
        given = dict(zip(in_order, args, strict=False)) | kwargs
        is_clear = len(given) == len(args) + len(kwargs) and required <= given.keys()
        if not is_clear or len(plain) < len(parameters) or not given.keys() <= parameters.keys():
            given = bound(name, declared, args, kwargs)
        for place, value in given.items():
            if (place, type(value)) in accepted:
                continue
            parameter = parameters[place]
            each = value if parameter.kind is Parameter.VAR_POSITIONAL else (value,)
            for wrong in filter(None, (_wrong(item, parameter, function) for item in each)):
                raise CallError(f"{name}: {place}: {wrong}")
            if place in plain and not hasattr(value, "ndim"):  # of arrays the shape matters
                accepted.add((place, type(value)))
        return function(*args, **kwargs)

    return call


def bound(
    name: str, declared: Signature, args: tuple[Any, ...], kwargs: dict[str, Any]
) -> dict[str, Any]:
    """Arguments by parameter.

    Raises
    ------
    UsageError : there is no such parameter, or one is missing.
    """
    known = [parameter for parameter in declared.parameters if parameter != "self"]
    takes_any = any(
        parameter.kind is Parameter.VAR_KEYWORD for parameter in declared.parameters.values()
    )
    for given in () if takes_any else kwargs:
        if given not in known:
            raise CallError(f"{name}: {unknown(given, known, 'parameter')}")
    try:
        return declared.bind(*args, **kwargs).arguments
    except TypeError as error:
        raise CallError(f"{name}: {error}; it takes {', '.join(known)}") from None


def _wrong(value: Any, parameter: Parameter, function: Callable[..., Any]) -> str:
    """What is wrong with a value; empty where it may be what is declared."""
    kinds = [part.strip() for part in str(parameter.annotation).split("|")]
    classes = {item.__name__ for item in type(value).__mro__}
    wanted = []
    for kind in kinds:
        accepts, words = PLAIN.get(kind) or PLAIN.get(kind.partition("[")[0]) or (None, "")
        if kind.startswith(NUMBERS):
            accepts, words = _may_be_numbers, "numbers"
        elif accepts is None and (choices := _choices(kind, function)):
            accepts, words = (lambda text: isinstance(text, str)), f"one of {', '.join(choices)}"
        if kind in classes or (accepts is not None and accepts(value)):
            return ""
        if accepts is None:
            if not _is_class(kind, function):
                return ""  # which the function looks at itself
            words = f"{'an' if kind[0] in 'AEIOU' else 'a'} {kind}"
        wanted.append(words)
    text = repr(value) if isinstance(value, str | int | float | None) else None
    got = text[:60] if text else f"one of the type {type(value).__name__}"
    hint = ", which load reads from a file" if READ & {*kinds} and isinstance(value, str) else ""
    return f"got {got}; give {' or '.join(dict.fromkeys(filter(None, wanted)))}{hint}"


def _choices(kind: str, function: Callable[..., Any]) -> list[str]:
    """Values of an alias such as ``Literal["a", "b"]`` in the module of a function."""
    result = getattr(getattr(function, "__globals__", {}).get(kind), "__args__", ())
    return [repr(item) for item in result] if all(isinstance(item, str) for item in result) else []


def _is_class(kind: str, function: Callable[..., Any]) -> bool:
    """Whether a name is that of a class of ours that values are made of."""
    if not kind.isidentifier():
        return False
    value = getattr(function, "__globals__", {}).get(kind) or next(_public(kind), None)
    return isclass(value) and not getattr(value, "_is_protocol", False)


def _public(kind: str) -> Iterator[Any]:
    """A class that is imported for annotations only, by its public name."""
    for room in ROOMS:
        module = import_module(f"equipoise.{room}".rstrip("."))
        if kind in module.__all__:
            yield getattr(module, kind)


def keyworded(cls: Any) -> Any:
    """Let a constructor say which keyword is none of its own, which costs nothing where all are;
    methods that give a changed object are guarded as functions are.
    """
    for name in [var for var in vars(cls) if var.startswith("with_")]:
        setattr(cls, name, _guarded(getattr(cls, name)))
    make = vars(cls).get("__init__")
    if isinstance(make, Constructor):
        make.wrap = partial(_answering, cls)
    else:
        cls.__init__ = _answering(cls, cls.__init__)
    return cls


def _answering(cls: Any, make: Any) -> Any:
    """A constructor that says which keyword is none of its own."""

    @wraps(make)
    def __init__(self: Any, *args: Any, **kwargs: Any) -> None:
        try:
            make(self, *args, **kwargs)
        except TypeError:
            bound(cls.__name__, signature(make), (self, *args), kwargs)
            raise

    return __init__
