"""The app for people without Python: `python -m packaging_app` builds it, for the system that it runs on.

`recipe` lists what is packed, `tranquility.spec` hands that to PyInstaller, `start` is where the packed program begins.
The program itself imports nothing from here.
"""
