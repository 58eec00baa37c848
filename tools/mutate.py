#!/usr/bin/env python3
"""Feeds the program damaged files of every kind that it reads.

Each case takes a file of the examples, of the fuzzers' corpora or of those made here, damages
a few of its bytes or words, and runs the program on it as a user would, mostly `info`, at times
a render of 16 x 16 pixels. Whatever the file, the program must come to its end by itself (with
an exit code it documents), within 20 seconds and 1 GiB. Unlike a fuzzer this knows nothing of
the program's inside, and it drives the whole of it, libraries included.

usage: mutate.py PROGRAM SOURCES [--cases N] [--seed N] [--only CASE] [--keep FOLDER]

A case depends on the seed and its number only: --only runs one of them again. The folder of one
that fails is kept, with the command in a file of its own.
"""
import argparse
import concurrent.futures
import gzip
import io
import json
import os
import random
import re
import resource
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import time
import zipfile
import zlib

MEMORY = 1 << 30  # bytes
PATIENCE = 20  # seconds
CODES = (0, 1, 2, 3)

HEAD = """LookAt 0 1 -4  0 0 0  0 1 0
Camera "perspective" "float fov" 50
Film "rgb" "integer xresolution" 16 "integer yresolution" 16
WorldBegin
LightSource "point" "rgb I" [10 10 10] "point3 from" [0 3 -2]
"""


# --- examples ---

class Example:
    """A file to damage, the files it needs beside it, and how to run the program on it."""

    def __init__(self, name, data, run, beside=None, scene=None):
        self.name, self.data, self.run = name, data, run
        self.beside = beside or {}
        self.scene = scene  # text of a scene that names the file


def tetrahedron():
    positions = [0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1]
    faces = [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]
    return positions, faces


def obj_files():
    positions, faces = tetrahedron()
    text = 'mtllib a.mtl\no body\n'
    for i in range(0, 12, 3):
        text += 'v %g %g %g\n' % tuple(positions[i:i + 3])
    text += 'vt 0 0\nvt 1 0\nvt 0 1\nvn 0 0 1\nusemtl clay\n'
    text += ''.join('f %d/1/1 %d/2/1 %d/3/1\n' % tuple(i + 1 for i in f) for f in faces)
    materials = ('newmtl clay\nKd 0.7 0.5 0.3\nKs 0.2 0.2 0.2\nNs 30\nNi 1.5\nd 1\nillum 2\n'
                 'map_Kd a.png\nmap_bump -bm 0.5 a.png\nnewmtl lamp\nKe 5 5 5\nPm 1\nPr 0.2\n')
    return text.encode(), materials.encode()


def stl_files():
    positions, faces = tetrahedron()
    corner = [positions[i:i + 3] for i in range(0, 12, 3)]
    text = 'solid body\n'
    binary = b'body'.ljust(80, b'\0') + struct.pack('<I', len(faces))
    for face in faces:
        text += ' facet normal 0 0 1\n  outer loop\n'
        binary += struct.pack('<3f', 0, 0, 1)
        for i in face:
            text += '   vertex %g %g %g\n' % tuple(corner[i])
            binary += struct.pack('<3f', *corner[i])
        text += '  endloop\n endfacet\n'
        binary += b'\0\0'
    return (text + 'endsolid body\n').encode(), binary


