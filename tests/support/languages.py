"""Languages by how much is written in them."""

from __future__ import annotations

from equipoise.i18n import LANGUAGES

UNFINISHED: frozenset[str] = frozenset()
"""Languages whose catalogue lacks texts, which are said in English until they are there."""
COMPLETE = tuple(code for code in LANGUAGES if code not in UNFINISHED)
"""Languages in which everything is said that the package says."""
DOCUMENTED = ("en", "ja", "ko")
"""Languages of the bundled files and of the documentation."""
