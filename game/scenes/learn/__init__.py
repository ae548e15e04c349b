"""Learn: the list of chapters, and the chapters, each with a guess, a try, its verdict and the code that did it."""
