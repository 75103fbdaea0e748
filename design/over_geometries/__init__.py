"""Proofs over all geometries within bounds: nothing better exists."""

from design.over_geometries.certify_design import certify_design
from design.over_geometries.design_certificate import DesignCertificate
from design.over_geometries.replay_design import replay_design

__all__ = ["DesignCertificate", "certify_design", "replay_design"]
