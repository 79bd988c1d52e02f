"""Denoises a picture with Intel's Open Image Denoise, from its colours alone."""

import argparse

import numpy as np
from pyoidn.denoise import denoise

import pixels


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--picture", required=True)
    parser.add_argument("--out", required=True)
    options = parser.parse_args()
    colour = np.ascontiguousarray(pixels.read_exr(options.picture))
    colour = np.nan_to_num(colour, nan=0.0, posinf=65504.0, neginf=0.0)
    pixels.write_exr(options.out, denoise(colour, hdr=True))


main()
