"""Draws a mesh cycle with ParaView: pvpython mesh_cycle_paraview.py out/article picture.png [phase | all].

The phase is the travel after a pair is at A over the base pitch; the step next to it is drawn. With ``all`` every step
is drawn, into picture_000.png and so on, ready for a film.
"""

import csv
import math
import sys
from pathlib import Path

from paraview import simple as pv

WARP = 20.0  # times the displacement
ARROW = 1.5e-7  # m of arrow for each N of contact force
SCALE = (0.0, 340.0)  # MPa, to the maximum at a fillet; under the contacts there is more


class Scene:
    """Both gears warped and coloured by von Mises stress, and the contact forces."""

    def __init__(self, folder):
        """Read the folder of a run and build the view."""
        self.cycle = pv.PVDReader(FileName=str(Path(folder) / "mesh_cycle.pvd"))
        self.cycle.UpdatePipeline()
        self.times = list(self.cycle.TimestepValues)
        self.approach = approaches(Path(folder) / "csv")
        self.contacts = pv.ExtractBlock(Input=self.cycle, Selectors=["//contacts"])
        pinion, wheel = (
            pv.WarpByVector(
                Input=pv.ExtractBlock(Input=self.cycle, Selectors=[f"//{name}"]),
                Vectors=["POINTS", "displacement_m"],
                ScaleFactor=WARP,
            )
            for name in ("pinion", "wheel")
        )
        self.pinion = pv.Transform(Input=pinion, Transform="Transform")
        self.view = pv.CreateView("RenderView")
        for gear in (self.pinion, wheel):
            self._show(gear)
        self._show_forces()
        self._look_at_contacts()

    def _show(self, gear):
        stress = pv.Calculator(
            Input=gear, ResultArrayName="von Mises stress [MPa]", Function="von_mises_Pa/1e6"
        )
        shown = pv.Show(stress, self.view)
        pv.ColorBy(shown, ("POINTS", "von Mises stress [MPa]"))
        colours = pv.GetColorTransferFunction("von Mises stress [MPa]")
        colours.ApplyPreset("Viridis (matplotlib)", True)
        colours.RescaleTransferFunction(*SCALE)
        bar = pv.GetScalarBar(colours, self.view)
        bar.Title, bar.ComponentTitle, bar.Visibility = "von Mises stress [MPa]", "", 1
        bar.TitleColor = bar.LabelColor = [0.0, 0.0, 0.0]
        bar.TitleFontSize = bar.LabelFontSize = 20
        if hasattr(bar, "DrawBackground"):  # a white card, on which the letters are read and print
            bar.DrawBackground, bar.BackgroundColor, bar.BackgroundPadding = 1, [1.0, 1.0, 1.0, 1.0], 8.0
        bar.LabelFormat = bar.RangeLabelFormat = "%.0f"
        bar.WindowLocation = "Any Location"
        bar.Position = [0.86, 0.03]

    def _show_forces(self):
        arrows = pv.Glyph(
            Input=self.contacts,
            GlyphType="2D Glyph",
            OrientationArray=["POINTS", "force_N"],
            ScaleArray=["POINTS", "force_N"],
            ScaleFactor=ARROW,
            GlyphMode="All Points",
        )
        arrows.GlyphType.GlyphType = "Arrow"
        arrows.GlyphType.Center = [0.5, 0.0, 0.0]  # the tail stands on the contact
        shown = pv.Show(arrows, self.view)
        shown.ColorArrayName = [None, ""]
        shown.AmbientColor = shown.DiffuseColor = [0.85, 0.1, 0.1]
        shown.LineWidth = 4.0

    def _look_at_contacts(self):
        self.contacts.UpdatePipeline()
        low_x, high_x, low_y, high_y = self.contacts.GetDataInformation().GetBounds()[:4]
        at = [(low_x + high_x) / 2, (low_y + high_y) / 2]
        self.view.ViewSize = [1200, 750]
        self.view.UseColorPaletteForBackground = 0
        self.view.Background = [1.0, 1.0, 1.0]
        self.view.OrientationAxesVisibility = 0
        self.view.InteractionMode = "2D"
        self.view.CameraFocalPoint, self.view.CameraPosition = [*at, 0.0], [*at, 1.0]
        self.view.CameraParallelProjection = 1
        self.view.CameraParallelScale = 0.0055

    def draw(self, time, path):
        """Draw one step.

        The displacement is that of the teeth on hubs that stand still. The pinion's hub turns on by the
        transmission error over its base radius, which closes the flanks; warped, it must turn on as many times.
        """
        self.view.ViewTime = time
        approach = min(self.approach, key=lambda known: abs(known[0] - time))[1]
        self.pinion.Transform.Rotate = [0.0, 0.0, math.degrees(WARP * approach / self._base_radius(time))]
        pv.SaveScreenshot(str(path), self.view)
        print(f"{path}: phase {time:.3f}")

    def _base_radius(self, time):
        """Lever of the greatest force about the pinion's axis, which is the origin."""
        self.contacts.UpdatePipeline(time)
        points = pv.servermanager.Fetch(pv.MergeBlocks(Input=self.contacts), idx=0)
        forces = points.GetPointData().GetArray("force_N")
        greatest = (0.0, 1.0)
        for number in range(points.GetNumberOfPoints()):
            (x, y, _), (fx, fy, _) = points.GetPoint(number), forces.GetTuple3(number)
            greatest = max(greatest, (math.hypot(fx, fy), abs(x * fy - y * fx)))
        return greatest[1] / greatest[0]


def approaches(folder):
    """Phases and loaded transmission errors [m] of the cycle that the fields show."""
    lubricated, dry = folder / "mesh_cycle_lubricated.csv", folder / "mesh_cycle_dry.csv"
    with (lubricated if lubricated.exists() else dry).open(newline="") as file:
        return [
            (float(row["position"]), 1e-6 * float(row["transmission_error_um"]))
            for row in csv.DictReader(file)
        ]


def main(folder, picture, which="0.5"):
    """Draw one step, or all."""
    scene, picture = Scene(folder), Path(picture)
    picture.parent.mkdir(parents=True, exist_ok=True)
    if which != "all":
        scene.draw(min(scene.times, key=lambda t: abs(t - float(which))), picture)
        return
    for number, time in enumerate(scene.times):
        scene.draw(time, picture.with_name(f"{picture.stem}_{number:03d}{picture.suffix}"))


if __name__ == "__main__":
    main(*sys.argv[1:])
