"""The programs of the graphics card, in GLSL 120: what every driver of the last fifteen years runs."""

from __future__ import annotations

FIGURE_VERTEX = """
#version 120
uniform sampler2D u_bones;
uniform vec2 u_bones_size;
uniform mat4 u_clip_from_world;
uniform vec3 u_eye;
uniform float u_row;
uniform float u_batched;
uniform float u_lift;
uniform sampler2D u_limbs;
uniform vec2 u_limbs_size;
uniform vec3 u_key;
uniform float u_shaded;
attribute vec3 a_position;
attribute vec3 a_normal;
attribute vec4 a_bones;
attribute vec4 a_weights;
attribute vec4 a_color;
attribute float a_metallic;
attribute float a_row;
varying vec3 v_position;
varying vec3 v_normal;
varying vec4 v_color;
varying float v_metallic;
varying vec2 v_open;
varying float v_solid;

vec4 texel(float column, float row) {
    return texture2DLod(u_bones, (vec2(column, row) + 0.5) / u_bones_size, 0.0);
}

vec4 limb(float column, float row) {
    return texture2DLod(u_limbs, (vec2(column, row) + 0.5) / u_limbs_size, 0.0);
}

// What the player's own limbs and instrument leave of the sky (x) and of the key light (y) at a point of the skin.
vec2 shaded(vec3 p, vec3 n, float row) {
    vec2 open = vec2(1.0);
    for (int i = 0; i < SHADERS; i++) {
        float column = 2.0 * (i == SHADERS - 1 ? HELD : float(i));
        vec4 a = limb(column, row);
        vec4 b = limb(column + 1.0, row);
        vec3 ab = b.xyz - a.xyz;
        vec3 ap = p - a.xyz;
        float length2 = max(dot(ab, ab), 1e-6);
        vec3 off = clamp(dot(ap, ab) / length2, 0.0, 1.0) * ab - ap;
        float d2 = max(dot(off, off), 1e-6);
        float d = sqrt(d2);
        float r = a.w;
        // Skin lies on its own limb: what is inside a capsule is not shaded by it.
        float outside = smoothstep(1.0, 1.3, d / r);
        open.x *= 1.0 - 0.9 * outside * min(r * r / d2, 1.0) * max(dot(n, off) / d, 0.0);
        float along = dot(ab, u_key);
        float det = max(length2 - along * along, 1e-6);
        float s = clamp((dot(ap, ab) - dot(ap, u_key) * along) / det, 0.0, 1.0);
        vec3 on = a.xyz + s * ab - p;
        float far = dot(on, u_key);
        float miss = sqrt(max(dot(on, on) - far * far, 0.0));
        float soft = 0.012 + 0.16 * max(far, 0.0);
        float cover = (1.0 - smoothstep(r - soft, r + soft, miss)) * min(1.0, r / soft);
        open.y *= 1.0 - outside * cover * smoothstep(0.0, 0.03, far);
    }
    return open;
}

void main() {
    float row = u_row + u_batched * a_row;
    vec4 state = texel(u_bones_size.x - 1.0, row);
    if (u_batched > 0.5 && state.x < 0.5) {
        gl_Position = vec4(0.0, 0.0, 2.0, 1.0);
        return;
    }
    vec4 x = vec4(0.0), y = vec4(0.0), z = vec4(0.0);
    for (int i = 0; i < 4; i++) {
        float weight = a_weights[i];
        if (weight > 0.0) {
            float column = 3.0 * a_bones[i];
            x += weight * texel(column, row);
            y += weight * texel(column + 1.0, row);
            z += weight * texel(column + 2.0, row);
        }
    }
    vec4 rest = vec4(a_position, 1.0);
    v_position = vec3(dot(x, rest), dot(y, rest), dot(z, rest));
    v_normal = vec3(dot(x.xyz, a_normal), dot(y.xyz, a_normal), dot(z.xyz, a_normal));
    v_color = a_color;
    v_metallic = a_metallic;
    v_solid = 1.0 - state.z;
    v_open = u_shaded > 0.5 ? shaded(v_position, normalize(v_normal), row) : vec2(1.0);
    vec3 shown = v_position + u_lift * normalize(u_eye - v_position);
    gl_Position = u_clip_from_world * vec4(shown, 1.0);
}
"""

