// Shared by all shaders: what is the same for the whole frame.
layout(std140) uniform Frame {
  mat4 view_projection;
  mat4 light_projection;  // world to the shadow map, 0 to 1
  vec4 eye;
  vec4 to_light;          // unit; w: edge of a shadow texel [m]
  vec4 key;               // light's colour, linear
  vec4 sky;               // ambient from above, linear
  vec4 earth;             // ambient from below, linear
  vec4 ground;            // colour of the ground, linear; w: its radius [m]
  vec4 top;               // background's colours, sRGB
  vec4 bottom;
  vec4 view;              // viewport: x, y: size; z: pixels a unit of line width
};

const vec3 kSideLamp = vec3(0.62, 0.54, 0.57);  // unit; a weak lamp that gives shaded sides form

// Filmic curve with the sRGB encoding built in (Hejl and Burgess-Dawson).
vec3 film(vec3 linear) {
  vec3 c = max(vec3(0.0), linear - 0.004);
  return (c * (6.2 * c + 0.5)) / (c * (6.2 * c + 1.7) + 0.06);
}

// The backdrop: brightest a little above the middle, darker to the corners.
vec3 backdrop(vec2 pixel) {
  vec2 p = pixel / view.xy - vec2(0.5, 0.55);
  p.x *= 0.8;
  float fall = min(dot(p, p) * 2.6, 1.0);
  // Half a grey level of noise hides the steps that 8 bits make in a slow gradient.
  float noise = fract(52.98 * fract(dot(pixel, vec2(0.0671, 0.0058)))) - 0.5;
  return mix(top.rgb, bottom.rgb, fall) + noise / 255.0;
}

#ifdef SHADOW_TAPS
uniform sampler2DShadow shadow_map;

// The lit share of a point given in shadow map coordinates, 0 to 1: percentage-closer filtering.
float lit_share(vec3 p) {
#if SHADOW_TAPS == 0
  return 1.0;
#elif SHADOW_TAPS == 1
  return texture(shadow_map, p);
#elif SHADOW_TAPS == 4
  const float r = 0.75 / SHADOW_SIZE;
  float sum = texture(shadow_map, p + vec3(-r, -r, 0.0));
  sum += texture(shadow_map, p + vec3(r, -r, 0.0));
  sum += texture(shadow_map, p + vec3(-r, r, 0.0));
  sum += texture(shadow_map, p + vec3(r, r, 0.0));
  return 0.25 * sum;
#else
  const float r = 2.4 / SHADOW_SIZE;
  float sum = 0.0;
  for (int x = -1; x <= 1; ++x)
    for (int y = -1; y <= 1; ++y) sum += texture(shadow_map, p + vec3(x, y, 0.0) * r);
  return sum / 9.0;
#endif
}
#endif
