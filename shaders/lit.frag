// Metallic-roughness shading: one key light with shadow, ambient from above and below.
in vec3 at;
in vec3 facing;
in vec2 texel;
in vec3 base;
in vec2 metal_rough;
in vec3 shadow_at;
uniform sampler2D base_texture;
out vec4 color;

void main() {
  vec3 albedo = base * texture(base_texture, texel).rgb;
  vec3 n = normalize(facing);
  vec3 v = normalize(eye.xyz - at);
  vec3 h = normalize(v + to_light.xyz);
  float n_l = max(dot(n, to_light.xyz), 0.0);
  float n_v = clamp(dot(n, v), 0.0, 1.0);
  float n_h = clamp(dot(n, h), 0.0, 1.0);
  float l_h = clamp(dot(to_light.xyz, h), 0.1, 1.0);

  float metallic = metal_rough.x;
  float a = max(metal_rough.y * metal_rough.y, 0.02);
  vec3 diffuse = albedo * (0.96 - 0.96 * metallic);
  vec3 specular = mix(vec3(0.04), albedo, metallic);

  // GGX with a cheap fit of visibility and Fresnel terms.
  float d = n_h * n_h * (a * a - 1.0) + 1.00001;
  float highlight = a * a / (d * d * l_h * l_h * (4.0 * a + 2.0));

  vec3 around = mix(earth.rgb, sky.rgb, 0.5 + 0.5 * n.z);
  vec3 mirrored = reflect(-v, n);
  float above = clamp(0.5 + mirrored.z * (1.6 - a), 0.0, 1.0);
  vec3 reflected = mix(earth.rgb, 1.7 * sky.rgb, above * above);
  float rim = 1.0 - n_v;
  rim *= rim * rim * rim;
  vec3 glance = mix(specular, vec3(clamp(1.04 - a, 0.04, 1.0)), rim) / (a * a + 1.0);

  float lit = n_l * lit_share(shadow_at);
  color = vec4(film(diffuse * around + glance * reflected +
                    key.rgb * lit * (diffuse + highlight * specular)), 1.0);
}
