layout(location = 0) in vec4 from;        // w: width in pixels
layout(location = 1) in vec4 to;          // w: 1 round ends, 0 flat
layout(location = 2) in vec4 color_from;
layout(location = 3) in vec4 color_to;
out vec2 place;      // along and across, in pixels from the first end
out vec4 tint;
flat out vec3 size;  // length, half width, round ends

void main() {
  vec4 a = view_projection * vec4(from.xyz, 1.0);
  vec4 b = view_projection * vec4(to.xyz, 1.0);
  // An end behind the eye is moved along the line to just in front of it.
  const float nearest = 1e-3;
  if (a.w < nearest && b.w > nearest) a = mix(b, a, (b.w - nearest) / (b.w - a.w));
  if (b.w < nearest && a.w > nearest) b = mix(a, b, (a.w - nearest) / (a.w - b.w));
  if (a.w < nearest || b.w < nearest) {
    gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
    return;
  }
  vec3 p = a.xyz / a.w, q = b.xyz / b.w;
  vec2 along = (q.xy - p.xy) * 0.5 * view.xy;
  float span = length(along);
  vec2 u = span > 1e-4 ? along / span : vec2(1.0, 0.0);
  vec2 w = vec2(-u.y, u.x);

  float half_width = 0.5 * from.w * view.z;
  float margin = half_width + 1.0;
  float end = float(gl_VertexID & 1), side = float(gl_VertexID >> 1) * 2.0 - 1.0;
  float overhang = to.w > 0.5 ? margin : 0.0;
  place = vec2(mix(-overhang, span + overhang, end), side * margin);
  tint = mix(color_from, color_to, end);
  size = vec3(span, half_width, to.w);
  vec2 pixel = mix(-overhang, span + overhang, end) * u + place.y * w;
  gl_Position = vec4(p.xy + pixel * 2.0 / view.xy, mix(p.z, q.z, end), 1.0);
}
