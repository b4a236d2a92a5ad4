#!/usr/bin/env python3
"""check_animation_file - let independent readers judge an animation file (FBX or BVH; also glTF/USD).

Usage
    check_animation_file.py FILE [--expected EXPECTED.json] [--tol 0.05] [--wtol 0.005]
                                 [--frames 0,1,100] [--readers a,b] [--require a,b]
                                 [--json OUT.json] [--timeout 120] [-v]

For every reader it prints ok / failed / not installed, bone count and roots, number of animated nodes,
duration and frame rate, blend-shape channels, and how far its world-space joint positions are from the
reference. The reference is EXPECTED.json, or without it the first reader that succeeded.

EXPECTED.json   {"fps": 60, "frames": [0, 10, ...],                 frame n means time n/fps after the take's start
                 "joints": {"hand_l": [[x, y, z], ...], ...},       one triple per entry of "frames"
                 "weights": {"jawOpen": [0.0, 0.31, ...]}}           optional, 0..1
    FBX/glTF/USD positions are in the canonical space: right-handed, Y up, +Z toward the viewer, centimetres
    (every reader's answer is brought there first). BVH has no declared axes or unit: raw file numbers.

Readers         install with                                          for
    structure   nothing (built in: records, offsets, footer)          .fbx
    fbxsdk      npm i fbx2gltf   (binary embeds Autodesk FBX SDK 2019.2; samples at 24/30/60 fps only)   .fbx
    ufbx        pip install ufbx==0.0.5   (NOT beside pyufbx: both own the folder ufbx/)   .fbx
    pufbx       pip install pufbx                                     .fbx (transforms only)
    blender     pip install bpy                                       .fbx .bvh .glb/.gltf
    assimp      apt-get install assimp-utils                          .fbx .bvh .glb (transforms only)
    three       npm i three                                           .fbx .bvh .glb
    bvhio, bvh, pybvh   pip install bvhio bvh pybvh                   .bvh (pybvh refuses position channels off the root)
    gltf        nothing (built-in evaluator)                          .glb
    gltfvalid   npm i gltf-validator                                  .glb .gltf
    usd         pip install usd-core                                  .usd .usda .usdc (UsdSkel)

Where things are looked for: python modules in this interpreter, in $CHECK_ANIM_PYTHONS (colon-separated
interpreters) and in */bin/python beside this script; node packages in $CHECK_ANIM_NODE_MODULES,
./node_modules, and node/node_modules or node_modules beside this script; FBX2glTF also in $FBX2GLTF.

Exit status: 0 every reader that ran agrees, 1 a reader failed or disagrees or a required one is missing, 2 usage.
Each reader runs in its own process, so a crash or a hang of one is just 'failed'.
"""
import argparse, atexit, base64, functools, gc, glob, json, math, os, pathlib, re, select, shutil, signal, stat, struct, subprocess, sys, tempfile, time, zlib

HERE = os.path.dirname(os.path.abspath(__file__))
KTIME = 46186158000
KEPT = []
TIME_MODE_FPS = {1: 120.0, 2: 100.0, 3: 60.0, 4: 50.0, 5: 48.0, 6: 30.0, 7: 30.0, 8: 30000 / 1001, 9: 30000 / 1001,
                 10: 25.0, 11: 24.0, 12: 1000.0, 13: 24000 / 1001, 15: 96.0, 16: 72.0, 17: 60000 / 1001, 18: 120000 / 1001}


class NotInstalled(Exception):
    pass


# ------------------------------------------------------------------ small 4x4 maths, column vectors, row-major lists
def mul(a, b):
    return [sum(a[4 * r + k] * b[4 * k + c] for k in range(4)) for r in range(4) for c in range(4)]


def trs(t, q, s):
    x, y, z, w = q
    n = math.sqrt(x * x + y * y + z * z + w * w) or 1.0
    x, y, z, w = x / n, y / n, z / n, w / n
    return [(1 - 2 * (y * y + z * z)) * s[0], 2 * (x * y - z * w) * s[1], 2 * (x * z + y * w) * s[2], t[0],
            2 * (x * y + z * w) * s[0], (1 - 2 * (x * x + z * z)) * s[1], 2 * (y * z - x * w) * s[2], t[1],
            2 * (x * z - y * w) * s[0], 2 * (y * z + x * w) * s[1], (1 - 2 * (x * x + y * y)) * s[2], t[2],
            0.0, 0.0, 0.0, 1.0]


def rot_axis(axis, deg):
    c, s = math.cos(math.radians(deg)), math.sin(math.radians(deg))
    return {'X': [1, 0, 0, 0, 0, c, -s, 0, 0, s, c, 0, 0, 0, 0, 1], 'Y': [c, 0, s, 0, 0, 1, 0, 0, -s, 0, c, 0, 0, 0, 0, 1],
            'Z': [c, -s, 0, 0, s, c, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]}[axis]


def lerp(a, b, u):
    return [x + (y - x) * u for x, y in zip(a, b)]


def nlerp(a, b, u):
    if sum(x * y for x, y in zip(a, b)) < 0:
        b = [-v for v in b]
    r = lerp(a, b, u)
    n = math.sqrt(sum(v * v for v in r)) or 1.0
    return [v / n for v in r]


def at(times, values, t, mix=lerp):
    """Value of a linear track at t (held outside)."""
    if t <= times[0]:
        return values[0]
    if t >= times[-1]:
        return values[-1]
    lo, hi = 0, len(times) - 1
    while hi - lo > 1:
        m = (lo + hi) // 2
        lo, hi = (m, hi) if times[m] <= t else (lo, m)
    return mix(values[lo], values[hi], (t - times[lo]) / (times[hi] - times[lo]))


def spline(times, keys, t, mix):
    """Value of a glTF cubic spline at t (held outside); a key is (slope in, value, slope out). Appendix C of glTF 2.0."""
    if t <= times[0] or t >= times[-1]:
        return keys[0 if t <= times[0] else -1][1]
    k = next(i for i in range(len(times) - 1) if t < times[i + 1])
    d = times[k + 1] - times[k]
    u = (t - times[k]) / d
    a, b, c, e = 2 * u ** 3 - 3 * u ** 2 + 1, d * (u ** 3 - 2 * u ** 2 + u), 3 * u ** 2 - 2 * u ** 3, d * (u ** 3 - u ** 2)
    return [a * p + b * m + c * q + e * n for p, m, q, n in zip(keys[k][1], keys[k][2], keys[k + 1][1], keys[k + 1][0])]


# ------------------------------------------------------------------ built-in FBX structure check
class FbxError(Exception):
    pass


