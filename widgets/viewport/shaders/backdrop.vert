#version 120
attribute vec2 a_corner;
varying vec2 v_corner;
void main() {
    v_corner = a_corner;
    gl_Position = vec4(a_corner, 0.9999, 1.0);
}
