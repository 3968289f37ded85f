#pragma once
#include <nlohmann/json.hpp>

#include "reference/metrics.h"

namespace volgi::app {

/// The figures under the names that data/reference/compare.py gives them; those that do not exist are left out.
nlohmann::ordered_json to_json(const Metrics& metrics);

}  // namespace volgi::app