def fbx_records(data):
    if data[:23] != b'Kaydara FBX Binary  \0\x1a\0':
        raise FbxError('not a binary FBX header')
    ver = struct.unpack_from('<I', data, 23)[0]
    big = ver >= 7500
    hd, hn = ('<QQQB', 25) if big else ('<IIIB', 13)

    def node(p, depth):
        if p + hn > len(data):
            raise FbxError('record header past the end of the file at %d' % p)
        end, n, plen, nl = struct.unpack_from(hd, data, p)
        if end == 0:
            if (n, plen, nl) != (0, 0, 0):
                raise FbxError('bad null record at %d' % p)
            return None, p + hn
        if end > len(data) or end < p + hn + nl + plen:
            raise FbxError('record at %d: end offset %d is outside its parent or the file' % (p, end))
        name = data[p + hn:p + hn + nl].decode('ascii', 'replace')
        q = p + hn + nl
        stop = q + plen
        props = []
        for _ in range(n):
            if q >= stop:
                raise FbxError('%s: property list shorter than its count' % name)
            ty = chr(data[q]); q += 1
            if ty in 'YCIFDLB':
                f, sz = {'Y': ('<h', 2), 'C': ('<?', 1), 'B': ('<?', 1), 'I': ('<i', 4), 'F': ('<f', 4), 'D': ('<d', 8), 'L': ('<q', 8)}[ty]
                props.append((ty, struct.unpack_from(f, data, q)[0])); q += sz
            elif ty in 'SR':
                ln = struct.unpack_from('<I', data, q)[0]; q += 4
                if q + ln > stop:
                    raise FbxError('%s: string past its record' % name)
                props.append((ty, bytes(data[q:q + ln]))); q += ln
            elif ty in 'fdlibc':
                cnt, enc, cl = struct.unpack_from('<III', data, q); q += 12
                raw = data[q:q + cl]; q += cl
                sz = {'f': 4, 'd': 8, 'l': 8, 'i': 4, 'b': 1, 'c': 1}[ty]
                if enc == 1:
                    try:
                        raw = zlib.decompress(raw)
                    except zlib.error as e:
                        raise FbxError('%s: bad zlib array: %s' % (name, e))
                elif enc != 0:
                    raise FbxError('%s: array encoding %d' % (name, enc))
                if len(raw) != cnt * sz:
                    raise FbxError('%s: array holds %d bytes, %d declared' % (name, len(raw), cnt * sz))
                props.append((ty, (cnt, raw)))
            else:
                raise FbxError('%s: unknown property type %r at %d' % (name, ty, q - 1))
        if q != stop:
            raise FbxError('%s: property list length wrong (%d, declared %d)' % (name, q, stop))
        kids = []
        if q < end:
            while True:
                k, q = node(q, depth + 1)
                if k is None:
                    break
                kids.append(k)
            if q != end:
                raise FbxError('%s: children end at %d, record at %d' % (name, q, end))
        return (name, props, kids), end

    p, top = 27, []
    while True:
        k, p = node(p, 0)
        if k is None:
            break
        top.append(k)
    return ver, top, p


FOOT2 = bytes.fromhex('f85a8c6adef5d97eece90ce3758f290b')


