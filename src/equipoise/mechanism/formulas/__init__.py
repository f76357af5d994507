"""The formulas, each written once: of dyads, joints, cams, rolling gears, belts and motion laws."""
