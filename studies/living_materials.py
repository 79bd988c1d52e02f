"""Copies the living room's folder, with three materials as its reference picture shows them.

    python3 studies/living_materials.py rooms/living-room-mitsuba CHANGED_FOLDER

The mirror over the fireplace reflects 0.7, the hearth is black plastic, leaves are dark from behind (docs/proof.md).
"""

import re
import shutil
import sys
from pathlib import Path

# Each is what a material begins with, and a change of what follows.
CHANGES = [
    (
        r'(<bsdf type="twosided" id="Mirror" >\s*<bsdf type="conductor" >\s*<string name="material" value="none" />)',
        r'\1<float name="specularReflectance" value="0.7" />',
    ),
    (
        r'(<bsdf type="twosided" id="FireplaceGlass" >\s*)<bsdf type="conductor" >\s*<string name="material" value="none" />',
        r'\1<bsdf type="plastic" ><rgb name="diffuseReflectance" value="0, 0, 0" />',
    ),
    (
        r'(<bsdf type="mask" id="Leaves" >\s*<texture.*?</texture>\s*)<bsdf type="twosided" >(.*?</bsdf>)\s*</bsdf>',
        r"\1\2",
    ),
]


def main(arguments):
    if len(arguments) != 2:
        sys.exit(__doc__)
    source, target = map(Path, arguments)
    shutil.copytree(source, target)
    scene = (source / "scene.xml").read_text()
    for pattern, replacement in CHANGES:
        scene, count = re.subn(pattern, replacement, scene, count=1, flags=re.DOTALL)
        if count != 1:
            sys.exit(f"{source / 'scene.xml'}: a material is not there: {pattern}")
    (target / "scene.xml").write_text(scene)


if __name__ == "__main__":
    main(sys.argv[1:])
