"""Everything that can be told of a model file: findings, their pictures, the report."""
