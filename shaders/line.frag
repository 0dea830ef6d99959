in vec2 place;
in vec4 tint;
flat in vec3 size;
out vec4 color;

void main() {
  float beyond = size.z > 0.5 ? place.x - clamp(place.x, 0.0, size.x) : 0.0;
  float cover = clamp(size.y + 0.5 - length(vec2(beyond, place.y)), 0.0, 1.0);
  // Thinner than a pixel: fainter instead.
  color = vec4(tint.rgb, tint.a * cover * min(2.0 * size.y, 1.0));
}
