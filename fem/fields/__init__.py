"""Displacement and stress on meshes: fields of a loaded pair, files for ParaView and other programs.

Public, in `fem`: `write_mesh`, `field_blocks`.
"""
