"""Every sound of the game, synthesised: `synth` has the means, `instruments` the sounds, `flight` what plays them."""
