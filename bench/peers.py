"""Programs of others on this machine, told of by environment variables.

NEPHROID_SMALLVCM  SmallVCM's program (Davidovič and Georgiev)
NEPHROID_PBRT      pbrt-v4's program, whose SPPM is a peer
"""
import os
import pathlib
import re
import shutil


def find(name):
    """The program that the variable names, or None."""
    path = os.environ.get(name)
    return shutil.which(path) if path else None


def absent():
    """What --peers would like to have and did not find."""
    return [name for name in ("NEPHROID_SMALLVCM", "NEPHROID_PBRT") if not find(name)]


def smallvcm(program, scene, algorithm, iterations, folder):
    """Of one of its scenes by number; by all threads, of which the processor's time is
    counted."""
    return [program, "-s", str(scene), "-a", algorithm, "-i", str(iterations), "-o",
            str(pathlib.Path(folder) / "peer.bmp")]


def pbrt(program, scene, photons, passes, side, folder):
    """pbrt of a copy, that asks for SPPM, of a scene which names no other files; by one
    thread."""
    text = re.sub(r'Integrator\s+"\w+"(\s+"[^"]+"\s+(\[[^]]*\]|\S+))*', "",
                  pathlib.Path(scene).read_text())
    text = re.sub(r'("integer [xy]resolution"\s+)(\d+|\[\s*\d+\s*\])', rf"\g<1>{side}", text)
    copy = pathlib.Path(folder) / "peer.pbrt"
    copy.write_text(f'Integrator "sppm" "integer maxdepth" 16 '
                    f'"integer photonsperiteration" {photons}\n' + text)
    return [program, "--quiet", "--nthreads", "1", "--spp", str(passes), "--outfile",
            str(pathlib.Path(folder) / "peer.exr"), str(copy)]
