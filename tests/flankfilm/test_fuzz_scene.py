"""Malformed and extreme scenes and studies: a list of faults or success, never anything else, never a hang.

The default suite tries some hundred files of each kind; the slow one a quarter of the files that ``FLANKFILM_FUZZ``
says, by ``FLANKFILM_SEED`` (tests/flankfilm/test_fuzz_files.py tries the others, with kinds that are not made here).
"""

from __future__ import annotations

import re
import tracemalloc
import types
import typing
from collections.abc import Callable
from pathlib import Path
from typing import TypeVar

import pytest
from hypothesis import HealthCheck, given, seed, settings
from hypothesis import strategies as st
from pydantic import BaseModel

from base import InputError
from flankfilm.runs.check import check_scene
from flankfilm.scene import Scene, parse_scene, template
from flankfilm.studies.plan import read_plan
from flankfilm.studies.study_file import StudyFile
from tests.mutations import FILES
from tests.seeds import SEED

T = TypeVar("T")
FEW = settings(max_examples=150, deadline=10_000, suppress_health_check=list(HealthCheck))
MANY = settings(deadline=10_000, suppress_health_check=list(HealthCheck), database=None)

# what stands in a file by mistake or by malice: not finite, huge, of another kind, nested, Unicode, a date
ODD = [
    *("nan", "-nan", "inf", "-inf", "-0.0", "0", "0.0", "1e308", "-1e308", "5e-324", "1e-300"),
    *("9" * 400, "-" + "9" * 400, "9" * 5000, "0x" + "f" * 5000, "9223372036854775808", "1_000", "1e400"),
    *("true", '""', '"nan"', '"\\u0000"', '"\\U0001F600"', '"../../x"', '"/etc/passwd"', "'''\n'''"),
    *("1979-05-27", "07:32:00", "1979-05-27T07:32:00Z", "[]", "{}", "[[]]", "[nan]", '{ "" = 1 }'),
    *("[" * 3000 + "]" * 3000, "[" + "0," * 20_000 + "]", "{ a = " * 500 + "1" + " }" * 500),
]


def models(annotation):
    """Models in an annotation, through unions and optionals."""
    if typing.get_origin(annotation) in (typing.Union, types.UnionType, typing.Annotated):
        return [m for part in typing.get_args(annotation) for m in models(part)]
    return [annotation] if isinstance(annotation, type) and issubclass(annotation, BaseModel) else []


def bounds(field):
    """Bounds of a number's field, with the numbers just inside and outside."""
    found = [getattr(m, n) for m in field.metadata for n in ("ge", "gt", "le", "lt") if hasattr(m, n)]
    return [v * f for v in found for f in (1, 1 + 1e-9, 1 - 1e-9, 0.5, 2)] or [0.0, 1.0]


@st.composite
def values(draw, field):
    """A value for a field: plausible, at the edge, or odd."""
    choice = draw(st.integers(0, 9))
    if choice == 0:
        return draw(st.sampled_from(ODD))
    inner = models(field.annotation)
    if inner:
        return draw(tables(draw(st.sampled_from(inner))))
    text = str(field.annotation)
    if "Literal" in text and "tuple" not in text:
        words = re.findall(r"'([^']*)'", text)
        return f'"{draw(st.sampled_from(words))}"'
    if "tuple" in text:
        if "Literal" in text:
            words = re.findall(r"'([^']*)'", text)
            return str(draw(st.lists(st.sampled_from(words), max_size=4)))
        return str(draw(st.lists(st.floats(0, 1e5), max_size=3)))
    if "bool" in text:
        return draw(st.sampled_from(["true", "false"]))
    if "str" in text:
        return '"' + draw(st.text("ab./\u00e9\u202e", max_size=300)) + '"'
    if "int" in text:
        edge = [int(v) for v in bounds(field)]
        return str(draw(st.sampled_from([*edge, 17, 20, 40, 100])))
    return repr(float(draw(st.one_of(st.sampled_from(bounds(field)), st.floats(1e-3, 300)))))


@st.composite
def tables(draw, model):
    """An inline table of a model with most of its keys, sometimes with one that it has not."""
    parts = []
    for name, field in model.model_fields.items():
        if field.is_required() or draw(st.booleans()):
            parts.append(f"{name} = {draw(values(field))}")
    if draw(st.integers(0, 15)) == 0:
        unknown = draw(st.text("ab .", max_size=5))
        parts.append(f'"{unknown}" = 1')
    return "{ " + ", ".join(parts) + " }"


LINES = [line.partition(" = ")[0] for line in template().splitlines() if re.match(r"\w+ = ", line)]


