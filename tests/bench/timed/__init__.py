"""Timed tests of pytest-benchmark."""
