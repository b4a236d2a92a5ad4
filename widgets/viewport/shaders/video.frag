#version 120
uniform sampler2D u_picture;
uniform float u_opacity;
varying vec2 v_at;
void main() {
    gl_FragColor = vec4(texture2D(u_picture, v_at).rgb, u_opacity);
}