FIGURE_FRAGMENT = """
#version 120
uniform vec3 u_eye;
uniform vec3 u_key;
uniform vec3 u_fill;
uniform vec3 u_rim;
uniform vec3 u_sky;
uniform vec3 u_ground;
uniform vec3 u_key_light;
uniform vec3 u_fill_light;
uniform vec4 u_line;
varying vec3 v_position;
varying vec3 v_normal;
varying vec4 v_color;
varying float v_metallic;
varying vec2 v_open;
varying float v_solid;

// A room to mirror: dark floor, bright ceiling, a large soft window before and one behind.
vec3 room(vec3 d, float blur) {
    vec3 below = mix(vec3(0.055, 0.05, 0.047), vec3(0.24, 0.225, 0.21), smoothstep(-0.1, -0.95, d.y));
    vec3 c = mix(below, vec3(0.34, 0.35, 0.37), smoothstep(-0.12 - blur, 0.14 + blur, d.y));
    c = mix(c, vec3(0.72, 0.74, 0.78), smoothstep(0.25 - 0.6 * blur, 0.95, d.y));
    float window = smoothstep(0.74 - 0.5 * blur, 0.86 + 0.2 * blur, dot(d, u_key));
    float back = smoothstep(0.80 - 0.5 * blur, 0.92 + 0.2 * blur, dot(d, normalize(vec3(0.75, 0.35, -0.55))));
    return c + vec3(2.3, 2.2, 2.05) * window + vec3(0.75, 0.85, 1.0) * back;
}

// Thresholds of ordered dithering (Bayer, 1973), 4 x 4.
float threshold(vec2 at) {
    vec2 p = floor(mod(at, 4.0));
    vec2 q = floor(p / 2.0);
    vec2 r = mod(p, 2.0);
    return (4.0 * (2.0 * mod(r.x + r.y, 2.0) + r.y) + 2.0 * mod(q.x + q.y, 2.0) + q.y + 0.5) / 16.0;
}

void main() {
    // Who stands in the way is seen through: a screen of pixels needs no sorting.
    if (v_solid < 1.0 && v_solid < threshold(gl_FragCoord.xy)) discard;
    if (u_line.a > 0.0) {
        gl_FragColor = u_line;
        return;
    }
    vec3 n = normalize(v_normal);
    vec3 to_eye = normalize(u_eye - v_position);
    if (!gl_FrontFacing) n = -n;
    float facing = clamp(dot(n, to_eye), 0.0, 1.0);
    vec3 albedo = v_color.rgb;
    float rough = v_color.a;

    // Light from all around; the floor takes it from what is low and looks down.
    float low = smoothstep(0.0, 0.55, v_position.y);
    float open = mix(mix(0.35, 0.85, low), 1.0, n.y * 0.5 + 0.5);
    vec3 light = mix(u_ground, u_sky, n.y * 0.5 + 0.5) * open * v_open.x;
    // Skin and cloth scatter: the key reaches around their edge.
    float key = clamp((dot(n, u_key) + 0.22) / 1.22, 0.0, 1.0);
    float fill = clamp((dot(n, u_fill) + 0.5) / 1.5, 0.0, 1.0);
    light += u_key_light * key * key * v_open.y * mix(0.6, 1.0, low) + u_fill_light * fill * v_open.x;

    vec3 f0 = mix(vec3(0.04), albedo, v_metallic);
    float away = 1.0 - facing;
    float away5 = away * away * away * away * away;
    vec3 fresnel = f0 + (max(vec3(1.0 - rough), f0) - f0) * away5;

    float alpha = max(rough * rough, 0.01);
    float power = min(2.0 / (alpha * alpha) - 2.0, 900.0);
    power = max(power, 2.0);
    vec3 h = normalize(u_key + to_eye);
    float shine = (power + 2.0) * 0.06 * pow(max(dot(n, h), 0.0), power);
    vec3 result = albedo * light * (1.0 - v_metallic);
    result += (1.0 - v_metallic) * fresnel * min(shine, 14.0) * max(dot(n, u_key), 0.0) * v_open.y;
    // What is wet or polished catches the fill too: eyes look alive from wherever they are seen.
    float wet = 1.0 - smoothstep(0.12, 0.34, rough);
    float glint = pow(max(dot(n, normalize(u_fill + to_eye)), 0.0), 420.0);
    result += (1.0 - v_metallic) * wet * glint * vec3(0.42, 0.44, 0.47);
    vec3 mirrored = room(reflect(-to_eye, n), rough * 0.55);
    result += mix((1.0 - rough) * 0.55, 1.0, v_metallic) * fresnel * mirrored * mix(0.5, 1.0, low);

    // A light behind parts dark cloth from a dark background.
    float edge = away * away * away;
    result += u_rim * edge * (0.35 + 0.65 * clamp(n.y + 0.35, 0.0, 1.0)) * (0.018 + 0.5 * albedo) * (1.0 - v_metallic);

    // Highlights roll off instead of clipping (ACES, Narkowicz's fit, 2015); then the display's curve.
    result *= 0.92;
    result = (result * (2.51 * result + 0.03)) / (result * (2.43 * result + 0.59) + 0.14);
    gl_FragColor = vec4(pow(clamp(result, 0.0, 1.0), vec3(1.0 / 2.2)), 1.0);
}
"""

