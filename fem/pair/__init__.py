"""A pair: compliance of both gears together, references of the deflection, faces of unequal width.

Nothing here depends on the load but the indentation of two flanks, which belongs to the compliance of a pair.

Public, in `fem`: `compliance`, `FaceGears`, `face_gears`, `LineFillets`, `line_fillets`, `Options`,
`PairCompliance`, `Fillets`, `fillets`, `single_pair_stiffness`.
"""
