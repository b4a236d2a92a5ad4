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
