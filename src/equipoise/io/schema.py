"""The JSON Schema of the model file, from its pydantic models."""

from __future__ import annotations

from typing import Any

from pydantic import create_model
from pydantic.json_schema import GenerateJsonSchema, JsonSchemaValue
from pydantic_core import core_schema

from equipoise.io.document import Document
from equipoise.io.document_balance import Balance


class _Generator(GenerateJsonSchema):
    """Without what TOML does not know (null) and what helps nobody (titles made from names)."""

    def nullable_schema(self, schema: core_schema.NullableSchema) -> JsonSchemaValue:
        return self.generate_inner(schema["schema"])

    def default_schema(self, schema: core_schema.WithDefaultSchema) -> JsonSchemaValue:
        # Defaults are given as text with units, by json_schema_extra.
        return self.generate_inner(schema["schema"])

    def field_title_should_be_set(self, schema: Any) -> bool:
        return False


def json_schema() -> dict[str, Any]:
    """JSON Schema (draft 2020-12) of the model file."""
    # The document leaves its table [balance] to a second step, which the schema has too.
    whole = create_model(
        "Document", __base__=Document, __doc__=Document.__doc__, balance=(Balance | None, None)
    )
    schema = whole.model_json_schema(schema_generator=_Generator)
    schema["$schema"] = GenerateJsonSchema.schema_dialect
    schema["title"] = "Equipoise model file"
    return schema