def three_mf():
    positions, faces = tetrahedron()
    vertices = ''.join('<vertex x="%g" y="%g" z="%g"/>' % tuple(positions[i:i + 3])
                       for i in range(0, 12, 3))
    triangles = ''.join('<triangle v1="%d" v2="%d" v3="%d"/>' % f for f in faces)
    return {
        '[Content_Types].xml':
            '<?xml version="1.0"?><Types xmlns="http://schemas.openxmlformats.org/package/2006/'
            'content-types"><Default Extension="model" ContentType="application/vnd.ms-package.'
            '3dmanufacturing-3dmodel+xml"/><Default Extension="rels" ContentType="application/'
            'vnd.openxmlformats-package.relationships+xml"/></Types>',
        '_rels/.rels':
            '<?xml version="1.0"?><Relationships xmlns="http://schemas.openxmlformats.org/package/'
            '2006/relationships"><Relationship Target="/3D/3dmodel.model" Id="r0" Type="http://'
            'schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>',
        '3D/3dmodel.model':
            '<?xml version="1.0"?><model unit="millimeter" xmlns="http://schemas.microsoft.com/'
            '3dmanufacturing/core/2015/02"><resources><object id="1" type="model"><mesh><vertices>'
            + vertices + '</vertices><triangles>' + triangles + '</triangles></mesh></object>'
            '</resources><build><item objectid="1"/></build></model>',
    }


def zipped(parts):
    out = io.BytesIO()
    with zipfile.ZipFile(out, 'w', zipfile.ZIP_DEFLATED) as z:
        for name, text in parts.items():
            z.writestr(zipfile.ZipInfo(name), text)
    return out.getvalue()


def collada():
    positions, faces = tetrahedron()
    numbers = ' '.join('%g' % x for x in positions)
    indices = ' '.join('%d' % i for f in faces for i in f)
    return ('<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" '
            'version="1.4.1"><asset><unit meter="1"/><up_axis>Y_UP</up_axis></asset>'
            '<library_effects><effect id="e"><profile_COMMON><technique sid="c"><lambert><diffuse>'
            '<color>0.8 0.2 0.1 1</color></diffuse></lambert></technique></profile_COMMON></effect>'
            '</library_effects><library_materials><material id="m"><instance_effect url="#e"/>'
            '</material></library_materials><library_geometries><geometry id="g"><mesh><source '
            'id="p"><float_array id="pa" count="12">' + numbers + '</float_array><technique_common>'
            '<accessor source="#pa" count="4" stride="3"><param name="X" type="float"/><param '
            'name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common>'
            '</source><vertices id="v"><input semantic="POSITION" source="#p"/></vertices>'
            '<triangles count="4" material="m"><input semantic="VERTEX" source="#v" offset="0"/>'
            '<p>' + indices + '</p></triangles></mesh></geometry></library_geometries>'
            '<library_visual_scenes><visual_scene id="s"><node id="n"><matrix>1 0 0 0 0 1 0 0 0 0 1 '
            '0 0 0 0 1</matrix><instance_geometry url="#g"><bind_material><technique_common>'
            '<instance_material symbol="m" target="#m"/></technique_common></bind_material>'
            '</instance_geometry></node></visual_scene></library_visual_scenes><scene>'
            '<instance_visual_scene url="#s"/></scene></COLLADA>').encode()


def fbx():
    positions, faces = tetrahedron()
    indices = ','.join('%d,%d,%d' % (a, b, -c - 1) for a, b, c in faces)
    return ('; FBX 7.4.0 project file\nFBXHeaderExtension:  {\n\tFBXHeaderVersion: 1003\n'
            '\tFBXVersion: 7400\n}\nGlobalSettings:  {\n\tVersion: 1000\n\tProperties70:  {\n'
            '\t\tP: "UpAxis", "int", "Integer", "",1\n\t}\n}\nObjects:  {\n'
            '\tGeometry: 100, "Geometry::body", "Mesh" {\n\t\tVertices: *12 {\n\t\t\ta: '
            + ','.join('%g' % x for x in positions) + '\n\t\t}\n\t\tPolygonVertexIndex: *12 {\n'
            '\t\t\ta: ' + indices + '\n\t\t}\n\t}\n\tModel: 200, "Model::body", "Mesh" {\n'
            '\t\tVersion: 232\n\t}\n}\nConnections:  {\n\tC: "OO",100,200\n\tC: "OO",200,0\n}\n'
            ).encode()


