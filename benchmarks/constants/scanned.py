"""Numeric constants of the packages: where they stand, what reads them, and one of them changed for a while.

They are looked up in the sources, so that one that comes tomorrow is studied as well: numbers and tuples of numbers
that a module binds to a name in upper case, and the fields of the records of settings. What compiled kernels know of
is left out: changing it means to compile them anew.
"""

from __future__ import annotations

import ast
import inspect
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, is_dataclass, replace
from functools import cache
from importlib import import_module
from math import isfinite
from pathlib import Path
from types import CodeType
from typing import Any

import pytest

ROOT = Path(__file__).parents[2]
PACKAGES = ("gears", "meshes", "fem", "ehl", "dynamics")
RECORDS = {
    ("fem.pair.options", "USUAL_OPTIONS"): "Options",
    ("ehl.discrete.method", "METHOD"): "Method",
    ("dynamics.model.options", "OPTIONS"): "Options",
}
"""Settings that users may know: instances, and classes whose defaults they are."""

_PURE = {
    "sqrt",
    "log",
    "exp",
    "pi",
    "math",
    "np",
    "numpy",
    "sys",
    "float_info",
    "epsilon",
    "float",
    "finfo",
    "eps",
}


@dataclass(frozen=True, order=True)
class Constant:
    """A name of a module, or a field of the record that it stands for."""

    module: str
    name: str
    field: str = ""

    def __str__(self) -> str:
        """Module and name."""
        return ".".join(filter(None, (self.module, self.name, self.field)))

    @property
    def package(self) -> str:
        """Package of the module."""
        return self.module.partition(".")[0]

    @property
    def value(self) -> Any:
        """Value as it is now."""
        bound = getattr(import_module(self.module), self.name)
        return getattr(bound, self.field) if self.field else bound


@cache
def sources() -> dict[str, ast.Module]:
    """Syntax trees of all modules of the packages but those of compiled kernels, by the modules' names."""
    files = (path for package in PACKAGES for path in sorted((ROOT / package).rglob("*.py")))
    return {
        ".".join(path.relative_to(ROOT).with_suffix("").parts).removesuffix(".__init__"): ast.parse(
            path.read_text(encoding="utf-8")
        )
        for path in files
    }


def _bound(statement: ast.stmt) -> Iterator[tuple[str, ast.expr]]:
    """Names and values of an assignment, of several at once too."""
    if isinstance(statement, ast.Assign) and len(statement.targets) == 1:
        target, value = statement.targets[0], statement.value
    elif isinstance(statement, ast.AnnAssign) and statement.value is not None:
        target, value = statement.target, statement.value
    else:
        return
    if isinstance(target, ast.Name):
        yield target.id, value
    elif isinstance(target, ast.Tuple) and isinstance(value, ast.Tuple):
        for name, part in zip(target.elts, value.elts, strict=True):
            if isinstance(name, ast.Name):
                yield name.id, part


def _numeric(value: ast.expr, constants: set[str]) -> bool:
    """Whether an expression is made of numbers, arithmetic and numeric constants above it."""
    kinds = (ast.operator, ast.unaryop, ast.expr_context, ast.UnaryOp, ast.BinOp, ast.Tuple, ast.Call)
    number = False
    for node in ast.walk(value):
        if isinstance(node, ast.Constant):
            if not isinstance(node.value, int | float) or isinstance(node.value, bool):
                return False
            number = True
        elif isinstance(node, ast.Name):
            if node.id not in _PURE | constants:
                return False
            number = number or node.id in constants
        elif isinstance(node, ast.Attribute):
            if node.attr not in _PURE | {"float64"}:
                return False
            number = True
        elif not isinstance(node, kinds):
            return False
    return number


@cache
def _plain(module: str) -> set[str]:
    """Numeric constants that a module binds itself."""
    names: set[str] = set()
    for statement in sources()[module].body:
        for name, value in _bound(statement):
            if name.upper() == name and _numeric(value, names):
                names.add(name)
    return names


