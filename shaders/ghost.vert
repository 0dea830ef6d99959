layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
uniform mat4 model;
out vec3 at;
out vec3 facing;
invariant gl_Position;  // the same with every fragment shader

void main() {
  vec4 world = model * vec4(position, 1.0);
  at = world.xyz;
  facing = mat3(model) * normal;
  gl_Position = view_projection * world;
}
