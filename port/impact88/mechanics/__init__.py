"""The planar impact in double precision: every formula once, planned, compiled or run by numpy."""
