// Brings a picture of one sample a pixel to where it belongs: edges are found by their contrast and
// blurred along themselves (after Lottes' FXAA, with fewer samples).
uniform sampler2D picture;
uniform vec4 place;  // the rectangle in the target: corner and size, at least the picture's
out vec4 color;

// Green is nearly all of the brightness, and one channel is quick to read. Scaled up it is read
// between the texels too, or edges would have speckles.
#ifdef SCALED
float brightness(vec2 uv, vec2 size, vec2 off) { return textureLod(picture, uv + off / size, 0.0).g; }
#else
float brightness(vec2 uv, vec2 size, vec2 off) {
  ivec2 p = ivec2(uv * size + off);
  return texelFetch(picture, clamp(p, ivec2(0), ivec2(size) - 1), 0).g;
}
#endif

void main() {
  vec2 uv = (gl_FragCoord.xy - place.xy) / place.zw;
  vec2 size = vec2(textureSize(picture, 0));
  float nw = brightness(uv, size, vec2(-1, 1)), ne = brightness(uv, size, vec2(1, 1));
  float sw = brightness(uv, size, vec2(-1, -1)), se = brightness(uv, size, vec2(1, -1));
  vec2 along = vec2(sw + se - nw - ne, ne + se - nw - sw);  // across the gradient
  float flat_part = max(0.03 * (nw + ne + sw + se), 0.008);
  along = clamp(along / (min(abs(along.x), abs(along.y)) + flat_part), -1.6, 1.6) / size;
  color = vec4(0.5 * (texture(picture, uv - along).rgb + texture(picture, uv + along).rgb), 1.0);
}
