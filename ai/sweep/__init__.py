"""Sweeps: the same task trained many times with other settings, to see which of them matter.

A study is a folder of plain files (`study`). To run its trials needs the extra `sweep`: Optuna asks for settings, Ray's
tasks train them (`driver`).
"""
