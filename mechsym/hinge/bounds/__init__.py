"""Limits of a guide: what is asked along the track, what is allowed, and the words for both.

A limit is an object of `face.GuideLimit`, in a file of its own or beside its likes, and a field of a case's `[limits]`
(`mechsym.hinge.choices`). Verdicts on one guide and on many, compiled maps, co-design, reports and sliders ask it, for
numbers, arrays and symbols alike.
"""
