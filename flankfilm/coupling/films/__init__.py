"""Films of the loaded contacts, along the path and over the face, in series with the teeth.

Public, in `flankfilm.coupling`: `FilmAlongPath`, `FaceFilms`, `FilmModel`, `PlacedMeniscus`, `LineFilms`,
`film_along_path`, `lubricate`, `lubricated_cycle`, `LubricatedCycle`, `PassageFilm`, `passage_film`.
"""
