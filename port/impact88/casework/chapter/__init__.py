"""The chapter's other problems: every equation, table and example around the program."""
