#include "core/error.h"
#include "propagation/transport_conservative_cpu.h"
#include "propagation/transport_ordinates_cpu.h"

namespace volgi {

std::unique_ptr<TransportCpu> make_transport(const VoxelGrid& voxels, const SchemeOptions& options,
                                             const VoxelGrid* half_voxels, const RanksOfVolume* ranks,
                                             const RanksOfVolume* half_ranks) {
  switch (options.scheme) {
    case Scheme::ordinates:
      return std::make_unique<OrdinatesTransportCpu>(voxels, choose_ordinates(voxels.grid().cells, options), nullptr,
                                                     ranks, SweepPipeline::AtOnce{},
                                                     choose_source_ordinates(voxels.grid().cells, options));
    case Scheme::conservative:
      return std::make_unique<ConservativeTransportCpu>(voxels, options.sh_order,
                                                        options.coarse_start.value_or(true) ? half_voxels : nullptr,
                                                        nullptr, ranks, half_ranks);
    case Scheme::gaitatzes2010:
    case Scheme::lpv2009:
      break;
  }
  throw Error(ExitCode::usage, "gaitatzes2010 and lpv2009 know no sides: they have no transport operator");
}

}  // namespace volgi
