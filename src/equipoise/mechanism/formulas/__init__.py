"""The formulas, each written once: of dyads, joints, couplings and motion laws."""
