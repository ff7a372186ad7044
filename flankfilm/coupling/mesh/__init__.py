"""The dry mesh: stiffness, load share and root stress by any model, references, errors and verification.

Public, in `flankfilm.coupling`: `FaceLoadModels`, `face_load_models`, `FaceTolerance`, `face_load_tolerance`,
`Flanks`, `LoadedTeeth`, `MeshCycle`, `mesh_cycle`, `StiffnessReferences`, `stiffness_references`,
`Resolution`, `resolution_of`, `LoadedFields`, `RootStresses`, `fillets_of`, `fillets_over_face`,
`pitch_point_fields`, `root_stresses`, `SinglePairs`, `single_pair_stiffness`, `single_pairs`, `Standards`,
`standards`, `TorqueCurves`, `revolution`, `torque_curves`, `Verification`, `compare_closed_forms`, `verification_of`.
"""
