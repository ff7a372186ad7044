"""What a picture of the loaded teeth shows, as it is handed to the process that draws it."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class View:
    """What is drawn, and how.

    Attributes
    ----------
    folder : str
        Of the run.
    target : str
        Picture or animation; its suffix is the format.
    size : tuple of int
        Width and height [pixels].
    scale : float
        Factor of the displacements.
    greatest, ticks : float, int
        End of the scale of colours [Pa], and its parts.
    centre : tuple of float
        Middle of the picture [m].
    reach : float
        Half its width [m].
    base_radius : float
        Of the pinion [m].
    position, error : tuple of float
        Positions of the mesh cycle [base pitches], and the loaded transmission error there [m].
    seconds : float
        Length of the animation; 0 for one picture.
    only : float
        Position of the one picture [base pitches].
    field : str
        Name of the field that is drawn.
    window : bool
        Whether a window is opened instead of a file written.
    """

    folder: str
    target: str
    size: tuple[int, int]
    scale: float
    greatest: float
    ticks: int
    centre: tuple[float, float]
    reach: float
    base_radius: float
    position: tuple[float, ...]
    error: tuple[float, ...]
    seconds: float
    only: float
    field: str = "von_mises_Pa"
    window: bool = False
