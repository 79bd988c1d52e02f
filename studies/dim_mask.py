"""Writes a mask for `photinus compare --mask`: white where a reference's mean over the channels is at most LIMIT.

    python3 -m venv target/studies && target/studies/bin/pip install numpy OpenEXR Pillow
    target/studies/bin/python studies/dim_mask.py REFERENCE.exr LIMIT MASK.png
"""

import sys

import numpy as np
import OpenEXR
from PIL import Image


def main(arguments):
    if len(arguments) != 3:
        sys.exit(__doc__)
    reference, limit, mask = arguments
    channels = OpenEXR.File(reference, separate_channels=True).channels()
    mean = np.mean([np.asarray(channels[name].pixels, dtype=np.float64) for name in "RGB"], axis=0)
    Image.fromarray(np.where(mean <= float(limit), 255, 0).astype(np.uint8)).save(mask)


if __name__ == "__main__":
    main(sys.argv[1:])
