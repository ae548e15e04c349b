"""The one name that an installed Tranquility owns: in a wheel, everything else lies in this folder."""