BACKDROP_VERTEX = """
#version 120
attribute vec2 a_corner;
varying vec2 v_corner;
void main() {
    v_corner = a_corner;
    gl_Position = vec4(a_corner, 0.9999, 1.0);
}
"""

# Backdrop and floor are one picture: every pixel's line of sight is cut with the floor.
BACKDROP_FRAGMENT = """
#version 120
uniform vec3 u_eye;
uniform vec3 u_forward;
uniform vec3 u_across;
uniform vec3 u_over;
uniform vec3 u_top;
uniform vec3 u_horizon;
uniform vec3 u_floor;
uniform vec3 u_lines;
uniform vec2 u_middle;
uniform float u_radius;
varying vec2 v_corner;

float grid(vec2 at, float cell, float width) {
    vec2 scaled = at / cell;
    vec2 wide = fwidth(scaled);
    vec2 near = abs(fract(scaled - 0.5) - 0.5);
    vec2 line = 1.0 - smoothstep(wide * width, wide * (width + 1.0), near);
    // Where lines are nearer than pixels they would shimmer.
    line *= 1.0 - smoothstep(0.15, 0.5, wide);
    return max(line.x, line.y);
}

void main() {
    vec3 d = normalize(u_forward + v_corner.x * u_across + v_corner.y * u_over);
    vec3 color = mix(u_horizon, u_top, smoothstep(0.0, 0.45, abs(d.y)));
    float reach = -u_eye.y / (abs(d.y) < 1e-4 ? -1e-4 : d.y);
    vec2 at = u_eye.xz + d.xz * reach;
    float lines = max(0.42 * grid(at, 1.0, 0.3), 0.13 * grid(at, 0.25, 0.1));
    if (reach > 0.0) {
        float out_m = length(at - u_middle);
        float pool = 1.0 - smoothstep(0.35 * u_radius, u_radius, out_m);
        float seen = d.y < 0.0 ? 1.0 : 0.35;
        color = mix(color, u_floor, pool * seen);
        color = mix(color, u_lines, lines * pool * seen);
    }
    // Half a step of noise keeps the gradients from banding.
    float noise = fract(sin(dot(gl_FragCoord.xy, vec2(12.9898, 78.233))) * 43758.5453) - 0.5;
    gl_FragColor = vec4(color + noise / 255.0, 1.0);
}
"""

VIDEO_VERTEX = """
#version 120
uniform vec2 u_share;
attribute vec2 a_corner;
varying vec2 v_at;
void main() {
    v_at = vec2(0.5 + 0.5 * a_corner.x, 0.5 - 0.5 * a_corner.y);
    gl_Position = vec4(a_corner * u_share, 0.9999, 1.0);
}
"""

VIDEO_FRAGMENT = """
#version 120
uniform sampler2D u_picture;
uniform float u_opacity;
varying vec2 v_at;
void main() {
    gl_FragColor = vec4(texture2D(u_picture, v_at).rgb, u_opacity);
}
"""

