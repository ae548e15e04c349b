"""Flying: free flights, the tutorial, missions, the start of the day, descents, and what helps the pilot."""