def constants(package: str) -> list[Constant]:
    """All numeric constants of a package outside its compiled kernels, as its sources have them."""
    own = [module for module in sources() if module.partition(".")[0] == package and "kernels" not in module]
    plain = [Constant(module, name) for module in own for name in sorted(_plain(module))]
    return sorted(plain + [c for module in own for c in _fields(module)])


def _fields(module: str) -> Iterator[Constant]:
    """Numeric defaults of the record of settings that stands in a module."""
    for (home, name), made in RECORDS.items():
        if home == module:
            (body,) = (s.body for s in sources()[home].body if isinstance(s, ast.ClassDef) and s.name == made)
            for statement in body:
                for field, value in _bound(statement):
                    if _numeric(value, set()):
                        yield Constant(home, name, field)


@cache
def _imports() -> dict[tuple[str, str], tuple[tuple[str, str], ...]]:
    """Modules that import a name from another, and what they call it, by that module and its name."""
    known: dict[tuple[str, str], tuple[tuple[str, str], ...]] = {}
    for module, tree in sources().items():
        for node in ast.walk(tree):
            if isinstance(node, ast.ImportFrom) and node.module and not node.level:
                for alias in node.names:
                    key = (node.module, alias.name)
                    known[key] = (*known.get(key, ()), (module, alias.asname or alias.name))
    return known


def bindings(module: str, name: str) -> tuple[tuple[str, str], ...]:
    """Modules that bind a constant, and what they call it: its own, and those that import it by name."""
    return ((module, name), *_imports().get((module, name), ()))


def compiled(constant: Constant) -> bool:
    """Whether kernels know a constant."""
    return any("kernels" in module for module, _ in bindings(constant.module, constant.name))


def _mentions(tree: ast.AST, name: str, field: str = "") -> bool:
    """Whether an expression reads a name, or a field of it."""
    if field:
        return any(
            isinstance(n, ast.Attribute) and n.attr == field and _mentions(n.value, name)
            for n in ast.walk(tree)
        ) or (isinstance(tree, ast.Name) and tree.id == name)
    return any(isinstance(n, ast.Name) and n.id == name for n in ast.walk(tree))


@dataclass(frozen=True)
class Follower:
    """Statement of a module that computes something from a constant when the module is imported."""

    module: str
    statement: ast.stmt
    names: tuple[str, ...]

    def patch(self, patch: pytest.MonkeyPatch) -> None:
        """Run it anew."""
        space = dict(vars(import_module(self.module)))
        exec(compile(ast.Module([self.statement], []), self.module, "exec"), space)
        for name in self.names:
            _bind(patch, Constant(self.module, name), space[name])


@cache
def followers(constant: Constant) -> tuple[Follower, ...]:
    """What is computed from a constant when modules are imported, and from that in turn, in its order."""
    family, statements = [constant], []
    for member in family:
        for module, name in bindings(member.module, member.name):
            for statement in sources()[module].body:
                if not isinstance(statement, ast.Assign | ast.AnnAssign) or statement.value is None:
                    continue
                targets = statement.targets if isinstance(statement, ast.Assign) else [statement.target]
                names = tuple(n.id for t in targets for n in ast.walk(t) if isinstance(n, ast.Name))
                follower = Follower(module, statement, names)
                if names and follower not in statements and _mentions(statement.value, name, member.field):
                    statements.append(follower)
                    family += [Constant(module, n) for n in names]
    return tuple(statements)


@dataclass(frozen=True)
class Default:
    """Default of a parameter, or of a field of a dataclass, that is computed from a constant."""

    module: str
    owner: str
    parameter: str
    expression: ast.expr

    def patch(self, patch: pytest.MonkeyPatch) -> None:
        """Compute it anew."""
        space = vars(import_module(self.module))
        owner = space[self.owner.partition(".")[0]]
        for part in self.owner.split(".")[1:]:
            owner = inspect.getattr_static(owner, part)
        value = eval(compile(ast.Expression(self.expression), self.module, "eval"), dict(space))
        if isinstance(owner, type):
            patch.setattr(owner, self.parameter, value)
            if not is_dataclass(owner):
                return
            owner = owner.__init__
        function = inspect.unwrap(getattr(owner, "__func__", owner))
        code = function.__code__
        positional = code.co_varnames[: code.co_argcount]
        if self.parameter in positional:
            place = positional.index(self.parameter) - len(positional)
            defaults = list(function.__defaults__ or ())
            defaults[place] = value
            patch.setattr(function, "__defaults__", tuple(defaults))
        else:
            patch.setitem(function.__kwdefaults__, self.parameter, value)


