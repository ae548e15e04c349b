"""Input devices: keyboard, gamepads and mouse, mapped to held flight controls and to commands."""
