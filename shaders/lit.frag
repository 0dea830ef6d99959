// Metallic-roughness shading: a key light with shadow, and a studio around that is mirrored.
in vec3 at;
in vec3 facing;
in vec4 base;
in vec3 metal_rough;
in vec3 shadow_at;
out vec4 color;

#ifdef TEXTURED
in vec2 texel;
uniform sampler2D color_texture;
uniform sampler2D surface_texture;
uniform sampler2D normal_texture;
uniform sampler2D emission_texture;
uniform vec4 glow;     // linear
uniform float bump;    // strength of the normal texture, 0: none
uniform float cutoff;  // less opaque is not there

// The frame of the texture follows from how position and coordinates change over the picture
// (Schueler's cotangent frame), so that no tangents are needed.
vec3 bumped(vec3 n) {
  vec3 dx = dFdx(at), dy = dFdy(at);
  vec2 tx = dFdx(texel), ty = dFdy(texel);
  vec3 across_y = cross(dy, n), across_x = cross(n, dx);
  vec3 t = across_y * tx.x + across_x * ty.x;
  vec3 b = across_y * tx.y + across_x * ty.y;
  float size = max(dot(t, t), dot(b, b));
  if (bump == 0.0 || size < 1e-30) return n;
  vec3 m = texture(normal_texture, texel).xyz * 2.0 - 1.0;
  // Green points up in a picture whose rows count down.
  return normalize((t * m.x - b * m.y) * (bump * inversesqrt(size)) + n * m.z);
}
#endif

// A studio: floor and ceiling, a wide lamp overhead and one at the side, blurred by roughness.
vec3 studio(vec3 d, float a) {
  float blur = 0.06 + 0.94 * a;
  vec3 room = mix(0.7 * earth.rgb, sky.rgb, smoothstep(-blur, blur, d.z + 0.1));
  float overhead = smoothstep(0.72 - 0.7 * blur, 0.80 + 0.2 * blur, d.z);
  float side = smoothstep(0.88 - 0.8 * blur, 0.93 + 0.07 * blur, dot(d, kSideLamp));
  return room + sky.rgb * (1.0 * overhead + 1.9 * side) * (1.0 - 0.75 * a);
}

void main() {
  vec3 n = normalize(facing);
  vec4 own = base;
  vec2 surface = metal_rough.xy;
  bool flat_shaded = metal_rough.z > 0.5;
  if (flat_shaded) {
    // The triangle's own, on the side that is seen.
    n = normalize(cross(dFdx(at), dFdy(at)));
    if (dot(n, eye.xyz - at) < 0.0) n = -n;
  }
#ifdef TEXTURED
  own *= texture(color_texture, texel);
  if (own.a < cutoff) discard;
  surface *= texture(surface_texture, texel).bg;
  if (!gl_FrontFacing && !flat_shaded) n = -n;
  n = bumped(n);
#endif
  vec3 albedo = own.rgb;
  vec3 v = normalize(eye.xyz - at);
  vec3 h = normalize(v + to_light.xyz);
  float n_l = max(dot(n, to_light.xyz), 0.0);
  float n_v = clamp(dot(n, v), 0.0, 1.0);
  float n_h = clamp(dot(n, h), 0.0, 1.0);
  float l_h = clamp(dot(to_light.xyz, h), 0.1, 1.0);

  float metallic = surface.x;
  float a = max(surface.y * surface.y, 0.02);
  vec3 diffuse = albedo * (0.96 - 0.96 * metallic);
  vec3 specular = mix(vec3(0.04), albedo, metallic);

  // GGX with a cheap fit of visibility and Fresnel terms.
  float d = n_h * n_h * (a * a - 1.0) + 1.00001;
  float highlight = a * a / (d * d * l_h * l_h * (4.0 * a + 2.0));

  vec3 around = mix(earth.rgb, sky.rgb, 0.5 + 0.5 * n.z) +
                sky.rgb * (0.30 * max(dot(n, kSideLamp), 0.0));
  vec3 reflected = studio(reflect(-v, n), a);
  float rim = 1.0 - n_v;
  rim *= rim * rim * rim;
  vec3 glance = mix(specular, vec3(clamp(1.04 - a, 0.04, 1.0)), rim) / (a * a + 1.0);

  float lit = n_l * lit_share(shadow_at);
  vec3 light = diffuse * around + glance * reflected +
               key.rgb * lit * (diffuse + highlight * specular);
#ifdef TEXTURED
  light += glow.rgb * texture(emission_texture, texel).rgb;
#endif
  color = vec4(film(light), own.a);
}