@st.composite
def changed_templates(draw):
    """The template with its numbers changed a little, and perhaps a key given an odd value."""
    text = template()
    share = draw(st.sampled_from([0.0, 0.05, 0.3]))
    chance = draw(st.randoms(use_true_random=False))

    def moved(number):
        value = float(number[2]) * chance.uniform(1 - share, 1 + share)
        return number[1] + (repr(value) if "." in number[2] else str(round(value)))

    text = re.sub(r"( = |\[|, )(\d+\.?\d*)\b", moved, text)
    if draw(st.booleans()):
        key, value = draw(st.sampled_from(LINES)), draw(st.sampled_from(ODD))
        text = re.sub(rf"(?m)^{key} = .*$", lambda _: f"{key} = {value}", text, count=1)
    return text


GEAR = st.builds(
    "{{ teeth = {}, profile_shift = {:.3f}, tip_alteration = {:.3f}, thickness_allowance_um = {:.1f}{} }}".format,
    st.one_of(st.integers(17, 60), st.integers(5, 10_000)),
    st.one_of(st.floats(0, 0.4), st.floats(-0.8, 1.5)),
    st.one_of(st.just(0.0), st.floats(-1, 1)),
    st.one_of(st.just(0.0), st.floats(0, 5e4)),
    st.sampled_from(
        [
            "",
            ", bore_mm = 1e6",
            ", tip_chamfer_mm = 0.1",
            ", tip_relief = { amount_um = 20, length_mm = 2.0 }",
        ]
    ),
)
PAIRS = st.builds(
    'wants = ["geometry"]\n[pair]\nmodule_mm = {!r}\nface_width_mm = 10.0\npinion = {}\nwheel = {}\n{}\n{}\n'.format,
    st.one_of(st.just(2.0), st.floats(0.01, 100)),
    GEAR,
    GEAR,
    st.sampled_from(["", "backlash_um = 50", "centre_distance_mm = 76.0", "centre_distance_mm = 1e6"]),
    st.just("")
    | st.builds(
        "rack = {{ h_aP = {!r}, h_fP = {!r}, rho_fP = {!r}, alpha_deg = {!r} }}".format,
        *([st.one_of(st.floats(0.5, 1.5), st.floats(0.001, 3))] * 3),
        st.floats(10, 35),
    ),
)
SCENES = st.one_of(tables(Scene).map(lambda t: "\n".join(split(t))), changed_templates(), PAIRS)


def split(table):
    """Top-level keys of an inline table, one a line."""
    lines, depth, begin, quoted = [], 0, 2, False
    for at, sign in enumerate(table):
        if sign == '"' and table[at - 1] != "\\":
            quoted = not quoted
        depth += 0 if quoted else (sign in "{[") - (sign in "}]")
        if (sign == "," and depth == 1 and not quoted) or at == len(table) - 1:
            lines.append(table[begin:at].strip())
            begin = at + 1
    return lines


def faults_of(judge):
    """Faults that a call raises; None where it succeeds. Anything else that it raises is a failure."""
    try:
        judge()
    except InputError as error:
        return error.faults
    return None


def told_well(faults):
    """Whether every fault says where and what is allowed, and the list can be read."""
    said = [f for f in faults if f.allowed != "is not an output"]  # which lists all of them
    return (
        0 < len(faults) <= 100
        and all(f.where and f.allowed for f in faults)
        and all(len(str(f)) < 2000 for f in said)
    )


def judged(text):
    """A scene is accepted, or refused with a list of faults."""
    faults = faults_of(lambda: check_scene(parse_scene(text)))
    assert faults is None or told_well(faults)


@st.composite
def studies(draw):
    """A study file: each key as it should be, at the edge, or odd."""
    keys = [
        "pair.module_mm",
        "pair.pinion.profile_shift",
        "pair.pinion.teeth",
        "pair",
        "tolerance",
        "",
        "a..b",
        "wants",
    ]
    number = st.one_of(st.floats(-2, 60).map(repr), st.integers(-5, 60).map(str), st.sampled_from(ODD))
    whole = st.one_of(st.integers(0, 6).map(str), st.sampled_from(["1000000", "1000001", *ODD]))
    ranges = st.builds(
        "{{ from = {}, to = {}{} }}".format,
        number,
        number,
        st.one_of(
            st.just(""),
            whole.map(", steps = {}".format),
            whole.map(", log = true, steps = {}".format),
            whole.map(", whole = true, steps = {}".format),
        ),
    )
    listed = st.lists(number, max_size=4).map(lambda found: "[" + ", ".join(found) + "]")
    vary = draw(
        st.dictionaries(st.sampled_from(keys), st.one_of(ranges, listed, st.sampled_from(ODD)), max_size=3)
    )
    outputs = draw(st.lists(st.sampled_from(["contact_ratio", "transmission_error", "other"]), max_size=3))
    lines = [f"outputs = {outputs}"]
    scenes = [
        '"scene.toml"',
        '"none.toml"',
        '"."',
        '"/dev/zero"',
        '"\\u0000"',
        '"' + "x" * 5000 + '"',
        "{ pair = 1 }",
    ]
    lines.append(f"scene = {draw(st.one_of(st.just(scenes[0]), st.sampled_from([*scenes, *ODD])))}")
    for key in StudyFile.model_fields:
        if key in ("design", "samples", "seed", "title") and draw(st.booleans()):
            words = ['"grid"', '"list"', '"sobol"', '"latin-hypercube"']
            value = st.sampled_from(words) if key == "design" else whole
            lines.append(f"{key} = {draw(st.one_of(value, value, st.sampled_from(ODD)))}")
    lines += ["[vary]", *(f'"{key}" = {value}' for key, value in vary.items())]
    if draw(st.booleans()):
        rule = draw(
            st.builds('{{ of = "{}", times = {}, plus = {} }}'.format, st.sampled_from(keys), number, number)
        )
        lines += ["[follow]", f'"pair.wheel.profile_shift" = {rule}']
    if draw(st.booleans()):
        lines += ["[set]", f'"{draw(st.sampled_from(keys))}" = {draw(number)}']
    return "\n".join(lines)


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    place = tmp_path_factory.mktemp("studies")
    (place / "scene.toml").write_text(template(), encoding="utf-8")
    return place


