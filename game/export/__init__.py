"""Export of replays as GIF or MP4.

May be imported by `shell` and `scenes`.
"""
