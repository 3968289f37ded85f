#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "propagation/passage_face.h"

namespace volgi {

/// Rays through narrow passages. A door ajar is a hundredth of what a room's sides see and brings all of their light:
/// of rays by the cosine few find it, and the room behind it is as bright as luck has it (15 cm in 136 cells: 1.13 of
/// the light). So what passes its faces is asked for by rays that are sent there, and left out of the others. Both
/// count the same faces, and together they are what rays by the cosine are in the mean. Passages that a point is next
/// to it sees well; they are left to the cosine. In cells; surfaces' normals as in the world.
class PassageAim {
 public:
  explicit PassageAim(std::span<const PassageFace> faces);
  bool empty() const { return passages_.empty(); }
  /// Whether a point [cells] is in a passage or next to one, where all of its light goes.
  bool is_beside(glm::vec3 point) const;

  /// What one point sees of passages: which are sent rays, and how often.
  class From {
   public:
    /// @param point  [cells].
    From(const PassageAim& aim, glm::vec3 point, glm::vec3 normal);
    bool empty() const { return shares_.empty(); }

    struct Ray {
      glm::vec3 target;  // on a face [cells]
      float weight;      // of the radiosity that it brings, in irradiance
    };
    /// @param n, of  the ray's number among so many. @param seed  chooses the place on a face.
    Ray ray(int n, int of, std::uint32_t seed) const;
    /// Faces of these passages that the way to `to` [cells] crosses.
    int crossed(glm::vec3 to) const;

   private:
    struct Share {
      int passage;
      float share;  // of the irradiance, where nothing hides it
    };
    const PassageAim& aim_;
    glm::vec3 point_, normal_;
    std::vector<Share> shares_;
    float sum_ = 0.0f;
  };

 private:
  struct Passage {
    std::vector<PassageFace> faces;
    glm::vec3 low{1e30f}, high{-1e30f};  // around its faces
  };
  std::vector<Passage> passages_;
};

}  // namespace volgi
