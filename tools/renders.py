"""Renders that are kept: what gallery.py and experiments.py ask for is made once and found again."""
import hashlib
import json
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent


class Kept:
    """Pictures in a folder, each under a name that tells its scene and its options; one that is
    newer than the scene's files and than the program is not made again."""

    def __init__(self, program, folder):
        self.program = str(program)
        self.folder = pathlib.Path(folder)
        self.folder.mkdir(parents=True, exist_ok=True)

    def run(self, *words):
        return subprocess.run([self.program, *map(str, words)], check=True, text=True,
                              stdout=subprocess.PIPE).stdout

    def path(self, name, scene, options):
        key = hashlib.sha256(" ".join([str(scene), *options]).encode()).hexdigest()[:10]
        return self.folder / f"{name}-{key}.exr"

    def is_new(self, path, scene):
        stats = path.with_suffix(".json")
        if not path.exists() or not stats.exists():
            return False
        made = path.stat().st_mtime
        build = pathlib.Path(self.program).resolve().parent.parent
        causes = [pathlib.Path(self.program), *build.glob("libnephroid.so"),
                  *scene.parent.glob("*.pbrt")]
        return all(f.stat().st_mtime < made for f in causes)

    def render(self, name, scene, *options):
        """The EXR of a scene (a path from the project's root); its statistics lie beside it."""
        scene, options = ROOT / scene, [str(o) for o in options]
        path = self.path(name, scene, options)
        if not self.is_new(path, scene):
            print(f"render {name}: {scene.name} {' '.join(options)}", file=sys.stderr, flush=True)
            part = path.with_name(path.stem + "-part.exr")
            self.run("render", scene, "-q", "-o", part, "--stats", path.with_suffix(".json"),
                     *options)
            part.rename(path)
        return path

    def layer(self, path, name, kind="exr"):
        """One layer of an EXR, as a picture of its own."""
        out = path.with_name(f"{path.stem}-{name}.{kind}")
        self.run("image", path, "--layer", name, "-o", out)
        return out

    def statistics(self, path):
        return json.loads(path.with_suffix(".json").read_text())

    def compare(self, path, reference):
        return json.loads(self.run("compare", path, reference, "--json"))

    def picture(self, sources, out, columns=None, size=None, exposure=None):
        """Writes one picture, or several as a sheet, as an 8-bit file."""
        words = []
        if columns:
            words += ["--columns", columns]
        if size:
            words += ["--size", size]
        if exposure:
            words += ["--exposure", exposure]
        self.run("image", *sources, "-o", out, *words)
