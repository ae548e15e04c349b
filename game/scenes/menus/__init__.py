"""The menu, the page of Play, settings, keys, and the dialogs that all screens ask with."""
