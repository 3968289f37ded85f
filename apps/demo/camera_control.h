#pragma once
#include <glm/glm.hpp>

#include "core/camera.h"

// Moves cameras as a hand does. All functions return the camera after the move and keep its depth range:
// with_depth_of() fits that. Positions are in the scene's centred frame [m]. Computed in double from angles that are
// taken anew at every call, so that the axes stay orthonormal however often a camera is moved.
namespace volgi::demo {

/// Where a camera looks: world_from_camera's rotation = about +Y by yaw · about +X by pitch · about +Z by roll.
/// Yaw 0 and pitch 0 look along -Z; pitch is the elevation, above 0 it looks up; roll above 0 leans the camera to its
/// left, which turns the picture to the right. Straight up and down, where yaw and roll turn about the same axis, roll
/// is 0.
struct ViewAngles {
  double yaw_rad = 0.0;
  double pitch_rad = 0.0;
  double roll_rad = 0.0;
};
ViewAngles view_angles(const Camera& camera);
/// The same place and lens, turned. Axes of unit length.
Camera with_angles(const Camera& camera, const ViewAngles& angles);

/// The elevation at which a hand's turning stops, so that up never flips: 89 degrees, where look_at_camera() still
/// takes +Y as up. A camera that is steeper to begin with stays there until it is turned back.
inline constexpr double STEEPEST_RAD = 1.5533430342749532;

/// Turns the camera and its place around `pivot`, which stays where it is in the picture but for the clamp.
/// @param yaw_rad    about +Y: above 0 the eye goes to its right.
/// @param pitch_rad  above 0 the camera looks higher, the eye sinks; clamped to STEEPEST_RAD.
Camera orbited(const Camera& camera, glm::vec3 pivot, double yaw_rad, double pitch_rad);

/// Moves parallel to the picture plane so that what is at the pivot's depth follows the cursor.
/// @param pivot  where it is not in front of the camera its distance stands for its depth.
/// @param drag   the cursor's way [pixels], y down.
Camera panned(const Camera& camera, glm::vec3 pivot, glm::vec2 drag, glm::ivec2 size);

/// Moves towards `pivot`, which stays under the same pixel, until its distance is `factor` times what it was. An
/// orthographic camera's ymag is scaled instead, about the pivot.
/// @param factor  above 0; below 1 nearer.
Camera dollied(const Camera& camera, glm::vec3 pivot, double factor);

/// Flies for a time, then turns on the spot; the turn is clamped as in orbited().
struct Flight {
  glm::vec3 velocity_m_per_s{0.0f};  // to the right, up and forward of the camera's own axes
  double yaw_rad = 0.0;              // above 0 to the left
  double pitch_rad = 0.0;            // above 0 up
};
Camera flown(const Camera& camera, const Flight& flight, double seconds);

/// Keeps the direction of view and the field of view, and puts the whole box into the picture with 5 % to spare, as
/// near as that allows, or with as small a ymag. Its depth range is fitted.
/// @param aspect  width over height of the picture.
Camera framed(const Camera& camera, glm::vec3 bounds_min, glm::vec3 bounds_max, double aspect);

/// Near and far plane around the box as look_at_camera() chooses them: far behind its farthest corner, near at half of
/// the way to it, and within it at 1e-4 of far, which reversed depth in float holds well. Fit again after each move.
/// An orthographic camera gets the box's part in front of it.
Camera with_depth_of(const Camera& camera, glm::vec3 bounds_min, glm::vec3 bounds_max);

/// A pace for scenes of any size: ten seconds along the diagonal [m/s]; 0.1 where there is none.
float typical_speed_m_per_s(glm::vec3 bounds_min, glm::vec3 bounds_max);

/// The camera leans to no side afterwards; what it looks at stays.
Camera levelled(const Camera& camera);

}  // namespace volgi::demo
