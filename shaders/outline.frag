uniform vec4 tint;  // sRGB
out vec4 color;

void main() { color = tint; }
