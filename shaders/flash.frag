// A contact: a soft spot, and for a moment a ring that runs outwards.
in vec2 from_middle;
uniform vec4 tint;   // sRGB
uniform vec2 pulse;  // strength of the ring, its radius 0 to 1
out vec4 color;

void main() {
  float r = length(from_middle);
  float spot = 0.75 * smoothstep(0.42, 0.30, r) + 0.20 * smoothstep(1.0, 0.2, r);
  float ring = pulse.x * smoothstep(0.10, 0.0, abs(r - pulse.y));
  color = vec4(tint.rgb, tint.a * min(spot + ring, 1.0));
}
