// Brings a picture of one sample a pixel to where it belongs. Edges are found by their contrast and
// blurred along themselves (after Lottes' FXAA, with fewer samples); scaled up everything is blurred
// over a texel, as single texels that were blurred would show as speckles.
uniform sampler2D picture;
uniform vec4 place;  // the rectangle in the target: corner and size, at least the picture's
out vec4 color;

// Green is nearly all of the brightness, and one channel is quick to read.
float brightness(int x, int y) { return texelFetch(picture, ivec2(x, y), 0).g; }

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
  ivec2 low = max(p - 1, ivec2(0)), high = min(p + 1, textureSize(picture, 0) - 1);
  float c = brightness(p.x, p.y), n = brightness(p.x, high.y), e = brightness(high.x, p.y);
  float s = brightness(p.x, low.y), w = brightness(low.x, p.y);
  vec2 along = vec2(s - n, e - w);  // across the gradient
  float flat_part = max(0.03 * (n + e + s + w), 0.008);
  along = clamp(along / (min(abs(along.x), abs(along.y)) + flat_part), -1.6, 1.6) / size;
  // A line as thin as a pixel has no side to be blurred along and would fall into dots: it is left
  // as it is, and a single dot half of it.
  float across_x = (c - e) * (c - w), across_y = (c - n) * (c - s);
  if (max(across_x, across_y) > 4e-4)
    along = vec2(min(across_x, across_y) > 4e-4 ? 0.3 : 0.0) / size;
  color = vec4(0.5 * (texture(picture, uv - along).rgb + texture(picture, uv + along).rgb), 1.0);
#endif
}
