"""REXS as JSON and in archives: the same pair as by XML, and nothing that a hostile file can do with them."""

from __future__ import annotations

import json
import zipfile
from contextlib import suppress
from io import BytesIO
from pathlib import Path
from xml.etree import ElementTree as ET

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from base import InputError
from flankfilm.building.pair import gear_pair
from flankfilm.exchange import rexs_archive
from flankfilm.exchange.bring_in import imported
from flankfilm.exchange.rexs_file import parse_model
from flankfilm.exchange.rexs_json import json_text
from flankfilm.exchange.rexs_write import rexs_file
from flankfilm.scene import parse_scene
from gears import Gear, GearPair
from tests.flankfilm.test_exchange_rexs import OLD, PAIR

JSON = json_text(ET.fromstring(OLD.encode()))

# An attribute's value stands under the name of its kind; arrays, and truth values in place of arrays, are in files
# of the FVA's converter and of Bearinx beside what is read here.
KINDS = {
    "model": {
        "version": "1.4",
        "applicationId": "Bearinx",
        "applicationVersion": "12.0.9241 (sandbox development)",
        "relations": [
            {"id": 5, "type": "stage", "refs": [{"id": 12, "role": "gear_1", "hint": "cylindrical_gear"}]}
        ],
        "components": [
            {
                "id": 12,
                "type": "cylindrical_gear",
                "attributes": [
                    {"id": "number_of_teeth", "unit": "none", "integer": 17},
                    {"id": "normal_module", "unit": "mm", "floating_point": 4.0},
                    {"id": "is_driving_gear", "unit": "none", "boolean": True},
                    {"id": "catalogue_designation", "string": "6210-2Z"},
                    {"id": "u_axis_vector", "unit": "mm", "floating_point_array": [1.0, 0.0, 0.0]},
                    {
                        "id": "coded",
                        "unit": "mm",
                        "floating_point_array_coded": {"code": "float64", "value": "AA=="},
                    },
                ],
            }
        ],
    }
}


def archive(**files):
    content = BytesIO()
    with zipfile.ZipFile(content, "w", zipfile.ZIP_DEFLATED) as packed:
        for name, text in files.items():
            packed.writestr(name, text)
    return content.getvalue()


def refused(content):
    with pytest.raises(InputError) as caught:
        parse_model(content, "model")
    return str(caught.value)


def test_values_of_every_kind():
    model = parse_model(json.dumps(KINDS).encode(), "model")
    gear = model.components["12"]
    assert gear.attributes == {
        "number_of_teeth": ("17", "none"),
        "normal_module": ("4.0", "mm"),
        "is_driving_gear": ("true", "none"),
        "catalogue_designation": ("6210-2Z", ""),
    }
    assert (model.version, model.application) == ("1.4", "Bearinx 12.0.9241 (sandbox development)")
    assert model.relations[0].roles == {"gear_1": "12"}


@pytest.mark.parametrize(
    "content",
    [
        JSON.encode(),
        b"\xef\xbb\xbf" + JSON.encode(),
        archive(**{"rexs-model.rexs": OLD}),
        archive(**{"a.rexsj": JSON, "__MACOSX/._a.rexsj": "shadow", "gde_file.gde": ""}),
    ],
    ids=["JSON", "JSON after a byte order mark", "archive", "archive with other files"],
)
def test_each_format_gives_the_same_model(content):
    assert parse_model(content, "model") == parse_model(OLD.encode(), "model")


@pytest.mark.parametrize("ending", [".rexs", ".rexsj", ".rexsz"])
def test_a_pair_goes_out_and_comes_back(tmp_path, ending):
    cut = GearPair(Gear(21, 0.3, generating_shift=0.27), Gear(34, 0.1), 2e-3, 0.02, centre_distance=55.9e-3)
    for pair in (PAIR, cut):
        path = tmp_path / f"pair{ending}"
        path.write_bytes(rexs_file(pair, "Größe", path)[0])
        found = imported(path)
        assert found.faults == ()
        scene = parse_scene(found.text)
        assert scene.title == "Größe"
        back = gear_pair(scene)
        assert (back.pinion.generating_shift, back.wheel.generating_shift) == (
            pair.pinion.generating_shift,
            None,
        )
        assert back.root_radii == pytest.approx(pair.root_radii, rel=1e-12)
        assert back.backlash == pytest.approx(pair.backlash, rel=1e-6)


