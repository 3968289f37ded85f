#pragma once
// k-means of virtual lights as Dong et al. 2009, sections 5 and 6, say it, in double and one light after another.
#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <glm/gtc/constants.hpp>
#include <vector>

#include "shaders/screen/visibility/area_maps/virtual_area_light.shared.h"
#include "shaders/shared/virtual_light.shared.h"

namespace volgi::test {

class PlainKMeans {
 public:
  PlainKMeans(const std::vector<shared::VirtualLight>& lights, int clusters, double diagonal_m, int max_iterations)
      : lights_(lights), diagonal_m_(diagonal_m), cluster_of_(lights.size(), NO_VIRTUAL_AREA_LIGHT) {
    seed(clusters);
    while (iterations_ < max_iterations) {
      if (iterations_ > 0) update();
      if (!assign()) break;
      ++iterations_;
    }
    means_.resize(size_t(clusters));
    update();
  }

  const std::vector<std::uint32_t>& cluster_of() const { return cluster_of_; }
  const std::vector<glm::dvec3>& means() const { return means_; }
  int iterations() const { return iterations_; }
  /// Least difference between a light's distances to its two nearest centers, over all iterations.
  double closest_call() const { return closest_call_; }
  /// Sum of all distances after every assignment.
  const std::vector<double>& objective() const { return objective_; }

 private:
  bool has_flux(size_t i) const { return lights_[i].flux != glm::vec3(0.0f); }

  void seed(int clusters) {
    std::vector<bool> taken(lights_.size(), false);
    size_t left = 0;
    for (size_t i = 0; i < lights_.size(); ++i) left += has_flux(i);
    for (size_t k = 0; k < size_t(clusters) && left > 0; ++k, --left) {
      size_t i = k * lights_.size() / size_t(clusters);
      while (!has_flux(i) || taken[i]) i = (i + 1) % lights_.size();
      taken[i] = true;
    }
    for (size_t i = 0; i < lights_.size(); ++i) {
      if (!taken[i]) continue;
      means_.push_back(glm::dvec3(lights_[i].position));
      normals_.push_back(glm::dvec3(lights_[i].normal));
    }
  }

  double distance(size_t i, size_t k) const {
    const glm::dvec3 n(lights_[i].normal);
    const double angle = std::atan2(glm::length(glm::cross(n, normals_[k])), glm::dot(n, normals_[k]));
    const glm::dvec3 way = glm::dvec3(lights_[i].position) - means_[k];
    return 0.7 * glm::length(way) / diagonal_m_ + 0.3 * angle / glm::pi<double>() +
           2.0 * std::abs(glm::dot(way, normals_[k])) / diagonal_m_;
  }

  bool assign() {
    bool moved = iterations_ == 0;
    double sum = 0.0;
    for (size_t i = 0; i < lights_.size(); ++i) {
      if (!has_flux(i)) continue;
      double smallest = 1e30, second = 1e30;
      std::uint32_t nearest = NO_VIRTUAL_AREA_LIGHT;
      for (size_t k = 0; k < normals_.size(); ++k) {
        const double d = distance(i, k);
        if (d < smallest) {
          second = smallest;
          smallest = d;
          nearest = std::uint32_t(k);
        } else {
          second = std::min(second, d);
        }
      }
      moved = moved || cluster_of_[i] != nearest;
      cluster_of_[i] = nearest;
      closest_call_ = std::min(closest_call_, second - smallest);
      sum += smallest;
    }
    objective_.push_back(sum);
    return moved;
  }

  void update() {
    for (size_t k = 0; k < normals_.size(); ++k) {
      glm::dvec3 position(0.0), normal(0.0);
      int count = 0;
      for (size_t i = 0; i < lights_.size(); ++i) {
        if (cluster_of_[i] != k) continue;
        position += glm::dvec3(lights_[i].position);
        normal += glm::dvec3(lights_[i].normal);
        ++count;
      }
      if (count == 0) continue;
      means_[k] = position / double(count);
      normals_[k] = glm::normalize(normal);
    }
  }

  const std::vector<shared::VirtualLight>& lights_;
  double diagonal_m_;
  std::vector<std::uint32_t> cluster_of_;
  std::vector<glm::dvec3> means_, normals_;  // of clusters with a seed; at the end means_ of all
  std::vector<double> objective_;
  int iterations_ = 0;
  double closest_call_ = 1e30;
};

}  // namespace volgi::test
