"""Mesh stiffness by ross-rotordynamics; runs in the peer's environment, with nothing of ours."""

import json
import sys
import time
from importlib import import_module


def main() -> None:
    """Read the work as JSON, print what was found as JSON."""
    given = json.load(sys.stdin)
    try:
        np = import_module("numpy")
        ross = import_module("ross")
        elements = import_module("ross.gear_element")
    except ImportError as error:
        print(json.dumps({"missing": str(error)}))
        return
    steel = ross.Material(
        name="steel", rho=given["density"], E=given["youngs_modulus"], Poisson=given["poisson_ratio"]
    )
    gears = [
        elements.GearElementTVMS(
            n=0,
            material=steel,
            width=given["width"],
            bore_diameter=2 * bore,
            module=given["module"],
            n_teeth=teeth,
            pr_angle=np.pi / 9,
        )
        for teeth, bore in zip(given["teeth"], given["bores"], strict=True)
    ]
    mesh = elements.Mesh(*gears)
    steps = (np.arange(given["positions"]) + 0.5) / given["positions"]
    angles = 2 * np.pi / given["teeth"][0] * steps
    seconds = []
    for _ in range(given["repeat"] + 1):
        began = time.process_time()
        stiffness = [float(mesh.get_variable_stiffness(angle)) for angle in angles]
        seconds.append(time.process_time() - began)
    run = {
        "level": "GearElementTVMS",
        "seconds": min(seconds[1:]),
        "first": seconds[0],
        "values": [sum(stiffness) / len(stiffness)],
    }
    print(json.dumps({"peer": "ross-rotordynamics", "version": ross.__version__, "runs": [run]}))


if __name__ == "__main__":
    main()
