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
varying vec2 v_uv;
uniform float u_textured;
uniform sampler2D u_color_map;
uniform sampler2D u_normal_map;
uniform sampler2D u_surface_map;
// Scale and offset of each map.
uniform vec4 u_color_place;
uniform vec4 u_normal_place;
uniform vec4 u_surface_place;
uniform vec4 u_factor;
// Roughness, metal, strength of the normal map, and least alpha: below 0 none, above 1 a screen of pixels.
uniform vec4 u_surface;
// Longest side of the colour map in pixels, and the least share of a pixel that what is cut out has to cover.
uniform float u_color_px;
uniform float u_least;
// Share of roughness and metal, and of occlusion, that the map has; and the longest side of the normal map in pixels.
uniform vec3 u_shared;

// A room to mirror: dark floor, bright ceiling, a large soft window before and one behind.
vec3 room(vec3 d, float blur) {
    vec3 below = mix(vec3(0.055, 0.05, 0.047), vec3(0.24, 0.225, 0.21), smoothstep(-0.1, -0.95, d.y));
    // The walls are darker than the ceiling: a tube that mirrors both shows that it is round.
    vec3 c = mix(below, vec3(0.16, 0.165, 0.175), smoothstep(-0.12 - blur, 0.14 + blur, d.y));
    c = mix(c, vec3(0.72, 0.74, 0.78), smoothstep(0.32 - 0.6 * blur, 0.95, d.y));
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

// The normal with the relief of a map: its axes from how the picture lies on the surface (Schueler, "Followup: Normal
// Mapping Without Precomputed Tangents", 2013). Green points up the picture, v down.
vec3 leaning(vec3 n, vec3 lean, vec2 at) {
    vec3 px = dFdx(v_position), py = dFdy(v_position);
    vec2 ux = dFdx(at), uy = dFdy(at);
    // A relief finer than pixels would glitter.
    float texels = max(length(ux), length(uy)) * u_shared.z;
    lean.xy *= 1.0 - smoothstep(0.7, 2.5, texels);
    vec3 across = cross(py, n), along = cross(n, px);
    vec3 t = across * ux.x + along * uy.x;
    vec3 b = across * ux.y + along * uy.y;
    float longest = max(dot(t, t), dot(b, b));
    if (longest < 1e-24) return n;
    float scale = inversesqrt(longest);
    return normalize(t * (scale * lean.x) - b * (scale * lean.y) + n * lean.z);
}

// The share of a pixel that is left of what is cut out: from near its edge is as wide as a pixel (Golus, "Anti-aliased
// Alpha Test", 2017); from afar, where a pixel holds many of the picture's, it is about their mean.
float covered(float alpha, float cutoff, vec2 at) {
    float edge = clamp((alpha - cutoff) / max(fwidth(alpha), 1e-3) + 0.5, 0.0, 1.0);
    float mean = clamp((alpha - cutoff) * 2.0 + 0.5, 0.0, 1.0);
    float texels = max(length(dFdx(at)), length(dFdy(at))) * u_color_px;
    return mix(edge, mean, smoothstep(1.0, 2.5, texels));
}

void main() {
    // Who stands in the way is seen through: a screen of pixels needs no sorting.
    if (v_solid < 1.0 && v_solid < threshold(gl_FragCoord.xy)) discard;
    if (u_line.a > 0.0) {
        gl_FragColor = u_line;
        return;
    }
    vec3 n = normalize(v_normal);
    vec3 albedo = v_color.rgb;
    float rough = v_color.a;
    float metallic = v_metallic;
    float hollow = 1.0;
    float share = 1.0;
    if (u_textured > 0.5) {
        vec2 on = v_uv * u_color_place.xy + u_color_place.zw;
        vec4 color = texture2D(u_color_map, on);
        vec4 surface = texture2D(u_surface_map, v_uv * u_surface_place.xy + u_surface_place.zw);
        vec2 at = v_uv * u_normal_place.xy + u_normal_place.zw;
        vec3 lean = texture2D(u_normal_map, at).xyz * 2.0 - 1.0;
        n = leaning(n, vec3(lean.xy * u_surface.z, lean.z), at);
        float alpha = color.a * u_factor.a;
        if (u_surface.w > 1.0 && alpha < threshold(gl_FragCoord.xy)) discard;
        if (u_surface.w >= 0.0 && u_surface.w <= 1.0) {
            share = covered(alpha, u_surface.w, on);
            if (share < u_least) discard;
        }
        albedo = pow(color.rgb, vec3(2.2)) * u_factor.rgb;
        rough = u_surface.x * mix(1.0, surface.g, u_shared.x);
        metallic = u_surface.y * mix(1.0, surface.b, u_shared.x);
        hollow = mix(1.0, surface.r, u_shared.y);
    }
    vec3 to_eye = normalize(u_eye - v_position);
    if (!gl_FrontFacing) n = -n;
    float facing = clamp(dot(n, to_eye), 0.0, 1.0);

    // Light from all around; the floor takes it from what is low and looks down.
    float low = smoothstep(0.0, 0.55, v_position.y);
    float open = mix(mix(0.35, 0.85, low), 1.0, n.y * 0.5 + 0.5);
    vec3 light = mix(u_ground, u_sky, n.y * 0.5 + 0.5) * open * v_open.x * hollow;
    // Skin and cloth scatter: the key reaches around their edge.
    float key = clamp((dot(n, u_key) + 0.22) / 1.22, 0.0, 1.0);
    float fill = clamp((dot(n, u_fill) + 0.5) / 1.5, 0.0, 1.0);
    light += u_key_light * key * key * v_open.y * mix(0.6, 1.0, low) + u_fill_light * fill * v_open.x;

    vec3 f0 = mix(vec3(0.04), albedo, metallic);
    float away = 1.0 - facing;
    float away5 = away * away * away * away * away;
    vec3 fresnel = f0 + (max(vec3(1.0 - rough), f0) - f0) * away5;

    float alpha = max(rough * rough, 0.01);
    float power = min(2.0 / (alpha * alpha) - 2.0, 900.0);
    power = max(power, 2.0);
    vec3 h = normalize(u_key + to_eye);
    float shine = (power + 2.0) * 0.06 * pow(max(dot(n, h), 0.0), power);
    vec3 result = albedo * light * (1.0 - metallic);
    result += (1.0 - metallic) * fresnel * min(shine, 14.0) * max(dot(n, u_key), 0.0) * v_open.y;
    // What is wet or polished catches the fill too: eyes look alive from wherever they are seen.
    float wet = 1.0 - smoothstep(0.12, 0.34, rough);
    float glint = pow(max(dot(n, normalize(u_fill + to_eye)), 0.0), 420.0);
    result += (1.0 - metallic) * wet * glint * vec3(0.42, 0.44, 0.47);
    vec3 mirrored = room(reflect(-to_eye, n), rough * 0.55);
    result += mix((1.0 - rough) * 0.55, 1.0, metallic) * fresnel * mirrored * mix(0.5, 1.0, low) * hollow;

    // A light behind parts dark cloth from a dark background.
    float edge = away * away * away;
    result += u_rim * edge * (0.35 + 0.65 * clamp(n.y + 0.35, 0.0, 1.0)) * (0.018 + 0.5 * albedo) * (1.0 - metallic);

    // Highlights roll off instead of clipping (ACES, Narkowicz's fit, 2015); then the display's curve.
    result *= 0.92;
    result = (result * (2.51 * result + 0.03)) / (result * (2.43 * result + 0.59) + 0.14);
    gl_FragColor = vec4(pow(clamp(result, 0.0, 1.0), vec3(1.0 / 2.2)), share);
}
