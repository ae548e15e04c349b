"""Every sound of the game, synthesised: `synth` has the means, `instruments` the sounds, `mixer` plays them."""
