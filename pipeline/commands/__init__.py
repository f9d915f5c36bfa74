"""Commands of `deamat`, one module each; `cli` registers them.

Heavy modules are imported inside the functions that need them: `deamat --help` shall be quick.
"""
