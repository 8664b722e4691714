"""Designs, effects, surrogates and calibration: mathematics on arrays alone.

Points lie in the unit cube: `u` has shape (points, parameters) and values from 0 to 1. One output has shape
(points, seeds), NaN where a run gave no value. The seeds are the same for all points. A point is missing when any of
its seeds has no value. Every function that draws random numbers takes a `seed` of its own and repeats itself with it.
"""
