#version 120
// Limbs as capsules: what of the sky and of the key light they take from a point of the floor. The nearer a foot is
// to the floor, the darker and sharper its mark.
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
