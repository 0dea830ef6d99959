layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
uniform mat4 model;
uniform float width;  // pixels

void main() {
  gl_Position = view_projection * model * vec4(position, 1.0);
  // Outwards in the picture, whatever the distance.
  vec2 out_of = (view_projection * model * vec4(normal, 0.0)).xy * view.xy;
  float far = length(out_of);
  if (far > 1e-12) gl_Position.xy += out_of / far * 2.0 * width * view.z / view.xy * gl_Position.w;
}
