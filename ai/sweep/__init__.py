"""Sweeps: many training runs with other settings, as trials of a study, and what a study found.

A study is a folder of plain files that `study` and the game read with NumPy alone. To run trials needs the extra
`sweep`: Optuna (`search`) proposes them, Ray (`cluster`, `driver`) trains them.
"""
