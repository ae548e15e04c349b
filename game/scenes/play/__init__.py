"""Flying: free flights, the tutorial, missions, today's flight, descents, and what helps the pilot."""