def test_an_archive_is_the_same_bytes_each_time_and_other_endings_are_refused():
    first, second = (rexs_file(PAIR, "pair", Path("pair.rexsz"))[0] for _ in range(2))
    assert first == second
    with pytest.raises(InputError, match=r"must end in \.rexs, \.rexsj or \.rexsz"):
        rexs_file(PAIR, "pair", Path("pair.xml"))


def test_numbers_are_read_as_they_stand():
    said = JSON.replace('"floating_point": 78.0', '"floating_point": 7.8e1').replace(
        '"integer": 17', f'"integer": 17{"0" * 5000}'
    )
    assert said.count("7.8e1") == 1
    model = parse_model(said.encode(), "model")
    assert model.components["211"].attributes["center_distance"] == ("7.8e1", "mm")
    assert len(model.components["53"].attributes["number_of_teeth"][0]) == 1000


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"{", "must be JSON"),
        (b'{"model": 5}', "no REXS model"),
        (b'{"a": 1}', "no REXS model"),
        (b'{"model": {"version": "7"}}', "not a REXS version"),
        (b'{"model": {"version": [1]}}', "not a REXS version"),
        (b'{"a": "\xff"}', "must be JSON"),
        (b'{"model": ' + 200_000 * b"[", "nested too deeply"),
        (JSON.replace('"id": 84', '"id": 83').encode(), "stands twice"),
        (b"PK", "must be a ZIP archive"),
        (archive(**{"a.rexs": OLD})[:-30], "must be a ZIP archive"),
        (archive(**{"a.rexs": OLD, "b.rexsj": JSON}), "must hold one REXS model"),
        (archive(**{"a.txt": OLD}), "must hold one REXS model"),
        (archive(**{"a.rexs": archive(**{"a.rexs": OLD})}), "must be XML"),
        (archive(**{f"{n}.gde": "" for n in range(1001)}), "at most 1,000"),
    ],
)
def test_damaged_and_hostile_content_is_refused_by_name(content, message):
    assert message in refused(content)


def test_an_archive_unpacks_no_more_than_its_bound_whatever_it_says(monkeypatch):
    """Of a file of zeros, a thousandth of its size when packed, as much is unpacked as the bound says, and one byte."""
    monkeypatch.setattr(rexs_archive, "LARGEST_FILE", 100_000)
    bomb = archive(**{"a.rexs": b"\0" * 20_000_000})
    assert len(bomb) < 30_000
    assert "unpacks to more than 100,000 bytes" in refused(bomb)
    monkeypatch.setattr(rexs_archive, "LARGEST_ARCHIVE", 1000)
    assert "archive of more than 1,000 bytes" in refused(bomb)


def test_an_archive_with_a_password_or_another_packing_is_refused():
    content = bytearray(archive(**{"a.rexs": OLD}))
    for start, at in ((b"PK\x03\x04", 6), (b"PK\x01\x02", 8)):
        content[content.index(start) + at] |= 1
    assert "without password" in refused(bytes(content))
    odd = BytesIO()
    with zipfile.ZipFile(odd, "w", zipfile.ZIP_LZMA) as packed:
        packed.writestr("a.rexs", OLD)
    assert "stored or deflated" in refused(odd.getvalue())


@settings(max_examples=150, deadline=None)
@given(st.integers(0, len(JSON) - 1), st.text(max_size=3))
def test_changed_json_is_read_or_refused(place, put):
    """Never another error than that of an input, whatever stands in the file."""
    text = JSON[:place] + put + JSON[place + 1 :]
    with suppress(InputError):
        assert parse_model(text.encode("utf-8", "surrogatepass"), "model").version


@settings(max_examples=150, deadline=None)
@given(st.binary(max_size=60), st.integers(0, 400))
def test_changed_archives_are_read_or_refused(put, place):
    content = archive(**{"a.rexs": OLD})
    with suppress(InputError):
        assert parse_model(content[:place] + put + content[place + len(put) :], "model").version
