// Glass: clear where it faces the eye, bright at the rim.
in vec3 at;
in vec3 facing;
uniform vec4 tint;   // sRGB
uniform vec2 alpha;  // facing the eye, at the rim
out vec4 color;

void main() {
  vec3 n = normalize(facing);
  float n_v = abs(dot(n, normalize(eye.xyz - at)));
  float rim = 1.0 - n_v;
  rim *= rim;
  float shade = 0.86 + 0.28 * max(dot(n, to_light.xyz), 0.0);
  color = vec4(min(tint.rgb * shade + 0.12 * rim, 1.0), mix(alpha.x, alpha.y, rim));
}
