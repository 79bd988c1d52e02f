"""Pictures in and out for the drivers: linear RGB as arrays of height x width x 3, row 0 on top."""

import numpy as np
import OpenEXR
from PIL import Image


def write_exr(path, rgb):
    """Writes 32-bit floats."""
    channels = {name: np.ascontiguousarray(rgb[..., i], dtype=np.float32) for i, name in enumerate("RGB")}
    header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
    with OpenEXR.File(header, channels) as file:
        file.write(path)


def read_exr(path, names=("R", "G", "B")):
    """Reads channels by name; those that most files have make the picture."""
    with OpenEXR.File(path, separate_channels=True) as file:
        channels = file.channels()
        return np.stack([np.asarray(channels[name].pixels, dtype=np.float32) for name in names], axis=-1)


def read_mask(path):
    """True where a mask is white."""
    return np.asarray(Image.open(path).convert("L")) >= 128


def write_mask(path, mask):
    """Writes a mask as black and white."""
    Image.fromarray(np.where(mask, 255, 0).astype(np.uint8)).save(path)
