"""Sweeps: many training runs with other settings, as trials of a study, and what a study tells.

A study is a folder of plain files that `study` reads and writes, with NumPy alone. `tuning` and `cluster` run trials
on Ray and need the extra `sweep`. Commands and the game import this package.
"""
