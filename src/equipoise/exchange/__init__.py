"""Machines as files of other programs: what there is, is declared in `formats`; each has a module.

`export` writes them; `tree` is the machine as bodies that hang on each other, which is what
programs for multibody systems want.  `reading` is the other way.
"""
