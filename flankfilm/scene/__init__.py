"""Scene files: keys and sections, reading with every fault listed, and the template of `flankfilm new`."""

from flankfilm.scene.reader import parse_scene, read_scene
from flankfilm.scene.schema import Scene, parse_tolerance
from flankfilm.scene.template import template

__all__ = ["Scene", "parse_scene", "parse_tolerance", "read_scene", "template"]
