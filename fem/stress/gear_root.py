"""Root stress of one gear along the mesh cycle: at its positions and the largest on its arcs; and along its face."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from base import Array, Integers, described, part, quantity, record
from base.results import EXACT, ITSELF
from fem.elasticity.fillet import FilletLine
from fem.elasticity.plane_elasticity import PlaneElasticity
from fem.stress.root_peaks import LOADED, OTHER, RootPeak, extreme

__all__ = ["FaceRootStress", "GearRootStress"]

SINGLE = "not estimated at single places; the maximum stresses have errors"


@record
class FaceRootStress:
    """Maximum stresses along the fillets of one gear at places of its face.

    Errors of the maximum stresses are by the cells, by the waves' mesh and by free ends, beyond those of even loads.
    """

    no_error = SINGLE
    headline = ("face_factor",)

    face_position: Array = quantity(
        "m",
        "places on the gear's own face, ends included, 0 at the middle of the face in contact",
        "place",
        shown="mm",
        no_error=EXACT,
    )
    travel: Array = quantity(
        "1", "base pitches since each tooth's pair passed A", "position tooth", no_error=EXACT
    )
    tension: Array = quantity(
        "Pa",
        "maximum principal stress along the fillet under the loaded flank",
        "position tooth place",
        shown="MPa",
    )
    compression: Array = quantity(
        "Pa",
        "minimum stress along the other fillet, negative in compression",
        "position tooth place",
        shown="MPa",
    )
    cycle_tension: Array = quantity("Pa", "maximum tension of all teeth and instants", "place", shown="MPa")
    cycle_compression: Array = quantity(
        "Pa", "maximum compression of all teeth and instants, negative", "place", shown="MPa"
    )
    tangential: Array = quantity(
        "Pa",
        "stress along the fillet under the loaded flank at the instant of the maximum tension",
        "place sample",
        shown="MPa",
    )
    face_factor: float = quantity(
        "1",
        "stress face-load factor: maximum tension over its mean over the face in contact, at the instant of the "
        "greatest",
    )
    over_even: float = quantity(
        "1",
        "maximum tension over that of the same forces of all pairs spread evenly along the face: what uneven loads "
        "cost this root",
    )
    tension_error: float = quantity(
        "1",
        "estimated relative error of the maximum tension from the variation along the face",
        no_error=ITSELF,
    )
    compression_error: float = quantity(
        "1",
        "estimated relative error of the maximum compression from the variation along the face",
        no_error=ITSELF,
    )


@record
class GearRootStress:
    """Stress along the fillets of one gear's teeth, at the sample points of ``line``."""

    no_error = "not estimated at single instants; the maximum stresses have errors"

    headline = ("greatest_tension_Pa", "greatest_compression_Pa")

    line: FilletLine
    law: PlaneElasticity
    position: Array = quantity("1", "base pitches from A, of the pair that entered last", "position")
    tooth: Integers = quantity(
        "1", "base pitches ahead of that pair; beside the loaded teeth one more at either end", "tooth"
    )
    tangential_Pa: Array = quantity(
        "Pa",
        "principal stress along the fillet, under the loaded flank first, along the other one second",
        "position tooth fillet sample",
        shown="MPa",
    )
    greatest_tension: RootPeak = part("maximum tension of all teeth and instants, and where it acts")
    greatest_compression: RootPeak = part("maximum compression of all teeth and instants, and where it acts")
    passage_range_Pa: Array = quantity(
        "Pa",
        "minimum and maximum stress of a tooth's passage at every sample, of all instants",
        "bound fillet sample",
        shown="MPa",
    )
    fillets_error: float = quantity(
        "1", "estimated relative error of the maximum stresses by the fillets' mesh", no_error=ITSELF
    )
    face: FaceRootStress | None = part(
        "over the face; None of loads that are even along it. Where they are not, all else given for all positions, "
        "teeth and samples is at the place along the face where the maximum tension is",
        default=None,
    )
    webbed: bool = part("whether the gear has a rim on a web", default=False)
    helical: bool = part("whether lines of contact cross the face", default=False)

    @property
    def errors(self) -> Mapping[str, float]:
        """Estimated relative errors of the maximum stresses by their names."""
        peaks = {
            "greatest_tension_Pa": self.greatest_tension,
            "greatest_compression_Pa": self.greatest_compression,
        }
        face = self.face
        over = (0.0, 0.0) if face is None else (face.tension_error, face.compression_error)
        return {
            name: self.fillets_error + peak.forces + peak.sampling + more
            for (name, peak), more in zip(peaks.items(), over, strict=True)
        }

    @described("1", "position tooth")
    def tooth_position(self) -> Array:
        """Base pitches since each tooth's pair passed A."""
        return np.asarray(self.position[:, None] + self.tooth)

    @described("Pa", "position tooth", shown="MPa")
    def tension_Pa(self) -> Array:
        """Maximum principal stress along the fillet under the loaded flank."""
        return extreme(self.line.arc, self.tangential_Pa[:, :, LOADED])[0]

    @described("m", "position tooth", shown="mm")
    def tension_arc(self) -> Array:
        """Place of the maximum stress: arc length from the middle of the gap."""
        return extreme(self.line.arc, self.tangential_Pa[:, :, LOADED])[1]

    @described("Pa", "position tooth", shown="MPa")
    def compression_Pa(self) -> Array:
        """Minimum principal stress along the other fillet, negative in compression."""
        return -extreme(self.line.arc, -self.tangential_Pa[:, :, OTHER])[0]

    @described("m", "position tooth", shown="mm")
    def compression_arc(self) -> Array:
        """Place of the minimum stress: arc length from the middle of the gap."""
        return extreme(self.line.arc, -self.tangential_Pa[:, :, OTHER])[1]

    @described("Pa", shown="MPa", error="errors")
    def greatest_tension_Pa(self) -> float:
        """Maximum tension under a loaded flank, of all teeth and positions."""
        return self.greatest_tension.stress_Pa

    @described("Pa", shown="MPa", error="errors")
    def greatest_compression_Pa(self) -> float:
        """Maximum compression, negative, on the other side of a loaded tooth, of all teeth and positions."""
        return self.greatest_compression.stress_Pa

    def passage(self) -> tuple[Array, Array]:
        """Follow one tooth through its mesh: every position and tooth is one instant of it.

        Returns
        -------
        position : (n teeth,) array
            Base pitches since its pair passed A, growing.
        tangential_Pa : (n teeth, 2, samples) array
        """
        order = np.argsort(self.tooth_position, axis=None, kind="stable")
        flat = self.tangential_Pa.reshape(-1, *self.tangential_Pa.shape[2:])
        return self.tooth_position.ravel()[order], flat[order]

    def fatigue(self) -> tuple[Array, Array]:
        """Amplitude and mean over one tooth's passage at every sample, each (2, samples) [Pa].

        A tooth's root is drawn when it bears and pressed when the tooth before it bears.
        """
        low, high = self.passage_range_Pa
        # far from its mesh the tooth is unloaded
        high, low = np.maximum(high, 0.0), np.minimum(low, 0.0)
        return 0.5 * (high - low), 0.5 * (high + low)
