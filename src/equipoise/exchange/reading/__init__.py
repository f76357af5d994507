"""Files of other programs as machines: what there is, is declared in `formats`.

Every format has a module, which takes what is in a file and gives an outline: `strokes` makes it of
lines, `planar` of bodies in space.  `imported` finishes it.  No file
is trusted: what cannot be read is refused in one sentence.
"""
