// The floor under everything: catches shadows and fades into the backdrop.
in vec2 from_middle;
in vec3 shadow_at;
out vec4 color;

void main() {
  float fade = clamp(1.0 - dot(from_middle, from_middle), 0.0, 1.0);
  float lit = to_light.z * lit_share(shadow_at);
  vec3 surface = film(ground.rgb * (sky.rgb + key.rgb * lit));
  color = vec4(mix(backdrop(gl_FragCoord.xy), surface, fade * fade), 1.0);
}
