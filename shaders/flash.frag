// A contact: a soft patch with a clear edge, and for a moment a ring that runs outwards.
in vec2 from_middle;
uniform vec4 tint;   // sRGB
uniform vec2 pulse;  // strength of the ring, its radius 0 to 1
out vec4 color;

void main() {
  float r = length(from_middle);
  float soft = fwidth(r) + 0.02;
  float patch_ = 0.50 * smoothstep(0.62, 0.10, r) + 0.28 * smoothstep(0.62 + soft, 0.62, r);
  float edge = 0.75 * smoothstep(0.045 + soft, 0.02, abs(r - 0.62));
  float ring = pulse.x * smoothstep(0.10, 0.0, abs(r - pulse.y));
  vec3 light = mix(tint.rgb, vec3(1.0), 0.25 * smoothstep(0.3, 0.0, r));
  color = vec4(light, tint.a * min(max(patch_, edge) + ring, 1.0));
}
