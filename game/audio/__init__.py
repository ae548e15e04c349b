"""Every sound of the game, synthesised: `synth` has the means, `instruments` the sounds, `mixer` plays them.

Every package of `game` but `core` and `input` may import it.
"""
