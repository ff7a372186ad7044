"""Small faults that can be planted in a source file: where they can stand, and the text of the file with one."""

from __future__ import annotations

import ast
import copy
import itertools
import random
import re
import subprocess
from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

SILENT = {"__repr__", "__str__", "_repr_html_", "_repr_png_", "_repr_svg_"}
"""Functions whose text is for the eye."""

ARITHMETIC: dict[type[ast.operator], tuple[type[ast.operator], ...]] = {
    ast.Add: (ast.Sub,),
    ast.Sub: (ast.Add,),
    ast.Mult: (ast.Div,),
    ast.Div: (ast.Mult,),
    ast.Pow: (ast.Mult,),
    ast.MatMult: (),
    ast.FloorDiv: (ast.Div,),
    ast.Mod: (ast.FloorDiv,),
    ast.BitAnd: (ast.BitOr,),
    ast.BitOr: (ast.BitAnd,),
}
COMPARISONS: dict[type[ast.cmpop], tuple[type[ast.cmpop], ...]] = {
    ast.Lt: (ast.LtE, ast.GtE),
    ast.LtE: (ast.Lt, ast.Gt),
    ast.Gt: (ast.GtE, ast.LtE),
    ast.GtE: (ast.Gt, ast.Lt),
    ast.Eq: (ast.NotEq,),
    ast.NotEq: (ast.Eq,),
    ast.Is: (ast.IsNot,),
    ast.IsNot: (ast.Is,),
    ast.In: (ast.NotIn,),
    ast.NotIn: (ast.In,),
}
TWINS = [
    ("min", "max"), ("minimum", "maximum"), ("amin", "amax"), ("nanmin", "nanmax"), ("argmin", "argmax"),
    ("sin", "cos"), ("any", "all"), ("floor", "ceil"), ("zeros", "ones"), ("real", "imag"),
]  # fmt: skip
EXCHANGED = {a: b for pair in TWINS for a, b in (pair, pair[::-1])}
"""Names that stand for one another."""
CHANGED = re.compile(r"^\+\+\+ b/(.*)$|^@@ -\S+ \+(\d+)(?:,(\d+))? @@", re.MULTILINE)
"""A file, or lines that are new in it, as git prints changes without the lines around them."""


@dataclass(frozen=True)
class Fault:
    """One change of one place of one file."""

    path: str  # from the root, with slashes
    place: str  # names of the classes and functions around it
    kind: str
    before: str
    after: str
    nth: int  # among the same ones in the same place
    line: int  # first and last line of the statement or expression, from 1
    last: int
    start: int  # bytes of the file
    end: int
    text: str  # what is written there instead

    @property
    def name(self) -> str:
        """What tells it from every other fault, also after lines have moved."""
        return f"{self.path}::{self.place} [{self.kind} {self.nth}] {self.before} -> {self.after}"

    def planted(self, source: bytes) -> bytes:
        """The file with the fault."""
        return source[: self.start] + self.text.encode() + source[self.end :]


Site = tuple[Any, str, tuple[str, ...]]
"""A node, what it is to the one around it, and the names of the classes and functions around it."""


def sites(source: bytes) -> list[Site]:
    """All places of a file where a fault can stand."""
    return [site for site in _nodes(ast.parse(source), ()) if any(_changes(*site[:2]))]


def faults_at(path: str, source: bytes, site: Site, every: Iterable[Site]) -> list[Fault]:
    """The faults that can stand in a place and that the compiler takes."""
    node, role, place = site
    starts = [0, *itertools.accumulate(len(line) for line in source.splitlines(keepends=True))]
    last = node.end_lineno or node.lineno
    start = starts[node.lineno - 1] + node.col_offset
    end = starts[last - 1] + (node.end_col_offset or 0)
    before = ast.unparse(node)
    alike = [one for one, _, there in every if there == place and type(one) is type(node)]
    nth = 1 + sum(
        1 for one in itertools.takewhile(lambda one: one is not node, alike) if ast.unparse(one) == before
    )
    found = []
    for kind, changed in _changes(node, role):
        after = ast.unparse(changed)
        as_long = "\n" * (last - node.lineno)
        text = f"{after}{as_long}" if isinstance(node, ast.stmt) else f"({after}{as_long})"
        fault = Fault(path, ".".join(place), kind, before, after, nth, node.lineno, last, start, end, text)
        if _compiles(fault.planted(source)):
            found.append(fault)
    return found


