"""setuptools, with the list of what belongs to a source distribution standing in .ci/manifest.

setuptools looks for that list in MANIFEST.in alone, and the top level holds no such file.
"""

from setuptools import build_meta
from setuptools.build_meta import *  # noqa: F403
from setuptools.command.egg_info import manifest_maker


def build_sdist(sdist_directory, config_settings=None):
    """Everything that is in the repository, tests included, so that they run from it."""
    manifest_maker.template = ".ci/manifest"
    return build_meta.build_sdist(sdist_directory, config_settings)
