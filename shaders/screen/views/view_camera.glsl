// The camera of what is drawn over a picture: set_view_camera() of screen/views/view_camera_internal.h.
#ifndef VOLGI_VIEW_CAMERA_GLSL
#define VOLGI_VIEW_CAMERA_GLSL

uniform mat4 clip_from_world;
uniform vec4 viewer;         // position and 1, or the direction towards an orthographic camera and 0
uniform vec2 picture_size;   // [pixels]
uniform float pixel_at_1_m;  // edge of a pixel [m] where clip.w is 1

const vec4 NOWHERE = vec4(0.0, 0.0, 2.0, 1.0);  // nearer than the near plane: nothing is drawn

vec3 to_viewer(vec3 position) { return normalize(viewer.xyz - position * viewer.w); }

// A position in the picture, with the depth of a place nearer to the viewer by `nearer_m`: what lies in a surface is
// then not hidden by it.
vec4 clip_position(vec3 position, float nearer_m) {
  vec4 clip = clip_from_world * vec4(position, 1.0);
  float way = viewer.w == 0.0 ? nearer_m : min(nearer_m, 0.5 * distance(viewer.xyz, position));
  vec4 nearer = clip_from_world * vec4(position + way * to_viewer(position), 1.0);
  // Never behind the near plane for that.
  clip.z = min(nearer.z / nearer.w, 0.999999) * clip.w;
  return clip;
}

#endif
