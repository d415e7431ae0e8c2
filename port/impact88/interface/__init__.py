"""The interface: the command line (`commands`) and the local web page (`desk`).

Needs: every wing, each on first use; a command whose wing is missing says so.
In: arguments, files, forms. Out: text, JSON, files, exit statuses.
Used by: everybody who does not import the package.
"""
