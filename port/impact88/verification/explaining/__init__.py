"""Explaining: causes that would make a differing page agree, each tested by replay."""
