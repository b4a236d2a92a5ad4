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
attribute vec2 a_more_bones;
attribute vec2 a_more_weights;
attribute vec4 a_color;
attribute float a_metallic;
attribute float a_row;
attribute vec2 a_uv;
varying vec3 v_position;
varying vec3 v_normal;
varying vec4 v_color;
varying float v_metallic;
varying vec2 v_open;
varying float v_solid;
varying vec2 v_uv;

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

// Adds a bone's share to the rows of the matrix that moves the vertex.
void moved(float bone, float weight, float row, inout vec4 x, inout vec4 y, inout vec4 z) {
    if (weight > 0.0) {
        float column = 3.0 * bone;
        x += weight * texel(column, row);
        y += weight * texel(column + 1.0, row);
        z += weight * texel(column + 2.0, row);
    }
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
        moved(a_bones[i], a_weights[i], row, x, y, z);
    }
    for (int i = 0; i < 2; i++) {
        moved(a_more_bones[i], a_more_weights[i], row, x, y, z);
    }
    vec4 rest = vec4(a_position, 1.0);
    v_position = vec3(dot(x, rest), dot(y, rest), dot(z, rest));
    v_normal = vec3(dot(x.xyz, a_normal), dot(y.xyz, a_normal), dot(z.xyz, a_normal));
    v_color = a_color;
    v_metallic = a_metallic;
    v_uv = a_uv;
    v_solid = 1.0 - state.z;
    v_open = u_shaded > 0.5 ? shaded(v_position, normalize(v_normal), row) : vec2(1.0);
    vec3 shown = v_position + u_lift * normalize(u_eye - v_position);
    gl_Position = u_clip_from_world * vec4(shown, 1.0);
}
