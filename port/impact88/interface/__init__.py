"""The interface: the command line (`commands`) and the local web page (`desk`).

Needs: `apple`, `collision`, `mechanics`, `program`, `tables`, `printouts`, `casework`,
`conformance`, `bench`; each on first use, and a command whose wing is missing says so.
In: arguments, files, forms. Out: text, JSON, files, exit statuses.
Way: `commands.cli` (`main`), the command's module, the wing; `desk.serving`, `desk.app`, the wing.
Used by: everybody who does not import the package.
"""