def off_file():
    positions, faces = tetrahedron()
    text = 'OFF\n4 4 0\n'
    for i in range(0, 12, 3):
        text += '%g %g %g\n' % tuple(positions[i:i + 3])
    return (text + ''.join('3 %d %d %d\n' % f for f in faces)).encode()


def png(width, height):
    rows = b''.join(b'\0' + bytes((40 * x + y) % 256 for x in range(3 * width))
                    for y in range(height))

    def chunk(kind, data):
        return (struct.pack('>I', len(data)) + kind + data +
                struct.pack('>I', zlib.crc32(kind + data)))
    head = struct.pack('>IIBBBBB', width, height, 8, 2, 0, 0, 0)
    return (b'\x89PNG\r\n\x1a\n' + chunk(b'IHDR', head) + chunk(b'IDAT', zlib.compress(rows)) +
            chunk(b'IEND', b''))


IMAGE_SCENE = HEAD + ('Texture "t" "spectrum" "imagemap" "string filename" "%s"\n'
                      'Material "diffuse" "texture reflectance" "t"\nShape "sphere"\n'
                      'LightSource "infinite" "string filename" "%s"\n')
SPECTRUM_SCENE = HEAD + ('Material "conductor" "spectrum eta" "%s" "spectrum k" "%s"\n'
                         'Shape "sphere"\n')
PROFILE_SCENE = HEAD + ('LightSource "goniometric" "string filename" "%s"\nShape "sphere"\n')
MESH_SCENE = HEAD + 'Shape "plymesh" "string filename" "%s"\n'


def read(path):
    with open(path, 'rb') as file:
        return file.read()


def made_models():
    obj, mtl = obj_files()
    text_stl, binary_stl = stl_files()
    picture = {'a.png': png(4, 4)}
    yield Example('a.obj', obj, 'scene', {'a.mtl': mtl, **picture})
    yield Example('a.mtl', mtl, 'named', {'a.obj': obj, **picture}, 'a.obj')
    yield Example('a.stl', text_stl, 'scene')
    yield Example('b.stl', binary_stl, 'scene')
    yield Example('a.3mf', zipped(three_mf()), 'scene')
    yield Example('a.dae', collada(), 'scene')
    yield Example('a.fbx', fbx(), 'scene')
    yield Example('a.off', off_file(), 'scene')


def corpus_examples(root):
    corpus = os.path.join(root, 'tests/fuzz/corpus')
    beside = {'body.bin': bytes(range(256)), 'image.png': png(2, 2)}
    kinds = {'gltf': 'scene', 'ies': PROFILE_SCENE, 'image': IMAGE_SCENE, 'pbrt': 'scene',
             'ply': MESH_SCENE}
    for kind, run in kinds.items():
        folder = os.path.join(corpus, kind)
        for name in sorted(os.listdir(folder)):
            data = read(os.path.join(folder, name))
            if run != 'scene':
                yield Example(name, data, 'in scene', scene=run.replace('%s', name))
            else:
                yield Example(name, data, 'scene', beside)
            if kind == 'ply':
                yield Example(name, data, 'scene')
            if kind == 'image':
                yield Example(name, data, 'compare')


def scene_examples(root):
    """The scenes of the project, with all that lies beside them."""
    top = os.path.join(root, 'scenes')
    for name in sorted(os.listdir(top)):
        folder = os.path.join(top, name)
        files = {f: read(os.path.join(folder, f)) for f in sorted(os.listdir(folder))
                 if os.path.isfile(os.path.join(folder, f))} if os.path.isdir(folder) else {}
        for file, data in files.items():
            if file.endswith('.pbrt'):
                others = {k: v for k, v in files.items() if k != file}
                yield Example(file, data, 'scene', others)
                yield Example(file + '.gz', gzip.compress(data, mtime=0), 'scene', others)
            elif file.endswith('.ply'):
                yield Example(file, data, 'scene')


