"""MP4 writer, frame by frame. Needs PyAV, which includes an encoder."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Final, cast

import av
import numpy as np
from av.video.reformatter import Colorspace
from numpy.typing import NDArray

_ENCODERS: Final = ("libx264", "libopenh264", "mpeg4")  # the encoders of PyAV depend on its build
_QUALITY: Final = {"crf": "18", "preset": "fast", "tune": "animation"}
_BT709: Final = 1  # marks the colour space as BT.709, high-definition video


class Mp4Writer:
    """Writer of an MP4; a context manager, at whose exit the file is complete.

    Args:
        path: the file to write.
        size: width and height in pixels, both even.
        rate: frames per second.

    Raises:
        OSError: the file can't be written, then or later.

    """

    def __init__(self, path: Path, size: tuple[int, int], rate: int) -> None:
        name = next((each for each in _ENCODERS if _encodes(each)), "")
        if not name:
            raise OSError(None, f"no encoder: {', '.join(_ENCODERS)}")
        self._container = av.open(str(path), "w", format="mp4", options={"movflags": "+faststart"})
        options = _QUALITY if name == "libx264" else {}
        self._stream = cast(Any, self._container.add_stream(name, rate=rate, options=options))
        self._stream.width, self._stream.height = size
        self._stream.pix_fmt = "yuv420p"  # the pixel format that every player supports
        context = self._stream.codec_context
        context.colorspace = context.color_primaries = context.color_trc = _BT709
        context.color_range = 1
        if name != "libx264":
            self._stream.bit_rate = 8_000_000

    def __enter__(self) -> Mp4Writer:
        return self

    def __exit__(self, kind: object, *error: object) -> None:
        try:
            if kind is None:
                self._container.mux(self._stream.encode(None))
        finally:
            self._container.close()

    def add(self, frame: NDArray[np.uint8]) -> None:
        """Append a frame (height, width, 3)."""
        picture = av.VideoFrame.from_ndarray(frame, format="rgb24")
        picture = picture.reformat(format="yuv420p", dst_colorspace=Colorspace.ITU709)
        self._container.mux(self._stream.encode(picture))


def _encodes(name: str) -> bool:
    """Whether this build of PyAV has the encoder, and not only the decoder."""
    try:
        av.Codec(name, "w")
    except ValueError:  # base class of PyAV's errors
        return False
    return True