def read_study(folder, text):
    path = folder / "study.toml"
    path.write_text(text, encoding="utf-8")
    faults = faults_of(lambda: read_plan(path).identity())
    assert faults is None or told_well(faults)


@FEW
@given(SCENES)
def test_any_scene_is_in_order_or_explained(text):
    judged(text)


@settings(FEW, deadline=60_000)  # a million rows, the most there may be, take 11 s
@given(studies())
def test_any_study_is_in_order_or_explained(folder, text):
    read_study(folder, text)


BOMBS = {
    "dotted key": ".".join(["a"] * 100_000) + " = 1",
    "dotted key, quoted": " . ".join(['"a"'] * 50_000) + " = 1",
    "dotted key, just allowed": ".".join(["a"] * 7_000) + " = 1",
    "dotted key in disguise": 'a = { b = """ " # """, ' + ".".join(["a"] * 100_000) + " = 1 }",
    "dotted table": "[" + ".".join(["a"] * 100_000) + "]",
    "keys": "\n".join(f"k{i}_mm = 1" for i in range(30_000)),
    "tables": "\n".join(f"[pair.k{i}]" for i in range(30_000)),
    "list": "wants = [" + "0," * 60_000 + "]",
    "nested lists": "a = " + "[" * 300_000,
    "nested tables": "a = " + "{ b = " * 400 + "1" + " }" * 400,
    "one word": "a" * 900_000,
    "one text": 'a = "' + "b" * 900_000 + '"',
    "dots": "a = " + "." * 900_000,
    "long key": "b" * 900_000 + " = 1",
    "long value": 'wants = ["vtk"]\n[stiffness]\nmodel = "' + "b" * 900_000 + '"',
    "digits": "a = " + "9" * 900_000,
}


def resident(what: str) -> int:
    """Memory of this process now (``VmRSS``) or at most since it was asked to begin anew (``VmHWM``) [bytes]."""
    found = re.search(rf"{what}:\s+(\d+) kB", Path("/proc/self/status").read_text(encoding="ascii"))
    assert found is not None
    return 1024 * int(found[1])


def peak_of(call: Callable[[], T]) -> tuple[T, int]:
    """What a call gives, and by how much memory grew meanwhile at most [bytes].

    Linux says so for the whole process; elsewhere each object is followed, which takes four times as long.
    """
    begin_anew = Path("/proc/self/clear_refs")
    if begin_anew.exists():
        begin_anew.write_text("5", encoding="ascii")
        before = resident("VmRSS")
        given = call()
        return given, resident("VmHWM") - before
    tracemalloc.start()
    try:
        return call(), tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()


def test_memory_that_was_freed_again_is_seen():
    assert peak_of(lambda: len(b"x" * 200_000_000))[1] > 150e6 > peak_of(lambda: 0)[1]


@pytest.mark.timeout(120)
@pytest.mark.parametrize("name", BOMBS)
def test_a_small_file_hangs_nothing_and_takes_no_memory(name):
    faults, most = peak_of(lambda: faults_of(lambda: parse_scene(BOMBS[name])))
    assert told_well(faults)
    assert most < 500e6


def test_dots_in_values_are_no_keys():
    text = template().replace("[500, 30000]", "[500.5, 30000.5]")
    text = text.replace('title = "', 'title = "1.2.3.4.5.6.7.8.9.10.11.12.13.14.15 e.g. z. B. ', 1)
    parse_scene(text + "# " + ". ".join("abcdefghijklmnopqrstuvwxyz") + "\n# ...................\n")


@pytest.mark.slow
@pytest.mark.timeout(0)
class TestMany:
    """Not among those that hypothesis remembers: the seed alone says which they are."""

    @seed(SEED)
    @settings(MANY, max_examples=15 * FILES // 100)
    @given(SCENES)
    def test_scenes(self, text):
        judged(text)

    @seed(SEED)
    @settings(MANY, max_examples=10 * FILES // 100)
    @given(studies())
    def test_studies(self, folder, text):
        read_study(folder, text)
