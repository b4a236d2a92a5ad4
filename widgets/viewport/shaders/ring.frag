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
