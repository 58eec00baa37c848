"""Renders that are kept: what gallery.py and experiments.py ask for is made once and found again."""
import hashlib
import json
import os
import pathlib
import resource
import signal
import subprocess
import sys
import time

MOST_BYTES = 400000  # of a picture in the repository
ROOT = pathlib.Path(__file__).resolve().parent.parent


def children_seconds():
    """Processor time of the processes that were started and have ended."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def processor_seconds(process):
    """That a process has taken so far, of all its threads."""
    fields = pathlib.Path(f"/proc/{process.pid}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def render_for(words, seconds):
    """A render that is told to end when it has had so many seconds of all processors together, so
    that a busy machine makes the picture that a quiet one makes. Passes under way are lost."""
    process = subprocess.Popen([*words, "--passes", "1000000"])
    while process.poll() is None:
        if processor_seconds(process) >= seconds:
            process.send_signal(signal.SIGTERM)
            seconds = float("inf")
        time.sleep(0.1)
    if process.returncode not in (0, 3):  # 3: ended when told to
        sys.exit(f"{' '.join(map(str, words))}: {process.returncode}")


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
        return (path.exists() and path.with_suffix(".json").exists()
                and self.is_newer(path, scene))

    def is_newer(self, path, scene):
        made = path.stat().st_mtime
        build = pathlib.Path(self.program).resolve().parent.parent
        causes = [pathlib.Path(self.program), *build.glob("libnephroid.so"),
                  *scene.parent.glob("*.pbrt")]
        return all(f.stat().st_mtime < made for f in causes)

    def render(self, name, scene, *options, processor=None):
        """The EXR of a scene (a path from the project's root); its statistics lie beside it, with
        the processor seconds it took. processor: how many it may take."""
        scene, options = ROOT / scene, [str(o) for o in options]
        path = self.path(name, scene, options + ([f"processor {processor:g}"] if processor else []))
        if not self.is_new(path, scene):
            print(f"render {name}: {scene.name} {' '.join(options)}", file=sys.stderr, flush=True)
            part = path.with_name(path.stem + "-part.exr")
            part.unlink(missing_ok=True)
            stats, before = path.with_suffix(".json"), children_seconds()
            words = ["render", str(scene), "-q", "-o", str(part), "--stats", str(stats), *options]
            if processor:
                render_for([self.program, *words], processor)
            if not part.exists():  # made at once, or since its first pass took longer
                before = children_seconds()
                self.run(*words, *(["--passes", "1"] if processor else []))
            said = json.loads(stats.read_text())
            said["processor"] = children_seconds() - before
            stats.write_text(json.dumps(said))
            part.rename(path)
        return path

    def photons(self, scene, *options):
        """A picture of the photons of one pass over the wireframe."""
        scene, options = ROOT / scene, [str(o) for o in options]
        path = self.path(f"photons-{scene.stem}", scene, options).with_suffix(".png")
        if not path.exists() or not self.is_newer(path, scene):
            self.run("photons", scene, "-q", "-o", path, *options)
        return path

    def layer(self, path, name, kind="exr"):
        """One layer of an EXR, as a picture of its own."""
        out = path.with_name(f"{path.stem}-{name}.{kind}")
        self.run("image", path, "--layer", name, "-o", out)
        return out

    def statistics(self, path):
        return json.loads(path.with_suffix(".json").read_text())

    def camera_seconds(self, path):
        """The camera's part of the processor time that a render took."""
        said = self.statistics(path)
        return said["processor"] * said["time"]["camera"] / said["time"]["total"]

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
        if pathlib.Path(out).stat().st_size > MOST_BYTES:
            sys.exit(f"{out} is too large to keep")