SHADOW_VERTEX = """
#version 120
uniform sampler2D u_limbs;
uniform vec2 u_limbs_size;
uniform mat4 u_clip_from_world;
attribute vec3 a_corner;
varying vec3 v_position;
varying vec2 v_corner;
varying float v_row;
void main() {
    v_row = (a_corner.z + 0.5) / u_limbs_size.y;
    vec4 place = texture2DLod(u_limbs, vec2((u_limbs_size.x - 0.5) / u_limbs_size.x, v_row), 0.0);
    v_corner = a_corner.xy;
    v_position = vec3(place.x + a_corner.x * place.w, 0.0, place.z + a_corner.y * place.w);
    gl_Position = place.w > 0.0 ? u_clip_from_world * vec4(v_position, 1.0) : vec4(0.0, 0.0, 2.0, 1.0);
}
"""

# Limbs as capsules: what of the sky and of the key light they take from a point of the floor. The nearer a foot is
# to the floor, the darker and sharper its mark.
SHADOW_FRAGMENT = """
#version 120
uniform sampler2D u_limbs;
uniform vec2 u_limbs_size;
uniform vec3 u_key;
uniform float u_strength;
uniform vec4 u_ring;
varying vec3 v_position;
varying vec2 v_corner;
varying float v_row;

void main() {
    float sky = 1.0;
    float sun = 1.0;
    vec3 p = v_position;
    for (int i = 0; i < LIMBS; i++) {
        vec4 a = texture2D(u_limbs, vec2((float(2 * i) + 0.5) / u_limbs_size.x, v_row));
        vec4 b = texture2D(u_limbs, vec2((float(2 * i) + 1.5) / u_limbs_size.x, v_row));
        vec3 ab = b.xyz - a.xyz;
        vec3 ap = p - a.xyz;
        float length2 = max(dot(ab, ab), 1e-6);
        float t = clamp(dot(ap, ab) / length2, 0.0, 1.0);
        vec3 off = a.xyz + t * ab - p;
        float r = mix(a.w, b.w, t);
        float d2 = max(dot(off, off), r * r);
        float d = sqrt(d2);
        // Between a ball, which hides as the square of r / d, and an endless tube.
        float near = clamp(r / d, 0.0, 1.0);
        sky *= 1.0 - 0.92 * near * sqrt(near) * (0.25 + 0.75 * clamp(off.y / d, 0.0, 1.0));
        // The point of the limb nearest to the ray to the light.
        float along = dot(ab, u_key);
        float det = max(length2 - along * along, 1e-6);
        float s = clamp((dot(ap, ab) - dot(ap, u_key) * along) / det, 0.0, 1.0);
        vec3 on = a.xyz + s * ab - p;
        float far = dot(on, u_key);
        float miss = sqrt(max(dot(on, on) - far * far, 0.0));
        float rs = mix(a.w, b.w, s);
        float soft = 0.015 + 0.11 * max(far, 0.0);
        float cover = (1.0 - smoothstep(rs - soft, rs + soft, miss)) * min(1.0, rs / soft * 0.85);
        sun *= 1.0 - cover * step(0.0, far);
    }
    float fade = 1.0 - smoothstep(0.7, 1.0, length(v_corner));
    float dark = 1.0 - mix(1.0, sky * mix(0.38, 1.0, sun), u_strength);
    gl_FragColor = vec4(0.0, 0.0, 0.0, dark * fade);
}
"""

RING_VERTEX = """
#version 120
uniform mat4 u_clip_from_world;
uniform vec3 u_middle;
uniform float u_radius;
attribute vec2 a_corner;
varying vec2 v_at;
void main() {
    v_at = a_corner * u_radius * 1.25;
    gl_Position = u_clip_from_world * vec4(u_middle.x + v_at.x, u_middle.y, u_middle.z + v_at.y, 1.0);
}
"""

RING_FRAGMENT = """
#version 120
uniform float u_radius;
uniform vec4 u_color;
varying vec2 v_at;
void main() {
    float off = abs(length(v_at) - u_radius);
    float wide = max(fwidth(length(v_at)), 1e-5);
    float half_width = min(0.006, 1.2 * wide);
    float line = 1.0 - smoothstep(half_width, half_width + wide, off);
    float glow = 0.16 * exp(-off * off / 0.0012);
    gl_FragColor = vec4(u_color.rgb, u_color.a * max(line, glow));
}
"""