def other_examples():
    spectrum = '\n'.join('%d %g' % (nm, 0.5 + nm / 2000) for nm in range(380, 780, 20))
    yield Example('a.spd', spectrum.encode(), 'in scene',
                  scene=SPECTRUM_SCENE.replace('%s', 'a.spd'))
    settings = ('# a comment\nphotons = 1000\npasses = 1\nspp = 2\nalpha = 0.7\nmaxdepth = 7\n'
                'integrator = vcm\ncaustic_kernel = cone\nfinal_gather = true\n')
    yield Example('a.set', settings.encode(), 'settings')


def all_examples(root):
    return [*scene_examples(root), *corpus_examples(root), *made_models(), *other_examples()]


# --- damage ---

NUMBERS = ['0', '-0', '1', '-1', '2', '0.5', '1e-45', '1e-38', '1e38', '3.5e38', '1e300', '-1e38',
           'nan', 'inf', '-inf', '255', '256', '32767', '65535', '65536', '2147483647',
           '2147483648', '-2147483648', '4294967295', '4294967296', '1073741824', '1000000',
           '9223372036854775807', '18446744073709551616', '99999999999999999999', '0x10', '1e',
           '+', '-', '.', '1,5', '']
TOKEN = re.compile(rb'[A-Za-z_][A-Za-z_0-9.:]*|[-+]?[0-9.][-+0-9.eE]*|\s+|.', re.S)
NUMBER = re.compile(rb'[-+]?[0-9.][-+0-9.eE]*$')


def damage_bytes(r, data):
    data = bytearray(data)
    if not data:
        return bytes([r.randrange(256)])
    at = r.randrange(len(data))
    kind = r.randrange(9)
    if kind == 0:
        data[at] ^= 1 << r.randrange(8)
    elif kind == 1:
        data[at] = r.randrange(256)
    elif kind == 2:
        data[at:at] = bytes(r.randrange(256) for _ in range(r.randrange(1, 9)))
    elif kind == 3:
        del data[at:at + r.randrange(1, 17)]
    elif kind == 4:
        end = min(len(data), at + r.randrange(1, 65))
        data[at:at] = data[at:end] * r.choice([1, 2, 50])
    elif kind == 5:
        del data[at:]
    elif kind in (6, 7):
        size = r.choice([1, 2, 4, 8])
        value = r.choice([0, 1, -1, 127, 128, 255, 256, 32767, 65535, 65536, (1 << 31) - 1,
                          1 << 31, (1 << 32) - 1, 1 << 32, (1 << 63) - 1, 1 << 62])
        order = r.choice(['little', 'big'])
        data[at:at + size] = (value % (1 << (8 * size))).to_bytes(size, order)
    else:
        end = min(len(data), at + r.randrange(1, 33))
        to = r.randrange(len(data))
        data[to:to + end - at] = data[at:end]
    return bytes(data)


def damage_words(r, data, other):
    words = TOKEN.findall(data)
    places = [i for i, w in enumerate(words) if not w.isspace()]
    if not places:
        return damage_bytes(r, data)
    at = r.choice(places)
    numbers = [i for i in places if NUMBER.match(words[i])]
    kind = r.randrange(9)
    if kind in (0, 1, 2) and numbers:
        words[r.choice(numbers)] = r.choice(NUMBERS).encode()
    elif kind == 3:
        del words[at]
    elif kind == 4:
        words[at:at] = [words[at], b' '] * r.choice([1, 2, 3, 200])
    elif kind == 5:
        to = r.choice(places)
        words[at], words[to] = words[to], words[at]
    elif kind == 6:
        words[at] = words[r.choice(places)]
    elif kind == 7:
        strange = [w for w in TOKEN.findall(other[:20000]) if not w.isspace()]
        words[at] = r.choice(strange) if strange else b''
    else:
        line = data.split(b'\n')
        first = r.randrange(len(line))
        move = line[first:first + r.randrange(1, 5)]
        to = r.randrange(len(line))
        if r.random() < 0.5:
            del line[first:first + len(move)]
        line[to:to] = move
        return b'\n'.join(line)
    return b''.join(words)


