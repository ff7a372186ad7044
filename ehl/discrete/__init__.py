"""The line contact and its equations on one grid: gap, flux, squeeze, heat, and Newton's method.

Closed forms of the same contact stand beside them: formulas of the film thickness, regimes, flash temperature.

Public, in `ehl`: `Roughness`, `LineContact`, `blok_flash_temperature`, `regime`, `FormulaFilm`, `dowson`,
`dowson_higginson_minimum`, `dowson_toyoda_central`, `moes_central`, `nijenbanning_line_central`,
`pan_hamrock_central`, `pan_hamrock_minimum`, `STEEL`, `Solid`, `Meniscus`, `OilLayer`.
"""
