"""Displacement and stress on meshes: fields of a loaded pair, files for ParaView and other programs."""
