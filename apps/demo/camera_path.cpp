#include "apps/demo/camera_path.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <string>

#include "core/error.h"

namespace volgi::demo {
namespace {

constexpr double LIMIT = 3.0;  // of tangents (Fritsch and Carlson 1980: no overshoot in a component)

bool finite(glm::dvec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

/// What is wrong with a key by itself; empty: nothing.
std::string complaint(const CameraKey& key) {
  if (!std::isfinite(key.time_s)) return "time_s is not finite";
  if (!finite(key.pose.position)) return "position is not finite";
  if (!(std::abs(glm::length(key.pose.orientation) - 1.0) < 0.01)) return "orientation is not of length 1";
  if (!std::isfinite(key.scene_time_s)) return "scene_time_s is not finite";
  const double lens = key.pose.ymag_m.value_or(key.pose.yfov_rad);
  if (!std::isfinite(lens) || lens <= 0.0) return "yfov_rad or ymag_m is not above 0";
  return {};
}

/// Rotation vector of a unit quaternion, of at most half a turn, and back.
glm::dvec3 log_of(glm::dquat q) {
  if (q.w < 0.0) q = -q;
  const glm::dvec3 axis(q.x, q.y, q.z);
  const double sine = glm::length(axis);
  return sine < 1e-12 ? 2.0 * axis : 2.0 * std::atan2(sine, q.w) / sine * axis;
}
glm::dquat exp_of(glm::dvec3 v) {
  const double angle = glm::length(v);
  return angle < 1e-12 ? glm::normalize(glm::dquat(1.0, 0.5 * v.x, 0.5 * v.y, 0.5 * v.z))
                       : glm::angleAxis(angle, v / angle);
}
/// The turn from `a` to `b` in a's own axes, which is the same in b's.
glm::dvec3 turn(const glm::dquat& a, const glm::dquat& b) { return log_of(glm::conjugate(a) * b); }
glm::dquat towards(const glm::dquat& a, const glm::dquat& b, double part) { return a * exp_of(part * turn(a, b)); }

/// What of a lens is interpolated, so that it stays above 0.
double lens_of(const CameraPose& pose) { return std::log(pose.ymag_m.value_or(pose.yfov_rad)); }
void set_lens(CameraPose& pose, double lens) { (pose.ymag_m ? *pose.ymag_m : pose.yfov_rad) = std::exp(lens); }

/// Rate of change from one key to the next, and at a key.
struct Rates {
  glm::dvec3 position{0.0}, turn{0.0};
  double lens = 0.0;
};

Rates rates_between(const CameraKey& a, const CameraKey& b) {
  const double seconds = b.time_s - a.time_s;
  return {(b.pose.position - a.pose.position) / seconds, turn(a.pose.orientation, b.pose.orientation) / seconds,
          (lens_of(b.pose) - lens_of(a.pose)) / seconds};
}

double size(double v) { return std::abs(v); }
double size(glm::dvec3 v) { return glm::length(v); }

/// The slope at the middle of three points of the parabola through them, limited. @param early, late  their seconds.
template <class Value>
Value tangent(Value before, Value after, double early, double late) {
  const Value slope = (before * late + after * early) / (early + late);
  const double most = LIMIT * std::min(size(before), size(after));
  return size(slope) > most ? slope * (most / size(slope)) : slope;
}

/// Tangent at the key `i`. At the ends the one that leaves no curvature there, given the next one.
Rates rates_at(const std::vector<CameraKey>& keys, size_t i) {
  const size_t last = keys.size() - 1;
  if (last == 0) return {};
  if (i == 0 || i == last) {
    const Rates segment = i == 0 ? rates_between(keys[0], keys[1]) : rates_between(keys[last - 1], keys[last]);
    if (last == 1) return segment;
    const Rates inner = rates_at(keys, i == 0 ? 1 : last - 1);
    return {1.5 * segment.position - 0.5 * inner.position, 1.5 * segment.turn - 0.5 * inner.turn,
            1.5 * segment.lens - 0.5 * inner.lens};
  }
  const Rates a = rates_between(keys[i - 1], keys[i]), b = rates_between(keys[i], keys[i + 1]);
  const double early = keys[i].time_s - keys[i - 1].time_s, late = keys[i + 1].time_s - keys[i].time_s;
  return {tangent(a.position, b.position, early, late), tangent(a.turn, b.turn, early, late),
          tangent(a.lens, b.lens, early, late)};
}

template <class Value>
Value hermite(Value from, Value to, Value rate_from, Value rate_to, double seconds, double s) {
  const double s2 = s * s, s3 = s2 * s;
  return from * (2.0 * s3 - 3.0 * s2 + 1.0) + to * (3.0 * s2 - 2.0 * s3) +
         (rate_from * (s3 - 2.0 * s2 + s) + rate_to * (s3 - s2)) * seconds;
}

/// De Casteljau's steps along great circles.
glm::dquat bezier(glm::dquat a, glm::dquat b, glm::dquat c, glm::dquat d, double s) {
  a = towards(a, b, s), b = towards(b, c, s), c = towards(c, d, s);
  a = towards(a, b, s), b = towards(b, c, s);
  return glm::normalize(towards(a, b, s));
}

CameraKey between(const std::vector<CameraKey>& keys, size_t i, double time_s) {
  const CameraKey &from = keys[i], &to = keys[i + 1];
  const Rates out = rates_at(keys, i), in = rates_at(keys, i + 1);
  const double seconds = to.time_s - from.time_s, s = (time_s - from.time_s) / seconds;
  CameraKey key = from;
  key.time_s = time_s;
  key.scene_time_s = from.scene_time_s + s * (to.scene_time_s - from.scene_time_s);
  key.pose.position = hermite(from.pose.position, to.pose.position, out.position, in.position, seconds, s);
  const double lens = hermite(lens_of(from.pose), lens_of(to.pose), out.lens, in.lens, seconds, s);
  set_lens(key.pose, std::clamp(lens, std::min(lens_of(from.pose), lens_of(to.pose)),
                                std::max(lens_of(from.pose), lens_of(to.pose))));
  const glm::dquat &a = from.pose.orientation, &d = to.pose.orientation;
  key.pose.orientation =
      bezier(a, a * exp_of(out.turn * (seconds / 3.0)), d * exp_of(in.turn * (-seconds / 3.0)), d, s);
  if (is_level(a) && is_level(d)) key.pose.orientation = levelled(key.pose.orientation);
  return key;
}

/// Weights of keys around the key `i` for the value at its time of the straight line that fits them best.
struct LineFit {
  size_t first = 0;
  std::vector<double> weights;
};

LineFit line_fit(const std::vector<CameraKey>& keys, size_t i, double sigma) {
  const double time = keys[i].time_s, reach = 3.0 * sigma;
  const auto earlier = [](const CameraKey& key, double t) { return key.time_s < t; };
  const auto first = std::lower_bound(keys.begin(), keys.end(), time - reach, earlier);
  LineFit out{size_t(first - keys.begin()), {}};
  double sum = 0.0, moment = 0.0, square = 0.0;
  for (size_t k = out.first; k < keys.size() && keys[k].time_s <= time + reach; ++k) {
    const double away = keys[k].time_s - time, weight = std::exp(-0.5 * away * away / (sigma * sigma));
    out.weights.push_back(weight);
    sum += weight, moment += weight * away, square += weight * away * away;
  }
  const double determinant = sum * square - moment * moment;
  for (size_t k = 0; k < out.weights.size(); ++k)
    out.weights[k] *= (square - moment * (keys[out.first + k].time_s - time)) / determinant;
  return out;
}

CameraPose fitted(const std::vector<CameraKey>& keys, size_t i, const LineFit& fit) {
  CameraPose pose = keys[i].pose;
  glm::dvec3 position(0.0), turned(0.0);
  double lens = 0.0;
  for (size_t k = 0; k < fit.weights.size(); ++k) {
    const CameraPose& other = keys[fit.first + k].pose;
    position += fit.weights[k] * (other.position - pose.position);
    turned += fit.weights[k] * turn(pose.orientation, other.orientation);
    lens += fit.weights[k] * lens_of(other);
  }
  pose.position += position;
  pose.orientation = glm::normalize(pose.orientation * exp_of(turned));
  set_lens(pose, lens);
  return is_level(keys[i].pose.orientation)
             ? CameraPose{pose.position, levelled(pose.orientation), pose.yfov_rad, pose.ymag_m}
             : pose;
}

/// How far apart, where 1 is just within the tolerance.
double distance(const CameraKey& a, const CameraKey& b, const PathTolerance& tolerance) {
  const double angle = glm::length(turn(a.pose.orientation, b.pose.orientation));
  const double lens = std::abs(a.pose.yfov_rad - b.pose.yfov_rad) / tolerance.angle_rad;
  const double view = std::abs(a.pose.ymag_m.value_or(0.0) - b.pose.ymag_m.value_or(0.0)) / tolerance.position_m;
  return std::max({glm::distance(a.pose.position, b.pose.position) / tolerance.position_m, angle / tolerance.angle_rad,
                   lens, view, std::abs(a.scene_time_s - b.scene_time_s) / tolerance.scene_time_s});
}

}  // namespace

CameraPath::CameraPath(std::vector<CameraKey> keys) {
  keys_.reserve(keys.size());
  for (const CameraKey& key : keys) {
    keys_.push_back(key);
    check_last();
  }
}

void CameraPath::check_last() const {
  const size_t i = keys_.size() - 1;
  std::string wrong = complaint(keys_[i]);
  if (wrong.empty() && i > 0) {
    if (!(keys_[i].time_s > keys_[i - 1].time_s))
      wrong = fmt::format("time_s {} is not after the {} of the key before", keys_[i].time_s, keys_[i - 1].time_s);
    if (keys_[i].pose.ymag_m.has_value() != keys_[i - 1].pose.ymag_m.has_value())
      wrong = "perspective and orthographic keys in one path";
  }
  if (!wrong.empty()) throw Error(ExitCode::bad_input, fmt::format("camera path: keys[{}]: {}", i, wrong));
}

void CameraPath::add(const CameraKey& key) {
  while (!keys_.empty() && key.time_s <= keys_.back().time_s) keys_.pop_back();
  keys_.push_back(key);
  check_last();
}

CameraKey CameraPath::at(double time_s) const {
  assert(!keys_.empty());
  const auto later = [](double t, const CameraKey& key) { return t < key.time_s; };
  const auto next = std::upper_bound(keys_.begin(), keys_.end(), time_s, later);
  CameraKey held = next == keys_.begin() ? keys_.front() : *(next - 1);
  if (next == keys_.begin() || next == keys_.end() || held.time_s == time_s) {
    held.time_s = time_s;
    return held;
  }
  return between(keys_, size_t(next - keys_.begin()) - 1, time_s);
}

CameraPath CameraPath::smoothed(double seconds) const {
  CameraPath out = *this;
  for (size_t i = 1; i + 1 < keys_.size(); ++i) {
    const double to_end = std::min(keys_[i].time_s - first_time_s(), last_time_s() - keys_[i].time_s);
    const double sigma = std::min(seconds, to_end / 3.0);
    if (!(sigma > 0.0)) continue;
    const LineFit fit = line_fit(keys_, i, sigma);
    // A line needs keys on both sides.
    if (fit.first < i && fit.first + fit.weights.size() > i + 1) out.keys_[i].pose = fitted(keys_, i, fit);
  }
  return out;
}

CameraPath CameraPath::thinned(const PathTolerance& tolerance) const {
  if (keys_.size() < 3) return *this;
  std::vector<size_t> kept{0, keys_.size() - 1};
  for (;;) {
    CameraPath out;
    for (const size_t k : kept) out.keys_.push_back(keys_[k]);
    // The worst of every segment that is too far off; each pass brings all of them nearer.
    std::vector<size_t> more;
    for (size_t segment = 0; segment + 1 < kept.size(); ++segment) {
      double worst = 1.0;
      size_t where = 0;
      for (size_t k = kept[segment] + 1; k < kept[segment + 1]; ++k) {
        const double off = distance(out.at(keys_[k].time_s), keys_[k], tolerance);
        if (off > worst) worst = off, where = k;
      }
      if (where != 0) more.push_back(where);
    }
    if (more.empty()) return out;
    kept.insert(kept.end(), more.begin(), more.end());
    std::sort(kept.begin(), kept.end());
  }
}

}  // namespace volgi::demo
