"""Section of the report about the formulas of ISO 6336, and the table of its root stress."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from flankfilm.figures.reading import read_figure
from flankfilm.report.page import Headline, Part, Table, said
from flankfilm.report.stiffness_parts import contact_table, iso_table
from flankfilm.report.text import number, of_both

if TYPE_CHECKING:
    from flankfilm.coupling import Standards
    from gears.closed_form import Iso6336RootStress

OF_EACH_SECTION = {
    "form factor Y_F": "Y_F",
    "stress correction factor Y_S": "Y_S",
    "chord of the root s_Fn": "s_Fn",
    "bending moment arm h_Fe": "h_Fe",
    "root fillet radius rho_F": "rho_F",
    "notch parameter q_s": "q_s",
}
"""Figures of the root of either gear by ISO 6336-3."""

UNKNOWN = "closed form, error unknown"


def root_table(iso: Iso6336RootStress) -> Table:
    """Factors and nominal root stress of both gears by ISO 6336-3."""
    rows: dict[str, Sequence[float]] = {
        label: [getattr(section, name) for section in iso.sections] for label, name in OF_EACH_SECTION.items()
    }
    if iso.Y_beta != 1.0:
        rows["helix angle factor Y_beta"] = (iso.Y_beta, iso.Y_beta)
    rows |= {
        "rim thickness factor Y_B": iso.Y_B,
        "nominal root stress sigma_F0 [MPa]": [1e-6 * value for value in iso.stresses],
    }
    cells = tuple((name, *(number(value, 5) for value in values)) for name, values in rows.items())
    return Table(("ISO 6336-3, lengths in modules", "pinion", "wheel"), cells)


def section(iso: Standards) -> Part:
    """Stiffness, contact stress and root stress of a pair by ISO 6336."""
    tables, notes = (
        [iso_table(iso.stiffness, along_face=True), contact_table(iso.contact, None)],
        [said("standards")],
    )
    if iso.root is None:
        notes.append(f"ISO 6336-3 gives no result: {iso.root_fault}")
    else:
        tables.append(root_table(iso.root))
        notes.append(said("iso6336_3", where="at D for the pinion and at B for the wheel"))
    return Part("standards", "ISO 6336", tables=tuple(tables), notes=tuple(notes))


def headlines(iso: Standards) -> list[Headline]:
    """Mesh stiffness and nominal stresses for the page's head."""
    stiffness, contact = read_figure(iso.stiffness, "c_gamma"), read_figure(iso.contact, "stresses")
    shown = [
        Headline("c_gamma_alpha of ISO 6336-1", number(float(stiffness.values), 5), UNKNOWN, stiffness.unit),
        Headline("nominal contact stress of ISO 6336-2", number(contact.values[0], 5), UNKNOWN, contact.unit),
    ]
    if iso.root is not None:
        name = "nominal root stress of ISO 6336-3, pinion and wheel"
        shown.append(Headline(name, of_both(iso.root.stresses), UNKNOWN, "MPa"))
    return shown
