"""The same bits on every processor: nothing in the engine depends on how a library adds up."""

import hashlib
import os
import subprocess
import sys

import pytest

from tests.engine.test_batch import landers, throw, toys

# What OpenBLAS and NumPy would do on other processors; those that this one cannot do are ignored by both.
PROCESSORS = (
    {},
    {"OPENBLAS_CORETYPE": "Prescott"},
    {"OPENBLAS_CORETYPE": "Haswell", "NPY_DISABLE_CPU_FEATURES": "AVX512_ICL X86_V4 X86_V3"},
)


def flown() -> str:
    """Return a digest of all bits of flights with contacts of every kind."""
    digest = hashlib.sha256()
    for make, batch in ((toys, 3), (landers, 1), (landers, 3)):
        world = make(batch)
        throw(world, 11)
        for _ in range(240):
            world.step()
            digest.update(world.state.pose.tobytes() + world.state.velocity.tobytes())
    return digest.hexdigest()


@pytest.mark.slow
def test_a_flight_is_the_same_to_the_last_bit_on_every_processor():
    command = [sys.executable, "-W", "ignore", "-c", "from tests.engine.test_processors import flown; print(flown())"]
    digests = [
        subprocess.run(command, env={**os.environ, **each}, capture_output=True, text=True, check=True).stdout
        for each in PROCESSORS
    ]
    assert len(set(digests)) == 1, dict(zip(map(str, PROCESSORS), digests, strict=True))
