out vec4 color;

void main() { color = vec4(backdrop(gl_FragCoord.xy), 1.0); }
