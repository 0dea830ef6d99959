// Dark where something is about to touch.
in vec2 from_middle;
uniform float strength;
out vec4 color;

void main() {
  float near = clamp(1.0 - dot(from_middle, from_middle), 0.0, 1.0);
  color = vec4(0.0, 0.0, 0.0, strength * near * near);
}