def is_text(data):
    return b'\0' not in data[:2000]


def damage_plain(r, data, other):
    for _ in range(r.choice([1, 1, 1, 2, 3, 8])):
        if is_text(data) and r.random() < 0.75:
            data = damage_words(r, data, other)
        else:
            data = damage_bytes(r, data)
    return data


def damage_glb(r, data, other):
    """Its text, with lengths that fit: else nothing would get past them."""
    length = struct.unpack('<I', data[12:16])[0]
    text = damage_words(r, data[20:20 + length], other)
    text += b' ' * (-len(text) % 4)
    rest = data[20 + length:]
    return (data[:8] + struct.pack('<II', 20 + len(text) + len(rest), len(text)) + data[16:20] +
            text + rest)


def damage(r, data, other):
    """Half of what is packed is damaged inside."""
    inside = r.random() < 0.5
    if inside and data[:2] == b'\x1f\x8b':
        return gzip.compress(damage_plain(r, gzip.decompress(data), other), 1, mtime=0)
    if inside and data[:4] == b'PK\3\4':
        parts = {}
        with zipfile.ZipFile(io.BytesIO(data)) as z:
            parts = {name: z.read(name) for name in z.namelist()}
        name = r.choice(sorted(parts))
        parts[name] = damage_plain(r, parts[name], other)
        return zipped(parts)
    if inside and data[:4] == b'glTF':
        return damage_glb(r, data, other)
    return damage_plain(r, data, other)


# --- running ---

GROUPS = ('/sys/fs/cgroup', 'memory.max'), ('/sys/fs/cgroup/memory', 'memory.limit_in_bytes')
SCOPE = ['systemd-run', '--user', '--scope', '--quiet', '--collect', '-p', 'MemoryMax=%d' % MEMORY,
         '-p', 'MemorySwapMax=0', '--']


def new_group():
    """A control group of MEMORY, of either version of them; None where none can be made."""
    for mount, limit in GROUPS:
        if not os.path.exists(os.path.join(mount, 'cgroup.procs')):
            continue
        try:
            group = tempfile.mkdtemp(prefix='nephroid-mutate-', dir=mount)
        except OSError:
            continue
        try:
            with open(os.path.join(group, limit), 'w') as file:
                file.write(str(MEMORY))
            return group
        except OSError:
            os.rmdir(group)
    return None


def remove_group(group):
    """Not at once possible where the last of its processes has only just ended."""
    for _ in range(50):
        try:
            os.rmdir(group)
            return
        except OSError:
            time.sleep(0.02)


def memory_limiter():
    """How memory can be limited on this machine: as 'control group', 'scope' of the user's
    session, or 'address space', which is stricter."""
    group = new_group()
    if group:
        remove_group(group)
        return 'control group'
    if shutil.which(SCOPE[0]) and subprocess.run(SCOPE + ['true'], stdin=subprocess.DEVNULL,
                                                 stderr=subprocess.DEVNULL).returncode == 0:
        return 'scope'
    return 'address space'


class Limits:
    """Of one run: 1 GiB of memory; and 20 seconds, of work where it works, three times as many
    where it waits."""

    def __init__(self, limiter):
        self.limiter = limiter
        self.group = new_group() if limiter == 'control group' else None

    def around(self, command):
        return SCOPE + command if self.limiter == 'scope' else command

    def enter(self):
        """In the child, before the program begins."""
        if self.group:
            with open(os.path.join(self.group, 'cgroup.procs'), 'w') as file:
                file.write('0')
        elif self.limiter != 'scope':
            resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
        resource.setrlimit(resource.RLIMIT_CPU, (PATIENCE, PATIENCE + 5))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))

    def leave(self):
        if self.group:
            remove_group(self.group)


