#version 120
uniform vec2 u_share;
attribute vec2 a_corner;
varying vec2 v_at;
void main() {
    v_at = vec2(0.5 + 0.5 * a_corner.x, 0.5 - 0.5 * a_corner.y);
    gl_Position = vec4(a_corner * u_share, 0.9999, 1.0);
}