def written_since(root: Path, revision: str) -> dict[str, set[int]]:
    """Lines, by file, that were written or changed since a revision; a file that only moved has none."""
    command = [
        "git",
        "diff",
        "--unified=0",
        "--find-renames",
        "--no-color",
        "--no-ext-diff",
        revision,
        "--",
        "*.py",
    ]
    changes = subprocess.run(command, cwd=root, capture_output=True, text=True, check=True).stdout
    found: dict[str, set[int]] = {}
    path = ""
    for file, first, count in CHANGED.findall(changes):
        path = file or path
        if first:
            found.setdefault(path, set()).update(range(int(first), int(first) + int(count or 1)))
    return found


def sample(
    root: Path,
    files: Iterable[Path],
    number: int,
    seed: int,
    lines: Mapping[str, Collection[int]] | None = None,
) -> list[Fault]:
    """Draw places at random, all equally likely, and one fault of each; only in `lines` by file if given."""
    rng = random.Random(seed)
    of_file = {file: sites(file.read_bytes()) for file in sorted(files)}
    every = [
        (file, site)
        for file, some in of_file.items()
        for site in some
        if lines is None or site[0].lineno in lines.get(file.relative_to(root).as_posix(), ())
    ]
    drawn: list[Fault] = []
    for file, site in rng.sample(every, len(every)):
        if len(drawn) == number:
            break
        path, source = file.relative_to(root).as_posix(), file.read_bytes()
        if able := faults_at(path, source, site, of_file[file]):
            drawn.append(rng.choice(able))
    return drawn


def named(root: Path, names: Iterable[str]) -> list[Fault]:
    """Find faults again by their names, also after lines have moved; those that are gone are left out."""
    found = []
    for name in names:
        file = root / name.partition("::")[0]
        if not file.exists():
            continue
        source, place = file.read_bytes(), name.partition("::")[2].partition(" [")[0]
        every = sites(source)
        near = (site for site in every if ".".join(site[2]) == place)
        all_here = (f for site in near for f in faults_at(name.partition("::")[0], source, site, every))
        found += itertools.islice((fault for fault in all_here if fault.name == name), 1)
    return found


def _compiles(source: bytes) -> bool:
    try:
        compile(source, "planted", "exec", dont_inherit=True)
    except (SyntaxError, ValueError):
        return False
    return True


def _nodes(node: ast.AST, place: tuple[str, ...]) -> Iterator[tuple[Any, str, tuple[str, ...]]]:
    """Statements and expressions that compute, and what each is to the one around it; no types, no messages."""
    for name, inner in ast.iter_fields(node):
        if name in ("annotation", "returns", "decorator_list", "bases"):
            continue
        for one in inner if isinstance(inner, list) else [inner]:
            if not isinstance(one, ast.AST) or _is_silent(one):
                continue
            inside = (*place, one.name) if isinstance(one, ast.FunctionDef | ast.ClassDef) else place
            if isinstance(one, ast.expr | ast.stmt):
                yield one, f"{type(node).__name__}.{name}", inside
            yield from _nodes(one, inside)


def _is_silent(node: ast.AST) -> bool:
    """Messages, patterns, imports, and what type checkers alone see."""
    match node:
        case ast.Raise() | ast.Import() | ast.ImportFrom() | ast.JoinedStr() | ast.pattern():
            return True
        case ast.FunctionDef(name=name):
            return name in SILENT
        case ast.If(test=ast.Name(id=name)):
            return name == "TYPE_CHECKING"
        case ast.Call(func=ast.Attribute(attr=name) | ast.Name(id=name)):
            return name in ("warn", "warn_explicit", "TypeVar", "cast")
    return False