def command_of(r, example, program):
    render = r.random() < 0.12
    target = {'in scene': 'main.pbrt', 'named': example.scene}.get(example.run, example.name)
    if example.run == 'settings':
        return [program, 'info', 'main.pbrt', '--settings', example.name]
    if example.run == 'compare':
        return [program, 'compare', example.name, example.name]
    if render:
        return [program, 'render', target, '-q', '--size', '16x16', '--passes', '1', '--spp', '1',
                '--set', 'photons=1000', '-j', '1', '-o', 'out.pfm']
    return [program, 'info', target]


def write_files(folder, example, data):
    for name, bytes_ in {**example.beside, example.name: data}.items():
        with open(os.path.join(folder, name), 'wb') as file:
            file.write(bytes_)
    if example.run in ('in scene', 'settings'):
        text = example.scene or HEAD + 'Shape "sphere"\n'
        with open(os.path.join(folder, 'main.pbrt'), 'w') as file:
            file.write(text)


def run(command, folder, limiter):
    """What went wrong, or None, and what the program said."""
    limits = Limits(limiter)
    process = subprocess.Popen(limits.around(command), cwd=folder, stdin=subprocess.DEVNULL,
                               stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                               preexec_fn=limits.enter, start_new_session=True)
    try:
        output = process.communicate(timeout=3 * PATIENCE)[0]
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)
        return 'still there after %d s' % (3 * PATIENCE), process.communicate()[0]
    finally:
        limits.leave()
    if process.returncode == -signal.SIGXCPU:
        return 'still at work after %d s' % PATIENCE, output
    if process.returncode < 0:
        return 'ended by %s' % signal.Signals(-process.returncode).name, output
    if process.returncode not in CODES:
        return 'exit code %d' % process.returncode, output
    if b'\x1b' in output:
        return 'an escape sequence in what it says', output
    return None, output


def run_case(number, options, examples):
    r = random.Random('%s-%d' % (options.seed, number))
    example = r.choice(examples)
    other = r.choice(examples).data
    data = damage(r, example.data, other)
    folder = tempfile.mkdtemp(prefix='nephroid-mutate-')
    try:
        write_files(folder, example, data)
        command = command_of(r, example, os.path.abspath(options.program))
        fault, output = run(command, folder, options.limiter)
        if options.only is not None:
            sys.stdout.buffer.write(output)
        if fault:
            kept = os.path.join(options.keep, '%s-%d' % (options.seed, number))
            shutil.rmtree(kept, ignore_errors=True)
            shutil.copytree(folder, kept)
            with open(os.path.join(kept, 'command'), 'w') as file:
                file.write('%s\n%s\n' % (' '.join(command), fault))
            return 'case %d: %s: %s: %s' % (number, example.name, fault, kept)
        return None
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('program')
    parser.add_argument('sources')
    parser.add_argument('--cases', type=int, default=10000)
    parser.add_argument('--seed', type=int, default=random.SystemRandom().randrange(1 << 31))
    parser.add_argument('--only', type=int)
    parser.add_argument('--keep', default='mutate-found')
    parser.add_argument('--jobs', type=int, default=os.cpu_count())
    options = parser.parse_intermixed_args()
    options.limiter = memory_limiter()
    examples = all_examples(options.sources)
    numbers = [options.only] if options.only is not None else range(options.cases)
    print('mutate: seed %d, %d cases of %d examples, memory limited by %s' % (
        options.seed, len(numbers), len(examples), options.limiter), flush=True)
    faults = 0
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        for fault in pool.map(lambda n: run_case(n, options, examples), numbers):
            if fault:
                faults += 1
                print(fault, flush=True)
    print('mutate: %d of %d cases failed' % (faults, len(numbers)))
    return 1 if faults else 0


if __name__ == '__main__':
    sys.exit(main())
