"""Regions, requirements and the synthesis of geometries that meet them."""
