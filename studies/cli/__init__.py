"""The command line."""

from studies.cli.app import main

__all__ = ["main"]
