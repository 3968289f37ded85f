#pragma once
#include <optional>

#include "core/gl/pass_timer.h"
#include "propagation/light_in/final_gather_cpu.h"
#include "propagation/volume_cpu.h"
#include "screen/base/gbuffer.h"
#include "screen/bounces/volume/contacts.h"

namespace volgi::screen {

/// Pass "propagation/final_gather": what the volume's sides that pixels read have of light, by rays
/// (propagation/light_in/final_gather_cpu.h). It asks the G-buffer which these are: waits for it, as `--backend cpu`
/// waits for virtual lights.
class GatherSeenSides {
 public:
  static constexpr const char* name = "propagation/final_gather";
  /// @param volume  after irradiate(). @return null where nothing is to be gathered (gathers_seen_sides()).
  const SideIrradiance* run(const VolumeCpu& volume, const EmbreeScene& embree, const GBuffer& gbuffer,
                            gl::PassTimer& timer);
  /// After run(), where it has gathered: Contacts.
  void run_contacts(const VolumeCpu& volume, const EmbreeScene& embree, const ContactPicture& picture,
                    const gl::Texture& into, gl::PassTimer& timer);
  FinalGatherCpu::Report report() const { return ran_ ? gather_.report() : FinalGatherCpu::Report{}; }
  size_t contact_pixels() const { return ran_ ? contacts_.pixels() : 0; }
  size_t bytes() const;

 private:
  FinalGatherCpu gather_;
  SideIrradiance irradiance_;
  std::vector<glm::vec4> positions_;  // of pixels
  Contacts contacts_;
  bool ran_ = false;
};

/// Not where bounces are counted or carried over frames, nor by several ranks or other schemes than `ordinates`.
bool gathers_seen_sides(const VolumeOptions& options);

}  // namespace volgi::screen
