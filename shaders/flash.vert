layout(location = 0) in vec3 position;
layout(location = 2) in vec2 uv;
uniform mat4 model;
out vec2 from_middle;

void main() {
  from_middle = uv;
  vec4 world = model * vec4(position, 1.0);
  gl_Position = view_projection * world;
  // As deep as if it were nearer by its radius, so that a bent surface does not cut it.
  float radius = length(model[0].xyz);
  vec4 nearer = view_projection * (world + vec4(normalize(eye.xyz - world.xyz) * radius, 0.0));
  if (nearer.w > 0.0) gl_Position.z = nearer.z / nearer.w * gl_Position.w;
}
