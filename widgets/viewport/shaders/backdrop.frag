#version 120
// Backdrop and floor are one picture: every pixel's line of sight is cut with the floor.
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
