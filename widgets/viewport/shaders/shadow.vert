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
