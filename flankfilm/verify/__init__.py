"""Closed forms of tooth stiffness against finite elements, figure by figure."""

from flankfilm.verify.compare import Verification, verify_scene
from flankfilm.verify.tables import write_verification

__all__ = ["Verification", "verify_scene", "write_verification"]
