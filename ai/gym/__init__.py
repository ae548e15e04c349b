"""The lander as an environment of Gymnasium. Needs the extra `gym`.

May be imported by `cli`.
"""
