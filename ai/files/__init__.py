"""Files that anybody may have made: bounded reading, checked values, whole writing, one writer at a time.

The lowest floor of `ai`; it stands on NumPy alone.
"""
