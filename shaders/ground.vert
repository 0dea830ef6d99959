layout(location = 0) in vec3 position;
layout(location = 2) in vec2 uv;
uniform mat4 model;
out vec2 from_middle;
out vec3 shadow_at;

void main() {
  vec4 world = model * vec4(position, 1.0);
  from_middle = uv;
  shadow_at = (light_projection * world).xyz;
  gl_Position = view_projection * world;
}
