"""By your taste: one chooses between two flights, again and again, and a network learns to fly as one likes."""
