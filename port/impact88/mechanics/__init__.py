"""The planar impact in double precision: closed form, compiled kernels, accuracy, outcome."""
