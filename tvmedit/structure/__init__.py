"""Structure of a sequence: clusters and textons (paper B, section 4)."""

from tvmedit.structure.evaluate import Agreement, compare_boundaries, texton_errors
from tvmedit.structure.parse import parse_structure
from tvmedit.structure.structure import Cluster, Structure

__all__ = ["Agreement", "Cluster", "Structure", "compare_boundaries", "parse_structure", "texton_errors"]