def fbx_ids(stamp):
    """(FileId, footer id) that Autodesk's SDK expects for a CreationTime 'YYYY-MM-DD hh:mm:ss:mmm'; it rejects a file otherwise."""
    y, mo, d, h, mi, s, ms = [int(v) for v in re.findall(r'\d+', stamp)]
    text = ('%02d%02d%02d%02d%02d%04d%02d' % (s, mo, h, d, ms // 10, y, mi)).encode()

    def mix(a, b):
        c, o = 64, bytearray(a)
        for i in range(16):
            o[i] ^= c ^ b[i]
            c = o[i]
        return bytes(o)
    one = mix(bytes.fromhex('58aba9f06ca2d83f4d4749a3b4b2e73d'), text)
    return one, mix(mix(one, bytes.fromhex('e24f7b5fcde4c86ddbd8fbd74058c678')), text)


def fbx_structure(path):
    data = pathlib.Path(path).read_bytes()
    ver, top, p = fbx_records(data)
    warn = []
    tail = data[p:]
    if len(tail) < 16 + 4 + 4 + 120 + 16:
        raise FbxError('footer missing or cut (%d bytes)' % len(tail))
    tops = {t[0]: t for t in top}
    if 'FileId' not in tops or 'CreationTime' not in tops:
        raise FbxError('no FileId or CreationTime: Autodesk\'s SDK rejects the file')
    try:
        want = fbx_ids(tops['CreationTime'][1][0][1].decode())
    except Exception:
        raise FbxError('CreationTime is not YYYY-MM-DD hh:mm:ss:mmm')
    if tops['FileId'][1][0][1] != want[0] or tail[:16] != want[1]:
        raise FbxError('FileId or footer id does not match CreationTime: Autodesk\'s SDK rejects the file')
    if tail[-16:] != FOOT2:
        raise FbxError('footer end mark wrong or missing')
    v2 = tail.rfind(struct.pack('<I', ver), 0, len(tail) - 16)
    if v2 < 0:
        warn.append('version not repeated in footer')
    elif (p + v2) % 16:
        warn.append('footer version word not 16-byte aligned')
    names = [t[0] for t in top]
    for need in ('FBXHeaderExtension', 'FileId', 'CreationTime', 'GlobalSettings', 'Documents', 'Definitions', 'Objects', 'Connections'):
        if need not in names:
            warn.append('no ' + need)
    info = {'version': ver, 'warnings': warn}
    by = {t[0]: t for t in top}

    def p70(n):
        out = {}
        for k in n[2]:
            if k[0] == 'Properties70':
                for q in k[2]:
                    if q[1]:
                        out[q[1][0][1].decode('utf8', 'replace')] = [v for _, v in q[1][4:]]
        return out
    if 'GlobalSettings' in by:
        g = p70(by['GlobalSettings'])
        tm = (g.get('TimeMode') or [0])[0]
        info['time_mode'] = tm
        info['fps'] = (g.get('CustomFrameRate') or [0])[0] if tm == 14 else TIME_MODE_FPS.get(tm)
        for k in ('UpAxis', 'UpAxisSign', 'FrontAxis', 'FrontAxisSign', 'CoordAxis', 'CoordAxisSign', 'UnitScaleFactor'):
            info[k] = (g.get(k) or [None])[0]
    objs = by['Objects'][2] if 'Objects' in by else []
    ids, counts, uid = {}, {}, set()
    for o in objs:
        if len(o[1]) >= 3 and o[1][0][0] == 'L':
            if o[1][0][1] in uid:
                warn.append('duplicate object id %d' % o[1][0][1])
            uid.add(o[1][0][1])
            nm = o[1][1][1].split(b'\0\1')[0].decode('utf8', 'replace')
            kind = o[0] + ':' + o[1][2][1].decode('utf8', 'replace')
            counts[kind] = counts.get(kind, 0) + 1
            ids[o[1][0][1]] = (kind, nm, o)
    info['objects'] = counts
    parent = {}
    for c in (by['Connections'][2] if 'Connections' in by else []):
        v = [x[1] for x in c[1]]
        for x in v[1:3]:
            if x and x not in ids:
                warn.append('connection to unknown object %d' % x)
        if v[0] == b'OO' and v[1] in ids and ids[v[1]][0].startswith('Model:') and (v[2] == 0 or ids.get(v[2], ('',))[0].startswith('Model:')):
            parent[ids[v[1]][1]] = ids[v[2]][1] if v[2] in ids else None
    info['bones'] = [n for k, n, _ in ids.values() if k == 'Model:LimbNode']
    info['parent'] = parent
    start, stop, keys, bad = None, None, 0, 0
    fpt = KTIME / info['fps'] if info.get('fps') else None
    for k, n, o in ids.values():
        if k.startswith('AnimationStack') and start is None:
            pr = p70(o)
            start, stop = (pr.get('LocalStart') or [0])[0], (pr.get('LocalStop') or [0])[0]
            if fpt and abs(stop - round(stop / fpt) * fpt) > 0.51 and abs(stop - round(stop / fpt) * fpt) < 100:
                warn.append('LocalStop is %+d ticks off a whole frame: the SDK may drop the last frame' % round(stop - round(stop / fpt) * fpt))
        if k.startswith('AnimationCurve:'):
            sub = {c[0]: c[1] for c in o[2]}
            kt, kv = sub['KeyTime'][0][1], sub['KeyValueFloat'][0][1]
            keys += kt[0]
            if kt[0] != kv[0]:
                bad += 1
            tt = struct.unpack('<%dq' % kt[0], kt[1])
            if any(b <= a for a, b in zip(tt, tt[1:])):
                bad += 1
            if 'KeyAttrRefCount' not in sub or 'KeyAttrFlags' not in sub or 'KeyAttrDataFloat' not in sub:
                raise FbxError('an AnimationCurve without KeyAttrFlags/KeyAttrDataFloat/KeyAttrRefCount crashes Autodesk\'s SDK')
            else:
                rc = sub['KeyAttrRefCount'][0][1]
                if sum(struct.unpack('<%di' % rc[0], rc[1])) != kt[0]:
                    warn.append('KeyAttrRefCount does not add up to the keys of a curve')
    if bad:
        raise FbxError('%d animation curves with unequal or unsorted keys' % bad)
    info.update(start=(start or 0) / KTIME, stop=(stop or 0) / KTIME, keys=keys)
    info['warnings'] = warn[:12]
    return info


# ------------------------------------------------------------------ glTF evaluator (used for FBX2glTF output and .glb)
def load_glb(path):
    d = pathlib.Path(path).read_bytes()
    if d[:4] != b'glTF':
        js = json.loads(d)
        bufs = []
        for b in js.get('buffers', []):
            u = b['uri']
            bufs.append(base64.b64decode(u.split(',', 1)[1]) if u.startswith('data:') else pathlib.Path(os.path.dirname(path), u).read_bytes())
        return js, bufs
    p, js, binb = 12, None, b''
    while p + 8 <= len(d):
        ln, ty = struct.unpack_from('<II', d, p)
        if ty == 0x4E4F534A:
            js = json.loads(d[p + 8:p + 8 + ln])
        elif ty == 0x004E4942:
            binb = d[p + 8:p + 8 + ln]
        p += 8 + ln
    return js, [binb]


def eval_gltf(path, times, unit=100.0, names=None):
    js, bufs = load_glb(path)
    acc, bv = js.get('accessors', []), js.get('bufferViews', [])

    def read(i):
        a = acc[i]; v = bv[a['bufferView']]
        n = {'SCALAR': 1, 'VEC2': 2, 'VEC3': 3, 'VEC4': 4, 'MAT4': 16}[a['type']]
        off = v.get('byteOffset', 0) + a.get('byteOffset', 0)
        x = struct.unpack_from('<%df' % (n * a['count']), bufs[v['buffer']], off)
        return list(x) if n == 1 else [list(x[k:k + n]) for k in range(0, len(x), n)]
    nodes = js['nodes']
    par = {c: i for i, n in enumerate(nodes) for c in n.get('children', [])}
    tr, cubic = {}, set()
    dur, fps = 0.0, None
    anims = js.get('animations', [])
    if anims:
        an = anims[0]
        for c in an['channels']:
            s = an['samplers'][c['sampler']]
            ti = read(s['input']); va = read(s['output'])
            if s.get('interpolation') == 'CUBICSPLINE':
                va = [va[q:q + 3] for q in range(0, len(va), 3)]
                cubic.add((c['target']['node'], c['target']['path']))
            if c['target']['path'] == 'weights':
                k = len(va) // len(ti); va = [va[q:q + k] for q in range(0, len(va), k)]
            tr[(c['target']['node'], c['target']['path'])] = (ti, va)
            dur = max(dur, ti[-1])
            if len(ti) > 1 and fps is None:
                fps = (len(ti) - 1) / (ti[-1] - ti[0])
    joints = {j for s in js.get('skins', []) for j in s['joints']}
    name = [n.get('name', '#%d' % i) for i, n in enumerate(nodes)]
    pos, wts = [], {}
    for t in times:
        world = {}

        def w(i):
            if i not in world:
                n = nodes[i]
                if 'matrix' in n:
                    m = [n['matrix'][4 * c + r] for r in range(4) for c in range(4)]
                else:
                    g = lambda k, d, mix=lerp: (spline if (i, k) in cubic else at)(*tr[(i, k)], t, mix) if (i, k) in tr else n.get(k, d)
                    m = trs(g('translation', [0, 0, 0]), g('rotation', [0, 0, 0, 1], nlerp), g('scale', [1, 1, 1]))
                world[i] = mul(w(par[i]), m) if i in par else m
            return world[i]
        pos.append({name[i]: [unit * w(i)[3], unit * w(i)[7], unit * w(i)[11]] for i in range(len(nodes))})
        for i, n in enumerate(nodes):
            if 'mesh' in n:
                m = js['meshes'][n['mesh']]
                tn = m.get('extras', {}).get('targetNames') or m['primitives'][0].get('extras', {}).get('targetNames') or \
                    (names or {}).get(m.get('name')) or ['%s#%d' % (m.get('name'), k) for k in range(len(m['primitives'][0].get('targets', [])))]
                ww = at(*tr[(i, 'weights')], t) if (i, 'weights') in tr else m.get('weights', [0] * len(tn))
                for k, v in zip(tn, ww):
                    wts.setdefault(k, []).append(v)
    return {'bones': [name[i] for i in sorted(joints)] or name, 'parent': {name[i]: name[par[i]] if i in par else None for i in range(len(nodes))},
            'animated': len({k[0] for k in tr}), 'duration': dur, 'fps': fps, 'pos': pos, 'weights': wts}


# ------------------------------------------------------------------ the readers (each runs in a process of its own)
def r_structure(a):
    i = fbx_structure(a['file'])
    return {'bones': i['bones'], 'parent': i['parent'], 'duration': i['stop'] - i['start'], 'fps': i.get('fps'), 'animated': None,
            'note': 'FBX %d, %d keys, UpAxis %s unit %s%s' % (i['version'], i['keys'], i.get('UpAxis'), i.get('UnitScaleFactor'),
                                                            ('; warnings: ' + '; '.join(i['warnings'])) if i['warnings'] else '')}


def find_node_module(name):
    for d in filter(None, [os.environ.get('CHECK_ANIM_NODE_MODULES'), 'node_modules', HERE + '/node/node_modules', HERE + '/node_modules']):
        if os.path.isdir(os.path.join(d, name)):
            return os.path.abspath(os.path.join(d, name))
    raise NotInstalled('npm package %s' % name)


def r_fbxsdk(a):
    exe = os.environ.get('FBX2GLTF')
    if not exe:
        exe = os.path.join(find_node_module('fbx2gltf'), 'bin', 'Linux', 'FBX2glTF')
    if not os.path.exists(exe):
        raise NotInstalled(exe)
    if not os.access(exe, os.X_OK):       # npm leaves the execute bit off
        os.chmod(exe, os.stat(exe).st_mode | stat.S_IXUSR | stat.S_IXGRP | stat.S_IXOTH)
    fps = a.get('fps') or 60
    rate = 60 if fps % 24 or fps == 120 else 24
    if abs(fps - 30) < .5 or abs(fps - 29.97) < .1:
        rate = 30
    if abs(fps - 24) < .5:
        rate = 24
    with tempfile.TemporaryDirectory() as d:
        pr = subprocess.run([exe, '-b', '-v', '--anim-framerate', 'bake%d' % rate, '--fbx-temp-dir', d, '-i', os.path.abspath(a['file']), '-o', d + '/o'],
                            capture_output=True, text=True, errors='replace', cwd=d)
        lines = [x for x in re.split(r'[\r\n]+', pr.stdout + pr.stderr) if re.search(r'error|warn|fail|corrupt|unable|invalid', x, re.I)]
        if pr.returncode != 0 or not os.path.exists(d + '/o.glb'):
            raise RuntimeError('FBX2glTF exit %d: %s' % (pr.returncode, ' | '.join(lines)[-300:]))
        names, cur = {}, []      # this version drops morph names from the glTF but logs them, before each mesh's line
        for k, v in re.findall(r'(blendshape channel|mesh \d+): ([^\r\n]*)', pr.stdout.split('Animation Scene')[0]):
            if k.startswith('mesh'):
                names.setdefault(re.sub(r' \((skinned|rigid|static).*$', '', v), cur); cur = []
            else:
                cur.append(v)
        res = eval_gltf(d + '/o.glb', a['times'], names=names)
        m = re.search(r'Animation [^\n]*: \[(-?\d+) - (-?\d+)\]', pr.stdout)
        res['off_grid'] = [abs(t * rate - round(t * rate)) > 1e-3 for t in a['times']]   # between two baked samples
        if len(res['parent']) <= 1:
            raise RuntimeError('the SDK gave an empty scene: it rejected the file (FileId/CreationTime/footer, Definitions, or broken records)')
        res['note'] = 'baked at %d fps%s%s' % (rate, ', SDK frames %s..%s' % m.groups() if m else '', ('; ' + ' | '.join(lines)[:200]) if lines else '')
        return res


def canon(axes_cols, unit_cm):
    """Function from file space to Y-up centimetres; axes_cols = unit vectors of right, up, front in file space."""
    return lambda p: [unit_cm * sum(c * v for c, v in zip(ax, p)) for ax in axes_cols]


AXV = [(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)]


def r_ufbx(a):
    try:
        import ufbx
    except ImportError:
        raise NotInstalled('pip ufbx')
    gc.disable()                # ufbx 0.0.5 crashes when its objects are freed: keep them all until the process ends
    s = ufbx.load_file(a['file'])
    KEPT.append(s)
    if not hasattr(s, 'evaluate'):
        raise NotInstalled('ufbx with evaluate() (pyufbx has none)')
    ax, um = s.settings.axes, s.settings.unit_meters * 100
    f = canon([AXV[int(x)] if int(x) < 6 else AXV[d] for x, d in ((ax.right, 0), (ax.up, 2), (ax.front, 4))], um)
    nodes = [n for n in s.nodes]
    KEPT.extend([nodes, ax, [n.parent for n in nodes], [n.bone for n in nodes], [c for c in s.blend_channels]])
    bones = [n.name for n in nodes if n.bone is not None]
    par = {n.name: (n.parent.name or None) if n.parent is not None else None for n in nodes}
    st = s.anim_stacks[0] if len(s.anim_stacks) else None
    KEPT.append(st)
    t0 = st.time_begin if st else 0
    pos, local, wts, moving, first = [], [], {}, set(), {}
    names, chans = [n.name for n in nodes], [c.name for c in s.blend_channels]

    def one(t):
        e = s.evaluate(st.anim, t0 + t) if st else s
        KEPT.append(e)
        o, loc = {}, {}
        for i, nm in enumerate(names):      # by index and without .name: both crash ufbx 0.0.5 on an evaluated scene
            n = e.nodes[i]
            m, l = n.node_to_world, n.local_transform
            c3 = m.c3
            KEPT.append((n, m, c3, l))
            o[nm] = f((c3.x, c3.y, c3.z))
            loc[nm] = (l.translation.x, l.translation.y, l.translation.z, l.rotation.x, l.rotation.y, l.rotation.z, l.rotation.w)
        blends = [e.blend_channels[i] for i in range(len(chans))]
        KEPT.append(blends)
        return o, loc, [(c, b.weight) for c, b in zip(chans, blends)]
    for t in a['times']:        # a child per moment: ufbx 0.0.5 crashes when a second scene is evaluated in one process
        for _ in range(5):      # and now and then even so
            r, w = os.pipe()
            pid = os.fork()
            if pid == 0:
                try:
                    with os.fdopen(w, 'w') as h:
                        json.dump(one(t), h)
                finally:
                    os._exit(0)
            os.close(w)
            with os.fdopen(r) as h:
                txt = h.read()
            os.waitpid(pid, 0)
            if txt:
                break
        else:
            raise RuntimeError('ufbx crashed evaluating t=%g s' % t)
        o, loc, ws = json.loads(txt)
        pos.append(o)
        local.append({k: v[:3] for k, v in loc.items()})
        for k, v in loc.items():
            if k in first and max(abs(x - y) for x, y in zip(v, first[k])) > 1e-6:
                moving.add(k)
            first.setdefault(k, v)
        for k, v in ws:
            wts.setdefault(k, []).append(v)
    return {'bones': bones, 'parent': par, 'animated': len(moving), 'duration': (st.time_end - st.time_begin) if st else 0,
            'fps': s.settings.frames_per_second, 'pos': pos, 'local': local, 'weights': wts,
            'note': 'version %s by %s' % (s.metadata.version, s.metadata.creator)}


def r_pufbx(a):
    try:
        import pufbx
    except ImportError:
        raise NotInstalled('pip pufbx')
    s = pufbx.load_fbx(a['file'])
    st = s.anim_stacks[0]
    fps = a.get('fps') or 60
    # Between keys closer than the minimum rate (19.5 by default) it would draw straight lines.
    b = pufbx.bake_anim(s, st.anim, resample_rate=float(fps), minimum_sample_rate=float(fps))
    tr = {}
    for m in b.modified_nodes:
        k, r, sc = m.translation_keys, m.rotation_keys, m.scale_keys
        g = lambda z, c: ([float(v) for v in z['time']], [[float(q[j]) for j in c] for q in z['value']])
        tr[m.typed_id] = (g(k, 'xyz'), g(r, 'xyzw'), g(sc, 'xyz'))
    nodes = {i: s.nodes[i] for i in range(s.num_nodes)}
    par = {}
    for i, n in nodes.items():
        par[n.name] = (n.parent.name or None) if n.parent else None
    pos = []
    for t in a['times']:
        tt, world = t + st.time_begin, {}

        def w(n):
            if n.typed_id not in world:
                if n.typed_id in tr:
                    T, R, S = tr[n.typed_id]
                    m = trs(at(*T, tt), at(*R, tt, nlerp), at(*S, tt))
                else:
                    M = n.node_to_parent
                    M = M['v'] if isinstance(M, dict) else M
                    m = [M[3 * c + r] if r < 3 else (1.0 if c == 3 else 0.0) for r in range(4) for c in range(4)]
                world[n.typed_id] = mul(w(n.parent), m) if n.parent else m
            return world[n.typed_id]
        pos.append({n.name: a['to_canon'](w(n)[3::4][:3]) for n in nodes.values()})
    return {'bones': [n.name for n in nodes.values() if n.bone is not None], 'parent': par, 'animated': len(tr), 'duration': b.playback_duration,
            'fps': None, 'pos': pos, 'weights': {}, 'note': 'no settings/weights in this binding'}


def r_blender(a):
    try:
        import bpy
    except ImportError:
        raise NotInstalled('pip bpy')
    bpy.ops.wm.read_factory_settings(use_empty=True)
    ext = a['ext']
    if ext == '.fbx':
        bpy.ops.import_scene.fbx(filepath=a['file'], anim_offset=0.0, use_anim=True, ignore_leaf_bones=False)
    elif ext == '.bvh':
        bpy.ops.import_anim.bvh(filepath=a['file'], global_scale=0.01, frame_start=1, axis_forward='-Z', axis_up='Y', update_scene_fps=True, update_scene_duration=True)
    else:
        bpy.context.scene.render.fps = int(round(a.get('fps') or 60))
        bpy.ops.import_scene.gltf(filepath=a['file'])
    sc = bpy.context.scene
    fps = sc.render.fps / sc.render.fps_base
    arms = [o for o in bpy.data.objects if o.type == 'ARMATURE']
    bones, par = [], {}
    for o in arms:
        for b in o.data.bones:
            bones.append(b.name); par[b.name] = b.parent.name if b.parent else None
    nconn = 0
    for o in arms:      # the importer connects a child whose head meets its parent's tail; a connected bone ignores location keys
        nconn += sum(b.use_connect for b in o.data.bones)
        bpy.context.view_layer.objects.active = o
        bpy.ops.object.mode_set(mode='EDIT')
        for b in o.data.edit_bones:
            b.use_connect = False
        bpy.ops.object.mode_set(mode='OBJECT')
    rng = [ac.frame_range for ac in bpy.data.actions]
    dur = (max(r[1] for r in rng) - min(r[0] for r in rng)) / (sc.render.fps if ext == '.fbx' else fps) if rng else 0
    pos, wts = [], {}
    f0 = a.get('t0', 0) * sc.render.fps if ext == '.fbx' else 0
    f1 = 1 if ext == '.bvh' else 0      # the BVH importer puts the first motion line at frame 1
    for t in a['times']:
        # The FBX importer lays keys out at the rounded rate and forgets fps_base (import_fbx.py passes scene.render.fps).
        fr = t * sc.render.fps if ext == '.fbx' else t * fps
        fr = fr + f0 + f1
        sc.frame_set(int(math.floor(fr + 1e-6)), subframe=max(0.0, min(0.999999, fr - math.floor(fr + 1e-6))))
        o_ = {}
        for o in bpy.data.objects:
            v = o.matrix_world.translation
            o_[o.name] = [100 * v.x, 100 * v.z, -100 * v.y]
        for o in arms:
            for pb in o.pose.bones:
                v = (o.matrix_world @ pb.matrix).translation
                o_[pb.name] = [100 * v.x, 100 * v.z, -100 * v.y]
        pos.append(o_)
        for k in bpy.data.shape_keys:
            for kb in k.key_blocks[1:]:
                wts.setdefault(kb.name, []).append(kb.value)
    moving = {n for n in pos[0] if any(max(abs(x - y) for x, y in zip(p[n], pos[0][n])) > 1e-4 for p in pos)} if pos else set()
    return {'bones': bones or [o.name for o in bpy.data.objects], 'parent': par, 'animated': len(moving), 'duration': dur, 'fps': None if ext in ('.glb', '.gltf') else fps, 'pos': pos, 'weights': wts,
            'note': 'Blender %s; "animated" counts joints that moved in the sampled frames%s' % (bpy.app.version_string, '; %d connected bones were disconnected' % nconn if nconn else '')}


def r_assimp(a):
    if not shutil.which('assimp'):
        raise NotInstalled('apt assimp-utils')
    with tempfile.TemporaryDirectory() as d:
        pr = subprocess.run(['assimp', 'export', a['file'], d + '/o.json', '-fassjson'], capture_output=True, text=True, errors='replace')
        if not os.path.exists(d + '/o.json') or 'ERROR' in pr.stdout + pr.stderr:
            raise RuntimeError('assimp: ' + ' '.join(x for x in (pr.stdout + pr.stderr).splitlines() if 'ERROR' in x or 'rror' in x)[-300:])
        js = json.loads(pathlib.Path(d + '/o.json').read_bytes())
    an = (js.get('animations') or [None])[0]
    tr, dur, tps = {}, 0, 1.0
    if an:
        tps = an.get('tickspersecond') or 1.0
        dur = an['duration'] / tps
        if a['ext'] == '.fbx' and a.get('dur') and abs(dur - a['dur']) > .2 * a['dur'] + .1:
            tps *= dur / a['dur']                       # assimp 5.x counts FBX key times differently between releases
            dur = an['duration'] / tps
        for c in an['channels']:
            k = lambda x: ([y[0] / tps for y in c.get(x, [])], [y[1] for y in c.get(x, [])])
            tr[c['name']] = (k('positionkeys'), k('rotationkeys'), k('scalingkeys'))
    flat, par = [], {}

    # An animated bone's channel has its whole transform, yet assimp 5 leaves that at rest in helper nodes above it
    # too (assimp issue 5759), unless pivots are not preserved: so programs turn that off, or pass over the helpers.
    def walk(n, p):
        helps = '$AssimpFbx$' in n['name']
        if not helps:
            par[n['name']] = p
        flat.append(n['name'])
        for c in n.get('children', []):
            walk(c, p if helps else n['name'])
    walk(js['rootnode'], None)
    bones = sorted({b['name'] for m in js.get('meshes', []) for b in m.get('bones', [])})
    pos, s = [], 100.0 if a['ext'] == '.glb' else 1.0    # glTF is in metres
    for t in a['times']:
        o, tt = {}, t + a.get('t0', 0)

        def ev(n, m, above):
            c = tr.get(n['name'])
            if c and c[0][0] and c[1][0]:
                q = at(*c[1], tt, nlerp)
                l, m = trs(at(*c[0], tt), [q[1], q[2], q[3], q[0]], at(*c[2], tt) if c[2][0] else [1, 1, 1]), above
            else:
                l = n['transformation']
            w = mul(m, l) if m else l
            o[n['name']] = [w[3], w[7], w[11]]
            for k in n.get('children', []):
                ev(k, w, above if '$AssimpFbx$' in n['name'] else w)
        ev(js['rootnode'], None, None)
        pos.append({k: a['to_canon'](v) if a['ext'] == '.fbx' else [s * x for x in v] for k, v in o.items()})
    helper = sum('$AssimpFbx$' in n for n in flat)
    return {'bones': bones, 'parent': par, 'animated': len(tr), 'duration': dur, 'fps': None, 'pos': pos, 'weights': {},
            'note': 'no morph weights through assjson' + ('; %d pivot helper nodes' % helper if helper else '')}


THREE_JS = r'''
import fs from 'fs'; import path from 'path'; import {pathToFileURL} from 'url';
globalThis.window ??= globalThis; globalThis.self ??= globalThis;
const [dir, cfgFile] = process.argv.slice(2); const cfg = JSON.parse(fs.readFileSync(cfgFile));
const imp = p => import(pathToFileURL(path.join(dir, p)));
const T = await imp('build/three.module.js'); const file = cfg.file, ext = cfg.ext;
const buf = fs.readFileSync(file); let root, clip, clips;
if (ext === '.fbx') { const {FBXLoader} = await imp('examples/jsm/loaders/FBXLoader.js');
  T.TextureLoader.prototype.load = () => new T.Texture();  // Pictures need a page, which there is none of here.
  root = new FBXLoader().parse(buf.buffer.slice(buf.byteOffset, buf.byteOffset + buf.byteLength), ''); clip = root.animations[0]; }
else if (ext === '.bvh') { const {BVHLoader} = await imp('examples/jsm/loaders/BVHLoader.js');
  const r = new BVHLoader().parse(buf.toString('utf8')); root = new T.Group(); root.add(r.skeleton.bones[0]); clip = r.clip; }
else { const {GLTFLoader} = await imp('examples/jsm/loaders/GLTFLoader.js');
  const g = await new Promise((res, rej) => new GLTFLoader().parse(buf.buffer.slice(buf.byteOffset, buf.byteOffset + buf.byteLength), '', res, rej)); root = g.scene; clip = g.animations[0]; }
const nm = o => o.userData.originalName || o.name; const out = {bones: [], parent: {}, pos: [], weights: {}};
root.traverse(o => { if (o.isBone) out.bones.push(nm(o)); if (nm(o)) out.parent[nm(o)] = o.parent && o !== root ? nm(o.parent) || null : null; });
out.duration = clip ? clip.duration : 0; out.animated = clip ? new Set(clip.tracks.map(t => t.name.replace(/\.[^.]*$/, ''))).size : 0;
out.fps = null; if (clip) for (const t of clip.tracks) if (t.times.length > 1) { out.fps = (t.times.length - 1) / (t.times[t.times.length - 1] - t.times[0]); break; }
let mix = null; if (clip) { mix = new T.AnimationMixer(root); const a = mix.clipAction(clip); a.setLoop(T.LoopOnce); a.clampWhenFinished = true; a.play(); }
for (const t of cfg.times) { if (mix) { mix.stopAllAction(); const a = mix.clipAction(clip); a.reset(); a.play(); mix.setTime(Math.min(t + (ext === '.fbx' ? cfg.t0 : 0), clip.duration)); }
  root.updateMatrixWorld(true); const p = {}; const v = new T.Vector3();
  root.traverse(o => { if (nm(o)) { v.setFromMatrixPosition(o.matrixWorld); p[nm(o)] = [v.x, v.y, v.z]; }
    if (o.morphTargetDictionary) for (const k in o.morphTargetDictionary) (out.weights[k] ??= []).push(o.morphTargetInfluences[o.morphTargetDictionary[k]]); });
  out.pos.push(p); }
out.note = 'three r' + T.REVISION; if (!out.bones.length) out.bones = Object.keys(out.parent);
fs.writeFileSync(cfg.out, JSON.stringify(out));
'''


def r_three(a):
    if not shutil.which('node'):
        raise NotInstalled('node')
    d3 = find_node_module('three')
    with tempfile.TemporaryDirectory() as d:
        pathlib.Path(d + '/r.mjs').write_text(THREE_JS)
        cfg = {k: a[k] for k in ('file', 'ext', 'times', 't0')}
        cfg['file'] = os.path.abspath(cfg['file']); cfg['out'] = d + '/o.json'
        pathlib.Path(d + '/c.json').write_text(json.dumps(cfg))
        pr = subprocess.run(['node', d + '/r.mjs', d3, d + '/c.json'], capture_output=True, text=True, errors='replace')
        if pr.returncode or not os.path.exists(d + '/o.json'):
            er = [x for x in pr.stderr.splitlines() if 'rror' in x]
            raise RuntimeError('three: ' + (er[-1] if er else pr.stderr[-200:]))
        r = json.loads(pathlib.Path(d + '/o.json').read_bytes())
    if a['ext'] == '.fbx':      # FBXLoader leaves the file's unit, and turns Z-up scenes itself
        r['pos'] = [{k: [(a.get('unit') or 1.0) * c for c in v] for k, v in p.items()} for p in r['pos']]
    elif a['ext'] in ('.glb', '.gltf'):
        r['pos'] = [{k: [100 * x for x in v] for k, v in p.items()} for p in r['pos']]
    return r


def r_bvhio(a):
    try:
        import bvhio
    except ImportError:
        raise NotInstalled('pip bvhio')
    c = bvhio.readAsBvh(a['file'])
    h = bvhio.convertBvhToHierarchy(c.Root)
    lay = [j for j, *_ in h.layout()]
    par = {j.Name: (j.Parent.Name if j.Parent is not None else None) for j in lay}
    pos = []
    for t in a['times']:
        h.loadPose(int(round(t / c.FrameTime)))
        pos.append({j.Name: [j.PositionWorld.x, j.PositionWorld.y, j.PositionWorld.z] for j in lay})
    return {'bones': [j.Name for j in lay], 'parent': par, 'animated': len(lay), 'duration': (c.FrameCount - 1) * c.FrameTime, 'fps': 1 / c.FrameTime,
            'pos': pos, 'weights': {}, 'note': '%d frames' % c.FrameCount}


def r_bvh(a):
    try:
        import bvh
    except ImportError:
        raise NotInstalled('pip bvh')
    b = bvh.Bvh(open(a['file']).read())
    n, ft = b.nframes, b.frame_time
    if len(b.frames) != n:
        raise RuntimeError('%d frames declared, %d found' % (n, len(b.frames)))
    js = b.get_joints_names()
    if any(len(f) != len(b.frames[0]) for f in b.frames):
        raise RuntimeError('motion lines of different lengths')
    if len(b.frames[0]) != sum(len(b.joint_channels(j)) for j in js):
        raise RuntimeError('numbers in a motion line: %d, channels: %d' % (len(b.frames[0]), sum(len(b.joint_channels(j)) for j in js)))
    par = {}
    for j in js:
        i = b.joint_parent_index(j)
        par[j] = js[i] if i >= 0 else None
    pos = []
    for t in a['times']:
        fr, world = min(n - 1, int(round(t / ft))), {}
        for j in js:
            off = list(b.joint_offset(j)); rot = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]
            moved = False
            for ch in b.joint_channels(j):
                v = b.frame_joint_channel(fr, j, ch)
                if ch.endswith('position'):
                    if not moved:
                        off, moved = [0.0, 0.0, 0.0], True
                    off['XYZ'.index(ch[0])] = v
                else:
                    rot = mul(rot, rot_axis(ch[0], v))
            m = [1, 0, 0, off[0], 0, 1, 0, off[1], 0, 0, 1, off[2], 0, 0, 0, 1]
            m = mul(m, rot)
            world[j] = mul(world[par[j]], m) if par[j] else m
        pos.append({j: [w[3], w[7], w[11]] for j, w in world.items()})
    return {'bones': js, 'parent': par, 'animated': len(js), 'duration': (n - 1) * ft, 'fps': 1 / ft, 'pos': pos, 'weights': {},
            'note': '%d frames; position channels replace OFFSET (the usual reading)' % n}


def r_pybvh(a):
    try:
        import pybvh
    except ImportError:
        raise NotInstalled('pip pybvh')
    try:
        b = pybvh.read_bvh_file(a['file'])
    except ValueError as e:
        if 'position channels on non-root' in str(e):
            return {'skip': 'pybvh refuses position channels on joints other than the root'}
        raise
    names = [n for n in b.joint_names]
    xyz = b.node_positions() if hasattr(b, 'node_positions') and callable(b.node_positions) else None
    out = {'bones': names, 'parent': {}, 'animated': len(names), 'duration': None, 'fps': 1 / b.frame_time if getattr(b, 'frame_time', None) else None, 'weights': {}, 'pos': [], 'note': ''}
    if xyz is None:
        out['note'] = 'hierarchy only'
        out['pos'] = [{} for _ in a['times']]
    else:
        al = [n.name for n in b.nodes]
        for t in a['times']:
            f = min(len(xyz) - 1, int(round(t * out['fps'])))
            out['pos'].append({k: [float(v) for v in xyz[f][i]] for i, k in enumerate(al)})
    return out


def r_gltf(a):
    r = eval_gltf(a['file'], a['times'])
    r['note'] = 'built-in evaluator'
    return r


def r_gltfvalid(a):
    d = find_node_module('gltf-validator')
    js = "const v=require(process.argv[1]);const b=require('fs').readFileSync(process.argv[2]);v.validateBytes(new Uint8Array(b)).then(r=>{console.log(JSON.stringify(r))},e=>{console.error(e);process.exit(1)})"
    pr = subprocess.run(['node', '-e', js, d, a['file']], capture_output=True, text=True)
    if pr.returncode:
        raise RuntimeError(pr.stderr[-200:])
    r = json.loads(pr.stdout)
    i = r['issues']
    if i['numErrors']:
        raise RuntimeError('%d errors: %s' % (i['numErrors'], '; '.join(m['code'] + ' ' + m.get('pointer', '') for m in i['messages'][:5])))
    return {'bones': [], 'parent': {}, 'animated': None, 'duration': None, 'fps': None, 'weights': {}, 'note': '0 errors, %d warnings' % i['numWarnings']}


def r_usd(a):
    try:
        from pxr import Usd, UsdSkel, UsdGeom
    except ImportError:
        raise NotInstalled('pip usd-core')
    st = Usd.Stage.Open(a['file'])
    sk = [p for p in st.Traverse() if p.IsA(UsdSkel.Skeleton)]
    if not sk:
        raise RuntimeError('no Skeleton prim')
    cache = UsdSkel.Cache()
    mpu = UsdGeom.GetStageMetersPerUnit(st); zup = UsdGeom.GetStageUpAxis(st) == 'Z'
    tps = st.GetTimeCodesPerSecond(); s0 = st.GetStartTimeCode(); pos, wts = [{} for _ in a['times']], {}
    names, par = [], {}
    for p in sk:
        q = cache.GetSkelQuery(UsdSkel.Skeleton(p))
        own = [str(j).split('/')[-1] for j in q.GetJointOrder()]
        topo = q.GetTopology(); an = q.GetAnimQuery()
        names += own
        par |= {n: (own[topo.GetParent(i)] if topo.GetParent(i) >= 0 else None) for i, n in enumerate(own)}
        for o, t in zip(pos, a['times']):
            tc = Usd.TimeCode(s0 + t * tps)
            xf = UsdGeom.Xformable(p).ComputeLocalToWorldTransform(tc)
            for n, x in zip(own, q.ComputeJointSkelTransforms(tc)):
                v = (x * xf).ExtractTranslation()
                o[n] = [100 * mpu * c for c in ((v[0], v[2], -v[1]) if zup else v)]
            if an:
                for k, v in zip(an.GetBlendShapeOrder(), an.ComputeBlendShapeWeights(tc)):
                    wts.setdefault(str(k), []).append(float(v))
    return {'bones': names, 'parent': par, 'animated': len(names),
            'duration': (st.GetEndTimeCode() - s0) / tps, 'fps': st.GetFramesPerSecond(), 'pos': pos, 'weights': wts, 'note': ''}


READERS = {'structure': (r_structure, ('.fbx',), None), 'fbxsdk': (r_fbxsdk, ('.fbx',), None), 'ufbx': (r_ufbx, ('.fbx',), 'ufbx'),
           'pufbx': (r_pufbx, ('.fbx',), 'pufbx'), 'blender': (r_blender, ('.fbx', '.bvh', '.glb', '.gltf'), 'bpy'), 'assimp': (r_assimp, ('.fbx', '.bvh', '.glb'), None),
           'three': (r_three, ('.fbx', '.bvh', '.glb'), None), 'bvhio': (r_bvhio, ('.bvh',), 'bvhio'), 'bvh': (r_bvh, ('.bvh',), 'bvh'),
           'pybvh': (r_pybvh, ('.bvh',), 'pybvh'), 'gltf': (r_gltf, ('.glb', '.gltf'), None), 'gltfvalid': (r_gltfvalid, ('.glb', '.gltf'), None),
           'usd': (r_usd, ('.usd', '.usda', '.usdc'), 'pxr')}


# ------------------------------------------------------------------ worker and parent
def answer(reader, a):
    un = a.get('unit') or 1.0
    a['to_canon'] = canon([tuple(x) for x in a['axes']], un) if a.get('axes') else (lambda p: [un * v for v in p])
    try:
        r = READERS[reader][0](a); r['status'] = 'skipped' if 'skip' in r else 'ok'
    except NotInstalled as e:
        r = {'status': 'not installed', 'note': str(e)}
    except Exception as e:
        r = {'status': 'failed', 'note': '%s: %s' % (type(e).__name__, str(e)[:400])}
    return json.dumps(r)


def worker(reader):
    # One file after another: a request per line of input, an answer per line of output; other output of libraries is
    # separated.
    answers = os.fdopen(os.dup(1), 'w')
    os.dup2(2, 1)
    for line in sys.stdin:
        print(answer(reader, json.loads(line)), file=answers, flush=True)
    os._exit(0)          # some bindings crash while the interpreter is torn down


def interpreters():
    c = [sys.executable] + os.environ.get('CHECK_ANIM_PYTHONS', '').split(':') + sorted(glob.glob(HERE + '/*/bin/python'))
    out = []
    for p in c:
        if p and os.path.exists(p) and p not in out:
            out.append(p)
    return out


@functools.cache
def python_for(module):
    if module is None:
        return sys.executable
    for p in interpreters():
        code = "import importlib.util as u,sys;sys.exit(0 if u.find_spec(%r) else 1)" % module
        if module == 'ufbx':    # pyufbx owns the same name but cannot evaluate
            code = "import ufbx,sys;sys.exit(0 if hasattr(ufbx.Scene,'evaluate') else 1)"
        try:
            if subprocess.run([p, '-c', code], capture_output=True, timeout=60).returncode == 0:
                return p
        except (OSError, subprocess.TimeoutExpired):
            pass
    return None


class Worker:
    """A process that reads files with one library, which takes longer to load than most files to read."""

    def __init__(self, py, name):
        self.log = tempfile.TemporaryFile()
        self.process = subprocess.Popen([py, os.path.abspath(__file__), '--worker', name], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                                        stderr=self.log, start_new_session=True)

    def ask(self, cfg, timeout):
        self.process.stdin.write(json.dumps(cfg).encode() + b'\n')
        self.process.stdin.flush()
        line, end = b'', time.monotonic() + timeout
        while not line.endswith(b'\n'):
            if not select.select([self.process.stdout], [], [], max(0.0, end - time.monotonic()))[0]:
                return None
            more = os.read(self.process.stdout.fileno(), 1 << 20)
            if not more:
                break
            line += more
        return line

    def end(self):
        """The exit status, and the last that it printed."""
        try:
            os.killpg(self.process.pid, signal.SIGKILL)
        except ProcessLookupError:
            pass
        self.process.wait()
        self.process.stdin.close(); self.process.stdout.close()
        self.log.seek(0)
        with self.log:
            return self.process.returncode, self.log.read().decode('utf8', 'replace')


WORKERS = {}


@atexit.register
def end_workers():
    for w in WORKERS.values():
        w.end()
    WORKERS.clear()


def run_reader(name, cfg, timeout):
    if READERS[name][2] is None:    # what is built in, and programs that have processes of their own
        return json.loads(answer(name, dict(cfg)))
    py = python_for(READERS[name][2])
    if py is None:
        return {'status': 'not installed', 'note': 'python module ' + READERS[name][2]}
    w = WORKERS.get(name)
    if w is None:
        w = WORKERS[name] = Worker(py, name)
    try:
        line = w.ask(cfg, timeout)
    except BrokenPipeError:
        line = b''
    if line:
        return json.loads(line)
    del WORKERS[name]
    if line is None:
        w.end()
        return {'status': 'failed', 'note': 'no answer in %d s' % timeout}
    w.process.wait()
    status, out = w.end()
    return {'status': 'failed', 'note': 'reader died (%s) %s' % (('signal %d' % -status) if status < 0 else 'exit %d' % status, out[-200:].strip())}


def main(argv):
    if len(argv) > 1 and argv[0] == '--worker':
        return worker(argv[1])
    ap = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    ap.add_argument('file'); ap.add_argument('--expected'); ap.add_argument('--tol', type=float, default=0.05); ap.add_argument('--wtol', type=float, default=0.005)
    ap.add_argument('--frames'); ap.add_argument('--fps', type=float); ap.add_argument('--readers'); ap.add_argument('--require', default='')
    ap.add_argument('--json'); ap.add_argument('--timeout', type=float, default=120); ap.add_argument('-v', '--verbose', action='store_true')
    o = ap.parse_args(argv)
    if not os.path.isfile(o.file):
        print('no such file: ' + o.file); return 2
    ext = os.path.splitext(o.file)[1].lower()
    names = o.readers.split(',') if o.readers else [n for n, r in READERS.items() if ext in r[1]]
    bad = [n for n in names + [x for x in o.require.split(',') if x] if n not in READERS or ext not in READERS[n][1]]
    if bad or not names:
        print('no reader for %s: %s' % (ext, ', '.join(bad) or '-')); return 2
    exp = json.loads(pathlib.Path(o.expected).read_text()) if o.expected else None
    fps, dur, t0, unit, axes = o.fps, None, 0.0, 1.0, None
    if ext == '.fbx':
        try:
            i = fbx_structure(o.file)
            fps, dur, t0, unit = fps or i.get('fps'), i['stop'] - i['start'], i['start'], i.get('UnitScaleFactor') or 1.0
            if i.get('UpAxis') is not None and i['CoordAxis'] is not None:
                e = lambda k: [(1.0 if j == i[k] else 0.0) * (i[k + 'Sign'] or 1) for j in range(3)]
                axes = [e('CoordAxis'), e('UpAxis'), e('FrontAxis')]
        except Exception:
            pass
    elif ext == '.bvh':
        m = re.search(r'Frames:\s*(\d+)\s+Frame Time:\s*([\d.eE+-]+)', pathlib.Path(o.file).read_text(errors='replace'))
        if m and float(m.group(2)) > 0:
            fps, dur = fps or 1 / float(m.group(2)), (int(m.group(1)) - 1) * float(m.group(2))
    fps = fps or (exp or {}).get('fps') or 60.0
    if exp:
        frames, efps = exp['frames'], exp['fps']
    else:
        last = int(round((dur or 1) * fps)); efps = fps
        frames = [int(x) for x in o.frames.split(',')] if o.frames else sorted({0, last // 4 // 2 * 2, last // 2 // 2 * 2, last // 2 * 2})
    cfg = {'file': os.path.abspath(o.file), 'ext': ext, 'times': [f / efps for f in frames], 'fps': fps, 't0': t0, 'unit': unit, 'axes': axes, 'dur': dur}
    res, failed = {}, False
    ref, refname = (exp['joints'], 'expected') if exp else (None, None)
    refw = (exp or {}).get('weights')
    print('%s  %.3f fps, take %s s from %.3f s, frames %s, tolerance %g' % (o.file, fps, '%.4f' % dur if dur is not None else '?', t0, frames, o.tol))
    for n in names:
        r = res[n] = run_reader(n, cfg, o.timeout)
        if r['status'] == 'ok' and n not in ('gltfvalid',):
            if not r['bones']:
                r.update(status='failed', note='read, but no bones found; ' + r.get('note', ''))
            elif not r['duration'] and n not in ('structure', 'pybvh'):
                r.update(status='failed', note='read, but no animation found; ' + r.get('note', ''))
        print('%-10s %-13s %s' % (n, r['status'], ' '.join((r.get('note') or r.get('skip') or '').split())[:300]))
        if r['status'] == 'failed' or (r['status'] == 'not installed' and n in o.require.split(',')):
            failed = True
        if r['status'] != 'ok' or n == 'gltfvalid':
            continue
        par = r['parent']
        roots = [b for b in r['bones'] if par.get(b) not in r['bones']]
        print('           bones %d, roots %s, nodes %d, animated %s, duration %s s, fps %s' % (
            len(r['bones']), ','.join(roots[:4]), len(par) or len(r['bones']), r['animated'], '%.4f' % r['duration'] if r['duration'] is not None else '?', '%.3f' % r['fps'] if r['fps'] else '?'))
        if dur and r['duration'] is not None and abs(r['duration'] - dur) > 1.5 / fps:
            failed = True
            print('           DIFFERS: duration %.4f s, file says %.4f s' % (r['duration'], dur))
        if not r.get('pos'):
            continue
        ok = lambda x: x if x is not None and all(isinstance(c, (int, float)) and math.isfinite(c) for c in x) else None
        joints = {j: [ok(p.get(j)) for p in r['pos']] for j in (r['bones'] if not exp else exp['joints'])}
        if ref is None:
            good = {j: v for j, v in joints.items() if all(v)}
            if len(good) == len(joints):
                ref, refname = good, n
            else:
                failed = True
                print('           DIFFERS: positions that are not numbers'); continue
        worst, wj, miss, cnt = 0.0, '', [], 0
        grid = r.get('off_grid') or [False] * len(frames)
        for j, v in ref.items():
            if j not in joints or any(x is None for x in joints[j]):
                miss.append(j); continue
            for k, (x, y) in enumerate(zip(joints[j], v)):
                if grid[k]:
                    continue
                cnt += 1
                d = max(abs(p - q) for p, q in zip(x, y))
                if not d <= worst:
                    worst, wj = d, '%s @frame %s' % (j, frames[k])
        good = worst <= o.tol and not miss and cnt
        failed |= not good
        print('           %s: max position difference %.5f to %s over %d samples%s%s%s' % (
            'agrees' if good else 'DIFFERS', worst, refname, cnt, ' (%s)' % wj if wj else '', '; missing joints: ' + ','.join(miss[:5]) if miss else '',
            '; %d frames skipped (not on the bake grid)' % sum(grid) if any(grid) else ''))
        if o.verbose:
            for j in list(joints)[:3]:
                print('             ', j, [[round(c, 4) for c in x] if x else None for x in joints[j]])
        w = {k: v for k, v in r.get('weights', {}).items()}
        if w:
            print('           shapes: ' + '; '.join('%s %s' % (k, [round(x, 4) for x in v[:len(frames)]]) for k, v in list(w.items())[:6]) + (' ... %d in all' % len(w) if len(w) > 6 else ''))
            if refw is None:
                refw = w
            dw, mk = 0.0, [k for k in refw if k not in w]
            for k, v in refw.items():
                if k in w:      # a name that several meshes share has as many values per frame
                    n, m = max(1, len(w[k]) // len(frames)), max(1, len(v) // len(frames))
                    dw = max([dw] + [abs(x - v[i // n * m]) for i, x in enumerate(w[k]) if not grid[i // n]])
            if dw > o.wtol or mk:
                failed = True
            print('           %s: max weight difference %.5f%s' % ('agrees' if dw <= o.wtol and not mk else 'DIFFERS', dw, '; missing shapes: ' + ','.join(mk[:5]) if mk else ''))
    for n in [x for x in o.require.split(',') if x and x not in res]:
        print('%-10s required but not run' % n); failed = True
    if o.json:
        pathlib.Path(o.json).write_text(json.dumps({'file': o.file, 'fps': fps, 'frames': frames, 'readers': res, 'agree': not failed}))
    print('RESULT: ' + ('DISAGREE OR FAILED' if failed else 'all readers that ran agree'))
    return 1 if failed else 0


if __name__ == '__main__':
    sys.exit(main(sys.argv[1:]))
