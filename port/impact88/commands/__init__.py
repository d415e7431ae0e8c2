"""The commands, one module each: ``add_arguments(parser)`` and ``main(args) -> exit status``."""
