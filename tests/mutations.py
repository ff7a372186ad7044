"""Files as a careless or a hostile hand leaves them: text and bytes changed at random, by their grammar and against it.

``FLANKFILM_FUZZ`` says how many files there are in all (400 if it is not set).
"""

from __future__ import annotations

import json
import math
import os
import random
import re
from collections.abc import Callable
from typing import Any

FILES = int(os.environ.get("FLANKFILM_FUZZ", "400"))

ODD = (
    *(
        "nan",
        "-inf",
        "0",
        "-0.0",
        "1e308",
        "-1e308",
        "5e-324",
        "9" * 400,
        "0x" + "f" * 5000,
        "1e400",
        "1_000",
    ),
    *(
        "true",
        "null",
        '""',
        '"\\u0000"',
        "[]",
        "{}",
        "[[[]]]",
        "[nan]",
        "1979-05-27",
        "'''",
        '"""',
        "\\",
        "#",
    ),
    *('"../../../etc/passwd"', '"/dev/zero"', '"."', '"\\uD800"', "\u202e", "\x00", "\ufeff", "\u00e9" * 300),
    *('"!!python/object/apply:os.system [touch executed]"', "\"__import__('os').system('touch executed')\""),
    *(
        '"{{ 7 * 7 }}"',
        '"=cmd|calc"',
        '"$(touch executed)"',
        "[" * 2000,
        "{ a = " * 300,
        "<" * 300,
        "&amp;",
        "&x;",
    ),
)
"""What takes the place of a word."""

WORD = re.compile(r"[A-Za-z_][\w.]*|-?\d[\d.eE+-]*|\"[^\"\n]*\"")


def changed_text(chance: random.Random, text: str, pool: str) -> str:
    """A text with some of its words and lines changed; `pool` is another one of the same kind."""
    for _ in range(chance.choice((1, 1, 1, 2, 3, 8))):
        text = chance.choice(_OF_TEXT)(chance, text, pool)
    return text[:2_000_000]


def _word(chance: random.Random, text: str, pool: str) -> str:
    words = list(WORD.finditer(text))
    if not words:
        return text + chance.choice(ODD)
    one = chance.choice(words)
    others = WORD.findall(pool) or [""]
    new = chance.choice(ODD) if chance.random() < 0.5 else chance.choice(others)
    return text[: one.start()] + new + text[one.end() :]


def _number(chance: random.Random, text: str, _: str) -> str:
    numbers = list(re.finditer(r"-?\d+\.?\d*", text))
    if not numbers:
        return text
    one = chance.choice(numbers)
    value = float(one[0])
    new = chance.choice(
        (-value, 0.0, value * 10 ** chance.uniform(-12, 12), value + 1, value - 1, value * 1.01)
    )
    return (
        text[: one.start()]
        + (repr(new) if chance.random() < 0.7 or not math.isfinite(new) else str(int(new)))
        + text[one.end() :]
    )


def _line(chance: random.Random, text: str, pool: str) -> str:
    lines, others = text.split("\n"), pool.split("\n")
    at, to = chance.randrange(len(lines)), chance.randrange(len(lines))
    how = chance.randrange(5)
    if how == 0:
        del lines[at]
    elif how == 1:
        lines.insert(to, lines[at])
    elif how == 2:
        lines[at], lines[to] = lines[to], lines[at]
    elif how == 3:
        lines.insert(at, chance.choice(others))
    else:
        lines[at] = lines[at][: chance.randrange(len(lines[at]) + 1)]
    return "\n".join(lines)


def _piece(chance: random.Random, text: str, pool: str) -> str:
    at = chance.randrange(len(text) + 1)
    end = min(len(text), at + chance.choice((1, 1, 3, 20, 200)))
    how = chance.randrange(5)
    if how == 0:
        return text[:at] + text[end:]
    if how == 1:
        return text[:at] + text[at:end] * chance.choice((2, 50)) + text[end:]
    if how == 2:
        return text[:at] + chance.choice("\"'[]{}()=<>,;.:#&\n\t\r\0\x7f\u2028%!/\\") + text[at:]
    if how == 3:
        start = chance.randrange(len(pool) + 1)
        return text[:at] + pool[start : start + chance.choice((5, 50, 500))] + text[end:]
    return text[:at]


_OF_TEXT: tuple[Callable[[random.Random, str, str], str], ...] = (
    _word,
    _word,
    _number,
    _number,
    _line,
    _line,
    _piece,
)


def changed_bytes(chance: random.Random, content: bytes) -> bytes:
    """A content with some of its bytes changed, moved or cut."""
    for _ in range(chance.choice((1, 1, 2, 5, 20))):
        found = bytearray(content)
        at = chance.randrange(len(found) + 1)
        end = min(len(found), at + chance.choice((1, 2, 4, 8, 64, 4096)))
        how = chance.randrange(8)
        if how <= 2 and at < len(found):
            found[at] ^= 1 << chance.randrange(8)
        elif how == 3:
            found[at:end] = chance.choice((b"\0", b"\xff", b"\x7f")) * (end - at)
        elif how == 4:
            del found[at:end]
        elif how == 5:
            found[at:at] = chance.randbytes(end - at)
        elif how == 6:
            to = chance.randrange(len(found) + 1)
            found[to : to + end - at] = found[at:end]
        elif chance.random() < 0.2:
            del found[at:]
        content = bytes(found)
    return content


def changed_file(chance: random.Random, text: str, pool: str) -> bytes:
    """A text file, most often changed as text, now and then as bytes."""
    if chance.random() < 0.85:
        content = changed_text(chance, text, pool).encode("utf-8", "surrogatepass")
        return content if chance.random() < 0.9 else changed_bytes(chance, content)
    return changed_bytes(chance, text.encode("utf-8"))


def changed_value(chance: random.Random, value: Any, depth: int = 0) -> Any:
    """Plain data as JSON has it, with one of its parts replaced."""
    if isinstance(value, list) and value and depth < 6 and chance.random() < 0.85:
        place = chance.randrange(len(value))
        return [changed_value(chance, one, depth + 1) if i == place else one for i, one in enumerate(value)]
    if isinstance(value, dict) and value and depth < 6 and chance.random() < 0.85:
        key = chance.choice(list(value))
        if chance.random() < 0.2:
            return {(f"{k}x" if k == key else k): one for k, one in value.items()}
        if chance.random() < 0.2:
            return {k: one for k, one in value.items() if k != key}
        return {k: changed_value(chance, one, depth + 1) if k == key else one for k, one in value.items()}
    if isinstance(value, (int, float)) and chance.random() < 0.6:
        return chance.choice((-value, value + 1, 0, 2**31, 2**63, -1, 10**30, value * 1e300, 1e-300))
    odd = [
        None,
        True,
        -1,
        0,
        2**64,
        1e308,
        float("nan"),
        "",
        "x" * 1000,
        "\0",
        [],
        {},
        [[]],
        {"a": []},
        [0],
        [10**9],
    ]
    return chance.choice(
        [*odd, "O", "|O8", "V8", "<f8", "<U1000000000", "os", "system", "../x", json.dumps(ODD[:3])]
    )
