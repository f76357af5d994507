"""The JSON Schemas of model files, from their pydantic models."""

from __future__ import annotations

from typing import Any

from pydantic import BaseModel, create_model
from pydantic.json_schema import GenerateJsonSchema, JsonSchemaValue
from pydantic_core import core_schema

from equipoise.schema.document import Document
from equipoise.schema.document_balance import Balance
from equipoise.schema.document_study import StudyDocument
from equipoise.schema.document_tool import ToolDocument


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
    return _schema_of(whole, "Equipoise model file")


def tool_schema() -> dict[str, Any]:
    """JSON Schema (draft 2020-12) of the file of a tool."""
    return _schema_of(ToolDocument, "Equipoise tool file")


def study_schema() -> dict[str, Any]:
    """JSON Schema (draft 2020-12) of the study file."""
    return _schema_of(StudyDocument, "Equipoise study file")


def _schema_of(document: type[BaseModel], title: str) -> dict[str, Any]:
    schema = document.model_json_schema(schema_generator=_Generator)
    schema["$schema"] = GenerateJsonSchema.schema_dialect
    schema["title"] = title
    return schema
