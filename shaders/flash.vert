layout(location = 0) in vec3 position;
layout(location = 2) in vec2 uv;
uniform mat4 model;
out vec2 from_middle;

void main() {
  from_middle = uv;
  gl_Position = view_projection * model * vec4(position, 1.0);
}
