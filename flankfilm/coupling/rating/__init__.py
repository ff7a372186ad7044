"""Factors of a rating by our own models: dynamic factor of the motion, load factors of the loaded contact.

Public, in `flankfilm.coupling`: `ContactLaws`, `contact_laws`, `LoadedFactors`, `loaded_factors`, `MotionFactor`,
`motion_factor`, `OwnContact`, `own_contact`, `OwnRating`, `own_rating`, `UnequalPitches`, `unequal_pitches`.
"""
