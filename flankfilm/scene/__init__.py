"""Scene files: schema, reading with every fault listed, and the template of `flankfilm new`."""

from flankfilm.scene.reader import parse_scene, read_scene, template
from flankfilm.scene.schema import Scene

__all__ = ["Scene", "parse_scene", "read_scene", "template"]
