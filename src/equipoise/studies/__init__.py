"""Studies: many designs of one model, stored, chosen from, searched, and held to tolerances."""
