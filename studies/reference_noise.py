"""Splits the error of a picture into its own and that of the reference, with a second, independent picture.

    python3 -m venv target/studies && target/studies/bin/pip install numpy OpenEXR
    target/studies/bin/python studies/reference_noise.py REFERENCE.exr A.exr B.exr

The errors of A and B are independent, so that the mean of (A - R)(B - R) is the squared error of R alone, plus the product
of the biases of A and B. All figures are relative as relMSE is.
"""

import sys

import numpy as np
import OpenEXR


def read(path):
    """RGB of the layer without a name, rows x columns x 3."""
    channels = OpenEXR.File(path, separate_channels=True).channels()
    return np.stack([np.asarray(channels[name].pixels, dtype=np.float64) for name in "RGB"], axis=-1)


def main(arguments):
    if len(arguments) != 3:
        sys.exit(__doc__)
    reference, a, b = map(read, arguments)
    weight = 1 / ((reference**2).mean(axis=-1) + 0.01)
    product = ((a - reference) * (b - reference)).mean(axis=-1) * weight
    for name, picture in zip(arguments[1:], (a, b)):
        error = (((picture - reference) ** 2).mean(axis=-1) * weight).mean()
        print(f"{name}: relMSE {error:.3e}, mean {picture.mean() / reference.mean():.4f} of the reference's")
    print(f"reference: {product.mean():.2e} +- {product.std() / product.size**0.5:.1e}")


if __name__ == "__main__":
    main(sys.argv[1:])