def _changes(node: Any, role: str) -> Iterator[tuple[str, Any]]:
    """Kind of change, and the changed node."""
    if role in ("If.test", "IfExp.test", "comprehension.ifs"):
        yield "condition", ast.Constant(True)
        yield "condition", ast.Constant(False)
    match node:
        case ast.Constant(value=bool()):
            yield "flag", ast.Constant(not node.value)
        case ast.Constant(value=int()):
            yield "off by one", ast.Constant(node.value + 1)
        case ast.Constant(value=float()):
            yield "constant", ast.Constant(1.01 * node.value or 0.01)
        case ast.UnaryOp(op=ast.USub()):
            yield "sign", node.operand
        case ast.UnaryOp(op=ast.Not()):
            yield "not", node.operand
        case ast.BinOp() if not (_is_text(node.left) or _is_text(node.right)):
            for operator in ARITHMETIC.get(type(node.op), ()):
                yield "operator", _with(node, op=operator())
            yield "dropped term", node.left
            if isinstance(node.op, ast.Add | ast.Mult):
                yield "dropped term", node.right
            elif isinstance(node.op, ast.Sub):
                yield "dropped term", ast.UnaryOp(ast.USub(), node.right)
        case ast.Compare():
            for n, operator in enumerate(node.ops):
                for other in COMPARISONS[type(operator)]:
                    yield "comparison", _with(node, ops=[*node.ops[:n], other(), *node.ops[n + 1 :]])
        case ast.BoolOp():
            yield "and, or", _with(node, op=ast.And() if isinstance(node.op, ast.Or) else ast.Or())
            for n in range(len(node.values)):
                rest = node.values[:n] + node.values[n + 1 :]
                yield "dropped term", rest[0] if len(rest) == 1 else _with(node, values=rest)
        case ast.IfExp():
            yield "branches", _with(node, body=node.orelse, orelse=node.body)
        case ast.Call():
            yield from _changes_of_call(node)
        case ast.AugAssign():
            for operator in ARITHMETIC.get(type(node.op), ()):
                yield "operator", _with(node, op=operator())
            yield "removed", ast.Pass()
        case ast.Expr(value=ast.Call()) | ast.Continue() | ast.Break():
            yield "removed", ast.Pass()
        case ast.Assign(targets=[ast.Attribute() | ast.Subscript()]):
            yield "removed", ast.Pass()


def _changes_of_call(node: ast.Call) -> Iterator[tuple[str, ast.expr]]:
    function, given = node.func, node.args
    for n in range(len(given) - 1):
        pair = given[n : n + 2]
        if not any(isinstance(one, ast.Starred) for one in pair) and ast.dump(pair[0]) != ast.dump(pair[1]):
            yield "swapped arguments", _with(node, args=[*given[:n], *pair[::-1], *given[n + 2 :]])
    for n in range(len(node.keywords)):
        yield "dropped argument", _with(node, keywords=node.keywords[:n] + node.keywords[n + 1 :])
    match function:
        case ast.Name(id=name):
            if name in EXCHANGED:
                yield "other function", _with(node, func=ast.Name(EXCHANGED[name]))
        case ast.Attribute(attr=name):
            if name in EXCHANGED:
                yield "other function", _with(node, func=_with(function, attr=EXCHANGED[name]))
            if name in ("sqrt", "abs", "exp", "log", "hypot", "square") and given:
                yield "dropped function", given[0]


def _with(node: Any, **changes: Any) -> Any:
    other = copy.copy(node)
    for name, value in changes.items():
        setattr(other, name, value)
    return other


def _is_text(node: ast.expr) -> bool:
    return isinstance(node, ast.JoinedStr) or (isinstance(node, ast.Constant) and isinstance(node.value, str))
