"""The chapter's other problems: colinear impact, barrier, Equation 19, staged collisions."""
