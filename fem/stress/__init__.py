"""Root stress: along the fillets of both gears over a mesh cycle, in the plane and over the face.

Public, in `fem`: `FaceFillets`, `face_fillets`, `FaceRootStress`, `RootStress`, `root_stress`.
"""
