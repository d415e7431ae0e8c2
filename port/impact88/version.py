"""The package's version, which every record names."""

from __future__ import annotations

__version__ = "0.2.0"
