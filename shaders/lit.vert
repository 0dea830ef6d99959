layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 uv;
layout(location = 3) in vec4 color;    // square roots of linear light, opacity
layout(location = 4) in vec3 surface;  // metallic, roughness, 1: drawn flat
uniform mat4 model;
uniform vec4 tint;  // linear; w: how much
out vec3 at;
out vec3 facing;
out vec4 base;
out vec3 metal_rough;
out vec3 shadow_at;
#ifdef TEXTURED
out vec2 texel;
#endif
#ifdef MATTE
out vec3 in_shade;
out vec3 from_key;
#endif

void main() {
  vec4 world = model * vec4(position, 1.0);
  at = world.xyz;
  facing = normalize(mat3(model) * normal);
  vec3 own = color.rgb * color.rgb;
  float lightness = dot(own, vec3(0.21, 0.72, 0.07));
  base = vec4(mix(own, tint.rgb * (0.18 + 0.95 * lightness), tint.w), color.a);
  metal_rough = surface;
  // Moved off the surface by a texel, so that a surface does not shade itself.
  shadow_at = (light_projection * vec4(at + 1.5 * to_light.w * facing, 1.0)).xyz;
#ifdef TEXTURED
  texel = uv;
#endif
#ifdef MATTE
  vec3 around = mix(earth.rgb, sky.rgb, 0.5 + 0.5 * facing.z) +
                sky.rgb * (0.30 * max(dot(facing, kSideLamp), 0.0));
  in_shade = base.rgb * around + 0.08 * sky.rgb;  // the last stands for what it mirrors
  from_key = base.rgb * key.rgb * max(dot(facing, to_light.xyz), 0.0);
#endif
  gl_Position = view_projection * world;
}
