"""The 1988 program as published: listing as printed and restored, printouts, errata, tables."""
