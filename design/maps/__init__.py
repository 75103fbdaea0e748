"""Maps of a margin over a section of a region, sampled and proved."""

from design.maps.certified_cells import certified_cells
from design.maps.level_sets import LevelSet, boundary, level_set
from design.maps.map_index import Index, index_of
from design.maps.sampled_map import Map, map_of
from design.maps.section import Section

__all__ = [
    "Index",
    "LevelSet",
    "Map",
    "Section",
    "boundary",
    "certified_cells",
    "index_of",
    "level_set",
    "map_of",
]
