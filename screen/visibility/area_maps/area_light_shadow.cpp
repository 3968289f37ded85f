#include "screen/visibility/area_maps/area_light_shadow.h"

#include "screen/visibility/area_maps/convolution_shadow.h"
#include "screen/visibility/area_maps/percentage_closer_shadow.h"
#include "screen/visibility/area_maps/single_shadow.h"

namespace volgi::screen {

std::unique_ptr<AreaLightShadow> AreaLightShadow::make(Method method, Filter filter, int resolution, int layers) {
  switch (method) {
    case Method::convolution:
      return std::make_unique<ConvolutionShadow>(resolution, layers, filter);
    case Method::percentage_closer:
      return std::make_unique<PercentageCloserShadow>();
    case Method::single:
      break;
  }
  return std::make_unique<SingleShadow>();
}

}  // namespace volgi::screen
