// Diffuse light only, worked out at the vertices: for large surfaces where a processor draws.
in vec3 shadow_at;
in vec3 in_shade;
in vec3 from_key;
out vec4 color;

void main() { color = vec4(film(in_shade + from_key * lit_share(shadow_at)), 1.0); }
