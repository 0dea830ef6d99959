// Brings a picture of one sample a pixel to where it belongs. Edges are found by their contrast and
// blurred along themselves (after Lottes' FXAA, with fewer samples); scaled up everything is blurred
// over a texel, as single texels that were blurred would show as speckles.
uniform sampler2D picture;
uniform vec4 place;  // the rectangle in the target: corner and size, at least the picture's
out vec4 color;

// Green is nearly all of the brightness, and one channel is quick to read.
float brightness(ivec2 p) {
  return texelFetch(picture, clamp(p, ivec2(0), textureSize(picture, 0) - 1), 0).g;
}

void main() {
  vec2 uv = (gl_FragCoord.xy - place.xy) / place.zw;
  vec2 size = vec2(textureSize(picture, 0));
#ifdef SCALED
  vec2 r = 0.5 / size;
  vec3 sum = texture(picture, uv + r).rgb + texture(picture, uv - r).rgb +
             texture(picture, uv + vec2(r.x, -r.y)).rgb + texture(picture, uv + vec2(-r.x, r.y)).rgb;
  color = vec4(0.25 * sum, 1.0);
#else
  ivec2 p = ivec2(uv * size);
  float nw = brightness(p + ivec2(-1, 1)), ne = brightness(p + ivec2(1, 1));
  float sw = brightness(p + ivec2(-1, -1)), se = brightness(p + ivec2(1, -1));
  vec2 along = vec2(sw + se - nw - ne, ne + se - nw - sw);  // across the gradient
  float flat_part = max(0.03 * (nw + ne + sw + se), 0.008);
  along = clamp(along / (min(abs(along.x), abs(along.y)) + flat_part), -1.6, 1.6) / size;
  color = vec4(0.5 * (texture(picture, uv - along).rgb + texture(picture, uv + along).rgb), 1.0);
#endif
}