@cache
def defaults(constant: Constant) -> tuple[Default, ...]:
    """Defaults that are computed from a constant, wherever it is known."""
    return tuple(
        default
        for module, name in bindings(constant.module, constant.name)
        for default in _defaults(module)
        if _mentions(default.expression, name, constant.field)
    )


@cache
def _defaults(module: str) -> tuple[Default, ...]:
    """All defaults in a module's functions, methods and dataclasses."""

    def of(body: list[ast.stmt], owner: str) -> Iterator[Default]:
        for statement in body:
            if isinstance(statement, ast.FunctionDef):
                arguments = statement.args
                named = [a.arg for a in arguments.args + arguments.posonlyargs]
                last = named[len(named) - len(arguments.defaults) :]
                for name, value in zip(last, arguments.defaults, strict=True):
                    yield Default(module, owner + statement.name, name, value)
                for argument, default in zip(arguments.kwonlyargs, arguments.kw_defaults, strict=True):
                    if default is not None:
                        yield Default(module, owner + statement.name, argument.arg, default)
            elif isinstance(statement, ast.ClassDef):
                yield from of(statement.body, owner + statement.name + ".")
            elif owner:
                for name, value in _bound(statement):
                    yield Default(module, owner.removesuffix("."), name, value)

    return tuple(of(sources()[module].body, ""))


def reads(constant: Constant) -> Callable[[CodeType], bool]:
    """Whether code reads a constant: its name, where it is bound, or a default that is computed from it."""
    family = (constant, *(Constant(f.module, name) for f in followers(constant) for name in f.names))
    places = {
        (file_of(module), c.field or name) for c in family for module, name in bindings(c.module, c.name)
    }
    if constant.field:  # any attribute of that name in the package
        places |= {(file_of(m), constant.field) for m in sources() if m.startswith(constant.package + ".")}
    owners = {(file_of(d.module), d.owner.rpartition(".")[2]) for c in family for d in defaults(c)}
    of_classes = {
        file_of(d.module) for c in family for d in defaults(c) if d.owner.rpartition(".")[2][:1].isupper()
    }

    def answer(code: CodeType) -> bool:
        file = code.co_filename
        return (
            (file, code.co_name) in owners
            or file in of_classes
            or any((file, name) in places for name in code.co_names)
        )

    return answer


@cache
def file_of(module: str) -> str:
    """Path of a module's source, as its code has it."""
    return str(import_module(module).__file__)


def scaled(value: Any, twice: bool) -> Any:
    """Number or tuple of numbers, doubled or halved; an odd count keeps its middle, 65 becoming 129 or 33."""
    if isinstance(value, tuple):
        return tuple(scaled(v, twice) for v in value)
    if isinstance(value, float) or value == 0:
        return value * (2.0 if twice else 0.5)
    size = abs(value)
    middle = size % 2 if size > 1 else 0
    new = 2 * size - middle if twice else max((size + middle) // 2, 1)
    return new if value > 0 else -new


@contextmanager
def changed(constant: Constant, twice: bool) -> Iterator[None]:
    """Double or halve a constant for a while, in every module that knows it, with all that is computed from it."""
    with pytest.MonkeyPatch.context() as patch:
        value = scaled(constant.value, twice)
        if constant.field:
            value = replace(getattr(import_module(constant.module), constant.name), **{constant.field: value})
        _bind(patch, constant, value)
        for follower in followers(constant):
            follower.patch(patch)
        yield


def _bind(patch: pytest.MonkeyPatch, constant: Constant, value: Any) -> None:
    for module, name in bindings(constant.module, constant.name):
        patch.setattr(import_module(module), name, value)
    for default in defaults(constant):
        default.patch(patch)


def usable(value: Any) -> bool:
    """Whether a constant can be doubled at all."""
    return all(map(usable, value)) if isinstance(value, tuple) else isfinite(2.0 * value) and value != 0
