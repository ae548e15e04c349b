"""Files that anybody may have made: bounded reading, checked values, whole writing, one writer at a time.

The lowest floor of `ai` and `game`; it stands on NumPy, and when used, on filelock and platformdirs.
"""
