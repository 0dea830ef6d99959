void main() {
  // One triangle that covers the viewport, at the far end of depth.
  vec2 corner = vec2((gl_VertexID & 1) * 4 - 1, (gl_VertexID >> 1) * 4 - 1);
  gl_Position = vec4(corner, 1.0, 1.0);
}
